//! What time it is, for a search and for whoever tests one.

use std::fmt::Debug;
use std::time::Instant;

/// Tells seconds since some moment.
pub(crate) trait Clock: Debug + Sync {
    /// Of everybody.
    fn seconds(&self) -> f64;

    /// That this thread worked: others that take its processor do not count.
    fn worked(&self) -> f64;
}

/// The clock on the wall.
#[derive(Debug)]
pub(crate) struct Wall(Instant);

impl Wall {
    pub(crate) fn new() -> Self {
        Self(Instant::now())
    }
}

impl Clock for Wall {
    fn seconds(&self) -> f64 {
        self.0.elapsed().as_secs_f64()
    }

    #[cfg(any(unix, windows))]
    fn worked(&self) -> f64 {
        let now = cpu_time::ThreadTime::try_now();
        now.map_or_else(|_| self.seconds(), |now| now.as_duration().as_secs_f64())
    }

    #[cfg(not(any(unix, windows)))]
    fn worked(&self) -> f64 {
        self.seconds()
    }
}
