//! The two triangles of a cell, tested without a gap, after [Woop 13] in doubles.

use glam::Vec3A;
use nestray_core::ray::Ray;

/// Four neighbouring samples: lower corner, next along x, next along z, both.
#[derive(Clone, Copy, Debug)]
pub(super) struct Cell {
    pub(super) corners: [Vec3A; 4],
}

/// The space in which a ray is the z axis.
#[derive(Debug)]
pub(super) struct Probe {
    origin: [f64; 3],
    dir: [f64; 3],
    /// Which axes of space are x, y and z here.
    axes: [usize; 3],
    slope: [f64; 3],
}

impl Probe {
    pub(super) fn new(ray: &Ray) -> Self {
        let (origin, dir) = (ray.origin().to_array(), ray.dir().to_array());
        let size = dir.map(f32::abs);
        let z = if size[0] > size[1] && size[0] > size[2] {
            0
        } else {
            1 + usize::from(size[1] <= size[2])
        };
        let axes = [(z + 1) % 3, (z + 2) % 3, z];
        let dir = dir.map(f64::from);
        let slope = [dir[axes[0]] / dir[z], dir[axes[1]] / dir[z], 1.0 / dir[z]];
        Self { origin: origin.map(f64::from), dir, axes, slope }
    }

    fn seen(&self, point: Vec3A) -> [f64; 3] {
        let from = |i: usize| f64::from(point[self.axes[i]]) - self.origin[self.axes[i]];
        let z = from(2);
        [from(0) - self.slope[0] * z, from(1) - self.slope[1] * z, z]
    }
}

impl Cell {
    /// Which corners half of the cell has, counter-clockwise from above: 0 is the half at
    /// lower x … the one next along z, 1 the other.
    pub(super) fn half(&self, which: usize) -> [usize; 3] {
        if which == 0 { [0, 2, 3] } else { [0, 3, 1] }
    }

    /// Where in the cell, along x and z, the weights of half of it are.
    pub(super) fn place(&self, half: usize, [_, b, c]: [f64; 3]) -> [f64; 2] {
        if half == 0 { [c, b + c] } else { [b + c, b] }
    }

    /// Calls `found` with which half is hit, where on the ray and whether from the front,
    /// and the weights of its corners.
    pub(super) fn each_hit(
        &self,
        probe: &Probe,
        mut found: impl FnMut(usize, (f64, bool), [f64; 3]),
    ) {
        let [a, b, c, d] = self.corners;
        let seen = [probe.seen(a), probe.seen(b), probe.seen(c), probe.seen(d)];
        // Swapping the points changes exactly the sign, and a rounded difference is never on
        // the wrong side of zero: so both triangles at an edge agree on who is hit.
        let edge = |a: usize, b: usize| seen[a][0] * seen[b][1] - seen[a][1] * seen[b][0];
        for half in 0..2 {
            let [a, b, c] = self.half(half);
            let [u, v, w] = [edge(c, b), edge(a, c), edge(b, a)];
            let inside =
                (u >= 0.0) & (v >= 0.0) & (w >= 0.0) | (u <= 0.0) & (v <= 0.0) & (w <= 0.0);
            let sum = u + v + w;
            if !inside || sum == 0.0 {
                continue;
            }
            let weights = [u / sum, v / sum, w / sum];
            let depth = weights[0] * seen[a][2] + weights[1] * seen[b][2] + weights[2] * seen[c][2];
            let t = self.within(probe, half, depth * probe.slope[2]);
            found(half, (t, (probe.slope[2] > 0.0) == (sum > 0.0)), weights);
        }
    }

    /// Moved to where the ray is within the box of half of the cell: of a triangle seen
    /// nearly from its side the weights are mostly rounding.
    fn within(&self, probe: &Probe, half: usize, t: f64) -> f64 {
        let corners = self.half(half).map(|which| self.corners[which]);
        let (mut enter, mut leave) = (f64::NEG_INFINITY, f64::INFINITY);
        for axis in (0..3).filter(|&axis| probe.dir[axis] != 0.0) {
            let walls =
                corners.map(|p| (f64::from(p[axis]) - probe.origin[axis]) / probe.dir[axis]);
            enter = enter.max(walls[0].min(walls[1]).min(walls[2]));
            leave = leave.min(walls[0].max(walls[1]).max(walls[2]));
        }
        if enter <= leave { t.clamp(enter, leave) } else { t }
    }
}

/// Which half of a cell a place in it is in, and the weights of its corners there.
pub(super) fn weights([x, z]: [f64; 2]) -> (usize, [f64; 3]) {
    if x <= z { (0, [1.0 - z, z - x, x]) } else { (1, [1.0 - x, z, x - z]) }
}
