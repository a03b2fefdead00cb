//! Single shapes, by kind and fields.

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
use nestray_shapes::plane::Plane;
use nestray_shapes::polygon::Polygon;
use nestray_shapes::quadric::Quadric;
use nestray_shapes::sphere::Sphere;
use nestray_shapes::torus::Torus;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A shape.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub(super) enum Shape {
    /// A sphere.
    Sphere { center: [f32; 3], radius: f32 },
    /// A cone, cut off where its apex has a radius; open at both ends.
    Cone {
        base: [f32; 3],
        base_radius: f32,
        apex: [f32; 3],
        #[serde(default)]
        apex_radius: f32,
    },
    /// A cylinder, open at both ends.
    Cylinder { base: [f32; 3], top: [f32; 3], radius: f32 },
    /// A plane without end.
    Plane { point: [f32; 3], normal: [f32; 3] },
    /// A flat disk.
    Disk { center: [f32; 3], normal: [f32; 3], radius: f32 },
    /// A corner, and two edges from it.
    Parallelogram { corner: [f32; 3], u: [f32; 3], v: [f32; 3] },
    /// A closed box along the axes.
    Block { min: [f32; 3], max: [f32; 3] },
    /// A flat polygon, concave or not; counter-clockwise seen from its front.
    Polygon { vertices: Vec<[f32; 3]> },
    /// A polygon with a normal at each vertex for shading.
    Patch { vertices: Vec<[f32; 3]>, normals: Vec<[f32; 3]> },
    /// A ring about an axis: the radius of the circle, and that of the tube.
    Torus { center: [f32; 3], axis: [f32; 3], major: f32, minor: f32 },
    /// Where `squares · (x², y², z²) + products · (xy, yz, zx) + linear · (x, y, z) + constant`
    /// is zero, inside `clip`.
    Quadric {
        squares: [f32; 3],
        #[serde(default)]
        products: [f32; 3],
        #[serde(default)]
        linear: [f32; 3],
        #[serde(default)]
        constant: f32,
        #[serde(default, skip_serializing_if = "Option::is_none")]
        clip: Option<Clip>,
    },
    /// A bicubic Bézier patch: four rows of four control points.
    Bezier { points: [[[f32; 3]; 4]; 4] },
    /// Heights over a rectangle of the plane y = 0, rows along x; `counts` and corners are
    /// along x and along z.
    HeightField {
        from: [f32; 2],
        to: [f32; 2],
        counts: [usize; 2],
        heights: Vec<f32>,
        /// Whether normals are blended between samples.
        #[serde(default)]
        smooth: bool,
    },
}

/// A box. What is at or beyond 3.4028235e38 is endless.
#[derive(Clone, Copy, Debug, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct Clip {
    min: [f32; 3],
    max: [f32; 3],
}

impl Shape {
    /// Checked as far as data must fit together; a shape that makes no sense is never hit.
    pub(super) fn build(&self) -> Result<AnyShape, String> {
        let v = Vec3A::from_array;
        Ok(match self {
            &Self::Sphere { center, radius } => Sphere { center: v(center), radius }.into(),
            &Self::Cone { base, base_radius, apex, apex_radius } => {
                Cone { base: v(base), base_radius, apex: v(apex), apex_radius }.into()
            }
            &Self::Cylinder { base, top, radius } => {
                Cylinder { base: v(base), top: v(top), radius }.into()
            }
            &Self::Plane { point, normal } => Plane { point: v(point), normal: v(normal) }.into(),
            &Self::Disk { center, normal, radius } => {
                Disk { center: v(center), normal: v(normal), radius }.into()
            }
            &Self::Parallelogram { corner, u, v: w } => {
                Parallelogram { corner: v(corner), u: v(u), v: v(w) }.into()
            }
            &Self::Block { min, max } => Block { extent: Aabb { min: v(min), max: v(max) } }.into(),
            Self::Polygon { vertices } => Polygon::new(vertices.as_slice()).into(),
            Self::Patch { vertices, normals } => {
                if vertices.len() != normals.len() {
                    let (found, needed) = (normals.len(), vertices.len());
                    return Err(format!(".patch.normals: {found} for {needed} vertices"));
                }
                let both: Vec<_> = vertices.iter().copied().zip(normals.iter().copied()).collect();
                Patch::new(&both).into()
            }
            &Self::Torus { center, axis, major, minor } => {
                Torus { center: v(center), axis: v(axis), major, minor }.into()
            }
            &Self::Quadric { squares, products, linear, constant, clip } => {
                let clip = clip.map_or(Aabb::ENDLESS, Clip::build);
                Quadric { squares, products, linear, constant, clip }.into()
            }
            Self::Bezier { points } => BezierPatch { points: points.map(|row| row.map(v)) }.into(),
            Self::HeightField { from, to, counts, heights, smooth } => {
                let relief = if *smooth { Relief::Smooth } else { Relief::Facets };
                HeightField::new(*from, *to, *counts, heights.as_slice())
                    .map_err(|error| format!(".height_field: {error}"))?
                    .shaded(relief)
                    .into()
            }
        })
    }

    pub(super) fn of(shape: &AnyShape) -> Self {
        let a = |v: Vec3A| v.to_array();
        match shape {
            AnyShape::Sphere(s) => Self::Sphere { center: a(s.center), radius: s.radius },
            AnyShape::Cone(s) => Self::Cone {
                base: a(s.base),
                base_radius: s.base_radius,
                apex: a(s.apex),
                apex_radius: s.apex_radius,
            },
            AnyShape::Cylinder(s) => {
                Self::Cylinder { base: a(s.base), top: a(s.top), radius: s.radius }
            }
            AnyShape::Plane(s) => Self::Plane { point: a(s.point), normal: a(s.normal) },
            AnyShape::Disk(s) => {
                Self::Disk { center: a(s.center), normal: a(s.normal), radius: s.radius }
            }
            AnyShape::Parallelogram(s) => {
                Self::Parallelogram { corner: a(s.corner), u: a(s.u), v: a(s.v) }
            }
            AnyShape::Block(s) => Self::Block { min: a(s.extent.min), max: a(s.extent.max) },
            AnyShape::Polygon(s) => Self::Polygon { vertices: s.vertices().to_vec() },
            AnyShape::Patch(s) => Self::Patch {
                vertices: s.polygon().vertices().to_vec(),
                normals: s.normals().to_vec(),
            },
            AnyShape::Torus(s) => {
                Self::Torus { center: a(s.center), axis: a(s.axis), major: s.major, minor: s.minor }
            }
            AnyShape::Quadric(s) => Self::Quadric {
                squares: s.squares,
                products: s.products,
                linear: s.linear,
                constant: s.constant,
                clip: (s.clip != Aabb::ENDLESS).then(|| Clip::of(&s.clip)),
            },
            AnyShape::Bezier(s) => Self::Bezier { points: s.points.map(|row| row.map(a)) },
            AnyShape::HeightField(s) => {
                let [columns, rows] = s.counts();
                let (from, to) = (s.sample(0, 0), s.sample(columns - 1, rows - 1));
                Self::HeightField {
                    from: [from.x, from.z],
                    to: [to.x, to.z],
                    counts: [columns, rows],
                    heights: s.heights().to_vec(),
                    smooth: s.relief() == Relief::Smooth,
                }
            }
        }
    }
}

impl Clip {
    fn build(self) -> Aabb {
        let endless = |x: f32| if x.abs() >= f32::MAX { x * f32::INFINITY } else { x };
        let corner = |corner: [f32; 3]| Vec3A::from_array(corner.map(endless));
        Aabb { min: corner(self.min), max: corner(self.max) }
    }

    fn of(clip: &Aabb) -> Self {
        let ended = |corner: Vec3A| corner.to_array().map(|x| x.clamp(-f32::MAX, f32::MAX));
        Self { min: ended(clip.min), max: ended(clip.max) }
    }
}
