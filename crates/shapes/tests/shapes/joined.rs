//! Meshes that stand together answer as they do apart.

use std::sync::Arc;

use glam::Vec3A;
use nestray_core::children::Children;
use nestray_core::hit::{Hit, InstancePath};
use nestray_core::ray::{Ray, RayKind, Source};
use nestray_core::scratch::Scratch;
use nestray_core::simd::SCALAR;
use nestray_shapes::shape::Sides;
use nestray_shapes::triangle_mesh::{Mesh, Soup, TriangleMesh, Triangles};

use crate::numbers::Numbers;
use crate::parts::packed;

/// The same grid of triangles in all, and some of their own.
fn meshes() -> Vec<TriangleMesh> {
    let mut numbers = Numbers(23);
    let mut corners: Vec<[Vec3A; 3]> = Vec::new();
    for cell in 0..36u8 {
        let at = Vec3A::new(f32::from(cell % 6), f32::from(cell / 6), 0.5);
        corners.push([at, at + Vec3A::X, at + Vec3A::Y]);
    }
    let geometries = [9, 2, 5];
    let mesh = |geometry: u32| {
        let mut corners = corners.clone();
        for _ in 0..20 + geometry {
            let mut point = || [0; 3].map(|_| numbers.between(0.0, 6.0) as f32);
            corners.push([0; 3].map(|_| Vec3A::from_array(point())));
        }
        TriangleMesh::new(geometry, Arc::new(Triangles::from_corners(&corners)))
    };
    geometries.map(mesh).into()
}

fn rays(meshes: &[TriangleMesh]) -> Vec<Ray> {
    let mut numbers = Numbers(24);
    (0..2000)
        .map(|i| {
            let mut point = |size: f64| [0; 3].map(|_| numbers.between(0.0, size) as f32);
            let (from, to) = (Vec3A::from_array(point(6.0)), Vec3A::from_array(point(6.0)));
            let from = from + Vec3A::Z * 8.0;
            let geometry = [2, 5, 9, 4, Hit::NOTHING][i % 5];
            let most = meshes.iter().map(Children::count).max().unwrap_or(1);
            let primitive = i as u32 % (most + 3);
            let source = Source { geometry, primitive, path: InstancePath::NONE };
            Ray::new(from, to - from, RayKind::Camera).leaving(source)
        })
        .collect()
}

fn answers_as_apart<L>(joined: Mesh<L>, apart: &[TriangleMesh])
where
    Mesh<L>: Children,
{
    let (joined, leaves) = packed(joined);
    assert_eq!(leaves.iter().map(|&leaf| joined.leaf_len(leaf)).sum::<u32>(), joined.count());
    let mut scratch = Scratch::new();
    let mut found = [0; 10];
    for ray in rays(apart) {
        let (mut expected, mut all) = (Hit::none(ray.t_max()), Vec::new());
        for mesh in apart {
            for child in 0..Children::count(mesh) {
                mesh.closest_hit(child, &ray, &mut expected, &mut scratch);
                mesh.all_hits(child, &ray, &mut all, &mut scratch);
            }
        }
        let (mut hit, mut own, mut any) = (Hit::none(ray.t_max()), Vec::new(), false);
        let probe = joined.probe(&ray);
        for &leaf in &leaves {
            joined.closest_in_leaf(SCALAR, leaf, &probe, &mut hit);
            any |= joined.any_in_leaf(SCALAR, leaf, &probe, ray.t_max());
            joined.all_in_leaf(SCALAR, leaf, &probe, ray.t_max(), &mut own);
        }
        assert_eq!((hit, any), (expected, expected.is_some()), "{ray:?}");
        all.sort_by_key(Hit::id);
        own.sort_by_key(Hit::id);
        assert_eq!(own, all, "{ray:?}");
        if hit.is_some() {
            found[hit.geometry as usize] += 1;
            let of = apart.iter().find_map(|mesh| mesh.surface(&ray, &hit));
            assert_eq!(joined.surface(&ray, &hit), of);
            let source =
                Source { geometry: hit.geometry, primitive: hit.primitive, path: hit.path };
            let child = joined.child_of(&source).expect("it is one of them");
            let own = apart.iter().find_map(|mesh| Some(mesh.bounds(mesh.child_of(&source)?)));
            assert_eq!(Some(joined.bounds(child)), own);
        }
    }
    assert!([2, 5, 9].iter().all(|&geometry| found[geometry] > 100), "{found:?}");
    assert!(found[2] > found[9], "of equals the first geometry: {found:?}");
}

#[test]
fn together_they_answer_as_apart() {
    let apart = meshes();
    let joined = TriangleMesh::joined(&apart).expect("all are seen from the same sides");
    answers_as_apart(joined.packed_otherwise::<Soup>(), &apart);
    answers_as_apart(joined, &apart);
}

#[test]
fn not_all_can_come_together() {
    let meshes = meshes();
    assert!(TriangleMesh::joined(&[]).is_none());
    assert!(TriangleMesh::joined(&meshes[..1]).is_some_and(|one| one.count() == 36 + 29));
    let turned = meshes[1].clone().seen_from(Sides::Front);
    assert!(TriangleMesh::joined(&[meshes[0].clone(), turned]).is_none(), "other sides");
    assert!(TriangleMesh::joined(&[meshes[0].clone(), meshes[0].clone()]).is_none(), "twice");
    let part = meshes[1].part(&[1, 2, 3]);
    assert!(TriangleMesh::joined(&[meshes[0].clone(), part]).is_none(), "a part");
    let empty = TriangleMesh::new(3, Arc::new(Triangles::default()));
    let with = TriangleMesh::joined(&[empty.clone(), meshes[0].clone(), meshes[1].clone()]);
    let with = with.expect("one may be empty");
    let source = Source { geometry: 3, primitive: 0, path: InstancePath::NONE };
    assert_eq!((with.child_of(&source), empty.child_of(&source)), (None, None));
    assert_eq!(with.child_of(&Source { geometry: 9, ..source }), Some(36 + 22));
}
