//! Splitting children again and again, in space or in time, whoever says where.

use nestray_core::aabb::Aabb;
use nestray_core::family::Family;

use super::{Linear, Reference};
use crate::wide_tree::{Contents, Pair};

/// What is to be split.
#[derive(Debug)]
pub(crate) struct Open {
    /// Its children.
    pub(crate) inside: Vec<Reference>,
    /// What of them counts.
    pub(crate) cell: Aabb,
    /// When.
    pub(crate) time: [f32; 2],
    /// How many splits are above.
    pub(crate) depth: usize,
    /// How many references may become of it.
    pub(crate) room: f64,
    /// How it is split.
    pub(crate) manner: Manner,
}

/// How something is split.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Manner {
    /// The space and time it is in are cut.
    Cells,
    /// Its children are shared out, and at most time is cut.
    Children,
}

/// A binary tree over children in time: the root first, parents before what is below.
#[derive(Debug, Default)]
pub(crate) struct Timed {
    /// The children, so that those below a node stand side by side; some several times.
    pub(super) order: Vec<u32>,
    pub(super) pairs: Vec<Pair>,
    /// Of each node its box and when it is there.
    pub(super) parts: Vec<(Linear, [f32; 2])>,
}

/// What splitting needs to know.
pub(crate) struct Growing<'a> {
    pub(crate) family: &'a dyn Family,
    pub(crate) of: &'a Contents,
    /// Children in the two halves of some time, looked up once.
    halves: Vec<[Reference; 2]>,
}

impl Open {
    /// The box of a child, as far as it counts.
    pub(crate) fn part(&self, reference: &Reference) -> Linear {
        reference.bounds.cut_to(&self.cell)
    }

    /// A box around all that counts.
    pub(crate) fn bounds(&self) -> Linear {
        self.inside.iter().fold(Linear::EMPTY, |all, one| all.join(self.part(one)))
    }

    /// Whether anything in it moves.
    pub(crate) fn moves(&self) -> bool {
        self.inside.iter().any(|one| !one.bounds.is_still())
    }

    /// A part of it, with other children; `share` of the room is for it.
    pub(crate) fn part_of(&self, inside: Vec<Reference>, share: f64) -> Self {
        let (depth, room) = (self.depth + 1, self.room * share);
        Self { inside, depth, room, cell: self.cell, time: self.time, manner: self.manner }
    }
}

impl<'a> Growing<'a> {
    pub(crate) fn new(family: &'a dyn Family, of: &'a Contents) -> Self {
        Self { family, of, halves: Vec::new() }
    }

    /// All children, the whole shutter, everywhere.
    pub(crate) fn all(&self, room: f64, manner: Manner) -> Open {
        let inside = (0..self.family.count())
            .map(|child| Reference::new(self.family, child, [0.0, 1.0]))
            .collect();
        Open { inside, cell: Aabb::ENDLESS, time: [0.0, 1.0], depth: 0, room, manner }
    }

    /// What testing all of its children once costs, in nanoseconds.
    pub(crate) fn weight(&self, inside: &[Reference]) -> f64 {
        inside.iter().map(|one| f64::from(self.of.weights[one.child as usize])).sum()
    }

    /// The first half of its time and the second.
    pub(crate) fn in_time(&mut self, open: &mut Open) -> [Open; 2] {
        let [from, until] = open.time;
        let middle = from * 0.5 + until * 0.5;
        let times = [[from, middle], [middle, until]];
        for one in &mut open.inside {
            if one.halves == Reference::NOWHERE && !one.bounds.is_still() {
                one.halves = self.halves.len() as u32;
                let half = |time| Reference::new(self.family, one.child, time);
                self.halves.push(times.map(half));
            }
        }
        let half = |which: usize| {
            let of = |one: &Reference| match one.halves {
                Reference::NOWHERE => *one,
                at => self.halves[at as usize][which],
            };
            let passing = open.inside.iter().map(of).filter(|one| one.bounds.passes(&open.cell));
            Open { time: times[which], ..open.part_of(passing.collect(), 0.5) }
        };
        [half(0), half(1)]
    }
}

/// The tree that comes of splitting `whole` until `split` gives it back.
pub(crate) fn grow(whole: Open, mut split: impl FnMut(Open) -> Result<[Open; 2], Open>) -> Timed {
    let mut tree = Timed::default();
    let mut waiting = vec![(whole, None)];
    while let Some((open, above)) = waiting.pop() {
        let me = tree.pairs.len();
        if let Some(above) = above {
            let above: &mut Pair = &mut tree.pairs[above];
            // The left side comes first.
            let side = if above.left == 0 { &mut above.left } else { &mut above.right };
            *side = me as u32;
        }
        let bounds = open.bounds();
        let first = tree.order.len() as u32;
        tree.parts.push((bounds, open.time));
        tree.pairs.push(Pair { bounds: bounds.within, first, count: 0, left: 0, right: 0 });
        match split(open) {
            Ok([left, right]) => waiting.extend([(right, Some(me)), (left, Some(me))]),
            Err(leaf) => {
                tree.pairs[me].count = leaf.inside.len() as u32;
                tree.order.extend(leaf.inside.iter().map(|one| one.child));
            }
        }
    }
    for me in (0..tree.pairs.len()).rev() {
        let Pair { left, right, .. } = tree.pairs[me];
        if left != 0 {
            let counts = [left, right].map(|side| tree.pairs[side as usize].count);
            tree.pairs[me].count = counts[0] + counts[1];
        }
    }
    tree
}
