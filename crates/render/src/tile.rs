//! The squares that a picture is rendered in.

use crate::options::Crop;
use crate::sampler::mix;

/// A rectangle of pixels that one thread renders.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Tile {
    pub(crate) from: [u32; 2],
    pub(crate) to: [u32; 2],
}

/// Pixels a side: a thousand pixels are enough for a batch, and few enough for many threads.
const SIDE: u32 = 32;

/// The tiles of a part of the picture, row by row, or in an order made from a number.
pub(crate) fn tiles(window: Crop, shuffle: Option<u64>) -> Vec<Tile> {
    let mut tiles = Vec::new();
    for top in (window.from[1]..window.to[1]).step_by(SIDE as usize) {
        for left in (window.from[0]..window.to[0]).step_by(SIDE as usize) {
            let to = [(left + SIDE).min(window.to[0]), (top + SIDE).min(window.to[1])];
            tiles.push(Tile { from: [left, top], to });
        }
    }
    if let Some(seed) = shuffle {
        tiles.sort_by_cached_key(|tile| {
            mix(seed ^ u64::from(tile.from[0]) << 32 ^ u64::from(tile.from[1]))
        });
    }
    tiles
}

impl Tile {
    pub(crate) fn width(&self) -> usize {
        (self.to[0] - self.from[0]) as usize
    }

    pub(crate) fn pixels(&self) -> usize {
        self.width() * (self.to[1] - self.from[1]) as usize
    }

    /// Fills in its pixels in an order in which neighbours are near one another: first in twos,
    /// then in fours of those, and so on.
    pub(crate) fn order(&self, pixels: &mut Vec<u32>) {
        let [width, height] = [0, 1].map(|axis| self.to[axis] - self.from[axis]);
        let every_second_bit = |of: u32| (0..5).map(|i| (of >> (2 * i) & 1) << i).sum::<u32>();
        pixels.clear();
        pixels.extend((0..SIDE * SIDE).filter_map(|i| {
            let (x, y) = (every_second_bit(i), every_second_bit(i >> 1));
            (x < width && y < height).then_some(y * width + x)
        }));
    }

    /// Column and row of its `i`-th pixel.
    pub(crate) fn pixel(&self, i: usize) -> [u32; 2] {
        let (row, column) = (i / self.width(), i % self.width());
        [self.from[0] + column as u32, self.from[1] + row as u32]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tiles_cover_every_pixel_once_in_any_order() {
        let window = Crop { from: [3, 5], to: [103, 70] };
        for shuffle in [None, Some(1), Some(2)] {
            let mut seen = vec![0; 103 * 70];
            for tile in tiles(window, shuffle) {
                for i in 0..tile.pixels() {
                    let [x, y] = tile.pixel(i);
                    seen[(y * 103 + x) as usize] += 1;
                }
            }
            for (i, count) in seen.into_iter().enumerate() {
                let inside = i % 103 >= 3 && i / 103 >= 5;
                assert_eq!(count, i32::from(inside));
            }
        }
        let mut order = Vec::new();
        for tile in tiles(window, None) {
            tile.order(&mut order);
            assert_eq!(order[..2], [0, 1]);
            order.sort_unstable();
            assert!(order.into_iter().eq(0..tile.pixels() as u32));
            order = Vec::new();
        }
        assert_ne!(tiles(window, None), tiles(window, Some(1)));
    }
}
