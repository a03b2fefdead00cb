//! Numbers for sampling, from (pixel, sample, dimension), never from a stream: then it does
//! not matter who takes which sample when.
//!
//! Owen-scrambled Sobol points, four dimensions at a time, each set of four shuffled apart
//! [Burley 20].

mod many;

use std::sync::LazyLock;

use sobol_burley::parts::{
    Int4, hash, hash_int4, owen_scramble_int4_rev, owen_scramble_rev, sobol_int4_rev,
};

pub(crate) use self::many::fours;

/// By which the seeds of the shuffle and of each dimension differ.
const SHUFFLE: u32 = 0x79c6_8e4a;
const DIMENSIONS: [u32; 4] = [0x912f_69ba, 0x174f_18ab, 0x691e_72ca, 0xb40c_c1b8];

/// The numbers of one sample of one pixel.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Sampler {
    seed: u32,
    /// Which sample of its block, bits reversed.
    reversed: u32,
}

/// Which four dimensions a sampler gives.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Set {
    /// Place in the pixel and on the lens.
    Eye,
    /// Moment within the shutter, and three to spare.
    Time,
    /// Which light and where on it, and which part of a material, at each depth.
    Light(u32),
    /// Where a surface scatters to, and whether to go on, at each depth.
    Scatter(u32),
    /// Whether a surface lets pass, at each depth and try.
    Pass(u32, u32),
}

impl Sampler {
    /// Points repeat after this many; then they are shuffled anew.
    const BLOCK: u32 = 1 << 16;

    pub(crate) fn new(pixel: u32, sample: u32, seed: u64) -> Self {
        let block = sample / Self::BLOCK;
        let mixed = mix(mix(seed) ^ (u64::from(block) << 32 | u64::from(pixel)));
        Self { seed: (mixed >> 32) as u32, reversed: (sample % Self::BLOCK).reverse_bits() }
    }

    /// Four numbers in `[0, 1)`.
    pub(crate) fn four(&self, set: Set) -> [f32; 4] {
        point(self.reversed, self.seed_of(set))
    }

    /// By which the four dimensions are shuffled.
    #[inline(always)]
    fn seed_of(&self, set: Set) -> u32 {
        let (a, b) = match set {
            Set::Eye => (0, 0),
            Set::Time => (1, 0),
            Set::Light(depth) => (2, depth),
            Set::Scatter(depth) => (3, depth),
            Set::Pass(depth, again) => (4 + again, depth),
        };
        mix(u64::from(self.seed) << 32 ^ u64::from(a) << 16 ^ u64::from(b)) as u32
    }
}

/// What [`sobol_burley::sample_4d`] gives of the first four dimensions, without its walk from bit
/// to bit, whose length nobody can foresee.
fn point(reversed: u32, seed: u32) -> [f32; 4] {
    let shuffled = owen_scramble_rev(reversed, hash(seed ^ SHUFFLE));
    let part = |i: usize| SOBOL[i][(shuffled >> (28 - 4 * i)) as usize & 15];
    let sobol = part(0) ^ part(1) ^ part(2) ^ part(3);
    let scramble = Int4::from([seed.wrapping_mul(0x9c8f_2d3b); 4]) ^ Int4::from(DIMENSIONS);
    owen_scramble_int4_rev(sobol, hash_int4(scramble)).reverse_bits().to_f32_norm()
}

/// The points of all numbers that have no more than one of their four hexadecimal digits: a point
/// is the exclusive or of those of the digits of its number.
static SOBOL: LazyLock<[[Int4; 16]; 4]> = LazyLock::new(|| {
    [0, 1, 2, 3]
        .map(|i| std::array::from_fn(|digit| sobol_int4_rev((digit as u32) << (28 - 4 * i), 0)))
});

/// A number that looks random, for every number; the end of [Steele 14]'s generator.
#[inline(always)]
pub(crate) fn mix(x: u64) -> u64 {
    let x = x.wrapping_add(0x9e37_79b9_7f4a_7c15);
    let x = (x ^ x >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let x = (x ^ x >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
    x ^ x >> 31
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn samples_of_a_pixel_fill_the_square_evenly() {
        for sets in [Set::Eye, Set::Light(3)] {
            let mut cells = [0; 16];
            for sample in 0..64 {
                let [x, y, ..] = Sampler::new(77, sample, 5).four(sets);
                assert!((0.0..1.0).contains(&x) && (0.0..1.0).contains(&y));
                cells[(x * 4.0) as usize * 4 + (y * 4.0) as usize] += 1;
            }
            assert_eq!(cells, [4; 16], "{sets:?}");
        }
    }

    #[test]
    fn points_are_those_of_the_crate() {
        for i in 0..1u32 << 16 {
            let seed = mix(u64::from(i)) as u32;
            let expected = sobol_burley::sample_4d(i, 0, seed);
            assert_eq!(point(i.reverse_bits(), seed), expected, "{i} {seed}");
        }
    }

    #[test]
    fn samples_beyond_a_block_are_new_ones() {
        let at = |sample| Sampler::new(3, sample, 1).four(Set::Eye);
        assert_ne!(at(5), at(5 + Sampler::BLOCK));
        assert_ne!(at(5), at(6));
        assert_eq!(at(70_000), at(70_000));
    }
}
