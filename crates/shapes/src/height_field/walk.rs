//! The way of a ray over the grid, in two sizes of squares, as in [Amanatides 87] but from
//! wall to wall anew: nothing adds up, and a little more than the ray meets is visited.

use std::sync::Arc;

use nestray_core::aabb::Aabb;
use nestray_core::ray::Ray;

/// Cells along the edge of a tile.
pub(super) const TILE: usize = 16;

/// Lowest and highest sample of each tile.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Tiles {
    across: usize,
    ranges: Arc<[[f32; 2]]>,
    all: [f32; 2],
}

impl Tiles {
    pub(super) fn new(counts: [usize; 2], heights: &[f32]) -> Self {
        let tiles = counts.map(|count| (count - 1).div_ceil(TILE));
        let range = |tile: usize| {
            let [x, z] = [tile % tiles[0] * TILE, tile / tiles[0] * TILE];
            let mut range = [f32::INFINITY, f32::NEG_INFINITY];
            for row in z..=(z + TILE).min(counts[1] - 1) {
                for &height in
                    &heights[row * counts[0] + x..=row * counts[0] + (x + TILE).min(counts[0] - 1)]
                {
                    range = [range[0].min(height), range[1].max(height)];
                }
            }
            range
        };
        let ranges: Arc<[[f32; 2]]> = (0..tiles[0] * tiles[1]).map(range).collect();
        let join = |a: [f32; 2], b: &[f32; 2]| [a[0].min(b[0]), a[1].max(b[1])];
        let all = ranges.iter().fold([f32::INFINITY, f32::NEG_INFINITY], join);
        Self { across: tiles[0], ranges, all }
    }

    pub(super) fn of(&self, [x, z]: [usize; 2]) -> [f32; 2] {
        self.ranges[z * self.across + x]
    }

    pub(super) fn all(&self) -> [f32; 2] {
        self.all
    }
}

/// A ray over the grid: along x and z in cells, along y as it is.
#[derive(Debug)]
pub(super) struct Line {
    start: [f64; 2],
    step: [f64; 2],
    /// How far rounding may move a sample, or a point of the ray, in cells.
    slack: [f64; 2],
    height: f64,
    rise: f64,
    height_slack: f64,
    /// The axis along which the ray passes more cells.
    main: usize,
}

impl Line {
    pub(super) fn new(ray: &Ray, bounds: &Aabb, cell: [f64; 2]) -> Self {
        let (origin, dir) = (ray.origin().as_dvec3(), ray.dir().as_dvec3());
        let [low, reach] =
            [bounds.min.as_dvec3(), bounds.min.abs().max(bounds.max.abs()).as_dvec3()];
        let of = |axis: usize| {
            let place = 2 * axis;
            let slack = (reach[place] * 2e-7 + origin[place].abs() * 1e-12) / cell[axis] + 1e-6;
            [(origin[place] - low[place]) / cell[axis], dir[place] / cell[axis], slack]
        };
        let (x, z) = (of(0), of(1));
        Self {
            start: [x[0], z[0]],
            step: [x[1], z[1]],
            slack: [x[2], z[2]],
            height: origin.y,
            rise: dir.y,
            height_slack: (reach.y + origin.y.abs()) * 1e-10 + 1e-30,
            main: usize::from(x[1].abs() < z[1].abs()),
        }
    }

    /// Which of the wanted part of the ray is over the grid and between the lowest and the
    /// highest sample.
    pub(super) fn range(
        &self,
        bounds: &Aabb,
        cells: [usize; 2],
        wanted: [f64; 2],
    ) -> Option<[f64; 2]> {
        let slab = |start: f64, step: f64, low: f64, high: f64| {
            if step == 0.0 {
                return (low <= start && start <= high)
                    .then_some([f64::NEG_INFINITY, f64::INFINITY]);
            }
            let (a, b) = ((low - start) / step, (high - start) / step);
            Some([a.min(b), a.max(b)])
        };
        let over = |axis: usize| {
            let slack = self.slack[axis];
            slab(self.start[axis], self.step[axis], -slack, cells[axis] as f64 + slack)
        };
        let [low, high] = [bounds.min.y, bounds.max.y].map(f64::from);
        let up = slab(self.height, self.rise, low - self.height_slack, high + self.height_slack)?;
        let (x, z) = (over(0)?, over(1)?);
        let range = [x[0].max(z[0]).max(up[0]), x[1].min(z[1]).min(up[1])];
        // Widened: the cells under its very ends are wanted too.
        let more = (range[0].abs() + range[1].abs()) * 1e-14;
        let range = [(range[0] - more).max(wanted[0]), (range[1] + more).min(wanted[1])];
        (range[0] <= range[1]).then_some(range)
    }

    /// Calls `visit` with the squares of `size` cells that the ray is over during `range`, in
    /// order along the main axis, and when; only those with a cell in `from .. to`.
    pub(super) fn each(
        &self,
        size: usize,
        [from, to]: [[usize; 2]; 2],
        [enter, leave]: [f64; 2],
        mut visit: impl FnMut([usize; 2], [f64; 2]),
    ) {
        let (main, other) = (self.main, 1 - self.main);
        let edge = size as f64;
        let squares = |axis: usize, a: f64, b: f64| {
            let slack = self.slack[axis];
            let first = ((a.min(b) - slack) / edge).floor().max((from[axis] / size) as f64);
            let last = ((a.max(b) + slack) / edge).floor().min(((to[axis] - 1) / size) as f64);
            // Ends before it begins where there is none, and NaN is none.
            let squares = if first <= last { first as usize..last as usize + 1 } else { 0..0 };
            let (count, end) = (squares.len(), squares.end);
            let backward = self.step[axis] < 0.0;
            (0..count).map(move |n| if backward { end - 1 - n } else { squares.start + n })
        };
        let at = |axis: usize, t: f64| match self.step[axis] {
            0.0 => self.start[axis],
            step => self.start[axis] + step * t,
        };
        for i in squares(main, at(main, enter), at(main, leave)) {
            let (mut low, mut high) = (enter, leave);
            if self.step[main] != 0.0 {
                let wall = |place: f64| (place - self.start[main]) / self.step[main];
                let a = wall(i as f64 * edge - self.slack[main]);
                let b = wall((i + 1) as f64 * edge + self.slack[main]);
                (low, high) = (low.max(a.min(b)), high.min(a.max(b)));
            }
            for j in squares(other, at(other, low), at(other, high)) {
                visit(if main == 0 { [i, j] } else { [j, i] }, [low, high]);
            }
        }
    }

    /// Whether the ray is above or below all these heights during a range.
    pub(super) fn misses(&self, [low, high]: [f32; 2], [enter, leave]: [f64; 2]) -> bool {
        let (a, b) = (self.height + self.rise * enter, self.height + self.rise * leave);
        a.max(b) < f64::from(low) - self.height_slack
            || a.min(b) > f64::from(high) + self.height_slack
    }
}
