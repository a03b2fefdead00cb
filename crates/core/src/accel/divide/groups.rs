//! Each child in one leaf.

use crate::aabb::Aabb;
use crate::family::Family;
use crate::technique::Leaves;

/// A child that makes the box of a leaf so many times larger is put in none.
const TOO_LARGE: f32 = 4.0;

/// The children of each leaf, then those that are too large for theirs; no group is empty.
///
/// A child that is in several leaves goes where it makes the box around all others the least
/// larger.
pub(super) fn groups(family: &dyn Family, leaves: &Leaves) -> Vec<Vec<u32>> {
    let listed = Listed::new(family.count() as usize, leaves);
    let mut groups = vec![Vec::new(); leaves.count()];
    let mut boxes = vec![Aabb::EMPTY; leaves.count()];
    let (once, often): (Vec<u32>, Vec<u32>) = (0..family.count())
        .filter(|&child| !listed.of(child).is_empty())
        .partition(|&child| listed.of(child).len() == 1);
    for child in once {
        let leaf = listed.of(child)[0] as usize;
        boxes[leaf] = boxes[leaf].join(family.bounds(child));
        groups[leaf].push(child);
    }
    let mut large = Vec::new();
    for child in often {
        let bounds = family.bounds(child);
        let grown = |leaf: &u32| boxes[*leaf as usize].join(bounds).surface_area();
        let more = |leaf: &u32| grown(leaf) - boxes[*leaf as usize].surface_area();
        let best = listed.of(child).iter().min_by(|a, b| more(a).total_cmp(&more(b)));
        let Some(best) = best else { continue };
        let leaf = *best as usize;
        let fits = groups[leaf].is_empty() || grown(best) <= TOO_LARGE * boxes[leaf].surface_area();
        if fits {
            boxes[leaf] = boxes[leaf].join(bounds);
            groups[leaf].push(child);
        } else {
            large.push(child);
        }
    }
    groups.push(large);
    groups.retain(|group| !group.is_empty());
    groups
}

/// In which leaves each child is.
struct Listed {
    leaves: Vec<u32>,
    /// Where those of each child begin, and the end.
    starts: Vec<usize>,
}

impl Listed {
    fn new(children: usize, leaves: &Leaves) -> Self {
        let mut starts = vec![0; children + 2];
        let all =
            || (0..leaves.count()).flat_map(|leaf| leaves.of(leaf).iter().map(move |&c| (leaf, c)));
        for (_, child) in all() {
            starts[child as usize + 2] += 1;
        }
        for i in 2..starts.len() {
            starts[i] += starts[i - 1];
        }
        let mut listed = vec![0; starts[children + 1]];
        for (leaf, child) in all() {
            let at = &mut starts[child as usize + 1];
            listed[*at] = leaf as u32;
            *at += 1;
        }
        Self { leaves: listed, starts }
    }

    /// Those of one child, in order; a leaf that lists it twice may be there twice.
    fn of(&self, child: u32) -> &[u32] {
        &self.leaves[self.starts[child as usize]..self.starts[child as usize + 1]]
    }
}
