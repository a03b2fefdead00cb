//! Which children are in an index, and under which numbers.

/// Which child each number of a family stands for.
#[derive(Clone, Debug, Default)]
pub struct Names {
    /// Empty if every child is there, under its own number.
    renamed: Vec<u32>,
    count: u32,
}

impl Names {
    /// The children of `0..all` that `keep` wants; it is asked once for each, in order.
    #[must_use]
    pub fn keeping(all: u32, mut keep: impl FnMut(u32) -> bool) -> Self {
        let Some(first) = (0..all).find(|&child| !keep(child)) else {
            return Self { renamed: Vec::new(), count: all };
        };
        let renamed: Vec<u32> =
            (0..first).chain((first + 1..all).filter(|&child| keep(child))).collect();
        Self { count: renamed.len() as u32, renamed }
    }

    /// How many there are.
    #[inline(always)]
    #[must_use]
    pub fn count(&self) -> u32 {
        self.count
    }

    /// The child called `number`.
    #[inline(always)]
    #[must_use]
    pub fn child(&self, number: u32) -> u32 {
        if self.renamed.is_empty() { number } else { self.renamed[number as usize] }
    }

    /// What a child is called, if it is there.
    #[must_use]
    pub fn number(&self, child: u32) -> Option<u32> {
        if self.renamed.is_empty() {
            return (child < self.count).then_some(child);
        }
        self.renamed.binary_search(&child).ok().map(|number| number as u32)
    }

    /// Memory in use.
    #[must_use]
    pub fn bytes(&self) -> u64 {
        size_of_val(self.renamed.as_slice()) as u64
    }
}
