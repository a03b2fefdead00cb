//! How samples become pixels.
//!
//! Samples are placed as densely as the filter is high, and count for one pixel each: so
//! tiles share nothing, and every picture is the same to the bit [Ernst 06].

/// Which part of the picture a pixel is the mean of.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Filter {
    /// Its square, evenly.
    Box,
    /// A pyramid twice as wide.
    Tent,
    /// A bell of deviation 1/2, cut off at 3/2.
    #[default]
    Gaussian,
    /// Sharper than a bell, with a negative rim; two pixels to each side [Mitchell 88].
    Mitchell,
    /// The four corners of the pixel, one ray each, shared with its neighbours.
    Corners,
}

impl Filter {
    /// How far it reaches from the middle of a pixel.
    #[must_use]
    pub fn radius(self) -> f32 {
        match self {
            Self::Box | Self::Corners => 0.5,
            Self::Tent => 1.0,
            Self::Gaussian => 1.5,
            Self::Mitchell => 2.0,
        }
    }

    /// Its height along one axis, at a distance from the middle; the area is not 1.
    #[must_use]
    pub fn height(self, x: f32) -> f32 {
        let x = x.abs();
        if x > self.radius() {
            return 0.0;
        }
        match self {
            Self::Box | Self::Corners => 1.0,
            Self::Tent => 1.0 - x,
            Self::Gaussian => {
                let bell = |x: f32| libm::expf(-2.0 * x * x);
                bell(x) - bell(1.5)
            }
            Self::Mitchell if x < 1.0 => 7.0 / 6.0 * x * x * x - 2.0 * x * x + 8.0 / 9.0,
            Self::Mitchell => -7.0 / 18.0 * x * x * x + 2.0 * x * x - 10.0 / 3.0 * x + 16.0 / 9.0,
        }
    }
}

/// A filter made ready for picking places by its height.
#[derive(Clone, Debug)]
pub(crate) struct Places {
    radius: f32,
    /// Chance of the strips up to each edge, from 0 to 1.
    below: Vec<f32>,
    /// What a sample in each strip counts.
    weight: Vec<f32>,
    /// The strip that each of some even parts of the chances begins in.
    first: Vec<u8>,
}

impl Places {
    const STRIPS: usize = 64;
    /// So many that few have more than one strip; a power of two, so that a chance is in the
    /// part its product with it says.
    const PARTS: usize = 1024;

    pub(crate) fn new(filter: Filter) -> Self {
        let radius = filter.radius();
        let middle = |i: usize| ((i as f32 + 0.5) / Self::STRIPS as f32 * 2.0 - 1.0) * radius;
        let heights: Vec<f32> = (0..Self::STRIPS).map(|i| filter.height(middle(i))).collect();
        let total: f32 = heights.iter().map(|h| h.abs()).sum();
        let net: f32 = heights.iter().sum();
        let mut below = vec![0.0];
        let mut sum = 0.0;
        for height in &heights {
            sum += height.abs();
            below.push(sum / total);
        }
        let weight = heights.iter().map(|&h| (total / net).copysign(h)).collect();
        let strip = |u: f32| below.partition_point(|&b| b <= u).clamp(1, Self::STRIPS) - 1;
        let first = (0..Self::PARTS).map(|i| strip(i as f32 / Self::PARTS as f32) as u8).collect();
        Self { radius, below, weight, first }
    }

    /// How far from the middle of its pixel a sample is, and how much it counts.
    pub(crate) fn pick(&self, u: f32) -> (f32, f32) {
        let strip = self.strip(u);
        let (from, to) = (self.below[strip], self.below[strip + 1]);
        let part = if to > from { (u - from) / (to - from) } else { 0.5 };
        let at = (strip as f32 + part) / Self::STRIPS as f32 * 2.0 - 1.0;
        (at * self.radius, self.weight[strip])
    }

    /// The last strip that begins at `u` or below.
    fn strip(&self, u: f32) -> usize {
        let part = (u * Self::PARTS as f32) as usize;
        let mut strip = usize::from(self.first[part.min(Self::PARTS - 1)]);
        while strip < Self::STRIPS - 1 && self.below[strip + 1] <= u {
            strip += 1;
        }
        strip
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const ALL: [Filter; 4] = [Filter::Box, Filter::Tent, Filter::Gaussian, Filter::Mitchell];

    #[test]
    fn places_are_as_dense_as_the_filter_is_high() {
        for filter in ALL {
            let places = Places::new(filter);
            let mut found = [0.0f64; 8];
            let picks = 80_000;
            for i in 0..picks {
                let (x, weight) = places.pick((i as f32 + 0.5) / picks as f32);
                assert!(x.abs() <= filter.radius());
                found[((x / filter.radius() + 1.0) * 4.0).clamp(0.0, 7.0) as usize] +=
                    f64::from(weight);
            }
            let height = |cell: usize| -> f64 {
                let at = |i: usize| (cell as f32 + (i as f32 + 0.5) / 100.0) / 4.0 - 1.0;
                (0..100).map(|i| f64::from(filter.height(at(i) * filter.radius()))).sum()
            };
            let all: f64 = (0..8).map(height).sum();
            for (cell, found) in found.iter().enumerate() {
                let (found, expected) = (found / f64::from(picks), height(cell) / all);
                assert!((found - expected).abs() < 3e-3, "{filter:?} {cell}: {found} {expected}");
            }
        }
    }

    #[test]
    fn the_strip_is_the_last_that_begins_below() {
        for filter in ALL {
            let places = Places::new(filter);
            for u in (0..=1u32 << 16).map(|i| i as f32 / 65536.0).chain(places.below.clone()) {
                let strip = places.below.partition_point(|&b| b <= u).clamp(1, Places::STRIPS) - 1;
                assert_eq!(places.strip(u), strip, "{filter:?} {u}");
            }
        }
    }

    #[test]
    fn weights_have_mean_one() {
        for filter in ALL {
            let places = Places::new(filter);
            let mean: f32 =
                (0..10_000).map(|i| places.pick((i as f32 + 0.5) / 1e4).1).sum::<f32>() / 1e4;
            assert!((mean - 1.0).abs() < 2e-3, "{filter:?}: {mean}");
        }
    }
}
