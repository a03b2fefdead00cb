//! How many cells.

use glam::Vec3A;
use nestray_core::aabb::{Aabb, Clip};

use super::Grid;

/// Nanoseconds a step takes, about.
pub(crate) const STEP: f64 = 4.0;
/// Densities to choose from, in cells per child.
const DENSITIES: [f32; 8] = [0.25, 0.5, 1.0, 2.0, 4.0, 8.0, 16.0, 32.0];
/// Most cells in all.
const MOST_ALL: f64 = (1u32 << 27) as f64;
/// Children looked at to choose, evenly spread.
const SAMPLE: usize = 20_000;

/// Cells along each axis: about cubical, as many as settings or expected cost say, and not
/// so many that lists outgrow the children.
pub(super) fn resolution(
    params: &Grid,
    bounds: Aabb,
    boxes: &[Aabb],
    weights: &[f32],
    together: u32,
) -> [u32; 3] {
    let counted = Counted { bounds, boxes, weights, together };
    if params.density > 0.0 {
        // As asked, unless memory would explode: then the finest below.
        let below = DENSITIES.iter().rev().filter(|&&density| density < params.density);
        let fits = [params.density]
            .iter()
            .chain(below)
            .map(|&d| cells(params, bounds, boxes.len(), d))
            .find(|&cells| counted.fits(cells));
        return fits.unwrap_or([1; 3]);
    }
    let fits = |density: f32| {
        Some(cells(params, bounds, boxes.len(), density)).filter(|&cells| counted.fits(cells))
    };
    let mut tried: Vec<[u32; 3]> = DENSITIES.iter().filter_map(|&density| fits(density)).collect();
    if tried.is_empty() {
        // Children overlap much: the finest below.
        let below = halves(DENSITIES[0].into(), boxes.len() as f64);
        tried.extend(below.filter_map(|all| fits((all / boxes.len() as f64) as f32)).next());
    }
    let tried = tried.into_iter().chain([[1; 3]]);
    tried.min_by(|&a, &b| counted.cost(a).total_cmp(&counted.cost(b))).unwrap_or([1; 3])
}

/// So many cells as `density` says for each of `count` children, half as many, and so on down to one.
pub(crate) fn halves(density: f64, count: f64) -> impl Iterator<Item = f64> {
    let halves = std::iter::successors(Some(density * count), |&wanted| Some(wanted / 2.0));
    halves.take_while(|&wanted| wanted > 0.5)
}

/// About cubical cells, `density` per child.
fn cells(params: &Grid, bounds: Aabb, children: usize, density: f32) -> [u32; 3] {
    let limits = Limits {
        // Cells narrower than rounding would hold everything anyway.
        least: 8.0 * Clip::SLACK * bounds.reach(),
        along: params.max_cells.into(),
        all: MOST_ALL,
    };
    cubical(bounds, f64::from(density) * children as f64, &limits)
}

/// What cells must not exceed.
pub(crate) struct Limits {
    /// How narrow they may be.
    pub(crate) least: f32,
    /// How many there may be along one axis, and in all.
    pub(crate) along: f64,
    pub(crate) all: f64,
}

/// About cubical cells, `wanted` in all but for rounding; narrow axes first, so that the others
/// take up what is left [Havran 00].
pub(crate) fn cubical(bounds: Aabb, wanted: f64, limits: &Limits) -> [u32; 3] {
    let size = bounds.size().as_dvec3();
    let mut axes = [0, 1, 2];
    axes.sort_by(|&a, &b| size[a].total_cmp(&size[b]));
    let mut cells = [1; 3];
    let mut left = wanted.clamp(1.0, limits.all);
    for (place, axis) in axes.into_iter().enumerate() {
        let edge = size[axis];
        let along = match place {
            0 => cube_root(left * (edge / size[axes[1]]) * (edge / size[axes[2]])),
            1 => (left * (edge / size[axes[2]])).sqrt(),
            _ => left,
        };
        let most = (edge / f64::from(limits.least)).clamp(1.0, limits.along);
        cells[axis] = (along + 0.5).max(1.0).min(most) as u32;
        left = (left / f64::from(cells[axis])).max(1.0);
    }
    cells
}

/// The cube root of a number by Newton's method: the same on every machine.
pub(crate) fn cube_root(x: f64) -> f64 {
    if !(x.is_finite() && x > 1e-30) {
        return 0.0;
    }
    // A third of the exponent is a good start.
    let mut root = f64::from_bits(x.to_bits() / 3 + 0x2A9F_7893_782D_A1CE);
    for _ in 0..6 {
        root -= (root - x / (root * root)) / 3.0;
    }
    root
}

/// Mean number of cells a random line crosses: `Σ nᵢAᵢ / ΣA`, with `Aᵢ` the faces.
pub(crate) fn steps(cells: [u32; 3], bounds: Aabb) -> f64 {
    let s = bounds.size().as_dvec3();
    let faces = [s.y * s.z, s.z * s.x, s.x * s.y];
    let all: f64 = faces.iter().sum();
    (0..3).map(|axis| f64::from(cells[axis]) * faces[axis]).sum::<f64>() / all
}

/// The children, for trying a resolution on them.
pub(crate) struct Counted<'a> {
    /// What is cut into cells.
    pub(crate) bounds: Aabb,
    /// Their boxes.
    pub(crate) boxes: &'a [Aabb],
    /// What testing each costs, in nanoseconds.
    pub(crate) weights: &'a [f32],
    /// How many are tested at once.
    pub(crate) together: u32,
}

impl Counted<'_> {
    /// Some children, and how many each stands for.
    fn sample(&self) -> (impl Iterator<Item = usize>, f64) {
        let (all, stride) = (self.boxes.len(), self.boxes.len().div_ceil(SAMPLE));
        let taken = all.div_ceil(stride);
        // Not each at the same place of its stride: children may repeat themselves.
        let place = move |i: usize| (i.wrapping_mul(0x9E37_79B9) >> 8) % stride;
        let sample = (0..taken).map(move |i| (i * stride + place(i)).min(all - 1));
        (sample, all as f64 / taken as f64)
    }

    /// Edges of the block of cells around a box, on average over where walls may be, and how
    /// many cells that is.
    fn block(&self, child: usize, cell: Vec3A) -> (Vec3A, f64) {
        let block = (self.boxes[child].size() + cell).min(self.bounds.size());
        (block, (block / cell).as_dvec3().element_product())
    }

    /// Whether there are not too many cells, nor entries in their lists.
    pub(crate) fn fits(&self, cells: [u32; 3]) -> bool {
        let count = self.boxes.len() as f64;
        let all = cells.iter().map(|&n| f64::from(n)).product::<f64>();
        let cell = self.bounds.size() / Vec3A::from_array(cells.map(|n| n as f32));
        let (sample, each) = self.sample();
        // Wide children are kept apart.
        let entries = |child| Some(self.block(child, cell).1).filter(|&n| n <= all / 4.0);
        let entries: f64 = sample.filter_map(entries).sum::<f64>() * each;
        all <= (64.0 * count + 4096.0).min(MOST_ALL) && entries <= 16.0 * count + 4096.0
    }

    /// Nanoseconds a random line takes, all the way through.
    pub(crate) fn cost(&self, cells: [u32; 3]) -> f64 {
        steps(cells, self.bounds) * STEP + self.tests(cells)
    }

    /// Nanoseconds that tests of children take of that.
    pub(crate) fn tests(&self, cells: [u32; 3]) -> f64 {
        let cell = self.bounds.size() / Vec3A::from_array(cells.map(|n| n as f32));
        let area = |s: Vec3A| {
            let s = s.as_dvec3();
            s.x * s.y + s.y * s.z + s.z * s.x
        };
        let whole = area(self.bounds.size());
        let (sample, each) = self.sample();
        let tests = sample.map(|child| {
            let (block, count) = self.block(child, cell);
            // Packed children are tested in every cell, others once in their block.
            let reached = if self.together > 1 { count * area(cell) } else { area(block) };
            reached / whole * f64::from(self.weights[child])
        });
        tests.sum::<f64>() * each
    }
}
