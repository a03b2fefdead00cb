//! Directions about a normal, and how to pick them at random.

use std::f32::consts::{FRAC_1_PI, TAU};

use glam::Vec3A;

/// Three unit vectors at right angles; local `z` is the normal.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Frame {
    x: Vec3A,
    y: Vec3A,
    z: Vec3A,
}

impl Frame {
    /// Any frame about a unit normal [Duff 17].
    pub(crate) fn about(z: Vec3A) -> Self {
        let sign = 1.0f32.copysign(z.z);
        let a = -1.0 / (sign + z.z);
        let b = z.x * z.y * a;
        let x = Vec3A::new(1.0 + sign * z.x * z.x * a, sign * b, -sign * z.x);
        let y = Vec3A::new(b, sign + z.y * z.y * a, -z.y);
        Self { x, y, z }
    }

    pub(crate) fn world(&self, local: Vec3A) -> Vec3A {
        self.x * local.x + self.y * local.y + self.z * local.z
    }

    pub(crate) fn local(&self, world: Vec3A) -> Vec3A {
        Vec3A::new(self.x.dot(world), self.y.dot(world), self.z.dot(world))
    }
}

/// A point of the unit disk, evenly.
pub(crate) fn in_disk([u, v]: [f32; 2]) -> [f32; 2] {
    let radius = u.sqrt();
    let (sine, cosine) = libm::sincosf(TAU * v);
    [radius * cosine, radius * sine]
}

/// A direction about local `z`, more often near it: density `z / π`.
pub(crate) fn cosine_weighted(u: [f32; 2]) -> Vec3A {
    let [x, y] = in_disk(u);
    Vec3A::new(x, y, (1.0 - u[0]).max(0.0).sqrt())
}

/// The density of [`cosine_weighted`].
pub(crate) fn cosine_density(z: f32) -> f32 {
    z.max(0.0) * FRAC_1_PI
}

/// A direction within a cone about local `z`, evenly, whose angle has `1 − cosine` as given:
/// so that narrow cones keep their digits.
pub(crate) fn in_cone([u, v]: [f32; 2], one_minus_cosine: f32) -> Vec3A {
    let fall = u * one_minus_cosine;
    let radius = (fall * (2.0 - fall)).max(0.0).sqrt();
    let (sine, cosine) = libm::sincosf(TAU * v);
    Vec3A::new(radius * cosine, radius * sine, 1.0 - fall)
}

/// The density of [`in_cone`].
pub(crate) fn cone_density(one_minus_cosine: f32) -> f32 {
    1.0 / (TAU * one_minus_cosine)
}

/// A direction anywhere, evenly.
pub(crate) fn on_sphere(u: [f32; 2]) -> Vec3A {
    in_cone(u, 2.0)
}

/// The density of [`on_sphere`].
#[cfg(test)]
pub(crate) const SPHERE_DENSITY: f32 = 0.25 * FRAC_1_PI;

/// The mirror image of `v` about a unit normal; both point away from the surface.
pub(crate) fn mirrored(v: Vec3A, normal: Vec3A) -> Vec3A {
    normal * (2.0 * v.dot(normal)) - v
}

/// Where `v`, pointing away from a surface, goes on behind it, where light is slower by
/// `eta` than on its own side; none if all of it is mirrored. `normal` is on the side of `v`.
pub(crate) fn refracted(v: Vec3A, normal: Vec3A, eta: f32) -> Option<Vec3A> {
    let cosine = v.dot(normal);
    let ratio = 1.0 / eta;
    let sine_squared = ratio * ratio * (1.0 - cosine * cosine).max(0.0);
    if sine_squared >= 1.0 {
        return None;
    }
    let below = (1.0 - sine_squared).sqrt();
    Some(v * -ratio + normal * (ratio * cosine - below))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_frame_has_right_angles_about_any_normal() {
        for i in 0..200 {
            let u = [(i as f32 + 0.5) / 200.0, (i * 7 % 200) as f32 / 200.0];
            let z = on_sphere(u);
            let frame = Frame::about(z);
            let back = frame.local(frame.world(Vec3A::new(0.3, -0.7, 0.2)));
            assert!((back - Vec3A::new(0.3, -0.7, 0.2)).length() < 1e-5, "{z}");
        }
        for z in [Vec3A::Z, Vec3A::NEG_Z] {
            assert!(Frame::about(z).world(Vec3A::X).is_finite());
        }
    }

    #[test]
    fn refraction_follows_snell() {
        let v = Vec3A::new(0.6, 0.0, 0.8);
        let through = refracted(v, Vec3A::Z, 1.5).expect("it enters");
        assert!((through.x + 0.6 / 1.5).abs() < 1e-6 && through.z < 0.0);
        assert!((through.length() - 1.0).abs() < 1e-6);
        assert_eq!(refracted(v, Vec3A::Z, 1.0 / 1.8), None, "0.6 · 1.8 is more than 1");
        let straight = refracted(v, Vec3A::Z, 1.0).expect("nothing bends it");
        assert!((straight + v).length() < 1e-6);
    }
}
