//! What was done for the rays: the currency of reports, cost maps and calibration.
//!
//! Counting is a vector level of its own ([`Level::Counting`](crate::simd::Level)): the
//! loops are compiled once more with it, so that the others pay nothing.

use std::collections::BTreeMap;

use crate::ray::RayKind;

/// What the rays of each kind did.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Counters {
    kinds: BTreeMap<RayKind, Tally>,
}

/// What was done for rays of one kind.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Tally {
    /// Steps of each technique: nodes, cells.
    pub steps: BTreeMap<&'static str, u64>,
    /// Tests of children, by what they are; a nested aggregate or an instance is one too.
    pub tests: BTreeMap<&'static str, u64>,
    /// Tests saved because the child had been tested.
    pub repeats: u64,
}

impl Tally {
    /// Steps of all techniques.
    #[must_use]
    pub fn all_steps(&self) -> u64 {
        self.steps.values().sum()
    }

    /// Tests of all children.
    #[must_use]
    pub fn all_tests(&self) -> u64 {
        self.tests.values().sum()
    }
}

impl Counters {
    /// What was done for rays of each kind, in order.
    pub fn kinds(&self) -> impl Iterator<Item = (RayKind, &Tally)> {
        self.kinds.iter().map(|(&kind, tally)| (kind, tally))
    }

    /// What was done for all rays.
    #[must_use]
    pub fn total(&self) -> Tally {
        let mut total = Tally::default();
        for tally in self.kinds.values() {
            total.add(tally);
        }
        total
    }

    /// Adds what others counted.
    pub fn add(&mut self, other: &Self) {
        for (&kind, tally) in &other.kinds {
            self.kinds.entry(kind).or_default().add(tally);
        }
    }

    /// Counts steps of a technique.
    pub fn steps(&mut self, kind: RayKind, technique: &'static str, count: u64) {
        *self.tally(kind).steps.entry(technique).or_default() += count;
    }

    /// Counts tests of children.
    pub fn tests(&mut self, kind: RayKind, what: &'static str, count: u64) {
        *self.tally(kind).tests.entry(what).or_default() += count;
    }

    /// Counts a test that was saved.
    pub fn repeat(&mut self, kind: RayKind) {
        self.tally(kind).repeats += 1;
    }

    fn tally(&mut self, kind: RayKind) -> &mut Tally {
        self.kinds.entry(kind).or_default()
    }
}

impl Tally {
    fn add(&mut self, other: &Self) {
        for (&name, &count) in &other.steps {
            *self.steps.entry(name).or_default() += count;
        }
        for (&name, &count) in &other.tests {
            *self.tests.entry(name).or_default() += count;
        }
        self.repeats += other.repeats;
    }
}
