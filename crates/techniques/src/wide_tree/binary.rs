//! Binary trees over children, as builders make them.

use glam::Vec3A;
use nestray_core::aabb::Aabb;
use nestray_core::family::Family;
use nestray_core::huge::Huge;
use rayon::prelude::*;

use super::{LeafSize, collapse};

/// What a builder knows of the children.
#[derive(Debug)]
pub struct Contents {
    /// A box around each.
    pub boxes: Huge<Aabb>,
    /// [`Family::weight`] of each.
    pub weights: Vec<f32>,
    /// See [`Family::together`].
    pub together: u32,
}

impl Contents {
    pub(crate) fn new(family: &dyn Family) -> Self {
        /// Boxes that one thread asks for.
        const CHUNK: usize = 8192;
        let mut boxes = Huge::repeated(Aabb::EMPTY, family.count() as usize);
        boxes.par_chunks_mut(CHUNK).enumerate().for_each(|(chunk, boxes)| {
            family.boxes((chunk * CHUNK) as u32, boxes);
        });
        Self { boxes, weights: family.weights(), together: family.together() }
    }

    /// Whether all children weigh the same.
    pub(crate) fn is_even(&self) -> bool {
        self.weights.windows(2).all(|pair| pair[0] == pair[1])
    }

    /// Twice the centre of a child's box.
    #[inline]
    #[must_use]
    pub fn center(&self, child: u32) -> Vec3A {
        self.boxes[child as usize].min + self.boxes[child as usize].max
    }

    /// What testing `children` as one leaf costs, in visits of a node.
    pub(crate) fn leaf_cost(&self, size: LeafSize, children: &[u32]) -> f32 {
        /// Nanoseconds a visit of a node takes, about.
        const VISIT: f32 = 10.0;
        if self.together > 1 {
            return size.cost * children.len().div_ceil(self.together as usize) as f32;
        }
        children.iter().map(|&child| self.weights[child as usize]).sum::<f32>() / VISIT
    }
}

/// A node of the binary tree; not split if `left` is 0. What is below the side with the smaller
/// number comes right behind it, then what is below the other.
#[derive(Clone, Copy, Debug)]
pub struct Pair {
    /// A box around all below.
    pub bounds: Aabb,
    /// Where the children below begin in the order.
    pub first: u32,
    /// How many there are.
    pub count: u32,
    /// One subtree.
    pub left: u32,
    /// The other.
    pub right: u32,
}

impl Pair {
    /// The same node where its tree begins at `offset` of another.
    #[must_use]
    pub fn moved(self, offset: u32) -> Self {
        if self.left == 0 {
            return self;
        }
        Self { left: self.left + offset, right: self.right + offset, ..self }
    }
}

/// A binary tree, the root first, parents before what is below. A child may stand in it several
/// times, each with a box around a part of it.
#[derive(Debug)]
pub struct Binary<'a> {
    /// The children.
    pub of: &'a Contents,
    /// Their numbers, so that those below a node stand side by side.
    pub order: Vec<u32>,
    /// The nodes.
    pub pairs: Vec<Pair>,
}

/// What a binary tree becomes as a wide one.
#[derive(Clone, Debug)]
pub struct Outlook {
    /// What a random ray costs, in visits of a node; none if the tree would be too deep.
    pub cost: Option<f64>,
    /// Which of the binary nodes are best made leaves, unless they are inside one.
    pub leaves: Vec<bool>,
}

impl<'a> Binary<'a> {
    /// The tree in which merge `i` makes one subtree, called `children + i`, of two that were
    /// called before; children are called by their numbers. The last merge makes the root.
    /// What is below `halves_from` levels is put together anew, in halves.
    #[must_use]
    pub fn merged(of: &'a Contents, merges: &[[u32; 2]], halves_from: usize) -> Self {
        let children = of.boxes.len();
        let mut tree = Self { of, order: Vec::with_capacity(children), pairs: Vec::new() };
        tree.pairs.reserve(2 * children);
        let mut open = vec![((children + merges.len() - 1) as u32, 0, None)];
        while let Some((name, depth, above)) = open.pop() {
            let me = tree.pairs.len();
            if let Some(above) = above {
                let above: &mut Pair = &mut tree.pairs[above];
                // The left side comes first.
                let side = if above.left == 0 { &mut above.left } else { &mut above.right };
                *side = me as u32;
            }
            match (name as usize).checked_sub(children) {
                None => tree.halve(&[name]),
                Some(merge) if depth < halves_from => {
                    tree.push(0, 0);
                    let [left, right] = merges[merge];
                    open.extend([right, left].map(|side| (side, depth + 1, Some(me))));
                }
                Some(_) => tree.halve(&below(name, children, merges)),
            }
        }
        for me in (0..tree.pairs.len()).rev() {
            if tree.pairs[me].count == 0 {
                tree.close(me);
            }
        }
        tree
    }

    /// Whether some children stand in it several times.
    #[must_use]
    pub fn is_split(&self) -> bool {
        self.order.len() > self.of.boxes.len()
    }

    /// What stands in its leaves, each of which is one child: as if every piece of a child were a
    /// child of its own.
    #[must_use]
    pub fn pieces(&self) -> Contents {
        let mut boxes = Huge::repeated(Aabb::EMPTY, self.order.len());
        for pair in self.pairs.iter().filter(|pair| pair.left == 0) {
            debug_assert_eq!(pair.count, 1, "one child in a leaf");
            boxes[pair.first as usize] = pair.bounds;
        }
        let weights = self.order.iter().map(|&child| self.of.weights[child as usize]).collect();
        Contents { boxes, weights, together: self.of.together }
    }

    /// What it becomes as a wide tree, for builders that compare.
    #[must_use]
    pub fn outlook(&self, size: LeafSize) -> Outlook {
        collapse::outlook(size, self)
    }

    /// The children below a node.
    #[must_use]
    pub fn below(&self, pair: &Pair) -> &[u32] {
        &self.order[pair.first as usize..][..pair.count as usize]
    }

    /// Appends a node over what comes next in the order.
    fn push(&mut self, before: usize, count: usize) {
        let first = (self.order.len() - before) as u32;
        let count = count as u32;
        self.pairs.push(Pair { bounds: Aabb::EMPTY, first, count, left: 0, right: 0 });
    }

    /// Works out a node from its two sides.
    fn close(&mut self, me: usize) {
        let Pair { left, right, .. } = self.pairs[me];
        let (left, right) = (self.pairs[left as usize], self.pairs[right as usize]);
        self.pairs[me].bounds = left.bounds.join(right.bounds);
        self.pairs[me].count = left.count + right.count;
    }

    /// Appends `children` as a subtree split in halves.
    fn halve(&mut self, children: &[u32]) {
        let first = self.order.len();
        self.order.extend_from_slice(children);
        self.halve_from(first, children.len());
    }

    fn halve_from(&mut self, first: usize, count: usize) -> u32 {
        let me = self.pairs.len();
        self.push(self.order.len() - first, count);
        if count == 1 {
            self.pairs[me].bounds = self.of.boxes[self.order[first] as usize];
        } else {
            let half = in_halves(self.of, &mut self.order[first..][..count]);
            self.pairs[me].left = self.halve_from(first, half);
            self.pairs[me].right = self.halve_from(first + half, count - half);
            self.close(me);
        }
        me as u32
    }
}

/// All children in a subtree.
fn below(name: u32, children: usize, merges: &[[u32; 2]]) -> Vec<u32> {
    let (mut open, mut found) = (vec![name], Vec::new());
    while let Some(name) = open.pop() {
        match (name as usize).checked_sub(children) {
            None => found.push(name),
            Some(merge) => open.extend(merges[merge]),
        }
    }
    found
}

/// Surface area, in doubles: builders compare very small differences of very large ones.
#[must_use]
pub fn area(bounds: Aabb) -> f64 {
    let size = bounds.max.as_dvec3() - bounds.min.as_dvec3();
    2.0 * (size.x * size.y + size.y * size.z + size.z * size.x)
}

/// Puts the lower half along the longest axis first; returns how many that are.
#[must_use]
pub fn in_halves(of: &Contents, range: &mut [u32]) -> usize {
    let bounds = range.iter().fold(Aabb::EMPTY, |all, &c| all.join(of.boxes[c as usize]));
    let axis = longest(bounds.size());
    let half = range.len() / 2;
    range.select_nth_unstable_by(half, |&a, &b| {
        of.center(a)[axis].total_cmp(&of.center(b)[axis]).then(a.cmp(&b))
    });
    half
}

fn longest(size: Vec3A) -> usize {
    if size.x >= size.y.max(size.z) {
        0
    } else if size.y >= size.z {
        1
    } else {
        2
    }
}
