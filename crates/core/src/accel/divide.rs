//! What a technique would put in its leaves: for hybrids, where another technique puts that in
//! order [Scherson 87].

mod groups;

use glam::Vec3A;

use crate::aabb::Aabb;
use crate::accel::members::Members;
use crate::beam::{Beam, Facing};
use crate::children::Children;
use crate::family::Family;
use crate::ray::Source;
use crate::technique::Leaves;

/// Children in groups, each child in one.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Division {
    /// A group for each leaf, and at the end one of the children that are too large for any leaf.
    pub groups: Vec<Vec<u32>>,
    /// Children that are in no leaf: no box can hold them, or they can never be hit.
    pub outside: Vec<u32>,
}

/// The leaves that `build` makes of `children`, each child only in the one that it fits best.
///
/// To `build` a leaf of `per_leaf` children seems as cheap as a few children are: what is in it
/// will be in order too.
#[must_use]
pub fn divide<C: Children>(
    children: C,
    per_leaf: u32,
    build: &dyn Fn(&dyn Family, &mut Leaves),
) -> Division {
    let mut members = Members::unnamed(children);
    members.name();
    let names = &members.names;
    let mut leaves = Leaves::default();
    if names.count() > 0 {
        build(&Ordered::new(&members, per_leaf), &mut leaves);
    }
    let mut groups = groups::groups(&members, &leaves);
    let mut is_in = vec![false; members.children.count() as usize];
    for child in groups.iter_mut().flatten() {
        *child = names.child(*child);
        is_in[*child as usize] = true;
    }
    let outside = (0..).zip(is_in).filter(|(_, is_in)| !is_in).map(|(child, _)| child).collect();
    Division { groups, outside }
}

/// A family whose leaves will be in order too.
struct Ordered<'a> {
    family: &'a dyn Family,
    together: u32,
    /// What becomes of the weight of a child.
    factor: f32,
}

impl<'a> Ordered<'a> {
    fn new(family: &'a dyn Family, per_leaf: u32) -> Self {
        /// What a full leaf costs, in children or packs of them.
        const LEAF: f32 = 4.0;
        let own = family.together();
        let together = own.max(per_leaf);
        Self { family, together, factor: (LEAF * own as f32 / together as f32).min(1.0) }
    }
}

impl Family for Ordered<'_> {
    fn count(&self) -> u32 {
        self.family.count()
    }

    fn bounds(&self, child: u32) -> Aabb {
        self.family.bounds(child)
    }

    fn weight(&self, child: u32) -> f32 {
        (self.family.weight(child) * self.factor).max(f32::MIN_POSITIVE)
    }

    fn together(&self) -> u32 {
        self.together
    }

    fn bounds_during(&self, child: u32, time: [f32; 2]) -> Aabb {
        self.family.bounds_during(child, time)
    }

    fn moves_evenly(&self, child: u32, time: [f32; 2]) -> bool {
        self.family.moves_evenly(child, time)
    }

    fn clipped(&self, child: u32, cell: &Aabb) -> Aabb {
        self.family.clipped(child, cell)
    }

    fn along(&self, child: u32, direction: Vec3A) -> [f32; 2] {
        self.family.along(child, direction)
    }

    fn touches(&self, child: u32, cell: &Aabb) -> bool {
        self.family.touches(child, cell)
    }

    fn meets(&self, child: u32, beam: &Beam) -> Option<[f32; 2]> {
        self.family.meets(child, beam)
    }

    fn blocks(&self, child: u32, beam: &Beam) -> Option<f32> {
        self.family.blocks(child, beam)
    }

    fn facing(&self, child: u32, beam: &Beam) -> Facing {
        self.family.facing(child, beam)
    }

    fn child_of(&self, source: &Source) -> Option<u32> {
        self.family.child_of(source)
    }

    fn holds(&self, child: u32, source: &Source) -> bool {
        self.family.holds(child, source)
    }
}

#[cfg(test)]
mod tests;
