//! How best to cut up a binary tree, by dynamic programming [Ylitie 17].

use super::binary::Pair;

/// More children than this below a node are worth being shared out between threads.
const SHARED: u32 = 8192;

/// How best to cut each binary subtree into at most 1, 2, … 8 wide ones.
#[derive(Debug)]
pub(crate) struct Forests {
    best: Vec<Best>,
}

/// The best of one subtree.
#[derive(Clone, Copy, Debug)]
struct Best {
    /// Cost as at most `j + 1` parts.
    cost: [f32; 8],
    /// How often it is met, to whatever scale.
    area: f32,
    /// Whether one part of it is a leaf.
    is_leaf: bool,
}

/// Parts of a binary tree.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Roots {
    names: [u32; 8],
    count: usize,
}

impl Roots {
    fn push(&mut self, name: u32) {
        self.names[self.count] = name;
        self.count += 1;
    }
}

impl std::ops::Deref for Roots {
    type Target = [u32];

    fn deref(&self) -> &[u32] {
        &self.names[..self.count]
    }
}

impl Forests {
    /// `price` says how often subtree `i` is met, and what it costs as one leaf; leaves have
    /// at most `most` children, if the tree allows.
    pub(crate) fn new(
        most: usize,
        pairs: &[Pair],
        price: impl Fn(usize) -> [f32; 2] + Sync,
    ) -> Self {
        let mut best = vec![Best { cost: [0.0; 8], area: 0.0, is_leaf: true }; pairs.len()];
        fill(&mut best, 0, most, pairs, &price);
        Self { best }
    }

    /// What the whole costs.
    pub(crate) fn cost(&self) -> f32 {
        self.best[0].cost[0]
    }

    /// The roots of subtree `i` as at most `parts` parts. More never cost more than fewer, but two
    /// or more may cost more than one.
    fn roots(&self, pairs: &[Pair], i: u32, parts: usize, out: &mut Roots) {
        let pair = &pairs[i as usize];
        if parts == 1 || pair.left == 0 {
            return out.push(i);
        }
        let [left, right] = [pair.left, pair.right].map(|side| &self.best[side as usize].cost);
        let (cost, of_left) = cheapest(left, right, parts);
        if self.best[i as usize].cost[0] < cost {
            return out.push(i);
        }
        self.roots(pairs, pair.left, of_left, out);
        self.roots(pairs, pair.right, parts - of_left, out);
    }

    /// What a wide node made of subtree `i` holds, the largest last. It is the subtree itself if
    /// that is best as one leaf: only the root of a whole tree is asked nevertheless.
    pub(crate) fn children(&self, pairs: &[Pair], i: u32) -> Roots {
        let mut out = Roots::default();
        self.roots(pairs, i, 8, &mut out);
        let area = |i: u32| self.best[i as usize].area;
        out.names[..out.count].sort_by(|&a, &b| area(a).total_cmp(&area(b)));
        out
    }

    /// Whether a subtree is best as one leaf.
    pub(crate) fn is_leaf(&self, i: u32) -> bool {
        self.best[i as usize].is_leaf
    }

    /// How many nodes are on the longest way down.
    pub(crate) fn depth(&self, pairs: &[Pair]) -> usize {
        let mut deepest = 0;
        let mut open = vec![(0, 1)];
        while let Some((i, depth)) = open.pop() {
            deepest = deepest.max(depth);
            let children = self.children(pairs, i);
            let inner = children.iter().filter(|&&child| !self.is_leaf(child));
            open.extend(inner.map(|&child| (child, depth + 1)));
        }
        deepest
    }
}

/// The least that two subtrees together cost as so many parts, and how many of those the left one
/// gets.
#[inline]
fn cheapest(left: &[f32; 8], right: &[f32; 8], parts: usize) -> (f32, usize) {
    (1..parts).fold((f32::INFINITY, 1), |best, of_left| {
        let cost = left[of_left - 1] + right[parts - of_left - 1];
        if cost < best.0 { (cost, of_left) } else { best }
    })
}

/// Works out a subtree, which is numbered from `begin` on, from below.
fn fill(
    best: &mut [Best],
    begin: usize,
    most: usize,
    pairs: &[Pair],
    price: &(impl Fn(usize) -> [f32; 2] + Sync),
) {
    let pair = &pairs[begin];
    let own = if pair.left == 0 || pair.count <= SHARED {
        // Children come after their parents.
        begin..begin + best.len()
    } else {
        let second = pair.left.max(pair.right) as usize;
        let (first, rest) = best[1..].split_at_mut(second - begin - 1);
        rayon::join(
            || fill(first, begin + 1, most, pairs, price),
            || fill(rest, second, most, pairs, price),
        );
        begin..begin + 1
    };
    for i in own.rev() {
        let (pair, [area, leaf]) = (&pairs[i], price(i));
        best[i - begin] = if pair.left == 0 {
            Best { cost: [leaf; 8], area, is_leaf: true }
        } else {
            let [left, right] =
                [pair.left, pair.right].map(|side| &best[side as usize - begin].cost);
            let fits = pair.count as usize <= most;
            Best::of([left, right], area, fits.then_some(leaf))
        };
    }
}

impl Best {
    /// The best of two subtrees together, which may be made a leaf.
    #[inline]
    fn of([left, right]: [&[f32; 8]; 2], area: f32, leaf: Option<f32>) -> Self {
        let mut cost = [f32::INFINITY; 8];
        for of_left in 1..8 {
            for parts in of_left + 1..=8 {
                let both = left[of_left - 1] + right[parts - of_left - 1];
                let least = &mut cost[parts - 1];
                *least = if both < *least { both } else { *least };
            }
        }
        let node = area + cost[7];
        let leaf = leaf.filter(|leaf| *leaf <= node);
        cost[0] = leaf.unwrap_or(node);
        for parts in 1..8 {
            cost[parts] = if cost[parts - 1] < cost[parts] { cost[parts - 1] } else { cost[parts] };
        }
        Self { cost, area, is_leaf: leaf.is_some() }
    }
}
