//! The prices that explain times best: non-negative least squares.

use std::collections::{BTreeMap, BTreeSet};

use nestray_core::cost::CostModel;
use nestray_core::counters::Tally;
use nestray_registry as registry;

use super::{Prices, nanos};

/// What the rays of a set took in a structure, and what they did.
#[derive(Clone, Debug)]
pub(crate) struct Run {
    /// The scene.
    pub(crate) scene: String,
    /// Whether rays have neighbours; see
    /// [`RaySet::stay_together`](crate::optimize::ray_log::RaySet::stay_together).
    pub(crate) neighbours: bool,
    /// Of so many rays.
    pub(crate) tally: Tally,
    pub(crate) rays: usize,
    /// Of the whole structure.
    pub(crate) bytes: u64,
    /// Per ray.
    pub(crate) nanos: f64,
    /// How much it counts how far off it is.
    pub(crate) weight: f64,
}

/// What something is the price of.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Item {
    Ray,
    Far,
    Call,
    Transform,
    Primitive(&'static str),
    Step(&'static str),
}

/// Prices of rays with and without neighbours, near those that are usual where runs tell little: each of
/// those weighs as much as `prior` runs.
pub(crate) fn prices(runs: &[Run], usual: &Prices, prior: f64) -> Prices {
    let of = |neighbours: bool, usual: &CostModel| {
        let runs: Vec<&Run> = runs.iter().filter(|run| run.neighbours == neighbours).collect();
        fitted(&runs, usual, prior)
    };
    Prices { neighbours: of(true, &usual.neighbours), scattered: of(false, &usual.scattered) }
}

/// The median over all runs of how far off they are by prices found without their scenes.
pub(crate) fn error(runs: &[Run], usual: &Prices, prior: f64) -> f64 {
    let scenes: BTreeSet<&str> = runs.iter().map(|run| run.scene.as_str()).collect();
    let mut errors = Vec::new();
    for scene in scenes {
        let (left, others): (Vec<Run>, Vec<Run>) =
            runs.iter().cloned().partition(|run| run.scene == scene);
        let prices = prices(&others, usual, prior);
        errors.extend(left.iter().map(|run| (predicted(run, &prices) / run.nanos - 1.0).abs()));
    }
    errors.sort_by(f64::total_cmp);
    errors.get(errors.len() / 2).copied().unwrap_or(0.0)
}

/// Nanoseconds that a ray of a run takes by some prices.
fn predicted(run: &Run, prices: &Prices) -> f64 {
    nanos(prices.of(run.neighbours), &run.tally, run.rays, run.bytes) / run.rays.max(1) as f64
}

/// Prices by which all runs are predicted as well as can be: how far off each is counts as a part of its
/// time, and by its weight.
fn fitted(runs: &[&Run], usual: &CostModel, prior: f64) -> CostModel {
    let rows: Vec<BTreeMap<Item, f64>> = runs.iter().map(|run| row(run)).collect();
    let items: BTreeSet<Item> = rows.iter().flat_map(|row| row.keys().copied()).collect();
    let items: Vec<Item> = items.into_iter().collect();
    // The normal equations, prices in units of the usual ones.
    let units: Vec<f64> = items.iter().map(|item| item.of(usual).max(1.0)).collect();
    let count = items.len();
    let (mut matrix, mut right) = (vec![vec![0.0; count]; count], vec![0.0; count]);
    for (run, row) in runs.iter().zip(&rows) {
        let values: Vec<f64> = items
            .iter()
            .zip(&units)
            .map(|(item, unit)| row.get(item).copied().unwrap_or(0.0) * unit)
            .collect();
        for (i, a) in values.iter().enumerate() {
            right[i] += run.weight * a;
            for (sum, b) in matrix[i].iter_mut().zip(&values) {
                *sum += run.weight * a * b;
            }
        }
    }
    for (i, (row, item)) in matrix.iter_mut().zip(&items).enumerate() {
        row[i] += prior;
        right[i] += prior * item.of(usual) / units[i];
    }
    let mut model = usual.clone();
    for ((item, unit), price) in items.iter().zip(&units).zip(non_negative(&matrix, &right)) {
        item.set(&mut model, price * unit);
    }
    model
}

/// The `x` without negative numbers that is nearest to a solution of `matrix · x = right`, in the sense
/// of least squares, whose normal equations these are: [Lawson 74]'s active sets. The matrix is
/// symmetric and positive definite.
fn non_negative(matrix: &[Vec<f64>], right: &[f64]) -> Vec<f64> {
    let count = right.len();
    let (mut x, mut free) = (vec![0.0; count], vec![false; count]);
    let slack = |x: &[f64], i: usize| -> f64 {
        right[i] - matrix[i].iter().zip(x).map(|(a, x)| a * x).sum::<f64>()
    };
    // Each is let go as often as rounding may have it come back.
    for _ in 0..4 * count {
        let held = (0..count).filter(|&i| !free[i]);
        let next = held.max_by(|&a, &b| slack(&x, a).total_cmp(&slack(&x, b)));
        let Some(next) = next.filter(|&i| slack(&x, i) > 1e-9 * right[i].abs().max(1e-9)) else {
            break;
        };
        free[next] = true;
        loop {
            let which: Vec<usize> = (0..count).filter(|&i| free[i]).collect();
            let solved = solution(matrix, right, &which);
            let part = |(&i, &z): (&usize, &f64)| x[i] / (x[i] - z).max(f64::MIN_POSITIVE);
            let negative = which.iter().zip(&solved).filter(|(_, z)| **z <= 0.0);
            let Some(way) = negative.map(part).min_by(f64::total_cmp) else {
                which.iter().zip(solved).for_each(|(&i, z)| x[i] = z);
                break;
            };
            // As far as none becomes negative; those that are at the end of it are held.
            for (&i, z) in which.iter().zip(&solved) {
                x[i] += way.min(1.0) * (z - x[i]);
                if *z <= 0.0 && x[i] <= 1e-12 {
                    (x[i], free[i]) = (0.0, false);
                }
            }
        }
    }
    x
}

/// The solution of the equations of some unknowns, all others being zero.
fn solution(matrix: &[Vec<f64>], right: &[f64], which: &[usize]) -> Vec<f64> {
    let mut rows: Vec<Vec<f64>> = which
        .iter()
        .map(|&i| which.iter().map(|&j| matrix[i][j]).chain([right[i]]).collect())
        .collect();
    let count = which.len();
    for pivot in 0..count {
        let (above, below) = rows.split_at_mut(pivot + 1);
        let first = &above[pivot];
        for row in below {
            let times = row[pivot] / first[pivot];
            for (x, y) in row.iter_mut().zip(first).skip(pivot) {
                *x -= times * y;
            }
        }
    }
    let mut x = vec![0.0; count];
    for i in (0..count).rev() {
        let known: f64 = (i + 1..count).map(|j| rows[i][j] * x[j]).sum();
        x[i] = (rows[i][count] - known) / rows[i][i];
    }
    x
}

/// How much of each item a ray takes, over its time.
fn row(run: &Run) -> BTreeMap<Item, f64> {
    let per_ray = |count: f64| count / (run.rays.max(1) as f64 * run.nanos);
    let work = run.tally.all_steps() + run.tally.all_tests();
    let mut row = BTreeMap::new();
    row.insert(Item::Ray, 1.0 / run.nanos);
    row.insert(Item::Far, per_ray(work as f64) * CostModel::doublings(run.bytes));
    for (name, &count) in &run.tally.steps {
        *row.entry(Item::Step(name)).or_default() += per_ray(count as f64);
    }
    for (kind, &count) in &run.tally.tests {
        *row.entry(Item::test(kind)).or_default() += per_ray(count as f64);
    }
    row
}

impl Item {
    /// As [`test`](super::test) has it.
    fn test(kind: &'static str) -> Self {
        match kind {
            "instance" => Self::Transform,
            _ if registry::find(kind).is_some() => Self::Call,
            _ => Self::Primitive(kind),
        }
    }

    /// Its price.
    fn of(self, model: &CostModel) -> f64 {
        match self {
            Self::Ray => model.ray,
            Self::Far => model.far,
            Self::Call => model.call,
            Self::Transform => model.transform,
            Self::Primitive(kind) => model.primitive(kind),
            Self::Step(technique) => model.step(technique),
        }
    }

    /// Sets its price.
    fn set(self, model: &mut CostModel, price: f64) {
        match self {
            Self::Ray => model.ray = price,
            Self::Far => model.far = price,
            Self::Call => model.call = price,
            Self::Transform => model.transform = price,
            Self::Primitive(kind) => drop(model.primitive.insert(kind.into(), price)),
            Self::Step(technique) => drop(model.step.insert(technique.into(), price)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const PRIOR: f64 = 0.01;

    /// Runs of rays that do a little of everything, timed by prices that are known.
    fn runs(truth: &CostModel) -> Vec<Run> {
        let run = |i: u64| {
            let part = |step: f64, most: f64| 1.0 + (i as f64 * step).fract() * most;
            let mut tally = Tally::default();
            for (name, step) in [("bvh", 0.37), ("grid", 0.61), ("list", 0.83)] {
                tally.steps.insert(name, part(step, 9000.0) as u64);
            }
            for (kind, step) in [("triangle", 0.29), ("instance", 0.71), ("bvh", 0.53)] {
                tally.tests.insert(kind, part(step, 9000.0) as u64);
            }
            let bytes = (part(0.19, 1000.0) * CostModel::NEAR as f64) as u64;
            let nanos = nanos(truth, &tally, 1000, bytes) / 1000.0;
            let scene = format!("scene {}", i % 4);
            let neighbours = i.is_multiple_of(2);
            Run { scene, neighbours, tally, rays: 1000, bytes, nanos, weight: 1.0 }
        };
        (0..2000).map(run).collect()
    }

    #[test]
    fn prices_that_made_the_times_are_found_again() {
        let mut truth = Prices::usual().scattered.clone();
        (truth.ray, truth.far, truth.call, truth.transform) = (30.0, 1.5, 22.0, 41.0);
        // One that nothing costs at all.
        truth.step.insert("list".into(), 0.0);
        truth.step.insert("bvh".into(), 7.0);
        truth.primitive.insert("triangle".into(), 4.5);
        let runs = runs(&truth);
        let some = CostModel { ray: 20.0, far: 1.0, ..CostModel::default() };
        let found = fitted(&runs.iter().collect::<Vec<_>>(), &some, PRIOR);
        for (price, truth) in [
            (found.ray, 30.0),
            (found.far, 1.5),
            (found.call, 22.0),
            (found.transform, 41.0),
            (found.step("bvh"), 7.0),
            (found.step("list"), 0.0),
            (found.primitive("triangle"), 4.5),
        ] {
            assert!((price - truth).abs() < 0.05 * truth.max(2.0), "{price} {truth}");
        }
        let error = error(&runs, Prices::usual(), PRIOR);
        assert!(error < 0.02, "{error}");
    }

    #[test]
    fn no_price_is_negative_where_that_would_fit_best() {
        // The best solution is (3, −1): of those without negative numbers it is (2, 0).
        let matrix = [vec![2.0, 2.0], vec![2.0, 3.0]];
        assert_eq!(non_negative(&matrix, &[4.0, 3.0]), [2.0, 0.0]);
        assert_eq!(non_negative(&matrix, &[-1.0, -1.0]), [0.0, 0.0]);
        let both = non_negative(&matrix, &[4.0, 5.0]);
        assert!((both[0] - 1.0).abs() < 1e-12 && (both[1] - 1.0).abs() < 1e-12, "{both:?}");
    }

    #[test]
    fn what_was_never_seen_costs_what_is_usual() {
        assert_eq!(prices(&[], Prices::usual(), PRIOR), *Prices::usual());
        assert_eq!(error(&[], Prices::usual(), PRIOR), 0.0);
    }
}
