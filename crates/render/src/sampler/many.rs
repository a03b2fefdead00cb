//! The numbers of many samplers at once, by the same arithmetic: eight in the lanes of a vector.
//!
//! Loops over eight, that the compiler turns into vector instructions, of those it is told the
//! machine has.

use std::array;

use nestray_core::dispatch;
use nestray_core::simd::Level;
use sobol_burley::parts::sobol_rev;

use super::{DIMENSIONS, SHUFFLE, Sampler, Set};

type Eight = [u32; 8];

/// What [`Sampler::four`] gives of each, in place of what was in `fours`.
pub(crate) fn fours<'a>(
    level: Level,
    set: Set,
    samplers: impl Iterator<Item = &'a Sampler>,
    fours: &mut Vec<[f32; 4]>,
) {
    fours.clear();
    dispatch!(level, simd => {
        let _ = simd;
        fill(set, samplers, fours);
    });
}

#[inline(always)]
fn fill<'a>(set: Set, mut samplers: impl Iterator<Item = &'a Sampler>, fours: &mut Vec<[f32; 4]>) {
    let digits = &*DIGITS;
    loop {
        let (mut reversed, mut seeds, mut count) = ([0; 8], [0; 8], 0);
        while count < 8 {
            let Some(sampler) = samplers.next() else { break };
            (reversed[count], seeds[count]) = (sampler.reversed, sampler.seed_of(set));
            count += 1;
        }
        let [a, b, c, d] = points(digits, reversed, seeds);
        let points = a.into_iter().zip(b).zip(c).zip(d);
        fours.extend(points.map(|(((a, b), c), d)| [a, b, c, d]).take(count));
        if count < 8 {
            return;
        }
    }
}

/// The points of all numbers that have no more than one of their four hexadecimal digits, as in
/// one sampler.
type Digits = [[[u32; 4]; 16]; 4];

static DIGITS: std::sync::LazyLock<Digits> = std::sync::LazyLock::new(|| {
    let point = |i: usize, digit: usize| {
        array::from_fn(|dimension| sobol_rev((digit as u32) << (28 - 4 * i), dimension as u32))
    };
    array::from_fn(|i| array::from_fn(|digit| point(i, digit)))
});

/// Eight points, dimension by dimension.
#[inline(always)]
fn points(digits: &Digits, reversed: Eight, seeds: Eight) -> [[f32; 8]; 4] {
    let (mut shuffles, mut bases) = (seeds, seeds);
    for (shuffle, base) in shuffles.iter_mut().zip(&mut bases) {
        *shuffle = hash(*shuffle ^ SHUFFLE);
        *base = base.wrapping_mul(0x9c8f_2d3b);
    }
    let mut shuffled = reversed;
    for (number, shuffle) in shuffled.iter_mut().zip(&shuffles) {
        *number = scramble(*number, *shuffle);
    }
    let mut numbers = [[0; 8]; 4];
    for i in 0..8 {
        let digit = |place: usize| &digits[place][(shuffled[i] >> (28 - 4 * place)) as usize & 15];
        let (a, b, c, d) = (digit(0), digit(1), digit(2), digit(3));
        for dimension in 0..4 {
            numbers[dimension][i] = a[dimension] ^ b[dimension] ^ c[dimension] ^ d[dimension];
        }
    }
    let mut points = [[0.0; 8]; 4];
    for dimension in 0..4 {
        let (numbers, points) = (&numbers[dimension], &mut points[dimension]);
        for i in 0..8 {
            let number = scramble(numbers[i], hash(bases[i] ^ DIMENSIONS[dimension]));
            points[i] = f32::from_bits(number.reverse_bits() >> 9 | 0x3f80_0000) - 1.0;
        }
    }
    points
}

/// As [`sobol_burley::parts::hash`].
#[inline(always)]
fn hash(n: u32) -> u32 {
    let n = n ^ 0xe6fe_3beb;
    let n = (n ^ n >> 16).wrapping_mul(0x7feb_352d);
    let n = (n ^ n >> 15).wrapping_mul(0x846c_a68b);
    n ^ n >> 16
}

/// As [`sobol_burley::parts::owen_scramble_rev`].
#[inline(always)]
fn scramble(n: u32, by: u32) -> u32 {
    let n = (n ^ n.wrapping_mul(0x3d20_adea)).wrapping_add(by).wrapping_mul(by >> 16 | 1);
    let n = n ^ n.wrapping_mul(0x0552_6c56);
    n ^ n.wrapping_mul(0x53a2_2864)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn many_at_once_are_as_one_by_one() {
        for count in [0, 1, 7, 8, 100] {
            let all: Vec<Sampler> = (0..count).map(|i| Sampler::new(i * 31, i / 3, 7)).collect();
            for set in [Set::Eye, Set::Light(2), Set::Pass(1, 5)] {
                let expected: Vec<[f32; 4]> = all.iter().map(|one| one.four(set)).collect();
                for level in Level::available() {
                    let mut found = vec![[2.0; 4]];
                    fours(level, set, all.iter(), &mut found);
                    assert_eq!(found, expected, "{level:?}");
                }
            }
        }
    }
}
