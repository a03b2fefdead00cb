//! What a random line at a random time is expected to do.

use nestray_core::family::{Family, boxes};
use nestray_core::technique::{Expected, Leaves};

use super::{Linear, Part, TimedTree, Visits};
use crate::union::Standing;

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
    for (child, chance) in chances(often, whole) {
        expected.tests[child as usize] += chance;
    }
    expected
}

/// Moments looked at while boxes move.
const MOMENTS: usize = 4;

/// How often each child is tested at each time at which it is somewhere: whenever one of the leaves
/// is met that it stands in then.
fn chances(mut often: Vec<(u32, Part)>, whole: f64) -> Vec<(u32, f32)> {
    let key = |(child, part): &(u32, Part)| (*child, part.time.map(f32::to_bits));
    often.sort_by_key(key);
    let (mut standing, mut all) = (Standing::default(), Vec::new());
    for same in often.chunk_by(|a, b| key(a) == key(b)) {
        let (child, Part { time: [from, until], .. }) = same[0];
        let still = same.iter().all(|(_, part)| part.bounds.is_still());
        let moments = if still { 1 } else { MOMENTS };
        for moment in 0..moments {
            let when = (moment as f32 + 0.5) / moments as f32;
            let boxes = same.iter().map(|(_, part)| part.bounds.at(when));
            for bounds in boxes.filter(|bounds| !bounds.is_empty()) {
                standing.add(bounds, &[all.len() as u32]);
            }
            all.push((child, (until - from) / moments as f32));
        }
    }
    let chances = standing.chances(all.len() as u32, whole);
    all.into_iter().zip(chances).map(|((child, long), chance)| (child, long * chance)).collect()
}
