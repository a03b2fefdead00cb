//! A binary tree that can be changed.

use nestray_core::aabb::Aabb;

use crate::wide_tree::{Binary, area};

/// A binary tree. Its root is node 0 and stays there.
#[derive(Debug)]
pub(super) struct Tree {
    pub(super) nodes: Vec<Node>,
    /// Steps upwards made so far by moves.
    pub(super) climbed: usize,
}

/// A node.
#[derive(Clone, Copy, Debug)]
pub(super) struct Node {
    pub(super) bounds: Aabb,
    /// What it is in; itself for the root.
    pub(super) parent: u32,
    /// Its two sides; of a single child, twice its number.
    pub(super) sides: [u32; 2],
    pub(super) is_child: bool,
    /// Whether it moves as a whole: a child, or what makes a leaf.
    pub(super) is_whole: bool,
    /// Whether it is inside such a one.
    is_inside: bool,
}

impl Tree {
    /// The nodes of a binary tree; those marked as `leaves` move as a whole, none if
    /// nothing is said.
    pub(super) fn new(binary: &Binary<'_>, leaves: &[bool]) -> Self {
        let mut nodes: Vec<Node> = Vec::with_capacity(binary.pairs.len());
        for (i, pair) in binary.pairs.iter().enumerate() {
            let is_child = pair.left == 0;
            let child = binary.order[pair.first as usize];
            let sides = if is_child { [child; 2] } else { [pair.left, pair.right] };
            let is_whole = is_child || leaves.get(i).is_some_and(|is_leaf| *is_leaf);
            let (bounds, parent, is_inside) = (pair.bounds, 0, false);
            nodes.push(Node { bounds, parent, sides, is_child, is_whole, is_inside });
        }
        for (me, pair) in binary.pairs.iter().enumerate().filter(|(_, pair)| pair.left != 0) {
            for side in [pair.left, pair.right] {
                nodes[side as usize].parent = me as u32;
                nodes[side as usize].is_inside = nodes[me].is_whole || nodes[me].is_inside;
            }
        }
        Self { nodes, climbed: 0 }
    }

    #[inline]
    pub(super) fn node(&self, name: u32) -> &Node {
        &self.nodes[name as usize]
    }

    /// The other side of what a node is in.
    #[inline]
    pub(super) fn sibling(&self, name: u32) -> u32 {
        let [left, right] = self.node(self.node(name).parent).sides;
        if left == name { right } else { left }
    }

    /// Whether a node can be moved: neither the root nor a side of it, nor inside a leaf.
    #[inline]
    pub(super) fn is_movable(&self, name: u32) -> bool {
        let node = self.node(name);
        node.parent != 0 && !node.is_inside
    }

    /// Whether `name` is inside `around`, or is it.
    pub(super) fn is_within(&mut self, mut name: u32, around: u32) -> bool {
        while name != 0 && name != around {
            name = self.node(name).parent;
            self.climbed += 1;
        }
        name == around
    }

    /// Moves a subtree, with the node it is in, to beside `to`. Returns by how much the joint
    /// area of all boxes grows, and where it was.
    ///
    /// `to` is not in the subtree, is not what the subtree is in, and is not the root.
    pub(super) fn put_beside(&mut self, name: u32, to: u32) -> (f64, u32) {
        let (parent, from) = (self.node(name).parent, self.sibling(name));
        let above = self.node(parent).parent;
        let mut growth = -area(self.node(parent).bounds);
        self.replace(above, parent, from);
        growth += self.fit(above);
        let above = self.node(to).parent;
        self.replace(above, to, parent);
        let bounds = self.node(to).bounds.join(self.node(name).bounds);
        self.nodes[parent as usize].sides = [to, name];
        self.nodes[parent as usize].bounds = bounds;
        self.nodes[to as usize].parent = parent;
        growth += area(bounds) + self.fit(above);
        (growth, from)
    }

    /// Puts `new` in a node where `old` was.
    fn replace(&mut self, above: u32, old: u32, new: u32) {
        let sides = &mut self.nodes[above as usize].sides;
        sides[usize::from(sides[1] == old)] = new;
        self.nodes[new as usize].parent = above;
    }

    /// Fits the boxes from `name` upwards to what is in them; returns by how much they grow.
    fn fit(&mut self, mut name: u32) -> f64 {
        let mut growth = 0.0;
        loop {
            let Node { bounds, parent, sides: [left, right], .. } = *self.node(name);
            let fitting = self.node(left).bounds.join(self.node(right).bounds);
            if fitting == bounds {
                return growth;
            }
            self.climbed += 1;
            growth += area(fitting) - area(bounds);
            self.nodes[name as usize].bounds = fitting;
            if name == 0 {
                return growth;
            }
            name = parent;
        }
    }

    /// The tree as [`Binary::merged`] takes it, over `children`.
    pub(super) fn merges(&self, children: usize) -> Vec<[u32; 2]> {
        let mut order = Vec::with_capacity(children - 1);
        let mut open = vec![0];
        while let Some(name) = open.pop() {
            if !self.node(name).is_child {
                order.push(name);
                open.extend(self.node(name).sides);
            }
        }
        // What is inside comes first.
        order.reverse();
        let mut names = vec![0; self.nodes.len()];
        for (merge, &name) in order.iter().enumerate() {
            names[name as usize] = (children + merge) as u32;
        }
        let name = |side: u32| match self.node(side) {
            Node { is_child: true, sides: [child, _], .. } => *child,
            _ => names[side as usize],
        };
        order.iter().map(|&node| self.node(node).sides.map(name)).collect()
    }
}
