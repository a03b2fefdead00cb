//! A search that is over in time.

use std::sync::Mutex;
use std::time::{Duration, Instant};

use nestray::plan::optimize::Observer;
use nestray::render::watch::Watch as _;

use crate::progress::Watching;
use crate::stop;

/// Ends a search, timing included, when what comes next may take longer than there is time: as long
/// as the longest step so far.
#[derive(Debug)]
pub(super) struct Deadline {
    time: Duration,
    begun: Instant,
    /// When it was last asked, and the longest time between two questions.
    asked: Mutex<(Instant, Duration)>,
    watching: Watching,
}

impl Deadline {
    pub(super) fn new(time: Duration, watching: Watching) -> Self {
        let begun = Instant::now();
        Self { time, begun, asked: Mutex::new((begun, Duration::ZERO)), watching }
    }
}

impl Observer for Deadline {
    fn tried(&self, _evaluations: usize, _best: f64) {
        let done = self.begun.elapsed().min(self.time).as_millis();
        self.watching.advanced(done as u64, self.time.as_millis() as u64, 0);
    }

    fn stop(&self) -> bool {
        let mut asked = self.asked.lock().expect("nobody panics with it");
        let step = asked.0.elapsed().max(asked.1);
        *asked = (Instant::now(), step);
        stop::asked() || self.begun.elapsed() + step >= self.time
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::args::{ProgressMode, Talk};
    use crate::progress::Progress;

    fn deadline(time: Duration) -> Deadline {
        let talk = Talk { quiet: true, verbose: false, progress: ProgressMode::None };
        Deadline::new(time, Progress::new(&talk).watch("test"))
    }

    #[test]
    fn there_must_be_time_for_a_step_as_long_as_the_longest() {
        let hour = deadline(Duration::from_secs(3600));
        assert!(!hour.stop() && !hour.stop());
        hour.asked.lock().expect("free").1 = Duration::from_secs(3599);
        assert!(!hour.stop());
        hour.asked.lock().expect("free").1 = Duration::from_secs(3600);
        assert!(hour.stop());
        assert!(deadline(Duration::ZERO).stop());
    }
}
