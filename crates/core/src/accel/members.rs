//! The children in an index, as the technique sees them.

use glam::Vec3A;

use crate::aabb::Aabb;
use crate::beam::{Beam, Facing};
use crate::children::Children;
use crate::cost::CostModel;
use crate::family::Family;
use crate::names::Names;
use crate::ray::Source;

/// Children and their numbers in the index.
#[derive(Debug)]
pub(super) struct Members<C> {
    pub(super) children: C,
    pub(super) names: Names,
}

impl<C: Children> Members<C> {
    /// Children none of which is in the index yet.
    pub(super) fn unnamed(children: C) -> Self {
        Self { children, names: Names::default() }
    }

    /// Puts all children into the index that have a box and can be hit. Returns a box around those
    /// that can be hit, and which of them no box can hold.
    pub(super) fn name(&mut self) -> (Aabb, Vec<u32>) {
        let (children, mut all, mut unbounded) = (&self.children, Aabb::EMPTY, Vec::new());
        self.names = Names::keeping(children.count(), |child| {
            let bounds = children.bounds(child);
            // A NaN corner must not spread.
            if bounds.is_empty() {
                return false;
            }
            all = all.join(bounds);
            let is_bounded = bounds.is_bounded();
            if !is_bounded {
                unbounded.push(child);
            }
            is_bounded
        });
        (all, unbounded)
    }

    /// For each child the chance that it is hit for what a test costs. Where several stand
    /// together, the one with the best is tested first: what is behind it is then not tested.
    pub(super) fn promises(&self) -> Vec<f64> {
        let promise = |number| {
            let cost = self.children.cost(self.names.child(number), CostModel::usual());
            cost.hit_rate / cost.nanos().max(f64::MIN_POSITIVE)
        };
        (0..self.names.count()).map(promise).collect()
    }
}

impl<C: Children> Family for Members<C> {
    fn count(&self) -> u32 {
        self.names.count()
    }

    fn bounds(&self, child: u32) -> Aabb {
        self.children.bounds(self.names.child(child)).padded()
    }

    fn weight(&self, child: u32) -> f32 {
        let cost = self.children.cost(self.names.child(child), CostModel::usual());
        (cost.nanos() as f32).max(f32::MIN_POSITIVE)
    }

    fn weights(&self) -> Vec<f32> {
        let count = self.count();
        // What is packed is all of one kind.
        if C::PACKED && count > 0 {
            return vec![self.weight(0); count as usize];
        }
        (0..count).map(|child| self.weight(child)).collect()
    }

    fn together(&self) -> u32 {
        if C::PACKED { 8 } else { 1 }
    }

    fn bounds_during(&self, child: u32, time: [f32; 2]) -> Aabb {
        self.children.bounds_during(self.names.child(child), time).padded()
    }

    fn moves_evenly(&self, child: u32, time: [f32; 2]) -> bool {
        self.children.moves_evenly(self.names.child(child), time)
    }

    fn clipped(&self, child: u32, cell: &Aabb) -> Aabb {
        match self.children.clipped(self.names.child(child), cell) {
            empty if empty.is_empty() => Aabb::EMPTY,
            part => part.padded(),
        }
    }

    fn along(&self, child: u32, direction: Vec3A) -> [f32; 2] {
        self.children.along(self.names.child(child), direction)
    }

    fn touches(&self, child: u32, cell: &Aabb) -> bool {
        self.children.touches(self.names.child(child), cell)
    }

    fn meets(&self, child: u32, beam: &Beam) -> Option<[f32; 2]> {
        self.children.meets(self.names.child(child), beam)
    }

    fn blocks(&self, child: u32, beam: &Beam) -> Option<f32> {
        self.children.blocks(self.names.child(child), beam)
    }

    fn facing(&self, child: u32, beam: &Beam) -> Facing {
        self.children.facing(self.names.child(child), beam)
    }

    fn child_of(&self, source: &Source) -> Option<u32> {
        self.names.number(self.children.child_of(source)?)
    }

    fn holds(&self, child: u32, source: &Source) -> bool {
        self.children.holds(self.names.child(child), source)
    }
}
