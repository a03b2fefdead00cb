//! All plans that were tried, and the best of them for each goal.

use std::collections::{BTreeMap, BTreeSet};

use nestray_core::by_kind::Case;

use super::Candidate;
use super::effort::Efforts;
use super::measure::Finalist;
use super::ray_log::RayLog;
use super::score::{Counted, Score, Scorer};
use crate::plan::{ByKind, Node, Plan};

/// A plan and what it costs.
#[derive(Clone, Debug)]
pub(crate) struct Tried {
    pub(crate) plan: Plan,
    /// What rays do in it.
    pub(crate) counted: Counted,
    pub(crate) score: Score,
    pub(crate) name: Name,
}

/// What a plan is known as.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Name {
    /// One technique over everything, with its usual settings.
    Single(&'static str),
    /// A preset over everything.
    Preset(&'static str),
    /// Nothing but a number.
    None,
}

/// Every plan tried, by its hash.
#[derive(Debug)]
pub(crate) struct Archive {
    log: RayLog,
    tried: Vec<Tried>,
    by_hash: BTreeMap<String, Option<usize>>,
    /// The number of the plan that somebody had already.
    given: Option<usize>,
    /// How long plans take.
    pub(crate) efforts: Efforts,
}

/// What a search tries to make cheap: all rays, or those of one set.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Goal {
    Mix,
    Set(usize),
}

/// Plans of each goal that are timed.
const BEST: usize = 3;
/// So many times as dear as the best, by what is expected, what has a name is timed too:
/// expectations are never so far off.
const HOPE: f64 = 20.0;

impl Archive {
    pub(crate) fn new(log: &RayLog) -> Self {
        let (tried, by_hash, efforts) = (Vec::new(), BTreeMap::new(), Efforts::default());
        Self { log: log.clone(), tried, by_hash, given: None, efforts }
    }

    /// Plans that were tried, also those that cannot be built.
    pub(crate) fn evaluations(&self) -> usize {
        self.by_hash.len()
    }

    /// Whether there is none that can be built.
    pub(crate) fn is_empty(&self) -> bool {
        self.tried.is_empty()
    }

    /// What is known of a plan: nothing, that it cannot be built, or what it costs.
    pub(crate) fn known(&self, hash: &str) -> Option<Option<usize>> {
        self.by_hash.get(hash).copied()
    }

    /// Takes note of a plan, and of what rays do in it if it can be built; its number then.
    pub(crate) fn add(
        &mut self,
        plan: Plan,
        counted: Option<Counted>,
        name: Name,
        scorer: &Scorer<'_>,
    ) -> Option<usize> {
        let number = counted.map(|counted| {
            let score = scorer.price(&counted);
            self.tried.push(Tried { plan: plan.clone(), counted, score, name });
            self.tried.len() - 1
        });
        self.by_hash.insert(plan.hash(), number);
        number
    }

    /// Takes note of a plan that is timed in any case.
    pub(crate) fn add_given(&mut self, plan: Plan, counted: Counted, scorer: &Scorer<'_>) {
        self.given = self.add(plan, Some(counted), Name::None, scorer);
    }

    /// Prices everything again.
    pub(crate) fn price_anew(&mut self, scorer: &Scorer<'_>) {
        for Tried { counted, score, .. } in &mut self.tried {
            *score = scorer.price(counted);
        }
    }

    /// The best nameless plans of each goal.
    pub(crate) fn best_nests(&self) -> BTreeSet<usize> {
        let is_nest = |&number: &usize| self.tried[number].name == Name::None;
        let best = |goal: Goal| self.best(goal).into_iter().filter(is_nest).take(BEST);
        self.goals().into_iter().flat_map(best).collect()
    }

    pub(crate) fn get(&self, number: usize) -> &Tried {
        &self.tried[number]
    }

    /// Goals that differ.
    pub(crate) fn goals(&self) -> Vec<Goal> {
        let sets = self.log.sets.len();
        let each = (0..sets).filter(|_| sets > 1).map(Goal::Set);
        std::iter::once(Goal::Mix).chain(each).collect()
    }

    /// What a plan costs after some goal.
    pub(crate) fn cost(&self, number: usize, goal: Goal) -> f64 {
        let score = &self.tried[number].score;
        match goal {
            Goal::Mix => score.mix(&self.log),
            Goal::Set(set) => score.nanos[set],
        }
    }

    /// The best for a goal, the best first; of equals the first.
    pub(crate) fn best(&self, goal: Goal) -> Vec<usize> {
        let mut all: Vec<usize> = (0..self.tried.len()).collect();
        all.sort_by(|&a, &b| self.cost(a, goal).total_cmp(&self.cost(b, goal)).then(a.cmp(&b)));
        all
    }

    /// What is expected to be cheapest for the mix; a plan of one structure for all kinds.
    pub(crate) fn cheapest(&self) -> Plan {
        let best = self.best(Goal::Mix)[0];
        self.tried[best].plan.clone()
    }

    /// The cheapest for the mix, the cheapest first.
    pub(crate) fn candidates(&self) -> Vec<Candidate> {
        /// More than anybody looks at.
        const MOST: usize = 50;
        let candidate = |number: usize| {
            let Tried { plan, score, .. } = &self.tried[number];
            Candidate { plan: plan.clone(), score: score.clone() }
        };
        self.best(Goal::Mix).into_iter().take(MOST).map(candidate).collect()
    }

    /// Plans to be timed: every single technique and preset for which there is any hope, and the best for
    /// each goal.
    pub(crate) fn finalists(&self) -> Vec<Finalist> {
        let has_hope = |i: usize| {
            let goals = self.goals();
            let close = |&goal: &Goal| {
                let best = self.best(goal).first().map_or(0.0, |&best| self.cost(best, goal));
                self.cost(i, goal) <= HOPE * best
            };
            self.tried[i].name != Name::None && goals.iter().any(close)
        };
        let mut numbers: BTreeSet<usize> = (0..self.tried.len()).filter(|&i| has_hope(i)).collect();
        numbers.extend(self.given);
        for goal in self.goals() {
            numbers.extend(self.best(goal).into_iter().take(BEST));
        }
        let finalist = |number: usize| {
            let Tried { plan, score, name, .. } = &self.tried[number];
            Finalist {
                name: match *name {
                    Name::Single(name) | Name::Preset(name) => name.into(),
                    Name::None if self.given == Some(number) => "as given".into(),
                    Name::None => format!("plan {number}"),
                },
                plan: plan.clone(),
                predicted: Some(score.clone()),
                is_single: matches!(name, Name::Single(_)),
            }
        };
        self.in_order(numbers.into_iter().map(finalist).collect())
    }

    /// The usual plan first, then nests and those that have a name in turns, of each what is expected
    /// to be fastest first: should time run out, the rest is not missed, and there is something to
    /// hold the nests against.
    fn in_order(&self, finalists: Vec<Finalist>) -> Vec<Finalist> {
        let usual = self.tried.first().map(|tried| &tried.plan);
        let place = |finalist: &Finalist| {
            if Some(&finalist.plan) == usual {
                return f64::NEG_INFINITY;
            }
            finalist.predicted.as_ref().map_or(f64::INFINITY, |score| score.mix(&self.log))
        };
        let has_name = |one: &Finalist| {
            let number = self.known(&one.plan.hash()).flatten();
            number.is_some_and(|number| self.tried[number].name != Name::None)
        };
        let (mut singles, mut nests): (Vec<Finalist>, Vec<Finalist>) =
            finalists.into_iter().partition(|one| has_name(one) || Some(&one.plan) == usual);
        for all in [&mut singles, &mut nests] {
            all.sort_by(|a, b| place(a).total_cmp(&place(b)));
        }
        let (mut singles, mut nests) = (singles.into_iter(), nests.into_iter());
        let mut ordered = Vec::new();
        while singles.len() + nests.len() > 0 {
            ordered.extend(singles.next());
            ordered.extend(nests.next());
        }
        ordered
    }
}

/// One structure for each kind of rays: `plans` has one for each set. None if it is the same for
/// all, or if instances would have to be put in order differently for some.
pub(crate) fn composed(log: &RayLog, plans: &[&Plan]) -> Option<Plan> {
    let heaviest = (0..plans.len())
        .max_by(|&a, &b| log.sets[a].weight.total_cmp(&log.sets[b].weight).then(b.cmp(&a)))?;
    let other = plans[heaviest];
    let mut by_kind = ByKind::new(other.root.clone());
    let mut shared = other.shared.clone();
    let mut differ = false;
    for (set, plan) in log.sets.iter().zip(plans) {
        if plan.root == other.root && plan.shared == other.shared {
            continue;
        }
        let root = renamed(plan, &mut shared)?;
        differ = true;
        match set.case()? {
            Case::Camera => by_kind.camera = Some(root),
            Case::Shadow(_) => by_kind.shadow = Some(root),
            Case::Reflect => by_kind.reflect = Some(root),
            Case::Refract => by_kind.refract = Some(root),
            Case::Diffuse => by_kind.diffuse = Some(root),
            Case::Custom(number) => {
                by_kind.custom.insert(number?, root);
            }
        }
    }
    differ.then(|| Plan { shared, ..Plan::new(Node::ByKind(Box::new(by_kind))) })
}

/// The root of a plan whose shared subtrees join others: those that are equal are the same, and
/// those that differ get names of their own.
fn renamed(plan: &Plan, shared: &mut BTreeMap<String, Node>) -> Option<Node> {
    for (name, node) in &plan.shared {
        match shared.get(name) {
            Some(same) if same == node => {}
            // Names inside would have to change too: the first that came is kept.
            Some(_) => return Some(plan.root.clone()),
            None => {
                shared.insert(name.clone(), node.clone());
            }
        }
    }
    Some(plan.root.clone())
}
