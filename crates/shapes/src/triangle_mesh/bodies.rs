//! The meshes whose triangles stand together.

use std::sync::Arc;

use super::Triangles;

/// One mesh or several, their triangles numbered through in the order of their geometries: so
/// that the lower number is also the lower `(geometry, primitive)`.
#[derive(Clone, Debug)]
pub(super) struct Bodies {
    /// By geometry, ascending; at least one.
    all: Arc<[Body]>,
}

/// One mesh of them.
#[derive(Clone, Debug)]
struct Body {
    geometry: u32,
    /// The number of its first triangle.
    first: u32,
    triangles: Arc<Triangles>,
}

impl Bodies {
    pub(super) fn one(geometry: u32, triangles: Arc<Triangles>) -> Self {
        Self { all: [Body { geometry, first: 0, triangles }].into() }
    }

    /// All that stand in any of `parts`; none if two have the same geometry, or there are more
    /// than `most` triangles.
    pub(super) fn joined<'a>(parts: impl Iterator<Item = &'a Self>, most: u32) -> Option<Self> {
        let mut all: Vec<Body> = parts.flat_map(|part| part.all.iter().cloned()).collect();
        all.sort_by_key(|body| body.geometry);
        if all.windows(2).any(|pair| pair[0].geometry == pair[1].geometry) {
            return None;
        }
        let mut first = 0u32;
        for body in &mut all {
            body.first = first;
            first = first.checked_add(body.triangles.count()).filter(|&count| count <= most)?;
        }
        (!all.is_empty()).then(|| Self { all: all.into() })
    }

    /// How many triangles there are.
    pub(super) fn count(&self) -> u32 {
        self.all.last().map_or(0, |body| body.first + body.triangles.count())
    }

    /// The mesh that a triangle is of, and which it is there.
    #[inline]
    pub(super) fn find(&self, number: u32) -> (&Triangles, u32) {
        let body = self.body(number);
        (&body.triangles, number - body.first)
    }

    /// The mesh that a triangle is of, and its vertices there.
    #[inline]
    pub(super) fn face(&self, number: u32) -> (&Triangles, [u32; 3]) {
        let (triangles, primitive) = self.find(number);
        (triangles, triangles.faces[primitive as usize])
    }

    /// What a triangle is called in hits: geometry and primitive.
    #[inline]
    pub(super) fn name(&self, number: u32) -> [u32; 2] {
        let body = self.body(number);
        [body.geometry, number - body.first]
    }

    /// The number of the triangle so called, if it is there.
    #[inline]
    pub(super) fn number(&self, [geometry, primitive]: [u32; 2]) -> Option<u32> {
        let body = match &self.all[..] {
            [only] => Some(only).filter(|only| only.geometry == geometry),
            all => {
                let at = all.binary_search_by_key(&geometry, |body| body.geometry);
                at.ok().map(|at| &all[at])
            }
        }?;
        (primitive < body.triangles.count()).then_some(body.first + primitive)
    }

    #[inline]
    fn body(&self, number: u32) -> &Body {
        match &self.all[..] {
            [only] => only,
            // The first begins at 0.
            all => &all[all.partition_point(|body| body.first <= number) - 1],
        }
    }

    /// Whether few triangles share vertices; see [`Triangles::is_soup`].
    pub(super) fn are_soup(&self) -> bool {
        let vertices: usize = self.all.iter().map(|body| body.triangles.positions().len()).sum();
        vertices > 2 * self.count() as usize
    }
}
