//! How long it will take to build a plan, and try it.
//!
//! Nothing breaks off what is being built: a plan that may take longer than there is time must not
//! be begun.

use std::collections::{BTreeMap, BTreeSet};

use nestray_registry as registry;

use crate::plan::{Node, Plan};

/// What is known of the plans of a scene so far.
#[derive(Debug, Default)]
pub(crate) struct Efforts {
    /// Seconds that plans took, by their hash.
    plans: BTreeMap<String, f64>,
    /// The longest that a technique took which was alone.
    techniques: BTreeMap<String, f64>,
    /// What a technique takes of which nothing is known, over its [`usual`] effort.
    unit: f64,
    /// How many times as long as expected something took, at most.
    surprise: f64,
}

/// How many times as long as the usual technique another takes.
fn usual(technique: &str) -> f64 {
    /// Of one that nobody knows, which cannot be built.
    const UNKNOWN: f64 = 1.0;
    registry::find(technique).map_or(UNKNOWN, |entry| entry.effort)
}

impl Efforts {
    /// Takes note of how long a plan took.
    pub(crate) fn note(&mut self, plan: &Plan, seconds: f64) {
        let names = techniques(plan);
        let together = self.together(&names);
        if let (1, Some(&name)) = (names.len(), names.first()) {
            let longest = self.techniques.entry(name.to_owned()).or_default();
            *longest = longest.max(seconds);
            self.unit = self.unit.max(seconds / usual(name));
        } else if together > 0.0 {
            self.surprise = self.surprise.max(seconds / together);
        } else {
            // The first of all: what it takes is that of its techniques together.
            let usual: f64 = names.iter().map(|name| usual(name)).sum();
            self.unit = seconds / usual.max(1.0);
        }
        self.plans.insert(plan.hash(), seconds);
    }

    /// Seconds that a plan took, or may take; none before any was tried.
    pub(crate) fn expected(&self, plan: &Plan) -> f64 {
        match self.plans.get(&plan.hash()) {
            Some(&seconds) => seconds,
            None => self.together(&techniques(plan)) * self.surprise.max(1.0),
        }
    }

    /// What techniques take that each hold everything: no plan has them hold more.
    fn together(&self, techniques: &BTreeSet<&str>) -> f64 {
        let alone = |&name: &&str| {
            self.techniques.get(name).copied().unwrap_or_else(|| self.unit * usual(name))
        };
        techniques.iter().map(alone).sum()
    }
}

/// The techniques of a plan.
fn techniques(plan: &Plan) -> BTreeSet<&str> {
    let mut names = BTreeSet::new();
    for (_, node) in plan.nodes() {
        if let Node::Nest(nest) = node {
            names.insert(nest.technique.as_str());
            names.extend(nest.all_leaves().map(|(_, leaves)| leaves.technique.as_str()));
        }
    }
    names
}

#[cfg(test)]
mod tests {
    use nestray_scene::procedural::generate;

    use super::*;
    use crate::single::single;

    fn plan(technique: &str) -> Plan {
        let scene = generate("balls", Some(1)).expect("there is one");
        single(technique, Default::default(), &scene).expect("it is sound")
    }

    #[test]
    fn what_is_not_known_is_expected_to_take_as_long_as_it_ever_did() {
        let mut efforts = Efforts::default();
        assert_eq!(efforts.expected(&plan("sbvh")), 0.0, "nothing is known");
        efforts.note(&plan("bvh"), 0.5);
        assert_eq!(efforts.expected(&plan("bvh")), 0.5);
        assert_eq!(efforts.expected(&plan("sbvh")), 3.0);
        efforts.note(&plan("sbvh"), 2.0);
        assert_eq!(efforts.expected(&plan("sbvh")), 2.0, "now it is known");
        let nest = Node::nest("bvh", vec![Node::nest("sbvh", vec![Node::rest()])]);
        let both = Plan::new(nest);
        assert_eq!(efforts.expected(&both), 2.5);
        efforts.note(&both, 5.0);
        assert_eq!(efforts.expected(&both), 5.0);
        let other = Plan::new(Node::nest("sbvh", vec![Node::nest("bvh", vec![Node::rest()])]));
        assert_eq!(efforts.expected(&other), 5.0, "as far off as that was");
    }

    #[test]
    fn a_nest_that_comes_first_tells_of_its_techniques() {
        let nest = Node::nest("bvh", vec![Node::nest("sbvh", vec![Node::rest()])]);
        let mut efforts = Efforts::default();
        efforts.note(&Plan::new(nest), 3.5);
        assert_eq!(efforts.expected(&plan("bvh")), 0.5);
        assert_eq!(efforts.expected(&plan("sbvh")), 3.0);
    }
}
