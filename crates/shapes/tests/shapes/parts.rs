//! A part of a mesh answers as the whole does, for its own triangles.

use std::sync::Arc;

use glam::Vec3A;
use nestray_core::aabb::Aabb;
use nestray_core::beam::Beam;
use nestray_core::children::Children;
use nestray_core::hit::{Hit, InstancePath};
use nestray_core::names::Names;
use nestray_core::ray::{Ray, RayKind, Source};
use nestray_core::scratch::Scratch;
use nestray_core::simd::SCALAR;
use nestray_core::technique::{Leaf, Leaves};
use nestray_shapes::shape::Sides;
use nestray_shapes::triangle_mesh::{Mesh, Shared, Soup, TriangleMesh, Triangles};

use crate::numbers::Numbers;

/// A bumpy sheet of `2 · n²` triangles, and one that cannot be hit.
fn sheet(n: u32) -> Arc<Triangles> {
    let mut numbers = Numbers(7);
    let mut positions = Vec::new();
    for j in 0..=n {
        for i in 0..=n {
            positions.push([i as f32, j as f32, numbers.between(0.0, 1.0) as f32]);
        }
    }
    positions.push([f32::NAN; 3]);
    let bad = positions.len() as u32 - 1;
    let at = |i: u32, j: u32| j * (n + 1) + i;
    let cells = (0..n * n).map(|cell| (cell % n, cell / n));
    let faces = cells.flat_map(|(i, j)| {
        let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i, j + 1), at(i + 1, j + 1)];
        [[a, b, c], [b, d, c]]
    });
    let faces = faces.chain([[0, 1, bad]]).collect();
    Arc::new(Triangles::new(positions, faces).expect("the corners are there"))
}

/// Puts all usable children into leaves of a few.
pub(super) fn packed<L>(mut mesh: Mesh<L>) -> (Mesh<L>, Vec<Leaf>)
where
    Mesh<L>: Children,
{
    let names = Names::keeping(Children::count(&mesh), |child| !mesh.bounds(child).is_empty());
    let all: Vec<u32> = (0..names.count()).collect();
    let mut leaves = Leaves::default();
    for few in all.chunks(11) {
        leaves.push(few);
    }
    let leaves = mesh.pack(&leaves, &names);
    (mesh, leaves)
}

fn rays(size: f64, count: usize) -> Vec<Ray> {
    let mut numbers = Numbers(3);
    let mut point = |z: f64| {
        let at = [0; 2].map(|_| numbers.between(0.0, size) as f32);
        Vec3A::new(at[0], at[1], z as f32)
    };
    (0..count)
        .map(|i| {
            let (from, to) = (point(5.0), point(0.0));
            let source =
                Source { geometry: 4, primitive: i as u32 % 200, path: InstancePath::NONE };
            Ray::new(from, to - from, RayKind::Camera).leaving(source)
        })
        .collect()
}

/// The nearest of some children, tested one by one.
fn nearest(mesh: &impl Children, children: impl Iterator<Item = u32>, ray: &Ray) -> Hit {
    let mut hit = Hit::none(ray.t_max());
    for child in children {
        mesh.closest_hit(child, ray, &mut hit, &mut Scratch::new());
    }
    hit
}

fn parts_answer_as_the_whole<L>(whole: Mesh<L>, part: Mesh<L>, chosen: &[u32])
where
    Mesh<L>: Children,
{
    let (part, leaves) = packed(part);
    let (mut found, mut skipped) = (0, 0);
    for ray in rays(8.0, 600) {
        let expected = nearest(&whole, chosen.iter().copied(), &ray);
        let children = 0..Children::count(&part);
        assert_eq!(nearest(&part, children, &ray), expected, "one by one: {ray:?}");
        let (mut hit, mut all) = (Hit::none(ray.t_max()), Vec::new());
        let probe = part.probe(&ray);
        let mut any = false;
        for &leaf in &leaves {
            part.closest_in_leaf(SCALAR, leaf, &probe, &mut hit);
            any |= part.any_in_leaf(SCALAR, leaf, &probe, ray.t_max());
            part.all_in_leaf(SCALAR, leaf, &probe, ray.t_max(), &mut all);
        }
        assert_eq!((hit, any), (expected, expected.is_some()), "packed: {ray:?}");
        assert!(all.iter().all(|hit| chosen.contains(&hit.primitive)));
        assert_eq!(part.surface(&ray, &hit), whole.surface(&ray, &hit).filter(|_| hit.is_some()));
        found += usize::from(hit.is_some());
        skipped += usize::from(chosen.contains(&ray.source().primitive));
    }
    assert!(found > 100 && skipped > 100, "{found} found, {skipped} that leave it");
}

#[test]
fn a_part_of_a_mesh_answers_as_the_whole_does_for_its_triangles() {
    let triangles = sheet(8);
    let whole = TriangleMesh::new(4, triangles).seen_from(Sides::Front);
    // In any order, some of them twice, one that cannot be hit.
    let chosen: Vec<u32> = (0..100).map(|i| (i * 37 + 5) % 129).chain([5, 128]).collect();
    let part = whole.part(&chosen);
    parts_answer_as_the_whole::<Shared>(whole.clone(), part.clone(), &chosen);
    parts_answer_as_the_whole::<Soup>(whole.packed_otherwise(), part.packed_otherwise(), &chosen);
}

#[test]
fn a_part_knows_its_children_and_a_part_of_a_part_does() {
    let whole = TriangleMesh::new(4, sheet(8));
    let part = whole.part(&[90, 3, 60, 41, 7]).part(&[4, 0, 2]);
    let primitives = [3, 41, 90];
    assert_eq!(part.count(), 3);
    let (mut numbers, cell) = (Numbers(9), Aabb { min: Vec3A::ZERO, max: Vec3A::splat(4.5) });
    for (child, primitive) in (0..).zip(primitives) {
        assert_eq!(part.bounds(child), whole.bounds(primitive));
        assert_eq!(part.clipped(child, &cell), whole.clipped(primitive, &cell));
        assert_eq!(part.along(child, Vec3A::ONE), whole.along(primitive, Vec3A::ONE));
        for _ in 0..50 {
            let slopes = || [-0.2, 0.2];
            let from = Vec3A::new(4.0, 4.0, numbers.between(2.0, 9.0) as f32);
            let beam = Beam {
                origin: Aabb { min: from, max: from },
                axis: 2,
                backward: true,
                u: slopes(),
                v: slopes(),
                farthest: 100.0,
            };
            assert_eq!(part.meets(child, &beam), whole.meets(primitive, &beam));
            assert_eq!(part.blocks(child, &beam), whole.blocks(primitive, &beam));
            assert_eq!(part.facing(child, &beam), whole.facing(primitive, &beam));
        }
        let source = Source { geometry: 4, primitive, path: InstancePath::NONE };
        assert_eq!(part.child_of(&source), Some(child));
        assert!(part.holds(child, &source));
        let other = Source { primitive: primitive + 1, ..source };
        assert_eq!(part.child_of(&other), None);
        assert_eq!(part.child_of(&Source { geometry: 5, ..source }), None);
    }
    let ray = Ray::new(Vec3A::Z, Vec3A::NEG_Z, RayKind::Camera);
    let hit = Hit { t: 1.0, geometry: 4, primitive: 4, ..Hit::none(2.0) };
    assert!(whole.surface(&ray, &hit).is_some() && part.surface(&ray, &hit).is_none());
}

#[test]
fn the_memory_of_a_part_is_that_of_its_triangles() {
    let whole = TriangleMesh::new(4, sheet(200));
    let (small, _) = packed(whole.part(&(500..600).collect::<Vec<_>>()));
    let (all, _) = packed(whole);
    let each = all.packed_bytes() as f64 / 80_000.0;
    assert!((small.packed_bytes() as f64) < 3.0 * 100.0 * each, "{}", small.packed_bytes());
}

#[test]
fn leaves_are_packed_alike_by_any_number_of_threads() {
    fn check<L>(whole: &Mesh<L>, count: usize)
    where
        Mesh<L>: Children + Clone,
    {
        let pack = |threads: usize| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
            pool.expect("threads can be had").install(|| packed(whole.clone()).1)
        };
        let one = pack(1);
        assert_eq!(one.len(), count.div_ceil(11));
        assert!([2, 7].into_iter().all(|threads| pack(threads) == one));
    }
    let sheet = sheet(100);
    let mesh = TriangleMesh::new(4, Arc::clone(&sheet));
    check(&mesh, 20_000);
    check(&mesh.packed_otherwise::<Soup>(), 20_000);
    let (mesh, leaves) = packed(mesh);
    let all: Vec<[u32; 2]> = leaves.iter().flat_map(|&leaf| mesh.named_in(leaf)).collect();
    assert_eq!(all, (0..20_000).map(|i| [4, i]).collect::<Vec<_>>());
}
