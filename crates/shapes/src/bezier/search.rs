//! All places of a patch that a ray passes through.
//!
//! The patch is halved until Newton's method is safe: where the derivatives vary so little
//! over a part that it can hold at most one root. Parts are dropped only when their control
//! points, or a bound on their derivatives, prove that there is none.

use super::net::{At, Grid, Net, flipped, halves};

/// A place where the ray passes through.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Root {
    pub(super) uv: [f64; 2],
    /// `∂x/∂u ∂y/∂v − ∂x/∂v ∂y/∂u`.
    pub(super) turn: f64,
    /// The ray touches here, or the patch comes to a point: no simple root.
    pub(super) touches: bool,
}

/// A bicubic patch has no more roots [Kajiya 82]; a few for doubled ones.
const MOST: usize = 24;

/// More parts than any patch needs that the ray does not run along; then only simple roots
/// count.
const PARTS: u32 = 2000;

/// How far over the edge of a patch a root may lie: neighbours that round differently must
/// not leave a gap between them.
const OVER: f64 = 1e-8;

/// The roots found so far.
pub(super) struct Search<'a> {
    net: &'a Net,
    /// What rounding makes of a zero.
    rounding: f64,
    /// Parts smaller than this are points.
    point: f64,
    parts: u32,
    roots: [Root; MOST],
    count: usize,
}

/// A part of the patch: its control points, and where it is.
struct Part {
    x: Grid,
    y: Grid,
    from: [f64; 2],
    size: [f64; 2],
}

/// What a bound on the derivatives says of a part.
enum Verdict {
    /// No root.
    None,
    /// At most one, likely near this place; `firmly` if there is also no other around.
    One { near: [f64; 2], firmly: bool },
    /// Nobody knows.
    Many,
}

impl<'a> Search<'a> {
    /// Finds all roots.
    pub(super) fn new(net: &'a Net) -> Self {
        let size = |grid: &Grid| {
            let flat = grid.as_flattened();
            flat.iter().fold(0.0f64, |most, x| most.max(x.abs()))
        };
        let reach = size(&net.x).max(size(&net.y));
        let mut search = Self {
            net,
            rounding: reach * 1e-14,
            point: reach * 1e-11,
            parts: PARTS,
            roots: [Root::default(); MOST],
            count: 0,
        };
        let whole = Part { x: net.x, y: net.y, from: [0.0; 2], size: [1.0; 2] };
        if reach.is_finite() {
            search.look(&whole);
        }
        search
    }

    /// What was found.
    pub(super) fn roots(&self) -> impl Iterator<Item = &Root> {
        let exhausted = self.parts == 0;
        self.roots[..self.count].iter().filter(move |root| !exhausted || !root.touches)
    }

    fn look(&mut self, part: &Part) {
        if self.parts == 0
            || !straddles(&part.x, self.rounding)
            || !straddles(&part.y, self.rounding)
        {
            return;
        }
        self.parts -= 1;
        match part.judge(self.rounding) {
            Verdict::None => return,
            Verdict::One { near, firmly } => {
                if self.newton(part, near, firmly) {
                    return;
                }
            }
            Verdict::Many => {}
        }
        let [along_u, along_v] = part.extent();
        if along_u.max(along_v) < self.point {
            self.touch(part);
            return;
        }
        for half in part.halved(along_u < along_v) {
            self.look(&half);
        }
    }

    /// Follows Newton's method from `near`; says whether that settled the part.
    fn newton(&mut self, part: &Part, near: [f64; 2], firmly: bool) -> bool {
        let mut uv = near;
        for _ in 0..10 {
            let At { x, y } = self.net.at(uv);
            let turn = x[1] * y[2] - x[2] * y[1];
            let step = [(x[0] * y[2] - x[2] * y[0]) / turn, (x[1] * y[0] - x[0] * y[1]) / turn];
            uv = [uv[0] - step[0], uv[1] - step[1]];
            // In parts of this part, from its middle.
            let away = |axis: usize| ((uv[axis] - part.from[axis]) / part.size[axis] - 0.5).abs();
            let away = away(0).max(away(1));
            if away > 1.0 || away.is_nan() {
                return false;
            }
            if step[0].abs().max(step[1].abs()) > 1e-9 {
                continue;
            }
            // One more such step would change nothing: the error is squared in each.
            if part.holds(uv) {
                self.add(Root { uv: uv.map(|x| x.clamp(0.0, 1.0)), turn, touches: false });
                return true;
            }
            return firmly && away < 0.7;
        }
        false
    }

    /// A part as small as a point that the ray passes through, for all one can tell.
    fn touch(&mut self, part: &Part) {
        let uv = [0, 1].map(|axis| part.from[axis] + part.size[axis] * 0.5);
        let depth = |uv: [f64; 2]| self.net.depth(uv);
        let (low, high) = self
            .net
            .t
            .as_flattened()
            .iter()
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), &t| (low.min(t), high.max(t)));
        let near = |root: &Root| (depth(root.uv) - depth(uv)).abs() <= 1e-6 * (high - low);
        if !self.roots[..self.count].iter().any(near) {
            self.add(Root { uv, turn: 0.0, touches: true });
        }
    }

    /// Adds a root unless it is there already, found from the part next to it.
    fn add(&mut self, root: Root) {
        let same = |other: &Root| {
            (other.uv[0] - root.uv[0]).abs() <= 1e-7
                && (other.uv[1] - root.uv[1]).abs() <= 1e-7
                && other.turn * root.turn >= 0.0
        };
        if self.count < MOST && !self.roots[..self.count].iter().any(same) {
            self.roots[self.count] = root;
            self.count += 1;
        }
    }
}

/// Whether control points lie on both sides of zero.
#[inline]
fn straddles(grid: &Grid, rounding: f64) -> bool {
    let (mut low, mut high) = (grid[0], grid[0]);
    for row in &grid[1..] {
        for j in 0..4 {
            low[j] = if row[j] < low[j] { row[j] } else { low[j] };
            high[j] = if row[j] > high[j] { row[j] } else { high[j] };
        }
    }
    low.iter().any(|&x| x <= rounding) && high.iter().any(|&x| x >= -rounding)
}

impl Part {
    /// Largest steps between control points, along `u` and along `v`.
    fn extent(&self) -> [f64; 2] {
        [0, 1].map(|axis| farthest(&self.x, axis, 0.0).max(farthest(&self.y, axis, 0.0)))
    }

    /// The halves by `v`, or else by `u`.
    fn halved(&self, by_v: bool) -> [Self; 2] {
        let [x, y] = [&self.x, &self.y].map(|grid| {
            if by_v { halves(&flipped(grid)).map(|half| flipped(&half)) } else { halves(grid) }
        });
        let axis = usize::from(by_v);
        let mut size = self.size;
        size[axis] *= 0.5;
        let mut middle = self.from;
        middle[axis] += size[axis];
        [
            Self { x: x[0], y: y[0], from: self.from, size },
            Self { x: x[1], y: y[1], from: middle, size },
        ]
    }

    /// Whether a root is in it, or over its edge by less than neighbours may differ.
    fn holds(&self, uv: [f64; 2]) -> bool {
        [0, 1].iter().all(|&axis| {
            let from = uv[axis] - self.from[axis];
            -OVER <= from && from <= self.size[axis] + OVER
        })
    }

    /// Sees the part through the inverse of its mean derivative, which makes it nearly the
    /// identity: `near` by how much bounds how many roots there can be and where.
    fn judge(&self, rounding: f64) -> Verdict {
        let mean = |g: &Grid| {
            let [along, across] =
                [g[3][0] - g[0][0] + (g[3][3] - g[0][3]), g[0][3] - g[0][0] + (g[3][3] - g[3][0])];
            [along * 0.5, across * 0.5]
        };
        let ([xu, xv], [yu, yv]) = (mean(&self.x), mean(&self.y));
        let turn = xu * yv - xv * yu;
        let inverse = [[yv / turn, -xv / turn], [-yu / turn, xu / turn]];
        if !inverse.as_flattened().iter().all(|x| x.is_finite()) {
            return Verdict::Many;
        }
        let seen: [Grid; 2] = inverse.map(|[p, q]| {
            [0, 1, 2, 3].map(|i| [0, 1, 2, 3].map(|j| p * self.x[i][j] + q * self.y[i][j]))
        });
        let noise = inverse.map(|[p, q]| rounding * (p.abs() + q.abs()));
        if !straddles(&seen[0], noise[0]) || !straddles(&seen[1], noise[1]) {
            return Verdict::None;
        }
        // How far each row of the derivative is from that of the identity.
        let third = [[1.0 / 3.0, 0.0], [0.0, 1.0 / 3.0]];
        let off = [0, 1].map(|row| {
            let by = |axis: usize| farthest(&seen[row], axis, third[row][axis]);
            3.0 * (by(0) + by(1))
        });
        let most = off[0].max(off[1]);
        if most >= 0.95 || most.is_nan() {
            return Verdict::Many;
        }
        let middle = [center(&seen[0]), center(&seen[1])];
        // From the middle a root is at most half a part away, seen at most that much longer.
        let beyond = |row: usize| middle[row].abs() > (1.0 + off[row]) * 0.5 + noise[row] + 1e-9;
        if beyond(0) || beyond(1) {
            return Verdict::None;
        }
        let near = [0, 1].map(|axis| {
            let guess = (0.5 - middle[axis]).clamp(0.0, 1.0);
            self.from[axis] + guess * self.size[axis]
        });
        Verdict::One { near, firmly: most < 0.3 }
    }
}

/// How far the steps between control points along an axis are from `step`, at most.
#[inline]
fn farthest(grid: &Grid, axis: usize, step: f64) -> f64 {
    let mut most = [0.0f64; 3];
    for i in 0..4 {
        for j in 0..3 {
            let next =
                if axis == 0 { grid[j + 1][i] - grid[j][i] } else { grid[i][j + 1] - grid[i][j] };
            let off = (next - step).abs();
            most[j] = if off > most[j] { off } else { most[j] };
        }
    }
    most[0].max(most[1]).max(most[2])
}

/// The value in the middle.
#[inline]
fn center(grid: &Grid) -> f64 {
    let row = |r: &[f64; 4]| (r[0] + r[3]) + 3.0 * (r[1] + r[2]);
    ((row(&grid[0]) + row(&grid[3])) + 3.0 * (row(&grid[1]) + row(&grid[2]))) / 64.0
}
