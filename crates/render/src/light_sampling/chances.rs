//! Picking one of many by weight.

/// The chances of some things.
#[derive(Clone, Debug)]
pub(crate) struct Chances {
    /// Chance of the things up to each, from 0 to 1.
    below: Vec<f32>,
}

impl Chances {
    /// Chances by weight; what is not above 0, or not finite, is never picked. None if all
    /// are so.
    pub(crate) fn new(weights: &[f64]) -> Option<Self> {
        let sound = |w: f64| if w > 0.0 && w.is_finite() { w } else { 0.0 };
        let total: f64 = weights.iter().map(|&w| sound(w)).sum();
        if total <= 0.0 || !total.is_finite() {
            return None;
        }
        let mut sum = 0.0;
        let mut below = vec![0.0];
        for &weight in weights {
            sum += sound(weight);
            below.push((sum / total) as f32);
        }
        Some(Self { below })
    }

    /// The one at `u`, in `[0, 1)`, and its chance.
    pub(crate) fn pick(&self, u: f32) -> (usize, f32) {
        let mut which = self.below.partition_point(|&b| b <= u).clamp(1, self.len()) - 1;
        // Beyond the last thing there is by rounding.
        while which > 0 && self.of(which) == 0.0 {
            which -= 1;
        }
        (which, self.of(which))
    }

    /// The one at `u`, its chance, and how far `u` is into it, in `[0, 1)`.
    pub(crate) fn pick_within(&self, u: f32) -> (usize, f32, f32) {
        let (which, chance) = self.pick(u);
        let part = ((u - self.below[which]) / chance).clamp(0.0, 1.0 - f32::EPSILON);
        (which, chance, part)
    }

    /// How many things there are.
    pub(crate) fn len(&self) -> usize {
        self.below.len() - 1
    }

    /// The chance of one.
    pub(crate) fn of(&self, which: usize) -> f32 {
        self.below[which + 1] - self.below[which]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn things_are_picked_by_weight_and_never_without() {
        let chances = Chances::new(&[0.0, 1.0, f64::NAN, 3.0, 0.0]).expect("two have weight");
        let mut found = [0; 5];
        for i in 0..1000 {
            let (which, chance, part) = chances.pick_within((i as f32 + 0.5) / 1000.0);
            assert!((chance - [0.0, 0.25, 0.0, 0.75, 0.0][which]).abs() < 1e-6);
            assert!((0.0..1.0).contains(&part));
            found[which] += 1;
        }
        assert_eq!(found, [0, 250, 0, 750, 0]);
        assert_eq!(chances.pick(1.0).0, 3);
        assert!(Chances::new(&[0.0, -1.0]).is_none() && Chances::new(&[]).is_none());
    }
}
