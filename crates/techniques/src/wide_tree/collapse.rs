//! From a binary tree to nodes of eight.

use nestray_core::technique::Leaves;

use super::binary::{Binary, Outlook};
use super::emit::{Emit, Piece};
use super::forests::Forests;
use super::{LeafSize, Node};

/// Deepest tree a [`Trail`](nestray_core::trail::Trail) has room for.
pub(crate) const MAX_DEPTH: usize = 34;

/// From which depth on a binary tree is split in halves: the first that makes the wide one
/// shallow enough is taken.
const HALVES_FROM: [usize; 3] = [96, 24, 0];

/// The wide nodes of the tree that `build` makes, and whether it splits children.
pub(super) fn collapsed<'a>(
    size: LeafSize,
    leaves: &mut Leaves,
    build: impl Fn(usize) -> Binary<'a>,
) -> (Vec<Node>, bool) {
    assert_eq!(leaves.count(), 0, "a tree has all leaves there are");
    for halves_from in HALVES_FROM {
        let binary = build(halves_from);
        let forests = forests(size, &binary);
        let emit = Emit { binary: &binary, forests: &forests };
        if let Some(Piece { nodes, leaves: made }) = emit.all() {
            leaves.append(&made);
            return (nodes, binary.is_split());
        }
    }
    unreachable!("a tree split in halves is shallow")
}

/// What becomes of a binary tree.
pub(super) fn outlook(size: LeafSize, binary: &Binary<'_>) -> Outlook {
    let forests = forests(size, binary);
    let whole = binary.pairs[0].bounds.surface_area().max(f32::MIN_POSITIVE);
    let cost = f64::from(forests.cost()) / f64::from(whole);
    Outlook {
        cost: (forests.depth(&binary.pairs) <= MAX_DEPTH).then_some(cost),
        leaves: (0..binary.pairs.len() as u32).map(|i| forests.is_leaf(i)).collect(),
    }
}

/// How best to cut up a binary tree of boxes.
fn forests(size: LeafSize, binary: &Binary<'_>) -> Forests {
    Forests::new(size.most, &binary.pairs, |i| {
        let pair = &binary.pairs[i];
        let area = pair.bounds.surface_area();
        // What cannot be a leaf need not be asked for.
        let may_be = pair.left == 0 || pair.count as usize <= size.most;
        let cost = if may_be { binary.of.leaf_cost(size, binary.below(pair)) } else { 0.0 };
        [area, area * cost]
    })
}
