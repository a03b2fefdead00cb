//! A pass over the tree: who looks for a place, and who moves.

use rayon::prelude::*;

use super::search::{Place, best_place};
use super::tree::Tree;
use crate::wide_tree::Binary;

/// Steps upwards that a move may take without being counted: more than in any tree that is worth
/// having.
const USUAL: usize = 200;
/// More steps than that which all moves of a pass take, at most, for each node: shells in shells, moved
/// one into the other, become so deep that there would be no end.
const FAR: usize = 16;

/// The tree after a pass, as [`Binary::merged`] takes it; nodes marked as `leaves` move as a whole.
/// It is the same for any number of threads: they only look, and moves are made one by one.
pub(super) fn merges(share: f32, begin: &Binary<'_>, leaves: &[bool]) -> Vec<[u32; 2]> {
    let mut tree = Tree::new(begin, leaves);
    pass(&mut tree, share);
    tree.merges(begin.order.len())
}

/// Lets the largest subtrees look for better places, and moves them, those that gain most first.
fn pass(tree: &mut Tree, share: f32) {
    let found = &*tree;
    let mut places: Vec<Place> = largest(found, share)
        .par_chunks(1024)
        .flat_map_iter(|names| {
            let mut open = Vec::new();
            let place = move |&name: &u32| best_place(found, name, &mut open);
            names.iter().filter_map(place)
        })
        .collect();
    places.sort_unstable_by(|a, b| b.gain.total_cmp(&a.gain).then(a.name.cmp(&b.name)));
    let mut room = FAR * tree.nodes.len();
    for place in places {
        let before = tree.climbed;
        put(tree, place);
        let Some(left) = room.checked_sub((tree.climbed - before).saturating_sub(USUAL)) else {
            break;
        };
        room = left;
    }
}

/// The largest subtrees that can be moved.
fn largest(tree: &Tree, share: f32) -> Vec<u32> {
    let size = |name: u32| tree.node(name).bounds.surface_area();
    let mut names: Vec<u32> =
        (1..tree.nodes.len() as u32).filter(|&name| tree.is_movable(name)).collect();
    let count = (names.len() as f64 * f64::from(share)).ceil() as usize;
    if count < names.len() {
        names.select_nth_unstable_by(count, |&a, &b| size(b).total_cmp(&size(a)).then(a.cmp(&b)));
        names.truncate(count);
    }
    names.sort_unstable();
    names
}

/// Moves a subtree, unless moves made meanwhile are in the way or have made it not worth it.
fn put(tree: &mut Tree, Place { name, to, .. }: Place) {
    let parent = tree.node(name).parent;
    let is_free = tree.is_movable(name) && to != parent && tree.node(to).parent != parent;
    if !is_free || tree.is_within(to, name) {
        return;
    }
    let (growth, from) = tree.put_beside(name, to);
    if growth >= 0.0 {
        tree.put_beside(name, from);
    }
}
