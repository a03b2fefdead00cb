//! What a technique may ask about the children it orders.

use glam::Vec3A;

use crate::aabb::Aabb;
use crate::beam::{Beam, Facing};
use crate::ray::Source;

/// The children as a technique sees them: boxes and a few questions about what is
/// inside. Children are numbered from 0, are all bounded and not empty, and there is at
/// least one while a technique is built.
///
/// Nothing is kept here: techniques copy the boxes they need, and those that refine
/// themselves while rays fly ask again.
pub trait Family: Sync {
    /// How many there are.
    fn count(&self) -> u32;

    /// A box around a child, a few ulps wider than the child.
    fn bounds(&self, child: u32) -> Aabb;

    /// The boxes of the children from `first` on.
    fn boxes(&self, first: u32, boxes: &mut [Aabb]) {
        for (child, bounds) in (first..).zip(boxes) {
            *bounds = self.bounds(child);
        }
    }

    /// Expected cost of testing a child, in nanoseconds; a nested aggregate weighs
    /// more than a triangle. Positive.
    fn weight(&self, child: u32) -> f32;

    /// The weights of all children.
    fn weights(&self) -> Vec<f32> {
        (0..self.count()).map(|child| self.weight(child)).collect()
    }

    /// How many children of one leaf are tested for the price of one: more than 1 where
    /// they are packed.
    fn together(&self) -> u32;

    /// [`Object::bounds_during`](crate::object::Object::bounds_during), padded alike.
    fn bounds_during(&self, child: u32, time: [f32; 2]) -> Aabb;

    /// [`Object::moves_evenly`](crate::object::Object::moves_evenly).
    fn moves_evenly(&self, _child: u32, _time: [f32; 2]) -> bool {
        false
    }

    /// The part of a child's box that may touch `cell`, padded alike; see
    /// [`Object::clipped`](crate::object::Object::clipped).
    fn clipped(&self, child: u32, cell: &Aabb) -> Aabb;

    /// How far a child reaches along `direction`, for bounding slabs [Kay 86].
    fn along(&self, child: u32, direction: Vec3A) -> [f32; 2];

    /// Whether any of a child may lie in `cell`, for octrees and grids.
    fn touches(&self, child: u32, cell: &Aabb) -> bool;

    /// [`Object::meets`](crate::object::Object::meets), for directional techniques.
    fn meets(&self, child: u32, beam: &Beam) -> Option<[f32; 2]>;

    /// [`Object::blocks`](crate::object::Object::blocks).
    fn blocks(&self, child: u32, beam: &Beam) -> Option<f32>;

    /// [`Object::facing`](crate::object::Object::facing).
    fn facing(&self, child: u32, beam: &Beam) -> Facing;

    /// The child that `source` lies on, if it can be told; for ray coherence.
    fn child_of(&self, source: &Source) -> Option<u32>;

    /// Whether `source` lies on a child: quicker than to find out on which it lies.
    fn holds(&self, child: u32, source: &Source) -> bool {
        self.child_of(source) == Some(child)
    }
}

/// All boxes of a family, in order.
#[must_use]
pub fn boxes(family: &dyn Family) -> Vec<Aabb> {
    let mut boxes = vec![Aabb::EMPTY; family.count() as usize];
    family.boxes(0, &mut boxes);
    boxes
}
