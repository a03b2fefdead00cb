//! Cutting up space.

use nestray_core::aabb::Aabb;
use nestray_core::huge::Huge;
use nestray_core::technique::{Leaves, Step};

use super::{Cell, Cells, Children, EMPTY, Node, Rule, halves};

/// Most cells around one: a [`Trail`](nestray_core::trail::Trail) has room for twice as many.
const MAX_DEPTH: u32 = 64;
/// Most cells a child is in, on average, whatever a rule says.
const REPEATS: f64 = 8.0;

pub(super) fn build<R: Rule>(rule: &R, children: &Children, leaves: &mut Leaves) -> Cells {
    let count = children.boxes.len();
    let mut growing = Growing { rule, children, nodes: Vec::new(), leaves };
    let all = (0..count as u32).collect();
    let room = REPEATS * count as f64;
    let root = growing.grow(children.bounds, 0, all, room, R::Memory::default());
    Cells {
        nodes: Huge::new(&growing.nodes, 0),
        root,
        bounds: children.bounds,
        packed: children.are_packed(),
    }
}

struct Growing<'a, R> {
    rule: &'a R,
    children: &'a Children,
    nodes: Vec<Node>,
    leaves: &'a mut Leaves,
}

impl<R: Rule> Growing<'_, R> {
    /// Puts `inside` in order, with no more than `room` entries in leaves; returns the word for
    /// it.
    fn grow(
        &mut self,
        bounds: Aabb,
        depth: u32,
        inside: Vec<u32>,
        room: f64,
        memory: R::Memory,
    ) -> u32 {
        if inside.is_empty() {
            return EMPTY;
        }
        let cell = Cell { bounds, depth, inside: &inside, children: self.children };
        let cut = if depth < MAX_DEPTH { self.rule.cut(&cell, memory) } else { None };
        let Some((plane, memory)) = cut else {
            return Step::leaf(self.leaves.push(&inside)).word();
        };
        let [low, high] = cell.extent(plane.axis);
        assert!(low < plane.at && plane.at < high, "rules cut through cells");
        let [below, above] = sides(self.children, &inside, plane.axis, plane.at);
        let entries = (below.len() + above.len()) as f64;
        if entries > room {
            return Step::leaf(self.leaves.push(&inside)).word();
        }
        drop(inside);
        let node = self.nodes.len();
        self.nodes.push(Node { at: plane.at, axis: plane.axis as u32, words: [EMPTY; 2] });
        let parts = halves(bounds, plane.axis, plane.at);
        for (side, inside) in [below, above].into_iter().enumerate() {
            let room = room * inside.len() as f64 / entries;
            self.nodes[node].words[side] = self.grow(parts[side], depth + 1, inside, room, memory);
        }
        Step::onward(node as u32).word()
    }
}

/// Which children are below and above a plane. One that ends exactly there is on its own side
/// only: both sides reach beyond the plane.
fn sides(children: &Children, inside: &[u32], axis: usize, at: f32) -> [Vec<u32>; 2] {
    let is_above = |child: u32| children.boxes[child as usize].max[axis] > at;
    let is_below = |child: u32| children.boxes[child as usize].min[axis] < at || !is_above(child);
    let below = inside.iter().copied().filter(|&child| is_below(child)).collect();
    [below, inside.iter().copied().filter(|&child| is_above(child)).collect()]
}
