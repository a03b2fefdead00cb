//! What random lines at random times do.

use nestray_core::accel::Accel;
use nestray_core::object::{DynObject, Object};
use nestray_core::scratch::Scratch;
use nestray_core::technique::Technique;

use crate::counted::Numbers;

/// Says what lines at random times are expected to do and do: steps, then tests.
pub(crate) fn expected_and_counted<T: Technique>(
    technique: &T,
    children: &[DynObject],
) -> [[f64; 2]; 2] {
    const LINES: u32 = 20_000;
    let nest = Accel::new(technique.clone(), children.to_vec());
    let (mut numbers, mut scratch) = (Numbers::new(7), Scratch::counting());
    for _ in 0..LINES {
        let ray = numbers.line(&nest.bounds()).at_time(numbers.next());
        nest.all_hits(&ray, &mut Vec::new(), &mut scratch);
    }
    let total = scratch.counters.total();
    let each = |count: u64| count as f64 / f64::from(LINES);
    let tests = nest.expected().tests.iter().map(|&tests| f64::from(tests)).sum();
    [[nest.expected().steps, each(total.all_steps())], [tests, each(total.all_tests())]]
}
