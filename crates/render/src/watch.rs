//! Watching a render, and stopping it.

use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

/// Who wants to know how far a render has come. Asked and told after every batch, by several
/// threads at once.
pub trait Watch: Sync {
    /// So many samples of so many are done, for which so many rays were cast. Numbers told by
    /// different threads may arrive out of order.
    fn advanced(&self, _done_samples: u64, _total: u64, _rays: u64) {}

    /// Whether to stop; what is done by then is the result.
    fn stop(&self) -> bool {
        false
    }
}

/// Nobody watches.
#[derive(Clone, Copy, Debug, Default)]
pub struct Unwatched;

impl Watch for Unwatched {}

/// How far a render has come, over all threads.
pub(crate) struct Progress<'a> {
    watch: &'a dyn Watch,
    total: u64,
    done: AtomicU64,
    rays: AtomicU64,
    stopped: AtomicBool,
}

impl<'a> Progress<'a> {
    pub(crate) fn new(watch: &'a dyn Watch, total: u64) -> Self {
        let (done, rays) = (AtomicU64::new(0), AtomicU64::new(0));
        Self { watch, total, done, rays, stopped: AtomicBool::new(false) }
    }

    /// Adds what one batch did.
    pub(crate) fn add(&self, samples: u64, rays: u64) {
        let done = self.done.fetch_add(samples, Ordering::Relaxed) + samples;
        let rays = self.rays.fetch_add(rays, Ordering::Relaxed) + rays;
        self.watch.advanced(done, self.total, rays);
    }

    /// Whether to stop; once true, always true.
    pub(crate) fn stopped(&self) -> bool {
        if !self.stopped.load(Ordering::Relaxed) && self.watch.stop() {
            self.stopped.store(true, Ordering::Relaxed);
        }
        self.stopped.load(Ordering::Relaxed)
    }

    /// Whether every sample was taken.
    pub(crate) fn is_complete(&self) -> bool {
        self.done.load(Ordering::Relaxed) == self.total
    }
}
