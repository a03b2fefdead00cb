//! Boxes with faces across the axes.

use glam::{DVec3, Vec3A};
use nestray_core::aabb::Aabb;
use nestray_core::beam::Beam;
use nestray_core::ray::Ray;
use nestray_core::surface::Surface;

use crate::rounding::slack;
use crate::shadow::{Section, beyond};
use crate::shape::{Crossing, NOWHERE, Shape, interval_from};

/// A closed box with faces across the axes; rays hit it from outside and from inside. It may
/// be flat. The texture coordinates of each face run from 0 to 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Block {
    /// Its extent.
    pub extent: Aabb,
}

/// A place where a line enters or leaves.
#[derive(Clone, Copy)]
struct Wall {
    t: f64,
    axis: usize,
}

impl Block {
    /// Between two opposite corners, given in any order.
    #[must_use]
    pub fn between(a: Vec3A, b: Vec3A) -> Self {
        Self { extent: Aabb { min: a.min(b), max: a.max(b) } }
    }

    fn is_sound(&self) -> bool {
        self.extent.surface_area() > 0.0
            && self.extent.min.is_finite()
            && self.extent.max.is_finite()
            && self.extent.reach() <= Ray::FARTHEST
    }

    /// Where the line of the ray enters and leaves.
    fn walls(&self, ray: &Ray) -> Option<[Wall; 2]> {
        let (origin, dir) = (ray.origin().as_dvec3(), ray.dir().as_dvec3());
        let (min, max) = (self.extent.min.as_dvec3(), self.extent.max.as_dvec3());
        let mut enter = Wall { t: f64::NEG_INFINITY, axis: 0 };
        let mut leave = Wall { t: f64::INFINITY, axis: 0 };
        for axis in 0..3 {
            if dir[axis] == 0.0 {
                if origin[axis] < min[axis] || origin[axis] > max[axis] {
                    return None;
                }
                continue;
            }
            let a = (min[axis] - origin[axis]) / dir[axis];
            let b = (max[axis] - origin[axis]) / dir[axis];
            if a.min(b) > enter.t {
                enter = Wall { t: a.min(b), axis };
            }
            if a.max(b) < leave.t {
                leave = Wall { t: a.max(b), axis };
            }
        }
        (enter.t <= leave.t).then_some([enter, leave])
    }
}

impl Shape for Block {
    fn kind(&self) -> &'static str {
        "block"
    }

    fn bounds(&self) -> Aabb {
        if self.is_sound() { self.extent } else { Aabb::EMPTY }
    }

    fn along(&self, direction: Vec3A) -> [f32; 2] {
        if !self.is_sound() {
            return NOWHERE;
        }
        let direction = direction.as_dvec3();
        let a = self.extent.min.as_dvec3() * direction;
        let b = self.extent.max.as_dvec3() * direction;
        interval_from(a.min(b).element_sum(), a.max(b).element_sum())
    }

    /// The shell: a cell wholly inside does not touch it.
    fn touches(&self, cell: &Aabb) -> bool {
        let room = slack(self.extent.reach()) as f32;
        let inside = Aabb { min: self.extent.min + room, max: self.extent.max - room };
        self.bounds().padded().overlaps(cell) && !inside.contains(cell)
    }

    /// By its nearest face alone.
    fn blocks(&self, beam: &Beam) -> Option<f32> {
        if !self.is_sound() {
            return None;
        }
        let Aabb { min, max } = self.extent;
        let axis = beam.axis % 3;
        let section = Section::new(beam, f64::from(if beam.backward { max } else { min }[axis]))?;
        let within = (0..2).all(|i| {
            let aside = (axis + 1 + i) % 3;
            let room = slack(self.extent.reach().max(beam.origin.reach()));
            section.low[i] >= f64::from(min[aside]) + room
                && section.high[i] <= f64::from(max[aside]) - room
        });
        if within { beyond(section.farthest) } else { None }
    }

    #[inline]
    fn crossings(&self, ray: &Ray, mut found: impl FnMut(Crossing)) {
        if !self.is_sound() {
            return;
        }
        if let Some([enter, leave]) = self.walls(ray) {
            found(Crossing::of_solid(enter.t as f32, true));
            found(Crossing::of_solid(leave.t as f32, false));
        }
    }

    fn surface(&self, ray: &Ray, crossing: &Crossing) -> Surface {
        let Aabb { min, max } = self.extent;
        let Wall { t, axis } = match self.walls(ray) {
            Some([enter, _]) if crossing.front => enter,
            Some([_, leave]) => leave,
            None => Wall { t: f64::from(crossing.t), axis: 0 },
        };
        // It goes in against the normal and out along it.
        let up = (ray.dir()[axis] > 0.0) != crossing.front;
        let point = ray.origin().as_dvec3() + ray.dir().as_dvec3() * t;
        // Off the neighbouring faces, so that a ray can leave inwards at an edge.
        let (low, high) = (min.map(f32::next_up), max.map(f32::next_down));
        let mut position = point.as_vec3a().max(low.min(max)).min(high.max(min));
        position[axis] = if up { max } else { min }[axis];
        let mut normal = Vec3A::ZERO;
        normal[axis] = if up { 1.0 } else { -1.0 };
        let (next, last) = ((axis + 1) % 3, (axis + 2) % 3);
        let part = |axis: usize| {
            let size = f64::from(max[axis]) - f64::from(min[axis]);
            let part = (point[axis] - f64::from(min[axis])) / size;
            if size > 0.0 { part.clamp(0.0, 1.0) } else { 0.0 }
        };
        let mut tangent = DVec3::ZERO;
        tangent[next] = f64::from(normal[axis]);
        // Turned about on the lower faces, so that writing is never seen in a mirror.
        let u = if up { part(next) } else { 1.0 - part(next) };
        Surface {
            error: min.abs().max(max.abs()) * f32::EPSILON,
            tangent: tangent.as_vec3a(),
            mirrored: true,
            uv: [u as f32, part(last) as f32],
            ..Surface::new(position, normal)
        }
    }
}
