//! Shapes that make no sense are never hit.

use glam::Vec3A;
use nestray_core::aabb::Aabb;
use nestray_core::beam::Beam;
use nestray_core::cost::CostModel;
use nestray_core::object::Object;
use nestray_shapes::any::AnyShape;
use nestray_shapes::block::Block;
use nestray_shapes::cone::Cone;
use nestray_shapes::cylinder::Cylinder;
use nestray_shapes::disk::Disk;
use nestray_shapes::parallelogram::Parallelogram;
use nestray_shapes::patch::Patch;
use nestray_shapes::plane::Plane;
use nestray_shapes::polygon::Polygon;
use nestray_shapes::shape::{Shape, Single};
use nestray_shapes::sphere::Sphere;

use crate::hits::crossings;
use crate::numbers::Numbers;

fn broken() -> Vec<AnyShape> {
    let (o, x, y) = (Vec3A::ZERO, Vec3A::X, Vec3A::Y);
    let mut shapes: Vec<AnyShape> = Vec::new();
    for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, -1.0, 0.0, 1e30] {
        shapes.push(Sphere { center: o, radius: bad }.into());
        shapes.push(Disk { center: o, normal: x, radius: bad }.into());
        shapes.push(Cylinder { base: o, top: x, radius: bad }.into());
        let cone = Cone { base: o, base_radius: bad, apex: x, apex_radius: 0.0 };
        shapes.push(cone.into());
        shapes.push(Parallelogram { corner: o, u: x * bad, v: x }.into());
    }
    for bad in [f32::NAN, f32::INFINITY, 1e30] {
        let place = Vec3A::new(0.0, bad, 0.0);
        shapes.push(Sphere { center: place, radius: 1.0 }.into());
        shapes.push(Disk { center: place, normal: x, radius: 1.0 }.into());
        shapes.push(Plane { point: place, normal: x }.into());
        shapes.push(Cylinder { base: place, top: x, radius: 1.0 }.into());
        shapes.push(Cone { base: o, base_radius: 1.0, apex: place, apex_radius: 0.5 }.into());
        shapes.push(Block { extent: Aabb { min: place, max: Vec3A::ONE } }.into());
        shapes.push(Block { extent: Aabb { min: o, max: place } }.into());
        shapes.push(Parallelogram { corner: place, u: x, v: y }.into());
        shapes.push(Polygon::new(vec![o.to_array(), x.to_array(), place.to_array()]).into());
        shapes.push(Patch::new(&[([0.0; 3], [1.0; 3]), ([bad; 3], [bad; 3])]).into());
    }
    let nowhere = Vec3A::splat(f32::NAN);
    for normal in [o, nowhere, x * f32::INFINITY] {
        shapes.push(Disk { center: o, normal, radius: 1.0 }.into());
        shapes.push(Plane { point: o, normal }.into());
    }
    shapes.push(Cone { base: x, base_radius: 1.0, apex: x, apex_radius: 0.5 }.into());
    shapes.push(Cylinder { base: x, top: x, radius: 1.0 }.into());
    shapes.push(Parallelogram { corner: o, u: x, v: x * 0.3 }.into());
    shapes.push(Block { extent: Aabb { min: x, max: o } }.into());
    shapes.push(Block { extent: Aabb { min: o, max: o } }.into());
    shapes.push(Block { extent: Aabb::EMPTY }.into());
    for vertices in [
        vec![],
        vec![o],
        vec![o, x],
        vec![o, o, o],
        vec![x, x, y, y],
        vec![o, x, x * 2.0, x * 0.3],
        vec![o, x, nowhere],
    ] {
        let corners: Vec<_> = vertices.iter().map(|v| (v.to_array(), v.to_array())).collect();
        shapes.push(Patch::new(&corners).into());
        shapes.push(Polygon::new(vertices.iter().map(|v| v.to_array()).collect::<Vec<_>>()).into());
    }
    shapes
}

#[test]
fn a_shape_that_makes_no_sense_is_never_hit() {
    let unit = Aabb { min: Vec3A::splat(-1.0), max: Vec3A::ONE };
    let beam = Beam {
        origin: Aabb { min: Vec3A::splat(-5.0), max: Vec3A::splat(-4.0) },
        axis: 0,
        backward: false,
        u: [0.1, 0.2],
        v: [0.1, 0.2],
        farthest: f32::INFINITY,
    };
    for shape in broken() {
        assert!(shape.bounds().is_empty(), "{shape:?} {:?}", shape.bounds());
        let [low, high] = shape.along(Vec3A::new(1.0, 2.0, 0.0));
        assert!(low > high, "{shape:?} reaches from {low} to {high}");
        assert!(!shape.touches(&unit), "{shape:?}");
        assert_eq!(shape.blocks(&beam), None, "{shape:?}");
        assert_eq!(shape.hull_area(), 0.0, "{shape:?}");
        let _ = shape.facing(&beam);
        let single = Single::new(0, shape.clone());
        let _ = single.cost(&CostModel::default());
        let mut numbers = Numbers(8);
        for _ in 0..300 {
            let ray = numbers.ray_near(Vec3A::ZERO.as_dvec3(), 1.0);
            assert_eq!(crossings(&shape, &ray), [], "{shape:?} {ray:?}");
        }
    }
}

#[test]
fn a_repeated_vertex_changes_nothing() {
    let once = Polygon::new(vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]);
    let twice =
        Polygon::new(vec![[0.0; 3], [0.0; 3], [1.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]);
    let mut numbers = Numbers(9);
    for _ in 0..2_000 {
        let ray = numbers.ray_near(Vec3A::ZERO.as_dvec3(), 1.0);
        assert_eq!(crossings(&once, &ray), crossings(&twice, &ray), "{ray:?}");
    }
}

#[test]
fn a_flat_box_is_hit_like_a_rectangle() {
    let floor: AnyShape = Block::between(Vec3A::new(2.0, 0.0, 3.0), Vec3A::ZERO).into();
    let corner = Parallelogram { corner: Vec3A::ZERO, u: Vec3A::Z * 3.0, v: Vec3A::X * 2.0 };
    let mut numbers = Numbers(10);
    for _ in 0..2_000 {
        let ray = numbers.ray_near(Vec3A::ONE.as_dvec3(), 2.0);
        if ray.dir().y != 0.0 {
            let (a, b) = (crossings(&floor, &ray), crossings(&corner, &ray));
            assert_eq!(a.is_empty(), b.is_empty(), "{ray:?}");
        }
    }
}
