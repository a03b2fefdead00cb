//! A part of a patch seen so that it is nearly the identity, which says how many roots there
//! can be and where.

use super::net::{Grid, flipped, grid, row};
use super::search::Part;

/// The part through the inverse of its mean derivative: the first coordinate is about `u`,
/// the second about `v`, each in `[0, 1]` of the part, less that of the root.
pub(super) struct Lens {
    seen: [Grid; 2],
    /// What rounding makes of a zero.
    noise: [f64; 2],
}

impl Lens {
    /// None where there is no inverse.
    #[inline]
    pub(super) fn new(part: &Part, rounding: f64) -> Option<Self> {
        let mean = |g: &Grid| {
            let (a, b) = (g[3][3] - g[0][0], g[3][0] - g[0][3]);
            [(a + b) * 0.5, (a - b) * 0.5]
        };
        let ([xu, xv], [yu, yv]) = (mean(&part.x), mean(&part.y));
        let turn = xu * yv - xv * yu;
        let inverse = [[yv / turn, -xv / turn], [-yu / turn, xu / turn]];
        if !inverse.as_flattened().iter().all(|x| x.is_finite()) {
            return None;
        }
        let through = |[p, q]: [f64; 2]| grid(|i, j| p * part.x[i][j] + q * part.y[i][j]);
        let seen = [through(inverse[0]), through(inverse[1])];
        let noise = |[p, q]: [f64; 2]| rounding * (p.abs() + q.abs());
        let noise = [noise(inverse[0]), noise(inverse[1])];
        Some(Self { seen, noise })
    }

    /// Whether the control points prove that there is no root.
    pub(super) fn is_empty(&self) -> bool {
        !straddles(&self.seen[0], self.noise[0]) || !straddles(&self.seen[1], self.noise[1])
    }

    /// How far each row of the derivative can be from that of the identity, as a sum over the
    /// row: below 1 there is at most one root.
    #[inline]
    pub(super) fn spread(&self) -> [f64; 2] {
        const STEP: [[f64; 2]; 2] = [[1.0 / 3.0, 0.0], [0.0, 1.0 / 3.0]];
        let by = |row: usize, axis: usize| farthest(&self.seen[row], axis, STEP[row][axis]);
        [3.0 * (by(0, 0) + by(0, 1)), 3.0 * (by(1, 0) + by(1, 1))]
    }

    /// About where the only root is, if it is there at all.
    #[inline]
    pub(super) fn only(&self, spread: [f64; 2]) -> Option<[f64; 2]> {
        let middle = [center(&self.seen[0]), center(&self.seen[1])];
        // From the middle a root is at most half a part away, seen at most that much longer.
        let beyond =
            |row: usize| middle[row].abs() > (1.0 + spread[row]) * 0.5 + self.noise[row] + 1e-9;
        (!beyond(0) && !beyond(1)).then(|| middle.map(|off| (0.5 - off).clamp(0.0, 1.0)))
    }

    /// Between which `u` and which `v` all roots are [Nishita 90].
    #[inline]
    pub(super) fn range(&self) -> [[f64; 2]; 2] {
        [crossing(&self.seen[0], self.noise[0]), crossing(&flipped(&self.seen[1]), self.noise[1])]
    }
}

/// Where the hull of a net, seen along its rows, meets zero.
#[inline(always)]
fn crossing(grid: &Grid, noise: f64) -> [f64; 2] {
    let low = row(|i| least(least(grid[i][0], grid[i][1]), least(grid[i][2], grid[i][3])) - noise);
    let high = row(|i| most(most(grid[i][0], grid[i][1]), most(grid[i][2], grid[i][3])) + noise);
    let (mut from, mut to) = (3.0f64, 0.0f64);
    let mut add = |at: f64| (from, to) = (from.min(at), to.max(at));
    for (i, (&low_i, &high_i)) in low.iter().zip(&high).enumerate() {
        if low_i <= 0.0 && high_i >= 0.0 {
            add(i as f64);
        }
        for (k, (&low_k, &high_k)) in low.iter().zip(&high).enumerate() {
            if i == k || high_i <= 0.0 || low_k >= 0.0 {
                continue;
            }
            // From a point above to one below: the lines that cross zero nearest to either.
            let cross = |above: f64, below: f64| {
                i as f64 + (k as f64 - i as f64) * (above / (above - below))
            };
            add(cross(if low_i > 0.0 { low_i } else { high_i }, low_k));
            add(cross(high_i, if high_k < 0.0 { high_k } else { low_k }));
        }
    }
    // A hair for the rounding above.
    let [from, to] = [(from / 3.0 - 1e-6).max(0.0), (to / 3.0 + 1e-6).min(1.0)];
    if from < to { [from, to] } else { [0.0, 1.0] }
}

/// Whether control points lie on both sides of zero.
#[inline(always)]
pub(super) fn straddles(grid: &Grid, rounding: f64) -> bool {
    let (mut low, mut high) = (grid[0], grid[0]);
    for row in &grid[1..] {
        for j in 0..4 {
            low[j] = least(row[j], low[j]);
            high[j] = most(row[j], high[j]);
        }
    }
    low.iter().any(|&x| x <= rounding) && high.iter().any(|&x| x >= -rounding)
}

/// How far the steps between control points along an axis are from `step`, at most.
#[inline(always)]
pub(super) fn farthest(grid: &Grid, axis: usize, step: f64) -> f64 {
    let mut farthest = [0.0f64; 4];
    if axis == 0 {
        for pair in grid.windows(2) {
            farthest = row(|j| most((pair[1][j] - pair[0][j] - step).abs(), farthest[j]));
        }
    } else {
        for points in grid {
            for (j, pair) in points.windows(2).enumerate() {
                farthest[j] = most((pair[1] - pair[0] - step).abs(), farthest[j]);
            }
        }
    }
    most(most(farthest[0], farthest[1]), most(farthest[2], farthest[3]))
}

/// The lesser; a NaN only if it is the second: one instruction.
#[inline(always)]
fn least(a: f64, b: f64) -> f64 {
    if a < b { a } else { b }
}

/// The greater, likewise.
#[inline(always)]
fn most(a: f64, b: f64) -> f64 {
    if a > b { a } else { b }
}

/// The value in the middle.
#[inline]
fn center(grid: &Grid) -> f64 {
    let row = |r: &[f64; 4]| (r[0] + r[3]) + 3.0 * (r[1] + r[2]);
    ((row(&grid[0]) + row(&grid[3])) + 3.0 * (row(&grid[1]) + row(&grid[2]))) / 64.0
}
