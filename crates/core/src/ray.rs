//! Rays and what they are for.

use glam::{Affine3A, Vec3A, Vec4};

use crate::hit::{Hit, InstancePath};

/// What a ray was cast for; techniques and dispatchers may treat kinds apart.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum RayKind {
    /// From the eye.
    Camera,
    /// From a surface towards a light; only *whether* it is blocked matters.
    Shadow {
        /// Index of the light in the scene.
        light: u16,
    },
    /// Mirror reflection.
    Reflect,
    /// Refraction.
    Refract,
    /// Diffuse bounce of a path.
    Diffuse,
    /// A kind of the user's own.
    Custom(u8),
}

impl RayKind {
    /// The word for it in reports and plans; all lights share one, as do all custom kinds.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Camera => "camera",
            Self::Shadow { .. } => "shadow",
            Self::Reflect => "reflect",
            Self::Refract => "refract",
            Self::Diffuse => "diffuse",
            Self::Custom(_) => "custom",
        }
    }
}

/// The primitive a ray left, named as in a [`Hit`]. Flat primitives skip a ray that left
/// them, since it cannot meet them again; curved ones do not look at it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Source {
    /// [`Hit::geometry`].
    pub geometry: u32,
    /// [`Hit::primitive`].
    pub primitive: u32,
    /// [`Hit::path`], as seen from the space the ray is in.
    pub path: InstancePath,
}

impl Source {
    /// No surface: the eye, a sensor, empty space.
    pub const NONE: Self =
        Self { geometry: Hit::NOTHING, primitive: Hit::NOTHING, path: InstancePath::NONE };
}

/// A half-line with a parameter range. Immutable while it is traced: the nearest
/// hit so far lives in [`Hit`], not here.
///
/// Origins may lie within ±[`Ray::FARTHEST`], and the longest component of a direction
/// within [`Ray::SHORTEST`] and [`Ray::LONGEST`]. Anything else, NaN included, makes a ray
/// that hits nothing.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct Ray {
    /// The origin, and `t_min`: read at once.
    from: Vec4,
    /// The direction, and `t_max`.
    along: Vec4,
    time: f32,
    kind: RayKind,
    source: Source,
}

impl Ray {
    /// Largest coordinate of an origin, and of anything that can be hit.
    pub const FARTHEST: f32 = 1e15;
    /// Least size of the longest component of a direction.
    pub const SHORTEST: f32 = 1e-12;
    /// Largest size of the longest component of a direction.
    pub const LONGEST: f32 = 1e12;

    /// Origin and direction of a ray that hits nothing.
    const VOID: (Vec4, Vec4) =
        (Vec4::new(0.0, 0.0, 0.0, f32::INFINITY), Vec4::new(1.0, 0.0, 0.0, f32::NEG_INFINITY));

    /// A ray over `[0, ∞)` at the start of the shutter, from no surface. `dir` may have any
    /// length but zero; `t` counts in multiples of it.
    #[inline(always)]
    #[must_use]
    pub fn new(origin: Vec3A, dir: Vec3A, kind: RayKind) -> Self {
        let size = dir.abs();
        // Comparisons with NaN are false, so these lines refuse it.
        let usable = (origin.abs().cmple(Vec3A::splat(Self::FARTHEST))
            & size.cmple(Vec3A::splat(Self::LONGEST)))
        .all()
            && size.cmpge(Vec3A::splat(Self::SHORTEST)).any();
        let (from, along) =
            if usable { (origin.extend(0.0), dir.extend(f32::INFINITY)) } else { Self::VOID };
        Self { from, along, time: 0.0, kind, source: Source::NONE }
    }

    /// The same ray with hits accepted only where `t_min ≤ t ≤ t_max`. A negative `t_min`
    /// counts as 0; NaN makes a ray that hits nothing.
    #[inline(always)]
    #[must_use]
    pub fn between(self, t_min: f32, t_max: f32) -> Self {
        let (own_min, own_max) = (self.t_min(), self.t_max());
        let least = if t_min > own_min { t_min } else { own_min };
        let most = if t_max < own_max { t_max } else { own_max };
        // Not of NaN.
        let usable = t_min < f32::INFINITY && t_max <= f32::INFINITY;
        let (from, along) = if usable {
            // Not −0: then what begins there sorts as an integer does.
            (self.from.with_w(least + 0.0), self.along.with_w(most))
        } else {
            Self::VOID
        };
        Self { from, along, ..self }
    }

    /// The same ray over `[0, ∞)` again; one that hits nothing stays so.
    #[inline]
    #[must_use]
    pub fn whole(self) -> Self {
        // Only a void ray begins at infinity.
        if self.t_min() == f32::INFINITY {
            return self;
        }
        let (from, along) = (self.from.with_w(0.0), self.along.with_w(f32::INFINITY));
        Self { from, along, ..self }
    }

    /// The same ray at a moment within the shutter, in `[0, 1]`.
    #[inline]
    #[must_use]
    pub fn at_time(self, time: f32) -> Self {
        Self { time: if time >= 0.0 { time.min(1.0) } else { 0.0 }, ..self }
    }

    /// The same ray as one that leaves the surface just hit.
    #[inline]
    #[must_use]
    pub fn leaving(self, source: Source) -> Self {
        Self { source, ..self }
    }

    /// Start point, in the space of the object being tested.
    #[inline(always)]
    #[must_use]
    pub fn origin(&self) -> Vec3A {
        Vec3A::from_vec4(self.from)
    }

    /// Direction, of any length; `t` counts in multiples of it.
    #[inline(always)]
    #[must_use]
    pub fn dir(&self) -> Vec3A {
        Vec3A::from_vec4(self.along)
    }

    /// Hits nearer than this are ignored; never negative, nor −0.
    #[inline(always)]
    #[must_use]
    pub fn t_min(&self) -> f32 {
        self.from.w
    }

    /// Hits farther than this are ignored.
    #[inline(always)]
    #[must_use]
    pub fn t_max(&self) -> f32 {
        self.along.w
    }

    /// Moment within the shutter, in `[0, 1]`.
    #[inline(always)]
    #[must_use]
    pub fn time(&self) -> f32 {
        self.time
    }

    /// What the ray was cast for.
    #[inline(always)]
    #[must_use]
    pub fn kind(&self) -> RayKind {
        self.kind
    }

    /// The surface it left.
    #[inline(always)]
    #[must_use]
    pub fn source(&self) -> Source {
        self.source
    }

    /// `1 / dir` per axis, kept within 10⁹ times the smallest: with coordinates and
    /// directions in range no box test then meets an infinity or a NaN, and the slack of
    /// box tests is far larger than what the change moves.
    #[inline(always)]
    #[must_use]
    pub fn inverse_dir(&self) -> Vec3A {
        let dir = self.dir();
        let least = Vec3A::splat(dir.abs().max_element() * 1e-9);
        Vec3A::select(dir.abs().cmplt(least), least.copysign(dir), dir).recip()
    }

    /// The point at parameter `t`.
    #[inline]
    #[must_use]
    pub fn at(&self, t: f32) -> Vec3A {
        self.origin() + self.dir() * t
    }

    /// The same ray in another space, inside the instance numbered `first` that has `paths`
    /// paths inside. The direction is not renormalised, so a parameter `t` names the same
    /// point in both spaces.
    #[inline]
    #[must_use]
    pub fn entering(&self, to_from: &Affine3A, first: u32, paths: u32) -> Self {
        let inside = Self::new(
            to_from.transform_point3a(self.origin()),
            to_from.transform_vector3a(self.dir()),
            self.kind,
        );
        let source = match self.source.path.inside(first, paths) {
            Some(path) => Source { path, ..self.source },
            None => Source::NONE,
        };
        Self { time: self.time, source, ..inside.between(self.t_min(), self.t_max()) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_ray_that_is_not_one_hits_nothing() {
        let nan = f32::NAN;
        for (origin, dir) in [
            (Vec3A::new(nan, 0.0, 0.0), Vec3A::X),
            (Vec3A::ZERO, Vec3A::new(1.0, nan, 0.0)),
            (Vec3A::ZERO, Vec3A::ZERO),
            (Vec3A::splat(f32::INFINITY), Vec3A::X),
            (Vec3A::ZERO, Vec3A::new(f32::NEG_INFINITY, 0.0, 0.0)),
            (Vec3A::splat(1e16), Vec3A::X),
            (Vec3A::ZERO, Vec3A::splat(1e-20)),
        ] {
            let ray = Ray::new(origin, dir, RayKind::Camera).between(0.0, 9.0);
            assert!(ray.t_min() > ray.t_max(), "{origin} {dir}");
            assert!(ray.origin().is_finite() && ray.dir().is_finite());
        }
        assert!(Ray::new(Vec3A::ZERO, Vec3A::X, RayKind::Camera).between(nan, 1.0).t_max() < 0.0);
    }

    #[test]
    fn the_inverse_is_finite_and_keeps_signs() {
        let dir = Vec3A::new(-0.0, 2.0, 0.0);
        let inverse = Ray::new(Vec3A::ZERO, dir, RayKind::Camera).inverse_dir();
        assert!(inverse.is_finite() && inverse.x < 0.0 && inverse.z > 0.0);
        assert_eq!(inverse.y, 0.5);
    }
}
