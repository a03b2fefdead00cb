//! Time that a thread worked, whatever else the machine does.

use std::time::Duration;

use cpu_time::ThreadTime;

/// Processor time of this thread while `work` was done, and what came of it.
///
/// # Panics
/// If the system does not say.
pub fn timed<T>(work: impl FnOnce() -> T) -> (T, Duration) {
    let begun = ThreadTime::now();
    let result = work();
    (result, begun.elapsed())
}
