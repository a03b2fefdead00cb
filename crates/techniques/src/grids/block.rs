//! A block of cells.

/// A block of cells, both ends included.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Block {
    low: [u16; 3],
    high: [u16; 3],
}

impl Block {
    /// From the lowest to the highest cell.
    pub(super) fn new(low: [u32; 3], high: [u32; 3]) -> Self {
        Self { low: low.map(|cell| cell as u16), high: high.map(|cell| cell as u16) }
    }

    #[inline(always)]
    pub(super) fn low(&self) -> [u32; 3] {
        [self.low[0].into(), self.low[1].into(), self.low[2].into()]
    }

    #[inline(always)]
    pub(super) fn high(&self) -> [u32; 3] {
        [self.high[0].into(), self.high[1].into(), self.high[2].into()]
    }

    /// How many cells there are along each axis.
    pub(super) fn edges(&self) -> [u32; 3] {
        let (low, high) = (self.low(), self.high());
        [0, 1, 2].map(|axis| high[axis] - low[axis] + 1)
    }

    /// How many cells there are.
    pub(super) fn count(&self) -> u64 {
        self.edges().into_iter().map(u64::from).product()
    }

    /// The cells, x fastest.
    pub(super) fn cells(self) -> impl Iterator<Item = [u32; 3]> {
        let (low, high) = (self.low(), self.high());
        let along = move |axis: usize| low[axis]..=high[axis];
        along(2).flat_map(move |z| along(1).flat_map(move |y| along(0).map(move |x| [x, y, z])))
    }
}
