//! Keeping to one core.

#[cfg(target_os = "linux")]
use rustix::thread::{CpuSet, sched_getaffinity, sched_getcpu, sched_setaffinity};

/// Keeps this thread, and whatever it starts, on one core as long as it lives.
///
/// Libraries that build with several threads leave some behind that wait for more to do, busily: on
/// a core that shares its units with this one they would slow down all that is timed here. There
/// is nothing to leave behind where there is one core. Does nothing where the system cannot.
#[derive(Debug)]
pub struct OneCore {
    #[cfg(target_os = "linux")]
    before: Option<CpuSet>,
}

impl OneCore {
    /// The core that this thread is on.
    #[cfg(target_os = "linux")]
    #[must_use]
    pub fn new() -> Self {
        let before = sched_getaffinity(None).ok();
        let mut one = CpuSet::new();
        one.set(sched_getcpu());
        let is_kept = sched_setaffinity(None, &one).is_ok();
        Self { before: before.filter(|_| is_kept) }
    }

    /// The core that this thread is on.
    #[cfg(not(target_os = "linux"))]
    #[must_use]
    pub fn new() -> Self {
        Self {}
    }
}

#[cfg(target_os = "linux")]
impl Drop for OneCore {
    fn drop(&mut self) {
        if let Some(before) = &self.before {
            // It was allowed before; if it is no longer, one core is left.
            let _ = sched_setaffinity(None, before);
        }
    }
}

impl Default for OneCore {
    fn default() -> Self {
        Self::new()
    }
}
