//! What a ray meets next, and the leaves it may be.

use crate::trail;

/// What a ray meets next: a place of the technique's own (31 bits of its choice), a leaf,
/// or nothing any more. One word, so that trees can keep it in their nodes and in the
/// [`Trail`](crate::trail::Trail) as it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Step(u32);

impl Step {
    /// Nothing is left.
    pub const DONE: Self = Self(trail::DONE);
    /// Something is hit for certain, whatever it is: the end of a query for any hit. Only of an
    /// index that [`TELLS`](crate::technique::Index::TELLS).
    pub const HIT: Self = Self(trail::DONE - 1);
    const LEAF: u32 = 1 << 31;

    /// A node or cell.
    #[inline(always)]
    #[must_use]
    pub const fn onward(place: u32) -> Self {
        debug_assert!(place < Self::LEAF);
        Self(place)
    }

    /// Children to test.
    #[inline(always)]
    #[must_use]
    pub const fn leaf(leaf: Leaf) -> Self {
        Self(Self::LEAF | leaf.0)
    }

    /// From [`word`](Self::word).
    #[inline(always)]
    #[must_use]
    pub const fn from_word(word: u32) -> Self {
        Self(word)
    }

    /// As one word; the place, if it is one.
    #[inline(always)]
    #[must_use]
    pub const fn word(self) -> u32 {
        self.0
    }

    /// Whether it is a node or cell.
    #[inline(always)]
    #[must_use]
    pub const fn is_onward(self) -> bool {
        self.0 < Self::LEAF
    }

    /// Whether nothing is left.
    #[inline(always)]
    #[must_use]
    pub const fn is_done(self) -> bool {
        self.0 == trail::DONE
    }

    /// Whether something is hit for certain.
    #[inline(always)]
    #[must_use]
    pub const fn is_hit(self) -> bool {
        self.0 == Self::HIT.0
    }

    /// The leaf, if it is one.
    #[inline(always)]
    #[must_use]
    pub const fn as_leaf(self) -> Leaf {
        Leaf(self.0 & !Self::LEAF)
    }

    /// The same; a leaf by its new name, as
    /// [`rename_leaves`](crate::technique::Index::rename_leaves) is told.
    #[must_use]
    pub fn renamed(self, leaves: &[Leaf]) -> Self {
        if self.is_onward() || self.is_done() {
            return self;
        }
        Self::leaf(leaves[self.as_leaf().0 as usize])
    }
}

/// A leaf: its number while building, then whatever the children call it (31 bits, but not the
/// two greatest numbers).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Leaf(pub u32);

/// The leaves of a technique, in the order pushed.
#[derive(Debug, Default)]
pub struct Leaves {
    /// For each leaf its length, then its children.
    entries: Vec<u32>,
    /// Where each leaf begins.
    starts: Vec<u32>,
}

impl Leaves {
    /// Appends a leaf and says how it is called.
    pub fn push(&mut self, children: &[u32]) -> Leaf {
        let number = self.starts.len() as u32;
        self.starts.push(u32::try_from(self.entries.len()).expect("fewer than 2³¹ leaf entries"));
        self.entries.push(children.len() as u32);
        self.entries.extend_from_slice(children);
        Leaf(number)
    }

    /// Appends all leaves of another; says how the first is called now.
    pub fn append(&mut self, other: &Self) -> u32 {
        let number = self.starts.len() as u32;
        let begin = self.entries.len();
        u32::try_from(begin + other.entries.len()).expect("fewer than 2³¹ leaf entries");
        self.starts.extend(other.starts.iter().map(|start| start + begin as u32));
        self.entries.extend_from_slice(&other.entries);
        number
    }

    /// How many there are.
    #[must_use]
    pub fn count(&self) -> usize {
        self.starts.len()
    }

    /// The children of leaf `number`.
    #[must_use]
    pub fn of(&self, number: usize) -> &[u32] {
        let start = self.starts[number] as usize;
        &self.entries[start + 1..][..self.entries[start] as usize]
    }

    /// Puts the children of each leaf in order, the greatest of `numbers` first; what has the same
    /// stays as it is.
    pub(crate) fn sort_by(&mut self, numbers: &[f64]) {
        if numbers.windows(2).all(|pair| pair[0] == pair[1]) {
            return;
        }
        for &start in &self.starts {
            let start = start as usize;
            let count = self.entries[start] as usize;
            let children = &mut self.entries[start + 1..][..count];
            let number = |child: u32| numbers[child as usize];
            children.sort_by(|&a, &b| number(b).total_cmp(&number(a)));
        }
    }

    /// Gives up the numbers: what is left is one table, and where each leaf begins in it.
    pub(crate) fn into_table(self) -> (Vec<u32>, Vec<Leaf>) {
        (self.entries, self.starts.into_iter().map(Leaf).collect())
    }
}
