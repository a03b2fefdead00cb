//! Surfaces that places can be picked on.

use std::f32::consts::PI;

use glam::{Affine3A, Mat3A, Vec3A};

use crate::directions::{Frame, cone_density, in_cone, in_disk, on_sphere};

/// A surface in the world.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Outline {
    /// `corner + u · sides[0] + v · sides[1]`, for `u + v ≤ 1`.
    Triangle { corner: Vec3A, sides: [Vec3A; 2], mirrored: bool },
    /// The same, for `u` and `v` in `[0, 1]`.
    Parallelogram { corner: Vec3A, sides: [Vec3A; 2], mirrored: bool },
    /// A disk, squeezed: `center + x · axes[0] + y · axes[1]`.
    Ellipse { center: Vec3A, axes: [Vec3A; 2], mirrored: bool },
    /// A sphere.
    Sphere { center: Vec3A, radius: f32 },
    /// A sphere of radius 1 about the origin, transformed.
    Ellipsoid(Affine3A),
}

/// A place on a surface.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Place {
    pub(crate) position: Vec3A,
    /// Unit normal, on the front.
    pub(crate) normal: Vec3A,
    /// Coordinates on a triangle.
    pub(crate) uv: [f32; 2],
    /// Per solid angle, seen from where it was asked.
    pub(crate) density: f32,
}

impl Outline {
    /// A sphere, transformed.
    pub(crate) fn sphere(center: Vec3A, radius: f32, to: &Affine3A) -> Self {
        let m = to.matrix3;
        let size = m.x_axis.length_squared();
        let even = |a: f32| (a - size).abs() <= 1e-5 * size;
        let square = |a: Vec3A, b: Vec3A| a.dot(b).abs() <= 1e-5 * size;
        if even(m.y_axis.length_squared())
            && even(m.z_axis.length_squared())
            && square(m.x_axis, m.y_axis)
            && square(m.y_axis, m.z_axis)
            && square(m.z_axis, m.x_axis)
        {
            return Self::Sphere {
                center: to.transform_point3a(center),
                radius: radius * size.sqrt(),
            };
        }
        let unit = Affine3A {
            matrix3: Mat3A::from_diagonal(glam::Vec3::splat(radius)),
            translation: center,
        };
        Self::Ellipsoid(*to * unit)
    }

    /// A flat disk, transformed; none if it has no normal.
    pub(crate) fn disk(center: Vec3A, normal: Vec3A, radius: f32, to: &Affine3A) -> Option<Self> {
        let frame = Frame::about(normal.try_normalize()?);
        let axes =
            [Vec3A::X, Vec3A::Y].map(|axis| to.transform_vector3a(frame.world(axis) * radius));
        let center = to.transform_point3a(center);
        (radius > 0.0).then_some(Self::Ellipse { center, axes, mirrored: is_mirrored(to) })
    }

    /// A parallelogram, transformed.
    pub(crate) fn parallelogram(corner: Vec3A, sides: [Vec3A; 2], to: &Affine3A) -> Self {
        let sides = sides.map(|side| to.transform_vector3a(side));
        let corner = to.transform_point3a(corner);
        Self::Parallelogram { corner, sides, mirrored: is_mirrored(to) }
    }

    /// How large it is; of an ellipsoid, about.
    pub(crate) fn area(&self) -> f32 {
        match self {
            Self::Triangle { sides: [a, b], .. } => 0.5 * a.cross(*b).length(),
            Self::Parallelogram { sides: [a, b], .. } => a.cross(*b).length(),
            Self::Ellipse { axes: [a, b], .. } => PI * a.cross(*b).length(),
            Self::Sphere { radius, .. } => 4.0 * PI * radius * radius,
            Self::Ellipsoid(to) => {
                let m = cofactor(to);
                let sides = m.x_axis.length() + m.y_axis.length() + m.z_axis.length();
                4.0 / 3.0 * PI * sides
            }
        }
    }

    /// A place on it to look at from `at`; none if it cannot be seen from there.
    pub(crate) fn sample(&self, at: Vec3A, u: [f32; 2]) -> Option<Place> {
        let (position, uv) = match *self {
            Self::Triangle { corner, sides: [a, b], .. } => {
                let root = u[0].sqrt();
                let uv = [root * (1.0 - u[1]), root * u[1]];
                (corner + a * uv[0] + b * uv[1], uv)
            }
            Self::Parallelogram { corner, sides: [a, b], .. } => (corner + a * u[0] + b * u[1], u),
            Self::Ellipse { center, axes: [a, b], .. } => {
                let [x, y] = in_disk(u);
                (center + a * x + b * y, [0.0; 2])
            }
            Self::Sphere { center, radius } => {
                return sample_sphere(center, radius, at, u);
            }
            Self::Ellipsoid(to) => (to.transform_point3a(on_sphere(u)), [0.0; 2]),
        };
        let normal = self.normal_at(position)?;
        let density = self.density(at, position, normal);
        (density > 0.0 && density.is_finite()).then_some(Place { position, normal, uv, density })
    }

    /// Per solid angle seen from `at`, how often a place on it is picked.
    pub(crate) fn density(&self, at: Vec3A, position: Vec3A, normal: Vec3A) -> f32 {
        let way = position - at;
        let squared = way.length_squared();
        let per_area = match self {
            Self::Sphere { center, radius } => {
                let outside = (*center - at).length_squared();
                if outside > radius * radius {
                    return cone_density(half_angle(radius * radius / outside));
                }
                1.0 / self.area()
            }
            Self::Ellipsoid(to) => {
                let inside = to.inverse().transform_point3a(position).normalize_or_zero();
                1.0 / (4.0 * PI * (cofactor(to) * inside).length())
            }
            _ => 1.0 / self.area(),
        };
        let cosine = normal.dot(way).abs() / squared.sqrt();
        if cosine > 0.0 { per_area * squared / cosine } else { 0.0 }
    }

    fn normal_at(&self, position: Vec3A) -> Option<Vec3A> {
        match *self {
            Self::Triangle { sides: [a, b], mirrored, .. }
            | Self::Parallelogram { sides: [a, b], mirrored, .. }
            | Self::Ellipse { axes: [a, b], mirrored, .. } => {
                let normal = a.cross(b).try_normalize()?;
                Some(if mirrored { -normal } else { normal })
            }
            Self::Sphere { center, .. } => (position - center).try_normalize(),
            Self::Ellipsoid(to) => {
                let inside = to.inverse().transform_point3a(position);
                let normal = (cofactor(&to) * inside).try_normalize()?;
                Some(if is_mirrored(&to) { -normal } else { normal })
            }
        }
    }
}

/// Whether it turns left into right, and so fronts of flat things into backs.
pub(crate) fn is_mirrored(to: &Affine3A) -> bool {
    to.matrix3.determinant() < 0.0
}

/// What normals, and sizes of areas, are transformed by.
fn cofactor(to: &Affine3A) -> Mat3A {
    let m = to.matrix3;
    Mat3A::from_cols(m.y_axis.cross(m.z_axis), m.z_axis.cross(m.x_axis), m.x_axis.cross(m.y_axis))
}

/// `1 − cosine` of the angle with this squared sine.
fn half_angle(sine_squared: f32) -> f32 {
    let cosine = (1.0 - sine_squared).max(0.0).sqrt();
    sine_squared / (1.0 + cosine)
}

/// From outside the cap that is seen, from inside anywhere.
fn sample_sphere(center: Vec3A, radius: f32, at: Vec3A, u: [f32; 2]) -> Option<Place> {
    let way = center - at;
    let squared = way.length_squared();
    let outline = Outline::Sphere { center, radius };
    if squared <= radius * radius {
        let normal = on_sphere(u);
        let position = center + normal * radius;
        let density = outline.density(at, position, normal);
        return (density > 0.0 && density.is_finite()).then_some(Place {
            position,
            normal,
            uv: [0.0; 2],
            density,
        });
    }
    let distance = squared.sqrt();
    let narrow = half_angle(radius * radius / squared);
    let dir = in_cone(u, narrow);
    // Where the ray in that direction meets the sphere, as a direction from its centre.
    let sine_squared = (dir.x * dir.x + dir.y * dir.y).max(0.0);
    let along = distance * dir.z;
    let t = along - (radius * radius - squared * sine_squared).max(0.0).sqrt();
    let frame = Frame::about(way / distance);
    let normal = ((at - center) + frame.world(dir) * t).try_normalize()?;
    let position = center + normal * radius;
    let density = cone_density(narrow);
    density.is_finite().then_some(Place { position, normal, uv: [0.0; 2], density })
}
