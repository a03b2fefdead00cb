//! One of every kind of shape, again and again, on a plane without end.

use glam::{DAffine3, DMat3, DVec3, Vec3A};
use nestray_core::aabb::Aabb;
use nestray_shapes::any::AnyShape;
use nestray_shapes::bezier::BezierPatch;
use nestray_shapes::block::Block;
use nestray_shapes::cone::Cone;
use nestray_shapes::csg::Operation;
use nestray_shapes::cylinder::Cylinder;
use nestray_shapes::disk::Disk;
use nestray_shapes::height_field::{HeightField, Relief};
use nestray_shapes::parallelogram::Parallelogram;
use nestray_shapes::patch::Patch;
use nestray_shapes::plane::Plane;
use nestray_shapes::polygon::Polygon;
use nestray_shapes::quadric::Quadric;
use nestray_shapes::sphere::Sphere;
use nestray_shapes::torus::Torus;

use super::look::{camera, glass, matte, metal, outdoors, paint, still};
use super::mesh::Mesh;
use super::standard::rotation;
use crate::geometry::Geometry;
use crate::group::Group;
use crate::material::Material;
use crate::scene::Scene;
use crate::solid::{Operand, Solid, SolidError};

/// Kinds of bounded single shapes.
const KINDS: u64 = 11;

/// Solids made of solids.
const SOLIDS: u64 = 2;

/// Triangles of each mesh.
const MESH: u64 = 12;

/// Metres between copies.
const APART: f64 = 10.0;

/// Primitives of all copies, the plane and the height field, which is an instance.
pub(super) fn count(size: u32) -> u64 {
    (KINDS + MESH + SOLIDS) * u64::from(size).pow(2) + 2
}

pub(super) fn build(size: u32) -> Scene {
    let mut scene = outdoors();
    let ground = scene.add_material(matte("ground", [0.4, 0.38, 0.34]));
    let plane = Plane { point: Vec3A::ZERO, normal: Vec3A::Z };
    scene.add(Geometry::shapes("plane", ground, vec![plane.into()]));
    let copies: Vec<Vec3A> = (0..size * size)
        .map(|i| {
            let place = |i: u32| (f64::from(i) - f64::from(size - 1) / 2.0) * APART;
            DVec3::new(place(i % size), place(i / size), 0.0).as_vec3a()
        })
        .collect();
    for (kind, (name, material, shape)) in kinds().into_iter().enumerate() {
        let material = scene.add_material(Material { name: name.into(), ..material });
        let shapes = copies.iter().map(|&at| shape(at + cell(kind))).collect();
        scene.add(Geometry::shapes(name, material, shapes));
    }
    let brick = scene.add_material(matte("mesh", [0.5, 0.2, 0.12]));
    let turned = rotation(DVec3::new(0.6, 0.0, 0.8), 0.8);
    let mut mesh = Mesh::default();
    for &at in &copies {
        let middle = (at + cell(KINDS as usize)).as_dvec3() + DVec3::Z * 0.9;
        mesh.cuboid(DAffine3::from_mat3_translation(turned, middle));
    }
    scene.add(Geometry::mesh("mesh", brick, mesh.finish()));
    add_solids(&mut scene, &copies);
    add_ponds(&mut scene, &copies);
    let reach = APART * f64::from(size);
    let from = DVec3::new(-0.25, -0.95, 0.7) * reach;
    scene.cameras.push(camera("whole", from, DVec3::NEG_Y * 0.05 * reach, 44.0));
    scene
}

/// A frame and a lens that float above every copy.
fn add_solids(scene: &mut Scene, copies: &[Vec3A]) {
    let ball = |at: Vec3A, radius| Operand::shape(Sphere { center: at, radius });
    let frame = |at: Vec3A| {
        let half = Vec3A::splat(0.55);
        let turned = DAffine3::from_mat3_translation(
            rotation(DVec3::new(0.48, 0.6, 0.64), 0.9),
            (at + Vec3A::new(-2.2, 1.0, 3.0)).as_dvec3(),
        );
        let block = Operand::shape(Block::between(-half, half))?;
        let frame = Solid::new(Operation::Difference, block, ball(Vec3A::ZERO, 0.7)?)?;
        // With a ball inside.
        let frame = Operand::from(frame).placed(turned.as_affine3a())?;
        let inside = ball(turned.translation.as_vec3a(), 0.3)?;
        Solid::new(Operation::Union, frame, inside)
    };
    let lens = |at: Vec3A| {
        let (at, apart) = (at + Vec3A::new(2.2, 1.0, 3.0), Vec3A::new(0.2, -0.7, 0.25));
        Solid::new(Operation::Intersection, ball(at - apart, 1.0)?, ball(at + apart, 1.0)?)
    };
    let brass = scene.add_material(metal("frame", [0.8, 0.6, 0.25], 0.2));
    let clear = scene.add_material(glass("lens", [1.0; 3]));
    let solids = |make: &dyn Fn(Vec3A) -> Result<Solid, SolidError>| {
        copies.iter().map(|&at| make(at).expect("these are closed")).collect()
    };
    scene.add(Geometry::solids("frame", brass, solids(&frame)));
    scene.add(Geometry::solids("lens", clear, solids(&lens)));
}

/// A height field behind the other shapes of every copy; heights are above y = 0, so it is
/// turned.
fn add_ponds(scene: &mut Scene, copies: &[Vec3A]) {
    const SAMPLES: usize = 48;
    let height = |i: usize| {
        let [x, z] =
            [i % SAMPLES, i / SAMPLES].map(|i| 8.0 * i as f64 / (SAMPLES - 1) as f64 - 4.0);
        let from_middle = (x * x + 4.0 * z * z).sqrt();
        (0.8 + 0.5 * libm::cos(3.0 * from_middle) * libm::exp(-0.4 * from_middle)) as f32
    };
    let heights: Vec<f32> = (0..SAMPLES * SAMPLES).map(height).collect();
    let field = HeightField::new([-4.0, -1.0], [4.0, 1.0], [SAMPLES; 2], heights)
        .expect("the numbers make sense")
        .shaded(Relief::Smooth);
    let water = scene.add_material(metal("height field", [0.35, 0.5, 0.55], 0.15));
    let field = scene.add_apart(Geometry::shapes("height field", water, vec![field.into()]));
    let (name, geometries) = ("height field".into(), vec![field]);
    let group = scene.add_group(Group { name, geometries, places: Vec::new() });
    let upright = DMat3::from_cols(DVec3::X, DVec3::Z, DVec3::NEG_Y);
    for &at in copies {
        let at = at.as_dvec3() + DVec3::new(0.0, 4.0, -0.4);
        scene.place(group, still(DAffine3::from_mat3_translation(upright, at)));
    }
}

/// Where a kind stands within a copy.
fn cell(kind: usize) -> Vec3A {
    Vec3A::new((kind % 4) as f32 * 2.2 - 3.3, (kind / 4) as f32 * 2.4 - 3.6, 0.0)
}

/// A name, a material, and the shape about a point of the ground.
type Kind = (&'static str, Material, fn(Vec3A) -> AnyShape);

fn kinds() -> [Kind; KINDS as usize] {
    [
        ("sphere", glass("", [1.0; 3]), |at| Sphere { center: at + Vec3A::Z, radius: 0.8 }.into()),
        ("cone", paint("", [0.7, 0.3, 0.05], 0.4), |at| {
            let apex = at + Vec3A::new(0.2, 0.1, 1.9);
            Cone { base: at, base_radius: 0.8, apex, apex_radius: 0.15 }.into()
        }),
        ("cylinder", metal("", [0.6, 0.6, 0.65], 0.2), |at| {
            let top = at + Vec3A::new(0.3, -0.2, 1.6);
            Cylinder { base: at, top, radius: 0.6 }.into()
        }),
        ("disk", paint("", [0.1, 0.4, 0.15], 0.5), |at| {
            let normal = Vec3A::new(0.2, -0.7, 0.5);
            Disk { center: at + Vec3A::Z * 0.8, normal, radius: 0.8 }.into()
        }),
        ("parallelogram", metal("", [0.95, 0.7, 0.4], 0.05), |at| {
            let (u, v) = (Vec3A::new(1.4, 0.3, 0.1), Vec3A::new(0.2, 0.5, 1.4));
            Parallelogram { corner: at - Vec3A::X * 0.7, u, v }.into()
        }),
        ("block", paint("", [0.15, 0.2, 0.55], 0.3), |at| {
            Block::between(at - Vec3A::new(0.6, 0.5, 0.0), at + Vec3A::new(0.6, 0.5, 1.2)).into()
        }),
        ("polygon", matte("", [0.65, 0.6, 0.2]), |at| {
            // A star.
            let corner = |i: u32| {
                let angle = f64::from(i) * std::f64::consts::TAU / 10.0;
                let away = if i.is_multiple_of(2) { 0.9 } else { 0.38 };
                let (x, z) = (away * libm::sin(angle), away * libm::cos(angle));
                (at.as_dvec3() + DVec3::new(x, 0.35 * x, 0.9 - z)).as_vec3().to_array()
            };
            Polygon::new((0..10).map(corner).collect::<Vec<_>>()).into()
        }),
        ("patch", paint("", [0.6, 0.1, 0.3], 0.2), |at| {
            let corner = |x: f32, z: f32| {
                let normal = Vec3A::new(x, -1.0, 0.6 * z - 0.5).normalize();
                ((at + Vec3A::new(x, 0.2 * x, z)).to_array(), normal.to_array())
            };
            Patch::new(&[corner(-0.8, 0.1), corner(0.8, 0.1), corner(0.0, 1.6)]).into()
        }),
        ("torus", metal("", [0.75, 0.75, 0.8], 0.1), |at| {
            let axis = Vec3A::new(0.3, -0.8, 0.6);
            Torus { center: at + Vec3A::Z * 0.85, axis, major: 0.6, minor: 0.2 }.into()
        }),
        ("quadric", paint("", [0.3, 0.5, 0.5], 0.3), hyperboloid),
        ("bezier", paint("", [0.8, 0.75, 0.6], 0.25), |at| {
            let height =
                [[0.2, 0.9, 1.1, 0.2], [0.8, 2.6, 0.2, 0.9], [1.0, 0.3, 2.2, 0.8], [0.2; 4]];
            let points = std::array::from_fn(|i| {
                std::array::from_fn(|j| {
                    let place = |i: usize| (i as f32 - 1.5) * 0.55;
                    at + Vec3A::new(place(i), place(j), height[i][j])
                })
            });
            BezierPatch { points }.into()
        }),
    ]
}

/// `x² + y² − (z − ¾)²/2 = 0.15`, a cooling tower, from the ground up to 1.6.
fn hyperboloid(at: Vec3A) -> AnyShape {
    let [x, y, z] = (at + Vec3A::Z * 0.75).to_array();
    Quadric {
        squares: [1.0, 1.0, -0.5],
        products: [0.0; 3],
        linear: [-2.0 * x, -2.0 * y, z],
        constant: x * x + y * y - 0.5 * z * z - 0.15,
        clip: Aabb { min: at - Vec3A::new(1.0, 1.0, 0.0), max: at + Vec3A::new(1.0, 1.0, 1.6) },
    }
    .into()
}
