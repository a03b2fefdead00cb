//! One object that moves while the shutter is open.

use glam::Affine3A;

use crate::aabb::Aabb;
use crate::instance::{Motion, Placed, inverse};
use crate::object::Object;

/// An object that moves; see [`Keys`].
pub type Moving<O> = Placed<O, Keys>;

/// Where an object is at some moments; between two of them every point of it moves on a
/// straight line at even speed, before the first and after the last it rests.
///
/// A rotation takes several keys: between two, the object shrinks a little on the chord.
#[derive(Clone, Debug, PartialEq)]
pub struct Keys {
    /// Times ascend.
    keys: Vec<(f32, Affine3A)>,
}

/// Why keys make no motion.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum KeysError {
    /// There are none.
    Empty,
    /// A time is not a number, or not later than the one before.
    Order(usize),
}

impl Keys {
    /// A motion through `keys`: times, which count from 0 to 1 over the shutter, and
    /// `world_from_object` then.
    ///
    /// # Errors
    /// If there are no keys, or their times do not ascend.
    pub fn new(keys: Vec<(f32, Affine3A)>) -> Result<Self, KeysError> {
        if keys.is_empty() {
            return Err(KeysError::Empty);
        }
        if keys[0].0.is_nan() {
            return Err(KeysError::Order(0));
        }
        match keys
            .windows(2)
            .position(|pair| pair[0].0.partial_cmp(&pair[1].0) != Some(std::cmp::Ordering::Less))
        {
            Some(at) => Err(KeysError::Order(at + 1)),
            None => Ok(Self { keys }),
        }
    }

    /// The keys.
    #[must_use]
    pub fn keys(&self) -> &[(f32, Affine3A)] {
        &self.keys
    }
}

impl Motion for Keys {
    const KIND: &'static str = "moving";
    const MOVES: bool = true;

    fn object_from_world(&self, time: f32) -> Option<Affine3A> {
        inverse(&self.world_from_object(time))
    }

    fn world_from_object(&self, time: f32) -> Affine3A {
        let next = self.keys.partition_point(|key| key.0 <= time);
        if next == 0 || next == self.keys.len() {
            return self.keys[next.saturating_sub(1)].1;
        }
        let ((from, a), (to, b)) = (self.keys[next - 1], self.keys[next]);
        let part = (time - from) / (to - from);
        let mut between = [0.0; 12];
        for (x, (a, b)) in
            between.iter_mut().zip(a.to_cols_array().into_iter().zip(b.to_cols_array()))
        {
            *x = a + (b - a) * part;
        }
        Affine3A::from_cols_array(&between)
    }

    /// Points move on straight lines, so the ends and the keys between are enough.
    fn sweep(&self, local: Aabb, [from, to]: [f32; 2]) -> Aabb {
        let ends = [from, to].map(|time| self.world_from_object(time));
        let between = self.keys.iter().filter(|key| from < key.0 && key.0 < to);
        ends.iter()
            .chain(between.map(|(_, place)| place))
            .map(|place| local.transformed(place))
            .fold(Aabb::EMPTY, Aabb::join)
    }

    /// Before the first key and after the last it rests.
    fn is_even(&self, [from, to]: [f32; 2]) -> bool {
        self.keys.iter().all(|key| key.0 <= from || to <= key.0)
    }
}

impl<O: Object> Moving<O> {
    /// An object that moves through `keys`; see [`Instance::new`] for `number`.
    ///
    /// [`Instance::new`]: crate::instance::Instance::new
    #[must_use]
    pub fn new(number: u32, object: O, keys: Keys) -> Self {
        Self::with_motion(number, object, keys)
    }
}

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use super::*;

    #[test]
    fn it_is_half_way_at_half_time_and_rests_outside() {
        let at = |x: f32| Affine3A::from_translation(Vec3::new(x, 0.0, 0.0));
        let keys = Keys::new(vec![(0.25, at(0.0)), (0.75, at(4.0))]).expect("they ascend");
        for (time, x) in [(0.0, 0.0), (0.5, 2.0), (0.625, 3.0), (1.0, 4.0)] {
            assert_eq!(keys.world_from_object(time).translation.x, x, "at {time}");
        }
        let unit = Aabb { min: glam::Vec3A::ZERO, max: glam::Vec3A::ONE };
        assert_eq!(keys.sweep(unit, [0.0, 0.5]).max.x, 3.0);
        let even = [[0.0, 0.25], [0.25, 0.75], [0.3, 0.4], [0.75, 1.0]];
        assert!(even.iter().all(|&time| keys.is_even(time)));
        assert!(!keys.is_even([0.0, 1.0]) && !keys.is_even([0.2, 0.3]));
    }

    #[test]
    fn keys_out_of_order_are_refused() {
        let key = |time: f32| (time, Affine3A::IDENTITY);
        assert_eq!(Keys::new(Vec::new()), Err(KeysError::Empty));
        assert_eq!(Keys::new(vec![key(0.0), key(0.0)]), Err(KeysError::Order(1)));
        assert_eq!(Keys::new(vec![key(0.0), key(f32::NAN)]), Err(KeysError::Order(1)));
    }
}
