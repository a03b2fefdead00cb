//! Whether everything is held once.

use super::universe::Universe;
use super::{Leaf, Tree, case_name};
use crate::error::{PlanError, Problem};

/// Gives every `rest` what is left, and checks that everything is held once.
/// `path` is where the subtree stands.
pub(super) fn settle(
    path: &str,
    tree: &mut Tree<'_>,
    universe: &Universe<'_>,
) -> Result<(), PlanError> {
    let mut picked = vec![0; universe.count()];
    count(tree, 1, &mut picked);
    let mut cover = Cover { universe, picked };
    let held = cover.settle(tree)?;
    let mut holder = vec![None; universe.count()];
    for (item, path) in held {
        if let Some(other) = holder[item].replace(path) {
            let (what, path) = (universe.describe(item), path.to_owned());
            return Err(PlanError::at(path, Problem::Twice { what, other: other.to_owned() }));
        }
    }
    let mut missing = (0..universe.count()).filter(|&item| holder[item].is_none());
    match missing.next() {
        Some(item) => {
            let (what, more) = (universe.describe(item), missing.count());
            Err(PlanError::at(path, Problem::Missing { what, more }))
        }
        None => Ok(()),
    }
}

/// Adds `by` for everything picked by name: once for all cases of a by-kind node.
fn count(tree: &Tree<'_>, by: i64, picked: &mut [i64]) {
    match tree {
        Tree::Pick(leaf) | Tree::Place { leaf, .. } => {
            for &item in &leaf.items {
                picked[item] += by;
            }
        }
        Tree::Nest { children, .. } => {
            for child in children {
                count(child, by, picked);
            }
        }
        Tree::ByKind { cases, .. } => {
            let mut all = vec![0; picked.len()];
            for (_, case) in cases {
                count(case, 1, &mut all);
            }
            for (picked, any) in picked.iter_mut().zip(all) {
                *picked += if any > 0 { by } else { 0 };
            }
        }
        Tree::Lazy(inner) | Tree::Fence(_, inner) => count(inner, by, picked),
    }
}

struct Cover<'a> {
    universe: &'a Universe<'a>,
    /// How often each item is picked by name, as seen from where we are: of the by-kind nodes
    /// around us only our own case counts.
    picked: Vec<i64>,
}

impl Cover<'_> {
    /// What a subtree holds, each with the place of the selection.
    fn settle<'t>(&mut self, tree: &'t mut Tree<'_>) -> Result<Vec<(usize, &'t str)>, PlanError> {
        match tree {
            Tree::Pick(leaf) => Ok(self.leaf(leaf, false)),
            Tree::Place { leaf, .. } => Ok(self.leaf(leaf, true)),
            Tree::Nest { children, .. } => {
                let mut held = Vec::new();
                for child in children {
                    held.extend(self.settle(child)?);
                }
                Ok(held)
            }
            Tree::ByKind { .. } => self.by_kind(tree),
            Tree::Lazy(inner) | Tree::Fence(_, inner) => self.settle(inner),
        }
    }

    fn leaf<'t>(&mut self, leaf: &'t mut Leaf, places: bool) -> Vec<(usize, &'t str)> {
        if leaf.rest {
            leaf.items.extend(self.universe.all(places).filter(|&item| self.picked[item] == 0));
        }
        leaf.items.iter().map(|&item| (item, leaf.path.as_str())).collect()
    }

    fn by_kind<'t>(&mut self, tree: &'t mut Tree<'_>) -> Result<Vec<(usize, &'t str)>, PlanError> {
        count(tree, -1, &mut self.picked);
        // What the node counts for changes once the rests are given out, so it is undone from
        // a copy.
        let around = self.picked.clone();
        let Tree::ByKind { path, cases } = tree else { unreachable!("only called for these") };
        let mut all = Vec::new();
        for (case, tree) in cases {
            count(tree, 1, &mut self.picked);
            let held = self.settle(tree)?;
            self.picked.clone_from(&around);
            all.push((*case, held));
        }
        let (_, other) = all.pop().expect("there always is an `other`");
        let mut expected: Vec<usize> = other.iter().map(|&(item, _)| item).collect();
        expected.sort_unstable();
        for (case, held) in &all {
            let mut items: Vec<usize> = held.iter().map(|&(item, _)| item).collect();
            items.sort_unstable();
            if items != expected {
                let path = format!("{path}/by_kind/{}", case_name(*case));
                return Err(self.differs(path, &items, &expected));
            }
        }
        for &(item, _) in &other {
            self.picked[item] += 1;
        }
        Ok(other)
    }

    fn differs(&self, path: String, items: &[usize], expected: &[usize]) -> PlanError {
        let one = |in_these: &[usize], not_in: &[usize]| {
            in_these.iter().copied().find(|item| not_in.binary_search(item).is_err())
        };
        let twice =
            |these: &[usize]| these.windows(2).find(|pair| pair[0] == pair[1]).map(|pair| pair[0]);
        let more = one(items, expected).or_else(|| twice(items)).map(|item| (item, true));
        let less = || one(expected, items).or_else(|| twice(expected)).map(|item| (item, false));
        let (item, more) = more.or_else(less).expect("they differ");
        PlanError::at(path, Problem::Differs { what: self.universe.describe(item), more })
    }
}
