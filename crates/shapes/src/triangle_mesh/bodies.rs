//! The meshes whose triangles stand together.

use std::sync::Arc;

use super::Triangles;

/// One mesh or several, their triangles numbered through in the order of their geometries: so
/// that the lower number is also the lower `(geometry, primitive)`.
#[derive(Clone, Debug)]
pub(super) struct Bodies {
    /// By geometry, ascending; at least one.
    all: Arc<[Body]>,
    /// For the first of each [`STRIDE`] triangles, which mesh it is of; empty if there is one.
    near: Arc<[u32]>,
}

/// Triangles for each of which the search for their mesh begins at the same.
const STRIDE: u32 = 64;

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
        Self { all: [Body { geometry, first: 0, triangles }].into(), near: Arc::default() }
    }

    /// All triangles that stand in any of `parts`; none if two have the same geometry, or there
    /// are more than `most` triangles, or none.
    pub(super) fn joined<'a>(parts: impl Iterator<Item = &'a Self>, most: u32) -> Option<Self> {
        let bodies = parts.flat_map(|part| part.all.iter());
        let mut all: Vec<Body> =
            bodies.filter(|body| body.triangles.count() > 0).cloned().collect();
        all.sort_by_key(|body| body.geometry);
        if all.windows(2).any(|pair| pair[0].geometry == pair[1].geometry) {
            return None;
        }
        let mut first = 0u32;
        for body in &mut all {
            body.first = first;
            first = first.checked_add(body.triangles.count()).filter(|&count| count <= most)?;
        }
        if all.len() == 1 {
            return Some(Self { all: all.into(), near: Arc::default() });
        }
        let of = |number: u32| all.partition_point(|body| body.first <= number) as u32 - 1;
        let near = (0..first).step_by(STRIDE as usize).map(of).collect();
        (!all.is_empty()).then(|| Self { all: all.into(), near })
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
            all => {
                let from = self.near[(number / STRIDE) as usize] as usize;
                let next = all[from + 1..].iter().take_while(|body| body.first <= number);
                &all[from + next.count()]
            }
        }
    }

    /// Memory in use, but for the meshes themselves.
    pub(super) fn bytes(&self) -> usize {
        size_of_val::<[Body]>(&self.all) + size_of_val::<[u32]>(&self.near)
    }

    /// Whether few triangles share vertices; see [`Triangles::is_soup`].
    pub(super) fn are_soup(&self) -> bool {
        let vertices: usize = self.all.iter().map(|body| body.triangles.positions().len()).sum();
        vertices > 2 * self.count() as usize
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn joined_triangles_keep_their_names() {
        let sizes = [3, 0, 1, 64, 200, 1, 1, 0, 130];
        let bodies: Vec<Bodies> = (0..)
            .zip(sizes)
            .map(|(geometry, size)| {
                let triangles = Triangles::new(vec![[0.0; 3]; 3], vec![[0, 1, 2]; size]);
                Bodies::one(2 * geometry, Arc::new(triangles.expect("indices are in range")))
            })
            .collect();
        let joined = Bodies::joined(bodies.iter(), u32::MAX).expect("no geometry is there twice");
        let names = (0..).zip(sizes).flat_map(|(geometry, size)| {
            (0..size as u32).map(move |primitive| [2 * geometry, primitive])
        });
        for (number, name) in (0..).zip(names) {
            assert_eq!(joined.name(number), name);
            assert_eq!(joined.number(name), Some(number));
        }
        assert_eq!(joined.count(), 400);
        assert!(Bodies::joined(bodies.iter(), 399).is_none());
    }
}
