//! What rays did in each aggregate, beside what it expects of a random one.

use std::collections::BTreeSet;
use std::fmt::Write as _;

use nestray_core::counters::{Counters, Own, Site};
use nestray_core::ray::RayKind;
use serde::Serialize;

use super::Part;

/// Rays that were sent through an object, and what they did.
#[derive(Clone, Debug)]
pub struct Sent {
    /// What they are called, of which kind they are, and how many there were.
    pub rays: Vec<(String, RayKind, u64)>,
    /// What they did in each aggregate ([`Counters::by_site`]).
    pub counters: Counters,
}

/// What an aggregate does itself: without what others inside it do.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Doing {
    /// What it expects to do for a random ray that meets its bounds.
    pub expected: Expected,
    /// What it did for the rays that were sent.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub counted: Vec<Counted>,
    #[serde(skip)]
    sites: BTreeSet<Site>,
}

/// What an aggregate expects to do for a random ray.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Expected {
    /// Steps of its technique.
    pub steps: f64,
    /// Tests of its children.
    pub tests: f64,
}

/// What an aggregate did for rays of one kind.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Counted {
    /// What the rays are called.
    pub rays: String,
    /// How often it was asked, per ray that was sent.
    pub visits: f64,
    /// Steps of its technique, each time.
    pub steps: f64,
    /// Tests of its children, each time.
    pub tests: f64,
}

impl Doing {
    pub(super) fn new(own: Own) -> Self {
        Self {
            expected: Expected { steps: own.steps, tests: own.tests },
            counted: Vec::new(),
            sites: BTreeSet::from([own.site]),
        }
    }

    /// Takes in what is done in another aggregate that looks the same. One that stands in several
    /// places counts once.
    pub(super) fn absorb(&mut self, other: Self) {
        self.sites.extend(other.sites);
    }

    fn count(&mut self, sent: &Sent) {
        for (name, kind, rays) in &sent.rays {
            let mut work = nestray_core::counters::Work::default();
            for &site in &self.sites {
                work.add(&sent.counters.at(site, *kind));
            }
            if work.visits > 0 {
                let each = |count: u64| count as f64 / work.visits as f64;
                let visits = work.visits as f64 / *rays as f64;
                let (steps, tests) = (each(work.steps), each(work.tests));
                self.counted.push(Counted { rays: name.clone(), visits, steps, tests });
            }
        }
    }

    pub(super) fn write(&self, indent: usize, text: &mut String) {
        let name = |counted: &Counted| counted.rays.chars().count();
        let wide = self.counted.iter().map(name).max().unwrap_or(0).max("expected".len());
        let mut line = |cells: [&str; 4]| {
            let [rays, visits, steps, tests] = cells;
            let blank = "";
            let _ =
                writeln!(text, "{blank:indent$}{rays:<wide$} {visits:>8} {steps:>8} {tests:>8}");
        };
        let number = |x: f64| if x >= 1000.0 { format!("{x:.0}") } else { format!("{x:.2}") };
        line(["", "visits", "steps", "tests"]);
        let Expected { steps, tests } = self.expected;
        line(["expected", "", &number(steps), &number(tests)]);
        for Counted { rays, visits, steps, tests } in &self.counted {
            line([rays, &number(*visits), &number(*steps), &number(*tests)]);
        }
    }
}

impl Part {
    /// The same with what rays did that were sent through the object it describes, which is still
    /// there. What stands in several places has its work in all of them.
    #[must_use]
    pub fn counted(mut self, sent: &Sent) -> Self {
        self.count(sent);
        self
    }

    fn count(&mut self, sent: &Sent) {
        if let Some(doing) = &mut self.doing {
            doing.count(sent);
        }
        for child in &mut self.children {
            child.count(sent);
        }
    }
}
