//! Where a ray is among cells that are cut in two, again and again.

/// Which halves, the first in the highest bit.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Path(u64);

/// The cell that the first `bits` of a [`Path`] lead to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Cell {
    path: Path,
    bits: u32,
}

/// Bits along each side of a square.
const SIDE: u32 = 24;

impl Path {
    /// Most halves that are told apart.
    pub(crate) const BITS: u32 = 64;
    /// Most halves of a square that are told apart.
    pub(crate) const SQUARE: u32 = 2 * SIDE;

    /// Of a point in `[0, 1]²`, cut along its sides in turn; what is outside or not a number is
    /// moved inside.
    #[inline]
    pub(crate) fn in_square(x: f32, y: f32) -> Self {
        // Casts saturate.
        let [x, y] = [x, y].map(|x| spread(((x * (1 << SIDE) as f32) as u32).min((1 << SIDE) - 1)));
        Self((x << 1 | y) << (Self::BITS - Self::SQUARE))
    }

    /// Its first `bits` as a number, at most 32.
    #[inline(always)]
    pub(crate) fn first(self, bits: u32) -> u32 {
        self.0.checked_shr(Self::BITS - bits).unwrap_or(0) as u32
    }

    /// What follows the first `bits`, fewer than all.
    #[inline(always)]
    pub(crate) fn after(self, bits: u32) -> Self {
        Self(self.0 << bits)
    }

    /// With the half number `bit` set to `half`.
    #[inline(always)]
    pub(crate) fn with(self, bit: u32, half: usize) -> Self {
        Self(self.0 | (half as u64) << (Self::BITS - 1 - bit))
    }

    /// Cells that are cut so often.
    pub(crate) fn cell(self, bits: u32) -> Cell {
        Cell { path: self, bits }
    }
}

impl Cell {
    /// How often it was cut.
    pub(crate) fn bits(self) -> u32 {
        self.bits
    }

    /// Which halves lead to it.
    pub(crate) fn halves(self) -> impl Iterator<Item = usize> {
        (0..self.bits).map(move |bit| (self.path.0 >> (Path::BITS - 1 - bit) & 1) as usize)
    }

    /// The range of numbers along side `side` of a square, wider than what rounding moves a
    /// point.
    pub(crate) fn range(self, side: usize) -> [f32; 2] {
        const SLACK: f32 = 4.0 / (1 << SIDE) as f32;
        let (mut low, mut width) = (0.0, 1.0);
        for half in self.halves().skip(side).step_by(2) {
            width *= 0.5;
            low += width * half as f32;
        }
        [low - SLACK, low + width + SLACK]
    }
}

/// The bits of a number, with a gap after each.
#[inline]
fn spread(x: u32) -> u64 {
    let mut x = u64::from(x);
    for (shift, mask) in [
        (16, 0x0000_ffff_0000_ffff),
        (8, 0x00ff_00ff_00ff_00ff),
        (4, 0x0f0f_0f0f_0f0f_0f0f),
        (2, 0x3333_3333_3333_3333),
        (1, 0x5555_5555_5555_5555),
    ] {
        x = (x | x << shift) & mask;
    }
    x
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_are_in_the_cells_that_their_paths_lead_to() {
        for i in 0..2000u32 {
            let [x, y] = [i * 7919 % 2003, i * 104_729 % 2003].map(|x| x as f32 / 2002.0);
            let path = Path::in_square(x, y);
            for bits in (0..=36).step_by(2) {
                let cell = path.cell(bits);
                for (side, at) in [(0, x), (1, y)] {
                    let [low, high] = cell.range(side);
                    assert!(low <= at && at <= high, "{x} {y} {bits}");
                    assert!(high - low <= 1.01 / (1u32 << (bits / 2)) as f32 + 1e-6);
                }
            }
        }
        assert_eq!(Path::in_square(f32::NAN, 2.0), Path::in_square(0.0, 1.0));
    }

    #[test]
    fn paths_are_read_from_the_front() {
        let path = Path::default().with(0, 1).with(3, 1).with(5, 1);
        assert_eq!((path.first(0), path.first(1), path.first(4), path.first(6)), (0, 1, 9, 37));
        assert_eq!(path.after(3).first(3), 5);
        assert_eq!(path.cell(4).halves().collect::<Vec<_>>(), [1, 0, 0, 1]);
    }
}
