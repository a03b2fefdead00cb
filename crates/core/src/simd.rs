//! Eight lanes at a time, on whatever the machine has.
//!
//! A *token* ([`Scalar`], `Avx2`, `Avx512`) stands for a set of vector instructions;
//! holding one proves that the machine has them. Hot code is generic over the token
//! and `#[inline(always)]`, and is entered through [`dispatch!`](crate::dispatch), which
//! compiles it once per token. All tokens round alike, except in [`Simd::mul_sub`],
//! which therefore never decides a hit.

#[cfg(target_arch = "x86_64")]
mod kernel;
#[cfg(target_arch = "x86_64")]
mod pieces {
    pub(super) mod kernel;
}

use std::sync::OnceLock;

use crate::trail::{self, Top, Trail};

#[cfg(target_arch = "x86_64")]
pub use self::kernel::{Avx2, Avx512};

/// A set of vector instructions, working on eight `f32` lanes. Masks are bits, lane 0
/// lowest.
pub trait Simd: Copy + Send + Sync + 'static {
    /// Eight lanes.
    type F32: Copy;

    /// Whether the loops count what they do, see [`counters`](crate::counters).
    const COUNTS: bool = false;

    /// Runs `work` compiled for these instructions.
    fn vectorize<R>(self, work: impl FnOnce() -> R) -> R;
    /// The same value in all lanes.
    fn splat(self, x: f32) -> Self::F32;
    /// Lanes from memory.
    fn load(self, from: &[f32; 8]) -> Self::F32;
    /// Lanes to memory.
    fn array(self, a: Self::F32) -> [f32; 8];
    /// `a + b`.
    fn add(self, a: Self::F32, b: Self::F32) -> Self::F32;
    /// `a − b`.
    fn sub(self, a: Self::F32, b: Self::F32) -> Self::F32;
    /// `a · b`.
    fn mul(self, a: Self::F32, b: Self::F32) -> Self::F32;
    /// `a / b`.
    fn div(self, a: Self::F32, b: Self::F32) -> Self::F32;
    /// The smaller; the second if either is NaN.
    fn min(self, a: Self::F32, b: Self::F32) -> Self::F32;
    /// The larger; the second if either is NaN.
    fn max(self, a: Self::F32, b: Self::F32) -> Self::F32;
    /// `|a|`.
    fn abs(self, a: Self::F32) -> Self::F32;
    /// `a · b − c`, rounded once or twice: for bounds with slack only.
    fn mul_sub(self, a: Self::F32, b: Self::F32, c: Self::F32) -> Self::F32;
    /// The value in one lane, `lane` being below 8.
    fn lane(self, a: Self::F32, lane: usize) -> f32;
    /// Lanes where `a ≤ b`.
    fn le(self, a: Self::F32, b: Self::F32) -> u32;
    /// Lanes where `a = b`.
    fn eq(self, a: Self::F32, b: Self::F32) -> u32;
    /// The smallest of the lanes in `mask`, which are not NaN; `∞` if there are none.
    fn least(self, mask: u32, a: Self::F32) -> f32;
    /// The lanes of `a` in `mask`, those of `b` elsewhere.
    fn choose(self, mask: u32, a: Self::F32, b: Self::F32) -> Self::F32;
    /// Lane `k` is entry `index[k]` (below 16) of `low` and `high` end to end.
    fn pick(self, low: Self::F32, high: Self::F32, index: &[u8; 8]) -> Self::F32;

    /// Puts off the words in `mask`, which has two bits or more, farthest first; returns
    /// the nearest.
    #[inline(always)]
    fn put_off_sorted(
        self,
        trail: &mut Trail,
        top: &mut Top,
        mask: u32,
        enter: Self::F32,
        words: &[u32; 8],
    ) -> u32 {
        trail::put_off_sorted(trail, top, mask, &self.array(enter), words)
    }

    /// Puts off the words in `mask`, which has two bits or more; returns the last.
    #[inline(always)]
    fn put_off(self, trail: &mut Trail, top: &mut Top, mask: u32, words: &[u32; 8]) -> u32 {
        trail::put_off(trail, top, mask, words)
    }

    /// As [`put_off_sorted`](Self::put_off_sorted), for any mask, and without a branch
    /// where the machine allows: takes from the trail if the mask is empty.
    #[inline(always)]
    fn turn_sorted(
        self,
        trail: &mut Trail,
        top: &mut Top,
        mask: u32,
        enter: Self::F32,
        words: &[u32; 8],
        limit: f32,
    ) -> u32 {
        match mask {
            0 => self.take(trail, top, limit),
            one if one & (one - 1) == 0 => words[one.trailing_zeros() as usize & 7],
            _ => self.put_off_sorted(trail, top, mask, enter, words),
        }
    }

    /// As [`turn_sorted`](Self::turn_sorted), in no order.
    #[inline(always)]
    fn turn(self, trail: &mut Trail, top: &mut Top, mask: u32, words: &[u32; 8]) -> u32 {
        match mask {
            0 => trail::take_last(trail, top),
            one if one & (one - 1) == 0 => words[one.trailing_zeros() as usize & 7],
            _ => self.put_off(trail, top, mask, words),
        }
    }

    /// The newest word put off that begins no farther than `limit`.
    #[inline(always)]
    fn take(self, trail: &Trail, top: &mut Top, limit: f32) -> u32 {
        trail::take(trail, top, limit)
    }
}

/// No vector instructions in particular; see [`Scalar`] and [`Counting`].
#[derive(Clone, Copy, Debug)]
pub struct Plain<const COUNTS: bool>;

/// No vector instructions in particular.
pub type Scalar = Plain<false>;

/// As [`Scalar`], and everything is counted.
pub type Counting = Plain<true>;

/// The token of plain code; any machine can run it.
pub const SCALAR: Scalar = Plain;

/// The token of plain code that counts.
pub const COUNTING: Counting = Plain;

impl<const COUNTS: bool> Simd for Plain<COUNTS> {
    type F32 = [f32; 8];

    const COUNTS: bool = COUNTS;

    #[inline(always)]
    fn vectorize<R>(self, work: impl FnOnce() -> R) -> R {
        work()
    }
    #[inline(always)]
    fn splat(self, x: f32) -> [f32; 8] {
        [x; 8]
    }
    #[inline(always)]
    fn load(self, from: &[f32; 8]) -> [f32; 8] {
        *from
    }
    #[inline(always)]
    fn array(self, a: [f32; 8]) -> [f32; 8] {
        a
    }
    #[inline(always)]
    fn add(self, a: [f32; 8], b: [f32; 8]) -> [f32; 8] {
        std::array::from_fn(|i| a[i] + b[i])
    }
    #[inline(always)]
    fn sub(self, a: [f32; 8], b: [f32; 8]) -> [f32; 8] {
        std::array::from_fn(|i| a[i] - b[i])
    }
    #[inline(always)]
    fn mul(self, a: [f32; 8], b: [f32; 8]) -> [f32; 8] {
        std::array::from_fn(|i| a[i] * b[i])
    }
    #[inline(always)]
    fn div(self, a: [f32; 8], b: [f32; 8]) -> [f32; 8] {
        std::array::from_fn(|i| a[i] / b[i])
    }
    #[inline(always)]
    fn min(self, a: [f32; 8], b: [f32; 8]) -> [f32; 8] {
        std::array::from_fn(|i| if a[i] < b[i] { a[i] } else { b[i] })
    }
    #[inline(always)]
    fn max(self, a: [f32; 8], b: [f32; 8]) -> [f32; 8] {
        std::array::from_fn(|i| if a[i] > b[i] { a[i] } else { b[i] })
    }
    #[inline(always)]
    fn abs(self, a: [f32; 8]) -> [f32; 8] {
        a.map(f32::abs)
    }
    #[inline(always)]
    fn lane(self, a: [f32; 8], lane: usize) -> f32 {
        a[lane & 7]
    }
    #[inline(always)]
    fn mul_sub(self, a: [f32; 8], b: [f32; 8], c: [f32; 8]) -> [f32; 8] {
        std::array::from_fn(|i| a[i] * b[i] - c[i])
    }
    #[inline(always)]
    fn le(self, a: [f32; 8], b: [f32; 8]) -> u32 {
        (0..8).fold(0, |mask, i| mask | u32::from(a[i] <= b[i]) << i)
    }
    #[inline(always)]
    fn eq(self, a: [f32; 8], b: [f32; 8]) -> u32 {
        (0..8).fold(0, |mask, i| mask | u32::from(a[i] == b[i]) << i)
    }
    #[inline(always)]
    fn least(self, mask: u32, a: [f32; 8]) -> f32 {
        (0..8).filter(|i| mask >> i & 1 == 1).fold(f32::INFINITY, |least, i| least.min(a[i]))
    }
    #[inline(always)]
    fn choose(self, mask: u32, a: [f32; 8], b: [f32; 8]) -> [f32; 8] {
        std::array::from_fn(|i| if mask >> i & 1 == 1 { a[i] } else { b[i] })
    }
    #[inline(always)]
    fn pick(self, low: [f32; 8], high: [f32; 8], index: &[u8; 8]) -> [f32; 8] {
        index.map(|i| if i < 8 { low[usize::from(i) & 7] } else { high[usize::from(i) & 7] })
    }
}

/// Starts to fetch some cache lines from `address` on; any address will do.
#[inline(always)]
pub fn prefetch<const LINES: usize>(address: *const u8) {
    #[cfg(target_arch = "x86_64")]
    pieces::kernel::prefetch::<LINES>(address);
    #[cfg(not(target_arch = "x86_64"))]
    let _ = address;
}

/// The vector instructions in use: what the machine has, or less for tests.
#[derive(Clone, Copy, Debug)]
pub enum Level {
    /// See [`Scalar`].
    Scalar(Scalar),
    /// See [`Counting`].
    Counting(Counting),
    /// AVX2 and FMA.
    #[cfg(target_arch = "x86_64")]
    Avx2(Avx2),
    /// AVX-512 F, VL, DQ and BW, on 256-bit registers.
    #[cfg(target_arch = "x86_64")]
    Avx512(Avx512),
}

impl Level {
    /// The best this machine has; asked of the processor once.
    #[must_use]
    pub fn best() -> Self {
        static BEST: OnceLock<Level> = OnceLock::new();
        *BEST.get_or_init(|| Self::available()[0])
    }

    /// All this machine has, best first; [`Counting`] is not among them.
    #[must_use]
    pub fn available() -> Vec<Self> {
        let mut levels = Vec::new();
        #[cfg(target_arch = "x86_64")]
        {
            levels.extend(Avx512::detect().map(Self::Avx512));
            levels.extend(Avx2::detect().map(Self::Avx2));
        }
        levels.push(Self::Scalar(SCALAR));
        levels
    }
}

/// `dispatch!(level, simd => body)`: runs `body`, compiled once per level.
#[macro_export]
macro_rules! dispatch {
    ($level:expr, $simd:ident => $body:expr) => {
        match $level {
            $crate::simd::Level::Scalar($simd) => $body,
            $crate::simd::Level::Counting($simd) => $body,
            #[cfg(target_arch = "x86_64")]
            $crate::simd::Level::Avx2($simd) => $crate::simd::Simd::vectorize(
                $simd,
                #[inline(always)]
                || $body,
            ),
            #[cfg(target_arch = "x86_64")]
            $crate::simd::Level::Avx512($simd) => $crate::simd::Simd::vectorize(
                $simd,
                #[inline(always)]
                || $body,
            ),
        }
    };
}
