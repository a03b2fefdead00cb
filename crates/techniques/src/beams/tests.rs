//! What holds of all lists for beams: answers are those of exhaustive search, whatever rays come.

use std::sync::Arc;

use glam::Vec3A;
use nestray_core::accel::Accel;
use nestray_core::aim::Emitter;
use nestray_core::children::Children;
use nestray_core::hit::Hit;
use nestray_core::object::{DynObject, Object};
use nestray_core::ray::{Ray, RayKind, Source};
use nestray_core::scratch::Scratch;
use nestray_core::technique::Technique;
use nestray_shapes::any::AnyShape;
use nestray_shapes::parallelogram::Parallelogram;
use nestray_shapes::shape::Single;
use nestray_shapes::sphere::Sphere;
use nestray_shapes::triangle_mesh::{TriangleMesh, Triangles};

use crate::counted::Numbers;
use crate::eye_buffer::EyeBuffer;
use crate::light_buffer::LightBuffer;
use crate::list::List;
use crate::ray_classification::RayClassification;
use crate::ray_coherence::RayCoherence;

/// Balls, and sheets that hide what is behind them.
fn objects(seed: u64) -> Vec<DynObject> {
    let mut numbers = Numbers::new(seed);
    let one = |i: u32| -> DynObject {
        let at = numbers.point() * 10.0;
        let shape: AnyShape = if i.is_multiple_of(3) {
            let (u, v) = (numbers.direction(), numbers.direction());
            Parallelogram { corner: at, u: u * 1.5, v: v * 1.5 }.into()
        } else {
            Sphere { center: at, radius: 0.05 + 0.4 * numbers.next() }.into()
        };
        Arc::new(Single::new(i, shape))
    };
    (0..400).map(one).collect()
}

/// Long and short triangles, some of them large.
fn mesh(seed: u64) -> TriangleMesh {
    let mut numbers = Numbers::new(seed);
    let (mut positions, mut faces) = (Vec::new(), Vec::new());
    for i in 0..1500u32 {
        let at = numbers.point() * 10.0;
        let size = if i.is_multiple_of(10) { 3.0 } else { 0.4 };
        for _ in 0..3 {
            positions.push((at + numbers.direction() * size).to_array());
        }
        faces.push([3 * i, 3 * i + 1, 3 * i + 2]);
    }
    TriangleMesh::new(0, Arc::new(Triangles::new(positions, faces).expect("it is sound")))
}

const LAMPS: [Emitter; 4] = [
    Emitter::Point([5.0, 5.0, 5.5]),
    Emitter::Point([-4.0, 30.0, 7.0]),
    Emitter::Box { min: [4.0, 11.0, 4.0], max: [5.0, 11.5, 6.0] },
    Emitter::Direction([0.3, 2.0, -0.5]),
];

/// Rays to and from an emitter, whole and in part, and some that only nearly come to it.
fn rays(seed: u64, emitter: &Emitter, kind: RayKind, oracle: &dyn Object) -> Vec<Ray> {
    let (mut numbers, mut scratch) = (Numbers::new(seed), Scratch::new());
    let mut rays = Vec::new();
    for i in 0..1200u32 {
        let at = match *emitter {
            Emitter::Point(at) => Some(at.into()),
            Emitter::Box { min, max } => {
                let (min, max) = (Vec3A::from_array(min), Vec3A::from_array(max));
                Some(min + (max - min) * numbers.point())
            }
            Emitter::Direction(_) => None,
        };
        let point = numbers.point() * 14.0 - 2.0;
        let dir = match (at, *emitter) {
            (Some(at), _) => at - point,
            (None, Emitter::Direction(toward)) => toward.into(),
            _ => unreachable!("the others have a place"),
        };
        let end = if at.is_some() { 1.0 } else { f32::INFINITY };
        let whole = match i % 8 {
            0 => Ray::new(point, dir, kind).between(0.0, 0.999 * end),
            1 => Ray::new(point, dir, kind).between(1e-3, end),
            2 => Ray::new(point + dir, -dir, kind),
            3 => Ray::new(point + dir, -dir, kind).between(0.01, numbers.next() * 2.0),
            4 => Ray::new(point, dir, kind).between(numbers.next() * 0.5, numbers.next()),
            5 => Ray::new(point, dir + numbers.direction() * 0.01, kind).between(0.0, end),
            6 => Ray::new(point - dir * 3.0, dir, kind),
            _ => {
                // From what a ray hits, back to the emitter.
                let mut hit = Hit::none(f32::INFINITY);
                let out = Ray::new(point, -dir, kind);
                if !oracle.closest_hit(&out, &mut hit, &mut scratch) {
                    continue;
                }
                let surface = out.at(hit.t);
                let dir = at.map_or(dir, |at| at - surface);
                let (geometry, primitive) = (hit.geometry, hit.primitive);
                let source = Source { geometry, primitive, path: hit.path };
                Ray::new(surface, dir, kind).between(0.0, end).leaving(source)
            }
        };
        rays.push(whole);
    }
    rays
}

fn all(object: &dyn Object, ray: &Ray, scratch: &mut Scratch) -> Vec<(u32, u32, u32)> {
    let mut hits = Vec::new();
    object.all_hits(ray, &mut hits, scratch);
    let mut hits: Vec<_> =
        hits.iter().map(|hit| (hit.geometry, hit.primitive, hit.t.to_bits())).collect();
    hits.sort_unstable();
    hits.dedup();
    hits
}

/// Every query, one ray at a time and all together, twice: lists are made at the first.
fn same(what: &str, oracle: &dyn Object, nest: &dyn Object, rays: &[Ray]) {
    let mut scratch = Scratch::new();
    let (mut closest, mut blocked) = (vec![Hit::none(f32::INFINITY); rays.len()], Vec::new());
    for (i, ray) in rays.iter().enumerate() {
        closest[i] = Hit::none(ray.t_max());
        oracle.closest_hit(ray, &mut closest[i], &mut scratch);
        blocked.push(oracle.any_hit(ray, &mut scratch));
        for _ in 0..2 {
            let mut hit = Hit::none(ray.t_max());
            nest.closest_hit(ray, &mut hit, &mut scratch);
            assert_eq!(hit, closest[i], "{what}: closest of ray {i}, {ray:?}");
            let any = nest.any_hit(ray, &mut scratch);
            assert_eq!(any, blocked[i], "{what}: any of ray {i}, {ray:?}");
            let expected = all(oracle, ray, &mut scratch);
            assert_eq!(all(nest, ray, &mut scratch), expected, "{what}: all of ray {i}, {ray:?}");
        }
    }
    let mut hits: Vec<Hit> = rays.iter().map(|ray| Hit::none(ray.t_max())).collect();
    nest.closest_hits(rays, &mut hits, &mut scratch);
    assert!(hits == closest, "{what}: closest of all");
    let mut any = vec![false; rays.len()];
    nest.any_hits(rays, &mut any, &mut scratch);
    assert_eq!(any, blocked, "{what}: any of all");
}

/// Every technique of the kind, over these children.
fn answer_as_lists_do<C: Children + Clone + 'static>(children: &C) {
    let oracle = Accel::new(List::default(), children.clone());
    for (i, lamp) in LAMPS.into_iter().enumerate() {
        let kind = RayKind::Shadow { light: 0 };
        let rays_to = rays(i as u64, &lamp, kind, &oracle);
        for (side, most, depth, memory) in [(0, 4, 4, 64), (1, 1, 8, 1), (4, 16, 0, 64)] {
            let buffer = LightBuffer { lights: vec![lamp], side, most, depth, memory, max_leaf: 2 };
            let what = format!("{buffer:?}");
            same(&what, &oracle, &Accel::new(buffer, children.clone()), &rays_to);
        }
        let rays_from = rays(i as u64, &lamp, RayKind::Camera, &oracle);
        let buffer = EyeBuffer { eyes: LAMPS.to_vec(), ..EyeBuffer::default() };
        same(&format!("{lamp:?}"), &oracle, &Accel::new(buffer, children.clone()), &rays_from);
    }
}

/// Rays from everywhere to everywhere, and rays that leave what others hit.
fn any_rays(seed: u64, oracle: &dyn Object) -> Vec<Ray> {
    let (mut numbers, mut scratch) = (Numbers::new(seed), Scratch::new());
    let mut rays = Vec::new();
    for i in 0..500u32 {
        let mut dir = numbers.direction();
        if i.is_multiple_of(5) {
            dir[i as usize / 5 % 3] = 0.0;
        }
        let size = [1.0, 1.0, 40.0, 1e5][i as usize % 4];
        let origin = (numbers.point() * 14.0 - 7.0) * size + 5.0;
        let dir = if size > 1.0 { 5.0 - origin + dir * 3.0 } else { dir };
        let ray = Ray::new(origin, dir, RayKind::Diffuse);
        let mut hit = Hit::none(f32::INFINITY);
        if oracle.closest_hit(&ray, &mut hit, &mut scratch) {
            let (geometry, primitive) = (hit.geometry, hit.primitive);
            let source = Source { geometry, primitive, path: hit.path };
            let from = ray.at(hit.t);
            rays.push(Ray::new(from, numbers.direction(), RayKind::Diffuse).leaving(source));
            rays.push(Ray::new(from, dir, RayKind::Refract).leaving(source).between(0.0, 3.0));
        }
        rays.push(ray.between(numbers.next() - 0.5, f32::INFINITY));
        rays.push(ray.between(0.0, numbers.next() * 10.0));
    }
    rays
}

fn classes_and_origins_answer_as_lists_do<C: Children + Clone + 'static>(children: &C) {
    let oracle = Accel::new(List::default(), children.clone());
    let rays = any_rays(9, &oracle);
    for (most, depth, memory) in [(8, 24, 64), (1, 40, 64), (16, 3, 64), (1, 60, 1)] {
        let classes = RayClassification { most, depth, memory, max_leaf: 2 };
        same(&format!("{classes:?}"), &oracle, &Accel::new(classes, children.clone()), &rays);
    }
    for (side, depth, memory) in [(8, 0, 64), (1, 2, 64), (32, 0, 1)] {
        let from = RayCoherence { side, depth, memory, ..RayCoherence::default() };
        same(&format!("{from:?}"), &oracle, &Accel::new(from, children.clone()), &rays);
    }
}

#[test]
fn classes_and_origins_of_objects_answer_as_exhaustive_search_does() {
    classes_and_origins_answer_as_lists_do(&objects(4));
}

#[test]
fn classes_and_origins_of_triangles_answer_as_exhaustive_search_does() {
    classes_and_origins_answer_as_lists_do(&mesh(5));
}

#[test]
fn buffers_of_objects_answer_as_exhaustive_search_does() {
    answer_as_lists_do(&objects(1));
}

#[test]
fn buffers_of_triangles_answer_as_exhaustive_search_does() {
    answer_as_lists_do(&mesh(2));
}

#[test]
fn shadow_rays_test_few_children_and_hidden_ones_are_left_out() {
    let shapes = mesh(3);
    let tests = |nest: &dyn Object, rays: &[Ray]| {
        let mut scratch = Scratch::counting();
        for ray in rays {
            nest.any_hit(ray, &mut scratch);
        }
        scratch.counters.total().all_tests() as f64 / rays.len() as f64
    };
    let lamp = LAMPS[0];
    let oracle = Accel::new(List::default(), shapes.clone());
    let rays = rays(5, &lamp, RayKind::Shadow { light: 0 }, &oracle);
    let buffer = LightBuffer { lights: vec![lamp], most: 2, ..LightBuffer::default() };
    let without = LightBuffer { lights: Vec::new(), ..buffer.clone() };
    let with = tests(&Accel::new(buffer, shapes.clone()), &rays);
    let without = tests(&Accel::new(without, shapes), &rays);
    assert!(with < 0.7 * without, "{with} tests a ray, {without} without lists");
}

#[test]
fn settings_next_to_the_usual_are_in_range() {
    fn check<T: Technique>() {
        let usual = T::default();
        assert_eq!(usual.check(), Ok(()));
        assert!(usual.neighbours().iter().all(|next| next.check().is_ok() && *next != usual));
    }
    check::<LightBuffer>();
    check::<EyeBuffer>();
    check::<RayClassification>();
    check::<RayCoherence>();
    assert!(LightBuffer { side: 3, ..Default::default() }.check().is_err());
    let nowhere = Emitter::Point([f32::NAN, 0.0, 0.0]);
    assert!(LightBuffer { lights: vec![nowhere], ..Default::default() }.check().is_err());
}

#[test]
fn only_rays_that_lists_serve_are_shown_one_by_one() {
    let lights = LightBuffer { lights: LAMPS.to_vec(), ..LightBuffer::default() };
    let light_buffer = Accel::new(lights, objects(1));
    let shadow = RayKind::Shadow { light: 0 };
    assert!(light_buffer.parts(shadow) && !light_buffer.parts(RayKind::Camera));
    let tree = Accel::new(crate::bvh::Bvh::default(), objects(1));
    assert!(!tree.parts(shadow) && !tree.parts(RayKind::Camera));
    let both = nestray_core::by_kind::ByKind::new(vec![], Arc::new(light_buffer) as DynObject);
    assert!(both.parts(shadow), "as what serves them");
}
