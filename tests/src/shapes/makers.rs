//! One random shape of each kind, about as large as a ball with a centre and a radius.

use glam::Vec3A;
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
use nestray_shapes::polygon::Polygon;
use nestray_shapes::quadric::Quadric;
use nestray_shapes::sphere::Sphere;
use nestray_shapes::torus::Torus;

use crate::numbers::Numbers;

/// A unit vector, every other along an axis.
pub(super) fn axis(numbers: &mut Numbers) -> Vec3A {
    if numbers.once_in(2) { Vec3A::AXES[numbers.below(3)] } else { numbers.direction() }
}

pub(super) fn sphere(_: &mut Numbers, center: Vec3A, size: f32) -> AnyShape {
    Sphere { center, radius: size }.into()
}

pub(super) fn cone(numbers: &mut Numbers, center: Vec3A, size: f32) -> AnyShape {
    let half = axis(numbers) * size;
    let apex_radius = *numbers.pick(&[0.0, 0.25, 0.5]) * size;
    let base_radius = size * numbers.between(0.1, 0.7);
    Cone { base: center - half, base_radius, apex: center + half, apex_radius }.into()
}

pub(super) fn cylinder(numbers: &mut Numbers, center: Vec3A, size: f32) -> AnyShape {
    let half = axis(numbers) * size;
    let radius = size * *numbers.pick(&[0.01, 0.25, 0.5, 1.0]);
    Cylinder { base: center - half, top: center + half, radius }.into()
}

pub(super) fn block(numbers: &mut Numbers, center: Vec3A, size: f32) -> AnyShape {
    let half = [0; 3].map(|_| *numbers.pick(&[0.01, 0.5, 0.5, 1.0]) * size);
    let half = Vec3A::from_array(half);
    Block { extent: Aabb { min: center - half, max: center + half } }.into()
}

pub(super) fn torus(numbers: &mut Numbers, center: Vec3A, size: f32) -> AnyShape {
    let minor = size * *numbers.pick(&[0.05, 0.25, 0.4]);
    Torus { center, axis: axis(numbers), major: size - minor, minor }.into()
}

pub(super) fn disk(numbers: &mut Numbers, center: Vec3A, size: f32) -> AnyShape {
    Disk { center, normal: axis(numbers), radius: size }.into()
}

pub(super) fn parallelogram(numbers: &mut Numbers, center: Vec3A, size: f32) -> AnyShape {
    let (mut u, mut v) = (numbers.direction() * size, numbers.direction() * size);
    if numbers.once_in(2) {
        let first = numbers.below(3);
        (u, v) = (Vec3A::AXES[first] * size, Vec3A::AXES[(first + 1) % 3] * size);
    }
    Parallelogram { corner: center - (u + v) * 0.5, u, v }.into()
}

/// Corners around `center` at distances from `radius`.
fn ring(
    count: usize,
    center: Vec3A,
    normal: Vec3A,
    radius: impl Fn(usize) -> f32,
) -> Vec<[f32; 3]> {
    let x = normal.any_orthonormal_vector();
    let y = normal.cross(x);
    let corner = |i: usize| {
        let angle = std::f32::consts::TAU * i as f32 / count as f32;
        let out = x * libm::cosf(angle) + y * libm::sinf(angle);
        (center + out * radius(i)).to_array()
    };
    (0..count).map(corner).collect()
}

pub(super) fn polygon(numbers: &mut Numbers, center: Vec3A, size: f32) -> AnyShape {
    let (count, normal) = (3 + numbers.below(6), axis(numbers));
    Polygon::new(ring(count, center, normal, |_| size)).into()
}

pub(super) fn star(numbers: &mut Numbers, center: Vec3A, size: f32) -> AnyShape {
    let (count, normal) = (4 + 2 * numbers.below(8), axis(numbers));
    Polygon::new(ring(count, center, normal, |i| if i % 2 == 0 { size } else { size * 0.4 })).into()
}

pub(super) fn patch(numbers: &mut Numbers, center: Vec3A, size: f32) -> AnyShape {
    let (count, normal) = (3 + numbers.below(4), axis(numbers));
    let bent = |&v: &[f32; 3]| (Vec3A::from_array(v) - center) / size * 0.5 + normal;
    let corners: Vec<_> =
        ring(count, center, normal, |_| size).iter().map(|v| (*v, bent(v).to_array())).collect();
    Patch::new(&corners).into()
}

/// A quadric around `center`, of the given curvatures, `level` away from its centre.
pub(super) fn quadric(center: Vec3A, squares: [f32; 3], level: f32, clip: Aabb) -> AnyShape {
    let c = center.to_array().map(f64::from);
    let constant: f64 = (0..3).map(|i| f64::from(squares[i]) * c[i] * c[i]).sum();
    Quadric {
        squares,
        products: [0.0; 3],
        linear: [0, 1, 2].map(|i| (-2.0 * f64::from(squares[i]) * c[i]) as f32),
        constant: (constant - f64::from(level)) as f32,
        clip,
    }
    .into()
}

pub(super) fn ellipsoid(numbers: &mut Numbers, center: Vec3A, size: f32) -> AnyShape {
    let squares = [0; 3].map(|_| numbers.between(1.0, 4.0));
    quadric(center, squares, size * size, Aabb::ENDLESS)
}

pub(super) fn saddle(numbers: &mut Numbers, center: Vec3A, size: f32) -> AnyShape {
    let squares =
        [numbers.between(0.5, 2.0), numbers.between(-2.0, -0.5), numbers.between(-1.0, 1.0)];
    let half = Vec3A::splat(size * 0.6);
    let clip = Aabb { min: center - half, max: center + half };
    quadric(center, squares, size * size * numbers.between(-0.1, 0.1), clip)
}

pub(super) fn bezier(numbers: &mut Numbers, center: Vec3A, size: f32) -> AnyShape {
    let mut at = |i: usize, j: usize| {
        let even = Vec3A::new(i as f32 / 3.0 - 0.5, j as f32 / 3.0 - 0.5, 0.0);
        center + (even + (numbers.point() - 0.5) * 0.6) * size
    };
    BezierPatch { points: [0, 1, 2, 3].map(|i| [0, 1, 2, 3].map(|j| at(i, j))) }.into()
}

pub(super) fn hills(numbers: &mut Numbers, center: Vec3A, size: f32) -> AnyShape {
    let counts = [2 + numbers.below(12), 2 + numbers.below(9)];
    let heights: Vec<f32> = (0..counts[0] * counts[1])
        .map(|_| center.y + size * *numbers.pick(&[-0.25, 0.0, 0.0, 0.25]))
        .collect();
    let (from, to) = ([center.x - size, center.z - size], [center.x + size, center.z + size]);
    let relief = *numbers.pick(&[Relief::Facets, Relief::Smooth]);
    HeightField::new(from, to, counts, heights).expect("it has an area").shaded(relief).into()
}
