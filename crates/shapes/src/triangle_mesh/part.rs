//! Which of its triangles a mesh has for children.

use std::sync::Arc;

use nestray_core::hit::InstancePath;

use super::bodies::Bodies;
use super::{Layout, Mesh};
use crate::shape::Sides;

/// The children of a mesh: all its triangles, or some.
#[derive(Clone, Debug, Default)]
pub(super) struct Part {
    /// Numbers of triangles in ascending order; none if all are there, each under its own.
    chosen: Option<Arc<[u32]>>,
}

impl Part {
    /// Some children of this one, in any order.
    pub(super) fn part(&self, children: &[u32]) -> Self {
        let mut chosen: Vec<u32> = children.iter().map(|&child| self.number(child)).collect();
        chosen.sort_unstable();
        chosen.dedup();
        Self { chosen: Some(chosen.into()) }
    }

    /// How many there are.
    pub(super) fn count(&self, of: &Bodies) -> u32 {
        self.chosen.as_ref().map_or_else(|| of.count(), |chosen| chosen.len() as u32)
    }

    /// Which triangle a child is.
    #[inline]
    pub(super) fn number(&self, child: u32) -> u32 {
        self.chosen.as_ref().map_or(child, |chosen| chosen[child as usize])
    }

    /// The child that is a triangle, if it is there.
    #[inline]
    pub(super) fn child(&self, number: u32) -> Option<u32> {
        match &self.chosen {
            None => Some(number),
            Some(chosen) => chosen.binary_search(&number).ok().map(|child| child as u32),
        }
    }

    /// Whether some may be missing.
    pub(super) fn is_some(&self) -> bool {
        self.chosen.is_some()
    }

    /// Memory in use.
    pub(super) fn bytes(&self) -> usize {
        self.chosen.as_ref().map_or(0, |chosen| size_of_val::<[u32]>(chosen))
    }
}

impl<L: Layout> Mesh<L> {
    /// Most triangles of meshes that are [`joined`](Self::joined): their leaves can be named,
    /// however often a technique names each.
    pub const MOST_JOINED: u32 = 1 << 24;

    /// The triangles of several meshes as one family, not yet packed. Each still reports its own
    /// geometry and primitive. None if they cannot be one: there are none, two are of the same
    /// geometry or seen from other sides, one is a [`part`](Self::part), or there are more than
    /// [`MOST_JOINED`](Self::MOST_JOINED) triangles.
    #[must_use]
    pub fn joined(meshes: &[Self]) -> Option<Self> {
        let sides = meshes.first()?.sides;
        if meshes.iter().any(|mesh| mesh.sides != sides || mesh.part.is_some()) {
            return None;
        }
        let bodies = Bodies::joined(meshes.iter().map(|mesh| &mesh.bodies), Self::MOST_JOINED)?;
        Some(Self::over(bodies, sides, Part::default()))
    }

    /// The same mesh, not yet packed, to be laid out in another way.
    #[must_use]
    pub fn packed_otherwise<M: Layout>(&self) -> Mesh<M> {
        Mesh::over(self.bodies.clone(), self.sides, self.part.clone())
    }

    /// A mesh of some of its children, not yet packed, that report the same primitives. It shares
    /// the data, and takes room for its own triangles only.
    #[must_use]
    pub fn part(&self, children: &[u32]) -> Self {
        Self::over(self.bodies.clone(), self.sides, self.part.part(children))
    }

    /// How many triangles are in it.
    #[must_use]
    pub fn count(&self) -> u32 {
        self.part.count(&self.bodies)
    }

    /// Whether triangles have few vertices in common; see [`Triangles::is_soup`](super::Triangles::is_soup). Of a part,
    /// whether those of the whole do.
    #[must_use]
    pub fn is_soup(&self) -> bool {
        self.bodies.are_soup()
    }

    /// From which sides it is seen.
    #[must_use]
    pub fn sides(&self) -> Sides {
        self.sides
    }

    /// The child that a hit or a ray names, if it is one.
    pub(super) fn child_called(&self, name: [u32; 2], path: InstancePath) -> Option<u32> {
        if path != InstancePath::NONE {
            return None;
        }
        self.part.child(self.bodies.number(name)?)
    }
}
