//! One object placed in another space.

mod still;

use std::fmt::Debug;

use glam::{Affine3A, Vec3A};

use crate::aabb::{Aabb, Clip};
use crate::cost::{Cost, CostModel};
use crate::hit::Hit;
use crate::object::Object;
use crate::ray::{Ray, Source};
use crate::scratch::Scratch;
use crate::surface::Surface;

pub use self::still::Still;

/// Where an object is, during the shutter.
pub trait Motion: Debug + Send + Sync {
    /// What [`Object::kind`] says of an object so placed.
    const KIND: &'static str;

    /// Whether it ever moves.
    const MOVES: bool;

    /// Into the space of the object at `time`; none if the object is flattened then, and so
    /// cannot be hit.
    fn object_from_world(&self, time: f32) -> Option<Affine3A>;

    /// Out of the space of the object at `time`.
    fn world_from_object(&self, time: f32) -> Affine3A;

    /// What `direction · point` is of a point outside, told by the same point inside: the product
    /// with another direction, and what to add. None if it moves, or nobody knows.
    fn direction_inside(&self, _direction: Vec3A) -> Option<(Vec3A, f32)> {
        None
    }

    /// A box around all places of `local` during `[from, to]`, where `local` is a box around
    /// the object at any time.
    fn sweep(&self, local: Aabb, time: [f32; 2]) -> Aabb;

    /// Whether every point moves on a straight line at even speed during `[from, to]`.
    fn is_even(&self, _time: [f32; 2]) -> bool {
        !Self::MOVES
    }
}

/// An object, transformed. Many instances may share one object, with all the
/// index structure inside it [Snyder 87].
pub type Instance<O> = Placed<O, Still>;

/// An object somewhere else; see [`Instance`] and [`Moving`](crate::moving::Moving).
///
/// A ray is cut to the part within the bounds at its time before it is moved. Rounding in a transform
/// far from a rotation could otherwise put a hit outside the bounds, where one technique
/// looks and another does not.
#[derive(Debug)]
pub struct Placed<O, M> {
    /// Its number among the places of its parent; see [`InstancePath`].
    ///
    /// [`InstancePath`]: crate::hit::InstancePath
    first: u32,
    paths: u32,
    object: O,
    motion: M,
    bounds: Aabb,
    /// The largest coordinate of the bounds.
    reach: f32,
}

impl<O: Object> Instance<O> {
    /// Places `object`; `number`, at least 1, is what the path of its hits grows by. Hits keep
    /// their `t`. An object flattened by a singular transform is never hit.
    #[must_use]
    pub fn new(number: u32, object: O, world_from_object: Affine3A) -> Self {
        Self::with_motion(number, object, Still::new(world_from_object))
    }
}

impl<O: Object> Placed<O, Still> {
    /// A part of the object in the same place: rays are moved and cut as for the whole.
    pub(crate) fn part(&self, part: O) -> Self {
        let Self { first, paths, motion, bounds, reach, .. } = *self;
        Self { first, paths, object: part, motion, bounds, reach }
    }

    /// A box around where the object itself is.
    pub(crate) fn tight_bounds(&self) -> Aabb {
        self.motion.sweep(self.object.bounds(), [0.0, 1.0])
    }

    /// Out of the space of the object, and into it; none if it is flat.
    pub(crate) fn place(&self) -> Option<[Affine3A; 2]> {
        Some([self.motion.world_from_object(0.0), self.motion.object_from_world(0.0)?])
    }

    /// What is placed.
    pub(crate) fn inner(&self) -> &O {
        &self.object
    }
}

impl<O: Object, M: Motion> Placed<O, M> {
    /// Places `object` as `motion` says.
    #[must_use]
    pub fn with_motion(number: u32, object: O, motion: M) -> Self {
        debug_assert!(number > 0, "0 stands for no instance");
        let bounds = motion.sweep(object.bounds(), [0.0, 1.0]);
        let bounds = if bounds.is_empty() { Aabb::EMPTY } else { bounds.padded() };
        let paths = object.paths();
        Self { first: number, paths, object, motion, bounds, reach: bounds.reach() }
    }

    /// The ray in the space of the object; none if it passes by.
    #[inline]
    fn inside(&self, ray: &Ray, limit: f32) -> Option<Ray> {
        /// Less than techniques allow ([`Clip::SLACK`]), by what two such tests can differ.
        const SLACK: f32 = Clip::SLACK * 0.6;
        let (mut enter, mut leave) = (ray.t_min(), ray.t_max());
        if self.bounds.is_bounded() {
            let clip = Clip::with_slack(ray, self.reach, SLACK);
            (enter, leave) = clip.cut(&self.bounds, ray.t_max())?;
            if M::MOVES {
                let now = self.bounds_during([ray.time(); 2]).meet(self.bounds);
                (enter, leave) = clip.cut(&now, ray.t_max())?;
            }
            if enter > limit {
                return None;
            }
        }
        let to_from = self.motion.object_from_world(ray.time())?;
        Some(ray.entering(&to_from, self.first, self.paths).between(enter, leave))
    }

    /// The rays that do not pass by, in the space of the object, and which they are.
    fn all_inside(
        &self,
        rays: &[Ray],
        limit: impl Fn(usize) -> Option<f32>,
    ) -> (Vec<Ray>, Vec<usize>) {
        let mut all = (Vec::with_capacity(rays.len()), Vec::with_capacity(rays.len()));
        all.extend((0..rays.len()).filter_map(|i| Some((self.inside(&rays[i], limit(i)?)?, i))));
        all
    }
}

impl<O: Object, M: Motion> Object for Placed<O, M> {
    fn kind(&self) -> &'static str {
        M::KIND
    }

    fn bounds(&self) -> Aabb {
        self.bounds
    }

    fn bounds_during(&self, time: [f32; 2]) -> Aabb {
        match self.motion.sweep(self.object.bounds(), time) {
            empty if empty.is_empty() => Aabb::EMPTY,
            bounds => bounds.padded(),
        }
    }

    /// A face is where the outermost corner is, and the outermost of several that move evenly is never
    /// farther out than between where it is at both ends.
    fn moves_evenly(&self, time: [f32; 2]) -> bool {
        self.motion.is_even(time)
    }

    fn along(&self, direction: Vec3A) -> [f32; 2] {
        let [least, most] = self.bounds.along(direction);
        // An aggregate would ask all its children, for each of its instances anew.
        let is_aggregate = self.object.own().is_some();
        let (false, Some((inside, shift))) =
            (is_aggregate, self.motion.direction_inside(direction))
        else {
            return [least, most];
        };
        let [low, high] = self.object.along(inside);
        let room = 8.0 * f32::EPSILON * self.bounds.reach();
        // A NaN is no answer.
        [(low + shift - room).max(least), (high + shift + room).min(most)]
    }

    fn closest_hit(&self, ray: &Ray, hit: &mut Hit, scratch: &mut Scratch) -> bool {
        let Some(inside) = self.inside(ray, hit.t) else { return false };
        // Looked for apart: the ids inside cannot be compared with those outside.
        let mut found = Hit::none(hit.t.min(inside.t_max()));
        if !self.object.closest_hit(&inside, &mut found, scratch) {
            return false;
        }
        found.path = found.path.outside(self.first);
        let nearer = found.is_before(hit);
        if nearer {
            *hit = found;
        }
        nearer
    }

    fn any_hit(&self, ray: &Ray, scratch: &mut Scratch) -> bool {
        let Some(inside) = self.inside(ray, ray.t_max()) else { return false };
        self.object.any_hit(&inside, scratch)
    }

    fn all_hits(&self, ray: &Ray, hits: &mut Vec<Hit>, scratch: &mut Scratch) {
        let Some(inside) = self.inside(ray, ray.t_max()) else { return };
        let before = hits.len();
        self.object.all_hits(&inside, hits, scratch);
        for hit in &mut hits[before..] {
            hit.path = hit.path.outside(self.first);
        }
    }

    fn closest_hits(&self, rays: &[Ray], hits: &mut [Hit], scratch: &mut Scratch) {
        let (inside, which) = self.all_inside(rays, |i| Some(hits[i].t));
        let mut found: Vec<Hit> = inside
            .iter()
            .zip(&which)
            .map(|(ray, &i)| Hit::none(hits[i].t.min(ray.t_max())))
            .collect();
        self.object.closest_hits(&inside, &mut found, scratch);
        for (mut found, &i) in found.into_iter().zip(&which) {
            found.path = found.path.outside(self.first);
            if found.is_some() && found.is_before(&hits[i]) {
                hits[i] = found;
            }
        }
    }

    fn any_hits(&self, rays: &[Ray], blocked: &mut [bool], scratch: &mut Scratch) {
        let open = |i: usize| (!blocked[i]).then(|| rays[i].t_max());
        let (inside, which) = self.all_inside(rays, open);
        let mut found = vec![false; inside.len()];
        self.object.any_hits(&inside, &mut found, scratch);
        for (found, &i) in found.into_iter().zip(&which) {
            blocked[i] |= found;
        }
    }

    fn surface(&self, ray: &Ray, hit: &Hit) -> Option<Surface> {
        let path = hit.path.inside(self.first, self.paths)?;
        let inside = self.inside(ray, ray.t_max())?;
        let surface = self.object.surface(&inside, &Hit { path, ..*hit })?;
        Some(surface.transformed(&self.motion.world_from_object(ray.time())))
    }

    fn holds(&self, source: &Source) -> bool {
        match source.path.inside(self.first, self.paths) {
            Some(path) => self.object.holds(&Source { path, ..*source }),
            None => false,
        }
    }

    fn paths(&self) -> u32 {
        self.first.saturating_add(self.paths)
    }

    fn cost(&self, model: &CostModel) -> Cost {
        let inside = self.object.cost(model);
        Cost { bytes: 0, ..inside }.plus(model.transform, size_of::<Self>() as u64)
    }

    fn visit_children(&self, visit: &mut dyn FnMut(&dyn Object)) {
        visit(&self.object);
    }
}

/// The inverse, unless the matrix is singular or not finite.
pub(crate) fn inverse(matrix: &Affine3A) -> Option<Affine3A> {
    // In doubles: the determinant of a small scale has no room in `f32`.
    let inverse = glam::DAffine3::from_cols_array(&matrix.to_cols_array().map(f64::from)).inverse();
    let rounded = Affine3A::from_cols_array(&inverse.to_cols_array().map(|x| x as f32));
    (matrix.is_finite() && rounded.is_finite()).then_some(rounded)
}
