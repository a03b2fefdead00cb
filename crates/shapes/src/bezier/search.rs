//! All places of a patch that a ray passes through.
//!
//! The patch is halved until Newton's method is safe: where the derivatives vary so little
//! over a part that it can hold at most one root. Parts are dropped only when their control
//! points, or a bound on their derivatives, prove that there is none.

use super::lens::{Lens, farthest, straddles};
use super::net::{At, Grid, Net, cut, flipped, section};

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
pub(super) struct Part {
    pub(super) x: Grid,
    pub(super) y: Grid,
    from: [f64; 2],
    size: [f64; 2],
}

impl<'a> Search<'a> {
    /// Finds all roots.
    pub(super) fn new(net: &'a Net) -> Self {
        let size = |grid: &Grid| {
            let flat = grid.as_flattened();
            flat.iter().fold(0.0f64, |most, x| if x.abs() <= most { most } else { x.abs() })
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
        let may = straddles(&part.x, self.rounding) && straddles(&part.y, self.rounding);
        if self.parts == 0 || !may {
            return;
        }
        self.parts -= 1;
        let mut range = [[0.0, 1.0]; 2];
        if let Some(lens) = Lens::new(part, self.rounding) {
            if lens.is_empty() {
                return;
            }
            let spread = lens.spread();
            let most = spread[0].max(spread[1]);
            if most < 0.95 {
                let Some(near) = lens.only(spread) else { return };
                if self.newton(part, part.place(near), most < 0.3) {
                    return;
                }
            }
            range = lens.range();
        }
        let [along_u, along_v] = part.extent();
        if along_u.max(along_v) < self.point {
            self.touch(part);
        } else if (range[0][1] - range[0][0]) * (range[1][1] - range[1][0]) < 0.5 {
            self.look(&part.within(range));
        } else {
            for half in part.halved(along_u < along_v) {
                self.look(&half);
            }
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

impl Part {
    /// Largest steps between control points, along `u` and along `v`.
    fn extent(&self) -> [f64; 2] {
        let along = |axis| farthest(&self.x, axis, 0.0).max(farthest(&self.y, axis, 0.0));
        [along(0), along(1)]
    }

    /// The halves by `v`, or else by `u`.
    fn halved(&self, by_v: bool) -> [Self; 2] {
        let halves = |grid: &Grid| {
            if by_v {
                let [low, high] = cut(&flipped(grid), 0.5);
                [flipped(&low), flipped(&high)]
            } else {
                cut(grid, 0.5)
            }
        };
        let (x, y) = (halves(&self.x), halves(&self.y));
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

    /// The part of it in a range of `u` and of `v`, in `[0, 1]` of this one.
    fn within(&self, [u, v]: [[f64; 2]; 2]) -> Self {
        let inner = |grid: &Grid| flipped(&section(&flipped(&section(grid, u)), v));
        let (x, y) = (inner(&self.x), inner(&self.y));
        let size = [self.size[0] * (u[1] - u[0]), self.size[1] * (v[1] - v[0])];
        Self { x, y, from: self.place([u[0], v[0]]), size }
    }

    /// A place in it, given in `[0, 1]`, in the patch.
    fn place(&self, uv: [f64; 2]) -> [f64; 2] {
        let at = |axis: usize| self.from[axis] + uv[axis] * self.size[axis];
        [at(0), at(1)]
    }

    /// Whether a root is in it, or over its edge by less than neighbours may differ.
    fn holds(&self, uv: [f64; 2]) -> bool {
        [0, 1].iter().all(|&axis| {
            let from = uv[axis] - self.from[axis];
            -OVER <= from && from <= self.size[axis] + OVER
        })
    }
}
