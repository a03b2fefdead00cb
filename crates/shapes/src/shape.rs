//! Single shapes: what each has to say of itself, and the object made of it.

mod crossing;

use glam::Vec3A;
use nestray_core::aabb::Aabb;
use nestray_core::beam::{Beam, Facing};
use nestray_core::cost::{Cost, CostModel};
use nestray_core::hit::{Hit, InstancePath};
use nestray_core::object::Object;
use nestray_core::ray::{Ray, Source};
use nestray_core::scratch::Scratch;
use nestray_core::surface::Surface;

pub use self::crossing::Crossing;

/// A surface that a line crosses in a few places.
///
/// Shapes work out crossings in doubles from their `f32` data and round once, at the end:
/// then a hit lies within the bounds, up to the slack of every box test, and every technique
/// finds it. Only `+ − × ÷ √` are used, which round alike on every machine.
///
/// A shape that makes no sense (a NaN, a radius of zero) has empty bounds and no crossings.
pub trait Shape: std::fmt::Debug + Send + Sync {
    /// The word for it in reports, prices and scene files.
    fn kind(&self) -> &'static str;

    /// A box around it, rounded outwards; see [`bounds_from`].
    fn bounds(&self) -> Aabb;

    /// How far it reaches along `direction`; see [`Object::along`].
    fn along(&self, direction: Vec3A) -> [f32; 2] {
        self.bounds().along(direction)
    }

    /// See [`Object::hull_area`].
    fn hull_area(&self) -> f32 {
        self.bounds().surface_area()
    }

    /// Whether any of the surface may lie in `cell`; see [`Object::touches`].
    fn touches(&self, cell: &Aabb) -> bool {
        self.bounds().overlaps(cell)
    }

    /// See [`Object::facing`].
    fn facing(&self, _beam: &Beam) -> Facing {
        Facing::Mixed
    }

    /// See [`Object::blocks`]; of a surface that lets nothing through.
    fn blocks(&self, _beam: &Beam) -> Option<f32> {
        None
    }

    /// Calls `found` with every place where the line of the ray crosses the surface, in any
    /// order; the range of the ray does not matter.
    fn crossings(&self, ray: &Ray, found: impl FnMut(Crossing));

    /// The same, but only those within the range of the ray and up to `limit` are needed, and
    /// then up to what `found` answers. For shapes that many rays cross many times.
    fn crossings_until(&self, ray: &Ray, _limit: f32, mut found: impl FnMut(Crossing) -> f32) {
        self.crossings(ray, |crossing| _ = found(crossing));
    }

    /// What the surface looks like at a crossing found for this ray.
    fn surface(&self, ray: &Ray, crossing: &Crossing) -> Surface;

    /// Whether a ray that leaves it can never meet it again.
    fn is_flat(&self) -> bool {
        false
    }
}

impl<S: Shape> Shape for &S {
    fn kind(&self) -> &'static str {
        (**self).kind()
    }
    fn bounds(&self) -> Aabb {
        (**self).bounds()
    }
    fn along(&self, direction: Vec3A) -> [f32; 2] {
        (**self).along(direction)
    }
    fn hull_area(&self) -> f32 {
        (**self).hull_area()
    }
    fn touches(&self, cell: &Aabb) -> bool {
        (**self).touches(cell)
    }
    fn facing(&self, beam: &Beam) -> Facing {
        (**self).facing(beam)
    }
    fn blocks(&self, beam: &Beam) -> Option<f32> {
        (**self).blocks(beam)
    }
    fn crossings(&self, ray: &Ray, found: impl FnMut(Crossing)) {
        (**self).crossings(ray, found);
    }
    fn crossings_until(&self, ray: &Ray, limit: f32, found: impl FnMut(Crossing) -> f32) {
        (**self).crossings_until(ray, limit, found);
    }
    fn surface(&self, ray: &Ray, crossing: &Crossing) -> Surface {
        (**self).surface(ray, crossing)
    }
    fn is_flat(&self) -> bool {
        (**self).is_flat()
    }
}

/// Which sides of a surface can be seen.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Sides {
    /// Both.
    #[default]
    Both,
    /// Only the front, which its normal points away from.
    Front,
    /// Only the back.
    Back,
}

impl Sides {
    /// Whether a ray that arrives at the front, or at the back, sees the surface.
    #[inline]
    #[must_use]
    pub fn show(self, front: bool) -> bool {
        match self {
            Self::Both => true,
            Self::Front => front,
            Self::Back => !front,
        }
    }
}

/// One shape as an object.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Single<S> {
    /// Reported in hits.
    pub geometry: u32,
    /// Reported in hits.
    pub primitive: u32,
    /// Which sides can be hit.
    pub sides: Sides,
    /// The shape itself.
    pub shape: S,
}

impl<S: Shape> Single<S> {
    /// Primitive 0 of a geometry, seen from both sides.
    #[must_use]
    pub fn new(geometry: u32, shape: S) -> Self {
        Self { geometry, primitive: 0, sides: Sides::Both, shape }
    }

    /// Calls `found` with every crossing that counts as a hit, up to `limit`, then up to what it
    /// answers.
    #[inline]
    fn each_hit(&self, ray: &Ray, mut limit: f32, mut found: impl FnMut(&Crossing) -> f32) {
        if self.shape.is_flat() && ray.source() == self.source() {
            return;
        }
        self.shape.crossings_until(ray, limit, |crossing| {
            // Written so that NaN is refused.
            if crossing.t >= ray.t_min()
                && crossing.t <= ray.t_max()
                && self.sides.show(crossing.front)
            {
                limit = found(&crossing);
            }
            limit
        });
    }

    fn source(&self) -> Source {
        Source { geometry: self.geometry, primitive: self.primitive, path: InstancePath::NONE }
    }
}

impl<S: Shape> Object for Single<S> {
    fn kind(&self) -> &'static str {
        self.shape.kind()
    }

    fn bounds(&self) -> Aabb {
        self.shape.bounds()
    }

    fn along(&self, direction: Vec3A) -> [f32; 2] {
        self.shape.along(direction)
    }

    fn hull_area(&self) -> f32 {
        self.shape.hull_area()
    }

    fn touches(&self, cell: &Aabb) -> bool {
        self.shape.touches(cell)
    }

    fn blocks(&self, beam: &Beam) -> Option<f32> {
        // What has one side only lets rays through that come the other way.
        if self.sides == Sides::Both { self.shape.blocks(beam) } else { None }
    }

    fn facing(&self, beam: &Beam) -> Facing {
        self.shape.facing(beam)
    }

    fn closest_hit(&self, ray: &Ray, hit: &mut Hit, _scratch: &mut Scratch) -> bool {
        let mut nearer = false;
        self.each_hit(ray, hit.t, |found| {
            nearer |= hit.offer(found.t, found.uv, self.geometry, self.primitive);
            hit.t
        });
        nearer
    }

    fn any_hit(&self, ray: &Ray, _scratch: &mut Scratch) -> bool {
        let mut any = false;
        self.each_hit(ray, ray.t_max(), |_| {
            any = true;
            f32::NEG_INFINITY
        });
        any
    }

    fn all_hits(&self, ray: &Ray, hits: &mut Vec<Hit>, _scratch: &mut Scratch) {
        self.each_hit(ray, ray.t_max(), |found| {
            let [u, v] = found.uv;
            let id =
                Hit { geometry: self.geometry, primitive: self.primitive, ..Hit::none(found.t) };
            hits.push(Hit { u, v, ..id });
            ray.t_max()
        });
    }

    fn surface(&self, ray: &Ray, hit: &Hit) -> Option<Surface> {
        if (hit.geometry, hit.primitive) != (self.geometry, self.primitive) {
            return None;
        }
        let mut crossing = Crossing { t: hit.t, uv: [hit.u, hit.v], front: true };
        self.shape.crossings(ray, |found| {
            if found.t == hit.t && found.uv == crossing.uv {
                crossing = found;
            }
        });
        Some(self.shape.surface(ray, &crossing))
    }

    fn holds(&self, source: &Source) -> bool {
        *source == self.source()
    }

    fn cost(&self, model: &CostModel) -> Cost {
        let area = self.bounds().surface_area();
        let rate = if area > 0.0 { (self.hull_area() / area).min(1.0) } else { 0.5 };
        Cost::primitive(model.primitive(self.kind()), f64::from(rate), size_of::<Self>() as u64)
    }
}

/// A box from corners in doubles, rounded outwards; empty unless all are numbers.
#[must_use]
pub fn bounds_from(min: [f64; 3], max: [f64; 3]) -> Aabb {
    if min.iter().chain(&max).any(|x| x.is_nan()) {
        return Aabb::EMPTY;
    }
    Aabb { min: Vec3A::from_array(min.map(down)), max: Vec3A::from_array(max.map(up)) }
}

/// An interval from ends in doubles, rounded outwards; empty unless both are numbers.
#[must_use]
pub fn interval_from(low: f64, high: f64) -> [f32; 2] {
    if low.is_nan() || high.is_nan() { NOWHERE } else { [down(low), up(high)] }
}

/// The empty interval: how far nothing reaches.
pub const NOWHERE: [f32; 2] = [f32::INFINITY, f32::NEG_INFINITY];

fn down(x: f64) -> f32 {
    let y = x as f32;
    if f64::from(y) > x { y.next_down() } else { y }
}

fn up(x: f64) -> f32 {
    let y = x as f32;
    if f64::from(y) < x { y.next_up() } else { y }
}
