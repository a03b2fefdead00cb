//! What a thread carries along while it traces.

use crate::counters::Counters;
use crate::mailbox::Mailbox;
use crate::simd::Level;

/// Per-thread state: make one per thread and pass it to every query. Nothing in
/// it outlives a query except the memory, and what was counted.
#[derive(Debug)]
pub struct Scratch {
    /// See [`Mailbox`].
    pub mailbox: Mailbox,
    /// The vector instructions to use.
    pub level: Level,
    /// What was done, if `level` is [`Level::Counting`].
    pub counters: Counters,
    /// How many batches are being traced, each within the one before: each takes a lot of room on
    /// the stack.
    pub(crate) batches: u32,
}

impl Scratch {
    /// Uses the best vector instructions of this machine.
    #[must_use]
    pub fn new() -> Self {
        Self::with_level(Level::best())
    }

    /// Uses the given vector instructions; for tests and benches.
    #[must_use]
    pub fn with_level(level: Level) -> Self {
        let (mailbox, counters) = (Mailbox::default(), Counters::default());
        Self { mailbox, level, counters, batches: 0 }
    }

    /// Counts what is done, which takes several times as long. Answers do not change.
    #[must_use]
    pub fn counting() -> Self {
        Self::with_level(Level::Counting(crate::simd::COUNTING))
    }

    /// Counts for each aggregate too.
    #[must_use]
    pub fn counting_by_site() -> Self {
        Self { counters: Counters::by_site(), ..Self::counting() }
    }
}

impl Default for Scratch {
    fn default() -> Self {
        Self::new()
    }
}
