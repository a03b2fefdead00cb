//! Random shapes of every kind. A new kind is one more line in [`MAKERS`].

use glam::{DVec3, Vec3A};
use nestray_core::aabb::Aabb;
use nestray_shapes::any::AnyShape;
use nestray_shapes::bezier::BezierPatch;
use nestray_shapes::block::Block;
use nestray_shapes::cone::Cone;
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

use crate::numbers::Numbers;

/// A shape, and the ball it was made in.
#[derive(Clone, Debug)]
pub(crate) struct Sample {
    pub(crate) shape: AnyShape,
    pub(crate) center: DVec3,
    pub(crate) size: f64,
    pub(crate) form: Form,
}

/// What more can be asked of a shape.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Form {
    /// The surface of a convex body, open ends aside.
    Body,
    /// Flat, convex and bounded.
    Facet,
    /// None of these.
    Other,
}

/// Makes a shape about as large as the ball with this centre and radius.
type Maker = fn(&mut Numbers, Vec3A, f32) -> AnyShape;

const MAKERS: &[(Maker, Form)] = &[
    (sphere, Form::Body),
    (cone, Form::Body),
    (frustum, Form::Body),
    (cylinder, Form::Body),
    (block, Form::Body),
    (plane, Form::Other),
    (disk, Form::Facet),
    (parallelogram, Form::Facet),
    (polygon, Form::Facet),
    (star, Form::Other),
    (patch, Form::Facet),
    (torus, Form::Other),
    (apple, Form::Other),
    (ellipsoid, Form::Other),
    (saddle, Form::Other),
    (bezier, Form::Other),
    (hills, Form::Other),
];

/// One shape of each kind at the origin, of about unit size.
pub(crate) fn near(seed: u64) -> Vec<Sample> {
    let mut numbers = Numbers(seed);
    make(&mut numbers, |_| (DVec3::ZERO, 1.0))
}

/// One shape of each kind, of sizes 1e-3 to 1e5, up to 1e4 sizes away from the origin.
pub(crate) fn samples(seed: u64) -> Vec<Sample> {
    let mut numbers = Numbers(seed);
    make(&mut numbers, |numbers| {
        let size = numbers.size(-3.0, 5.0);
        (numbers.cube() * size * numbers.size(-1.0, 4.0), size)
    })
}

fn make(numbers: &mut Numbers, mut place: impl FnMut(&mut Numbers) -> (DVec3, f64)) -> Vec<Sample> {
    MAKERS
        .iter()
        .map(|&(maker, form)| {
            let (center, size) = place(numbers);
            let (center, size) = (center.as_vec3a(), size as f32);
            let shape = maker(numbers, center, size);
            Sample { shape, center: center.as_dvec3(), size: f64::from(size), form }
        })
        .collect()
}

fn unit(numbers: &mut Numbers) -> Vec3A {
    // Now and then along an axis.
    if numbers.below(4) == 0 {
        DVec3::AXES[numbers.below(3)].as_vec3a()
    } else {
        numbers.unit().as_vec3a()
    }
}

fn part(numbers: &mut Numbers, low: f64, high: f64) -> f32 {
    numbers.between(low, high) as f32
}

fn sphere(_: &mut Numbers, center: Vec3A, size: f32) -> AnyShape {
    Sphere { center, radius: size }.into()
}

fn frustum(numbers: &mut Numbers, center: Vec3A, size: f32) -> AnyShape {
    let half = unit(numbers) * (size * part(numbers, 0.1, 0.9));
    let [base_radius, apex_radius] = [0, 1].map(|_| size * part(numbers, 0.05, 0.7));
    Cone { base: center - half, base_radius, apex: center + half, apex_radius }.into()
}

fn cone(numbers: &mut Numbers, center: Vec3A, size: f32) -> AnyShape {
    let half = unit(numbers) * (size * part(numbers, 0.1, 0.9));
    let base_radius = size * part(numbers, 0.1, 0.7);
    Cone { base: center - half, base_radius, apex: center + half, apex_radius: 0.0 }.into()
}

fn cylinder(numbers: &mut Numbers, center: Vec3A, size: f32) -> AnyShape {
    let half = unit(numbers) * (size * part(numbers, 0.1, 0.9));
    Cylinder { base: center - half, top: center + half, radius: size * part(numbers, 0.1, 0.6) }
        .into()
}

fn block(numbers: &mut Numbers, center: Vec3A, size: f32) -> AnyShape {
    let half = Vec3A::from_array([0; 3].map(|_| part(numbers, 0.1, 0.6))) * size;
    Block { extent: Aabb { min: center - half, max: center + half } }.into()
}

fn plane(numbers: &mut Numbers, center: Vec3A, size: f32) -> AnyShape {
    Plane { point: center, normal: unit(numbers) * size }.into()
}

fn disk(numbers: &mut Numbers, center: Vec3A, size: f32) -> AnyShape {
    Disk { center, normal: unit(numbers) * size, radius: size }.into()
}

fn parallelogram(numbers: &mut Numbers, center: Vec3A, size: f32) -> AnyShape {
    let (u, v) = (unit(numbers), unit(numbers) + numbers.unit().as_vec3a() * 0.5);
    Parallelogram { corner: center - (u + v) * (size * 0.4), u: u * size, v: v * size }.into()
}

/// The corners of a polygon around `center`, counter-clockwise seen from where `normal`
/// points, at angles in order and distances from `radius`.
pub(crate) fn ring(
    count: usize,
    center: Vec3A,
    normal: Vec3A,
    mut radius: impl FnMut(usize) -> f32,
) -> Vec<[f32; 3]> {
    let x = normal.any_orthonormal_vector();
    let y = normal.cross(x);
    (0..count)
        .map(|i| {
            let angle = std::f32::consts::TAU * i as f32 / count as f32;
            let out = x * libm::cosf(angle) + y * libm::sinf(angle);
            (center + out * radius(i)).to_array()
        })
        .collect()
}

fn polygon(numbers: &mut Numbers, center: Vec3A, size: f32) -> AnyShape {
    let (count, normal) = (3 + numbers.below(6), unit(numbers));
    Polygon::new(ring(count, center, normal, |_| size)).into()
}

fn star(numbers: &mut Numbers, center: Vec3A, size: f32) -> AnyShape {
    let (count, normal) = (4 + 2 * numbers.below(30), unit(numbers));
    let inner = size * part(numbers, 0.2, 0.8);
    Polygon::new(ring(count, center, normal, |i| if i % 2 == 0 { size } else { inner })).into()
}

fn patch(numbers: &mut Numbers, center: Vec3A, size: f32) -> AnyShape {
    let (count, normal) = (3 + numbers.below(4), unit(numbers));
    let bent = |&v: &[f32; 3]| (Vec3A::from_array(v) - center) / size * 0.5 + normal;
    let corners: Vec<_> =
        ring(count, center, normal, |_| size).iter().map(|v| (*v, bent(v).to_array())).collect();
    Patch::new(&corners).into()
}

fn torus(numbers: &mut Numbers, center: Vec3A, size: f32) -> AnyShape {
    let minor = size * part(numbers, 0.05, 0.4);
    Torus { center, axis: unit(numbers), major: size - minor, minor }.into()
}

fn apple(numbers: &mut Numbers, center: Vec3A, size: f32) -> AnyShape {
    let minor = size * part(numbers, 0.55, 0.8);
    Torus { center, axis: unit(numbers) * 3.0, major: size - minor, minor }.into()
}

/// A quadric through rounded numbers around `center`: of the given curvatures, `level` sizes
/// squared away from its centre.
fn quadric(center: Vec3A, squares: [f32; 3], level: f32, clip: Aabb) -> AnyShape {
    let c = center.to_array();
    let constant: f64 = (0..3).map(|i| f64::from(squares[i]) * f64::from(c[i]).powi(2)).sum();
    Quadric {
        squares,
        products: [0.0; 3],
        linear: [0, 1, 2].map(|i| (-2.0 * f64::from(squares[i]) * f64::from(c[i])) as f32),
        constant: (constant - f64::from(level)) as f32,
        clip,
    }
    .into()
}

fn ellipsoid(numbers: &mut Numbers, center: Vec3A, size: f32) -> AnyShape {
    let squares = [0; 3].map(|_| part(numbers, 1.0, 4.0));
    // Its numbers say nothing about places far away.
    let center = center.clamp(Vec3A::splat(-size), Vec3A::splat(size));
    quadric(center, squares, size * size, Aabb::ENDLESS)
}

fn saddle(numbers: &mut Numbers, center: Vec3A, size: f32) -> AnyShape {
    let squares = [part(numbers, 0.5, 2.0), part(numbers, -2.0, -0.5), part(numbers, -1.0, 1.0)];
    let half = Vec3A::splat(size * 0.6);
    let clip = Aabb { min: center - half, max: center + half };
    quadric(center, squares, size * size * part(numbers, -0.1, 0.1), clip)
}

fn bezier(numbers: &mut Numbers, center: Vec3A, size: f32) -> AnyShape {
    let mut at = |i: usize, j: usize| {
        let even = Vec3A::new(i as f32 / 3.0 - 0.5, j as f32 / 3.0 - 0.5, 0.0);
        center + (even + numbers.cube().as_vec3a() * 0.3) * size
    };
    BezierPatch { points: [0, 1, 2, 3].map(|i| [0, 1, 2, 3].map(|j| at(i, j))) }.into()
}

fn hills(numbers: &mut Numbers, center: Vec3A, size: f32) -> AnyShape {
    let counts = [2 + numbers.below(40), 2 + numbers.below(20)];
    let heights: Vec<f32> =
        (0..counts[0] * counts[1]).map(|_| center.y + size * part(numbers, -0.2, 0.2)).collect();
    let half = size * 0.6;
    let (from, to) = ([center.x - half, center.z - half], [center.x + half, center.z + half]);
    let relief = if numbers.below(2) == 0 { Relief::Facets } else { Relief::Smooth };
    HeightField::new(from, to, counts, heights).expect("it has an area").shaded(relief).into()
}
