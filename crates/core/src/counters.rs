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
    /// What they did in each aggregate, if that is asked for.
    sites: Option<BTreeMap<(Site, RayKind), Work>>,
}

/// An aggregate, as long as it lives: where it is in memory.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Site(usize);

impl Site {
    /// Where something is.
    pub fn of<T>(aggregate: &T) -> Self {
        Self(std::ptr::from_ref(aggregate) as usize)
    }
}

/// What an aggregate did itself, without what others inside it did.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Work {
    /// How often it was asked.
    pub visits: u64,
    /// Steps of its technique.
    pub steps: u64,
    /// Tests of its children.
    pub tests: u64,
}

/// What an aggregate expects to do itself for one random ray that meets its bounds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Own {
    /// What its work is counted by.
    pub site: Site,
    /// Steps of its technique.
    pub steps: f64,
    /// Tests of its children.
    pub tests: f64,
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
    /// Counts for each aggregate too.
    #[must_use]
    pub fn by_site() -> Self {
        Self { sites: Some(BTreeMap::new()), ..Self::default() }
    }

    /// What was done in an aggregate for rays of a kind, if that was counted.
    #[must_use]
    pub fn at(&self, site: Site, kind: RayKind) -> Work {
        let sites = self.sites.as_ref();
        sites.and_then(|sites| sites.get(&(site, kind))).copied().unwrap_or_default()
    }

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
        for (&(site, kind), work) in other.sites.iter().flatten() {
            let sites = self.sites.get_or_insert_default();
            sites.entry((site, kind)).or_default().add(work);
        }
    }

    /// Counts that an aggregate was asked.
    pub fn visit(&mut self, kind: RayKind, site: Site) {
        if let Some(work) = self.work(kind, site) {
            work.visits += 1;
        }
    }

    /// Counts steps of a technique.
    pub fn steps(&mut self, kind: RayKind, technique: &'static str, site: Site, count: u64) {
        *self.tally(kind).steps.entry(technique).or_default() += count;
        if let Some(work) = self.work(kind, site) {
            work.steps += count;
        }
    }

    /// Counts tests of children of an aggregate.
    pub fn tests(&mut self, kind: RayKind, what: &'static str, site: Site, count: u64) {
        *self.tally(kind).tests.entry(what).or_default() += count;
        if let Some(work) = self.work(kind, site) {
            work.tests += count;
        }
    }

    /// Counts a test that was saved.
    pub fn repeat(&mut self, kind: RayKind) {
        self.tally(kind).repeats += 1;
    }

    fn tally(&mut self, kind: RayKind) -> &mut Tally {
        self.kinds.entry(kind).or_default()
    }

    fn work(&mut self, kind: RayKind, site: Site) -> Option<&mut Work> {
        Some(self.sites.as_mut()?.entry((site, kind)).or_default())
    }
}

impl Work {
    /// Adds what others counted.
    pub fn add(&mut self, other: &Self) {
        self.visits += other.visits;
        self.steps += other.steps;
        self.tests += other.tests;
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
