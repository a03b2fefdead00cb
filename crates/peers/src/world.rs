//! What rays are shot at: triangles, where they are and where they are again.

use std::borrow::Cow;

use glam::Affine3A;

/// Triangles in one space.
#[derive(Clone, Debug, Default)]
pub struct Mesh {
    /// Corners.
    pub positions: Vec<[f32; 3]>,
    /// Numbers of three corners each, all of which are there.
    pub faces: Vec<[u32; 3]>,
}

/// A mesh, somewhere.
#[derive(Clone, Copy, Debug)]
pub struct Place {
    /// Which.
    pub mesh: usize,
    /// Where.
    pub world_from_mesh: Affine3A,
}

/// Triangles that stand as they are, and meshes that stand in many places.
#[derive(Clone, Debug, Default)]
pub struct World {
    /// What stands as it is.
    pub fixed: Mesh,
    /// What stands in places.
    pub meshes: Vec<Mesh>,
    /// The places.
    pub places: Vec<Place>,
}

impl Mesh {
    /// Puts another mesh into it, moved.
    pub fn append(&mut self, other: &Self, to: &Affine3A) {
        let first = self.positions.len() as u32;
        let moved = |&p: &[f32; 3]| to.transform_point3a(p.into()).to_array();
        // What is not moved keeps every bit.
        if *to == Affine3A::IDENTITY {
            self.positions.extend_from_slice(&other.positions);
        } else {
            self.positions.extend(other.positions.iter().map(moved));
        }
        self.faces.extend(other.faces.iter().map(|face| face.map(|corner| corner + first)));
    }

    /// The corners of a triangle.
    #[must_use]
    pub fn corners(&self, face: [u32; 3]) -> [[f32; 3]; 3] {
        face.map(|corner| self.positions[corner as usize])
    }
}

impl World {
    /// Triangles that are stored.
    #[must_use]
    pub fn stored(&self) -> u64 {
        let inside: usize = self.meshes.iter().map(|mesh| mesh.faces.len()).sum();
        (self.fixed.faces.len() + inside) as u64
    }

    /// Triangles that can be hit, every place counted.
    #[must_use]
    pub fn shown(&self) -> u64 {
        let placed = self.places.iter().map(|place| self.meshes[place.mesh].faces.len() as u64);
        self.fixed.faces.len() as u64 + placed.sum::<u64>()
    }

    /// The same triangles without places, unless they are too many.
    ///
    /// # Errors
    /// Says how many they would be.
    pub fn flat(&self) -> Result<Cow<'_, Mesh>, String> {
        /// What fits a small machine with every library.
        const MOST: u64 = 8_000_000;
        if self.places.is_empty() {
            return Ok(Cow::Borrowed(&self.fixed));
        }
        if self.shown() > MOST {
            return Err(format!("{} triangles without instances", self.shown()));
        }
        let mut flat = self.fixed.clone();
        for place in &self.places {
            flat.append(&self.meshes[place.mesh], &place.world_from_mesh);
        }
        Ok(Cow::Owned(flat))
    }
}
