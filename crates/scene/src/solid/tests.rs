use glam::{Quat, Vec3, Vec3A};
use nestray_core::aabb::Aabb;
use nestray_core::hit::Hit;
use nestray_core::ray::{Ray, RayKind};
use nestray_core::scratch::Scratch;
use nestray_shapes::block::Block;
use nestray_shapes::cylinder::Cylinder;
use nestray_shapes::disk::Disk;
use nestray_shapes::plane::Plane;
use nestray_shapes::quadric::Quadric;
use nestray_shapes::sphere::Sphere;

use super::*;
use crate::geometry::Geometry;
use crate::scene::Scene;
use crate::surfaces::Surfaces;

fn ball(radius: f32) -> Operand {
    Operand::shape(Sphere { center: Vec3A::ZERO, radius }).expect("closed")
}

fn block(half: f32) -> Operand {
    let half = Vec3A::splat(half);
    Operand::shape(Block::between(-half, half)).expect("closed")
}

/// A tetrahedron, its front outside, each face with vertices of its own.
fn tetrahedron() -> Triangles {
    let corners = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let faces = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
    let positions = faces.as_flattened().iter().map(|&corner: &usize| corners[corner]).collect();
    Triangles::new(positions, (0..4).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect())
        .expect("sound")
}

fn shell(mesh: TriangleMesh) -> DynObject {
    Arc::new(Shell::new(mesh))
}

#[test]
fn what_has_no_inside_is_refused() {
    let open = |shape: AnyShape| Operand::shape(shape).expect_err("it is open").to_string();
    let disk = Disk { center: Vec3A::ZERO, normal: Vec3A::Z, radius: 1.0 };
    assert!(open(disk.into()).starts_with("a disk has no inside"));
    let tube = Cylinder { base: Vec3A::ZERO, top: Vec3A::Z, radius: 1.0 };
    assert!(open(tube.into()).starts_with("a cylinder has no inside"));
    let half = Aabb { min: Vec3A::splat(-2.0), max: Vec3A::new(2.0, 2.0, 0.5) };
    let quadric = |sign: f32, clip| Quadric {
        squares: [sign; 3],
        products: [0.0; 3],
        linear: [0.0; 3],
        constant: -sign,
        clip,
    };
    assert_eq!(Operand::shape(quadric(1.0, half)).err(), Some(SolidError::Cut));
    let kind = "quadric";
    let inside_out = Operand::shape(quadric(-1.0, Aabb::ENDLESS));
    assert_eq!(inside_out.err(), Some(SolidError::InsideOut { kind }));
    let wide = Aabb { max: Vec3A::splat(2.0), ..half };
    for clip in [wide, Aabb::ENDLESS] {
        Operand::shape(quadric(1.0, clip)).expect("it is whole");
    }
}

#[test]
fn a_mesh_must_be_closed_and_right_side_out() {
    let whole = tetrahedron();
    Operand::mesh(Arc::new(whole.clone())).expect("closed");
    let with = |faces: Vec<[u32; 3]>| {
        let mesh = Triangles::new(whole.positions().to_vec(), faces).expect("sound");
        Operand::mesh(Arc::new(mesh)).expect_err("not closed")
    };
    let hole = with(whole.faces()[..3].to_vec());
    assert!(hole.to_string().starts_with("the mesh is open at the edge from ["), "{hole}");
    let inside_out = with(whole.faces().iter().map(|&[a, b, c]| [a, c, b]).collect());
    assert_eq!(inside_out.to_string(), "the mesh is inside out: its front must be outside");
    assert_eq!(with(Vec::new()), SolidError::Open { kind: "flat mesh" });
    let one = whole.faces()[0];
    let flat = with(vec![one, [one[0], one[2], one[1]]]);
    assert_eq!(flat, SolidError::Open { kind: "flat mesh" });
}

#[test]
fn solids_too_deep_or_flat_are_refused() {
    let mut solid = Solid::new(Operation::Union, ball(1.0), ball(2.0)).expect("sound");
    for _ in 1..Solid::DEEPEST {
        solid = Solid::new(Operation::Union, solid.into(), ball(1.0)).expect("not too deep");
    }
    let deeper = Solid::new(Operation::Union, ball(1.0), solid.into());
    assert_eq!(deeper.err(), Some(SolidError::TooDeep));
    let flat = Affine3A::from_scale(Vec3::new(1.0, 0.0, 1.0));
    assert_eq!(ball(1.0).placed(flat).err(), Some(SolidError::Place));
}

#[test]
fn bounds_are_those_of_what_is_kept() {
    let moved = Affine3A::from_translation(Vec3::X);
    let right = || ball(1.0).placed(moved).expect("not flat");
    let bounds = |operation| Solid::new(operation, block(1.0), right()).expect("sound").bounds();
    let union = bounds(Operation::Union);
    assert!(union.min.x <= -1.0 && union.max.x >= 2.0 && union.max.x < 2.001);
    let both = bounds(Operation::Intersection);
    assert!(both.min.x > -0.001 && both.max.x == 1.0);
    assert_eq!(bounds(Operation::Difference).max, Vec3A::ONE);
    // A half of space has none, nor has what is left of it.
    let half = Operand::shape(Plane { point: Vec3A::ZERO, normal: Vec3A::Z }).expect("closed");
    let solid = Solid::new(Operation::Difference, half, ball(1.0)).expect("sound");
    assert!(!solid.bounds().is_bounded());
    let mut scene = Scene::new();
    scene.add(Geometry::solids("", 0, vec![solid]));
    assert!(scene.bounds().is_empty());
    assert_eq!(scene.primitives(), 1);
}

#[test]
fn surfaces_are_those_of_the_operand_that_was_hit() {
    // A block without a ball, moved as a whole: seen from above one looks into the hollow.
    let hollow = Solid::new(Operation::Difference, block(1.0), ball(1.2)).expect("sound");
    let place = Affine3A::from_scale_rotation_translation(
        Vec3::new(-1.0, 1.0, 2.0),
        Quat::from_rotation_z(0.3),
        Vec3::new(0.0, 0.0, 10.0),
    );
    let mesh = Operand::mesh(Arc::new(tetrahedron())).expect("closed");
    let hollow = Operand::from(hollow).placed(place).expect("not flat");
    let solid = Solid::new(Operation::Union, hollow, mesh).expect("sound");
    let mut scene = Scene::new();
    scene.add(Geometry::solids("", 3, vec![solid.clone()]));
    let world = solid.object([0, 0], Sides::Both, &shell);
    let surfaces = Surfaces::new(&scene).expect("it can be numbered");
    let seen = |from: Vec3A, dir: Vec3A| {
        let ray = Ray::new(from, dir, RayKind::Camera);
        let mut hit = Hit::none(ray.t_max());
        assert!(world.closest_hit(&ray, &mut hit, &mut Scratch::new()), "{from} {dir}");
        let point = surfaces.at(&ray, &hit);
        assert_eq!(point.material, 3);
        assert_eq!(Some(point.surface), world.surface(&ray, &hit));
        (hit.t, point.surface.normal)
    };
    // Through the ball, which is cut away, onto the face of the tetrahedron.
    let (t, normal) = seen(Vec3A::new(0.2, 0.2, 20.0), Vec3A::NEG_Z);
    assert!((t - 19.4).abs() < 1e-4 && normal.dot(Vec3A::ONE) > 1.73, "{t} {normal}");
    // Onto a bar of the frame, and from inside onto the hollow of another.
    let (t, normal) = seen(
        Vec3A::new(0.0, 0.0, 10.0),
        place.transform_vector3a(Vec3A::new(1.0, 1.0, 1.0)).normalize(),
    );
    assert!(t > 1.2 && t < 2.5 && normal.z < 0.0, "{t} {normal}");
}

#[test]
fn only_the_sides_that_are_seen_are_hit() {
    let solid = Solid::new(Operation::Intersection, ball(1.0), block(0.9)).expect("sound");
    let ray = Ray::new(Vec3A::new(0.1, 0.2, 5.0), Vec3A::NEG_Z, RayKind::Camera);
    let first = |sides| {
        let mut hit = Hit::none(ray.t_max());
        solid.object([0, 0], sides, &shell).closest_hit(&ray, &mut hit, &mut Scratch::new());
        hit.t
    };
    assert_eq!(first(Sides::Both), first(Sides::Front));
    assert!((first(Sides::Front) - 4.1).abs() < 1e-5 && (first(Sides::Back) - 5.9).abs() < 1e-5);
}
