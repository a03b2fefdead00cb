//! Which of its triangles a mesh has for children.

use std::sync::Arc;

use nestray_core::hit::InstancePath;

use super::{Layout, Mesh, Triangles};

/// The children of a mesh: all triangles of its data, or some.
#[derive(Clone, Debug, Default)]
pub(super) struct Part {
    /// Primitive numbers in ascending order; none if all are there, each under its own.
    chosen: Option<Arc<[u32]>>,
}

impl Part {
    /// Some children of this one, in any order.
    pub(super) fn part(&self, children: &[u32]) -> Self {
        let mut chosen: Vec<u32> = children.iter().map(|&child| self.primitive(child)).collect();
        chosen.sort_unstable();
        chosen.dedup();
        Self { chosen: Some(chosen.into()) }
    }

    /// How many there are.
    pub(super) fn count(&self, of: &Triangles) -> u32 {
        self.chosen.as_ref().map_or_else(|| of.count(), |chosen| chosen.len() as u32)
    }

    /// What a child is called in hits.
    #[inline]
    pub(super) fn primitive(&self, child: u32) -> u32 {
        self.chosen.as_ref().map_or(child, |chosen| chosen[child as usize])
    }

    /// The child that is called `primitive`, if it is there.
    #[inline]
    pub(super) fn child(&self, primitive: u32) -> Option<u32> {
        match &self.chosen {
            None => Some(primitive),
            Some(chosen) => chosen.binary_search(&primitive).ok().map(|child| child as u32),
        }
    }

    /// Memory in use.
    pub(super) fn bytes(&self) -> usize {
        self.chosen.as_ref().map_or(0, |chosen| size_of_val::<[u32]>(chosen))
    }
}

impl<L: Layout> Mesh<L> {
    /// The same mesh, not yet packed, to be laid out in another way.
    #[must_use]
    pub fn packed_otherwise<M: Layout>(&self) -> Mesh<M> {
        let mesh = Mesh::new(self.geometry, Arc::clone(&self.triangles));
        Mesh { part: self.part.clone(), ..mesh.seen_from(self.sides) }
    }

    /// A mesh of some of its children, not yet packed, that report the same primitives. It shares
    /// the data, and takes room for its own triangles only.
    #[must_use]
    pub fn part(&self, children: &[u32]) -> Self {
        Self { part: self.part.part(children), ..self.packed_otherwise() }
    }

    /// How many triangles are in it.
    #[must_use]
    pub fn count(&self) -> u32 {
        self.part.count(&self.triangles)
    }

    /// The child that a hit or a ray names, if it is one.
    pub(super) fn child_called(
        &self,
        geometry: u32,
        primitive: u32,
        path: InstancePath,
    ) -> Option<u32> {
        let is_mine = geometry == self.geometry && path == InstancePath::NONE;
        if is_mine { self.part.child(primitive) } else { None }
    }
}
