//! What a random line at a random time is expected to do.

use nestray_core::family::{Family, boxes};
use nestray_core::technique::{Expected, Leaves};

use super::{Linear, Part, TimedTree, Visits};

/// Counts nodes and children by their mean surfaces.
pub(super) fn expected(tree: &TimedTree, family: &dyn Family, leaves: &Leaves) -> Expected {
    let whole = boxes(family).into_iter().map(Linear::still).fold(Linear::EMPTY, Linear::join);
    let whole = whole.mean_area().max(f64::MIN_POSITIVE);
    let share = |part: &Part| (part.area() / whole).min(1.0);
    let mut expected = Expected { steps: 1.0, tests: vec![0.0; family.count() as usize] };
    let mut often = Vec::new();
    let mailbox = tree.visits == Visits::Often && family.together() == 1;
    for part in tree.nodes().flatten() {
        if part.step.is_onward() {
            expected.steps += share(&part);
            continue;
        }
        for &child in leaves.of(part.step.as_leaf().0 as usize) {
            if mailbox {
                often.push((child, part));
            } else {
                expected.tests[child as usize] += share(&part) as f32;
            }
        }
    }
    for (child, part) in hulls(often) {
        expected.tests[child as usize] += share(&part) as f32;
    }
    expected
}

/// What stands in several leaves at the same time is tested once, whenever one of them is met:
/// about as often as the box around them.
fn hulls(mut often: Vec<(u32, Part)>) -> Vec<(u32, Part)> {
    let key = |(child, part): &(u32, Part)| (*child, part.time.map(f32::to_bits));
    often.sort_by_key(key);
    often.dedup_by(|one, hull| {
        let same = key(one) == key(hull);
        if same {
            hull.1.bounds = hull.1.bounds.join(one.1.bounds);
        }
        same
    });
    often
}
