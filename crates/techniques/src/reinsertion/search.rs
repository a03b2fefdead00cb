//! Where a subtree would fit best, looked for without taking it out [Meister 18b].

use super::tree::Tree;
use crate::wide_tree::area;

/// Most nodes looked at for one subtree, so that no input takes long.
const MOST_VISITS: usize = 400;

/// A better place for a subtree.
#[derive(Clone, Copy, Debug)]
pub(super) struct Place {
    pub(super) name: u32,
    /// Beside what.
    pub(super) to: u32,
    /// By how much the joint area of all boxes falls.
    pub(super) gain: f64,
}

/// The best place for the subtree `name`, if there is a better one than where it is.
///
/// From the node it is in, the way leads up; at every node on it, into the other side, as
/// long as what is gained so far can pay for at least the box that will be around both.
pub(super) fn best_place(tree: &Tree, name: u32, open: &mut Vec<(f64, u32)>) -> Option<Place> {
    let bounds = tree.node(name).bounds;
    let own = area(bounds);
    let parent = tree.node(name).parent;
    let mut best = Place { name, to: name, gain: 0.0 };
    // What is gained by taking it out, so far on the way up.
    let mut gain = area(tree.node(parent).bounds);
    let (mut at, mut side) = (parent, tree.sibling(name));
    // The box of `at` once it is out.
    let mut rest = tree.node(side).bounds;
    let mut visits = 0;
    loop {
        if gain - own > best.gain {
            open.push((gain, side));
        }
        while let Some((gain, to)) = open.pop() {
            visits += 1;
            if gain - own <= best.gain || visits > MOST_VISITS {
                continue;
            }
            let node = tree.node(to);
            let joint = area(node.bounds.join(bounds));
            // Beside what it is beside already, nothing is gained.
            if gain - joint > best.gain && tree.node(to).parent != parent {
                best = Place { name, to, gain: gain - joint };
            }
            let gain = gain + area(node.bounds) - joint;
            if !node.is_whole && gain - own > best.gain {
                let [left, right] = node.sides;
                open.extend([(gain, left), (gain, right)]);
            }
        }
        if at != parent {
            rest = rest.join(tree.node(side).bounds);
            gain += area(tree.node(at).bounds) - area(rest);
        }
        if at == 0 || visits > MOST_VISITS {
            break;
        }
        (at, side) = (tree.node(at).parent, tree.sibling(at));
    }
    // Less is rounding.
    (best.gain > 1e-9 * own).then_some(best)
}
