//! What a mesh is made of.

use std::fmt;

use glam::Vec3A;
use nestray_core::aabb::Aabb;
use nestray_core::ray::Ray;

use super::polygon::Polygon;

/// Vertices and the triangles between them, checked.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Triangles {
    /// Places of the vertices. No coordinate is −0.
    pub(crate) positions: Vec<[f32; 3]>,
    /// The three vertices of each triangle, counter-clockwise seen from its front.
    pub(crate) faces: Vec<[u32; 3]>,
    /// One unit normal per vertex, or none at all.
    pub(crate) normals: Vec<[f32; 3]>,
    /// One pair of texture coordinates per vertex, or none at all.
    pub(crate) uvs: Vec<[f32; 2]>,
    /// One linear colour with alpha per vertex, or none at all.
    pub(crate) colors: Vec<[f32; 4]>,
}

/// Why data makes no mesh.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MeshError {
    /// A face names a vertex that is not there.
    Index {
        /// Which face.
        face: usize,
        /// What it names.
        index: u32,
        /// How many vertices there are.
        vertices: usize,
    },
    /// There are more vertices or faces than 32 bits can number.
    TooLarge,
    /// There are not as many normals, texture coordinates or colours as vertices.
    Attribute {
        /// What there are too few or too many of.
        what: &'static str,
        /// How many there are.
        found: usize,
        /// How many vertices there are.
        vertices: usize,
    },
}

impl fmt::Display for MeshError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Index { face, index, vertices } => {
                write!(f, "face {face} names vertex {index}, but there are {vertices}")
            }
            Self::TooLarge => write!(f, "more than 4 thousand million vertices or faces"),
            Self::Attribute { what, found, vertices } => {
                write!(f, "{found} {what} for {vertices} vertices")
            }
        }
    }
}

impl std::error::Error for MeshError {}

impl Triangles {
    /// A mesh of vertices and faces only; face `i` is triangle `i`.
    ///
    /// # Errors
    /// If a face names a vertex that is not there.
    pub fn new(mut positions: Vec<[f32; 3]>, faces: Vec<[u32; 3]>) -> Result<Self, MeshError> {
        if positions.len() >= u32::MAX as usize || faces.len() >= u32::MAX as usize {
            return Err(MeshError::TooLarge);
        }
        for (face, corners) in faces.iter().enumerate() {
            if let Some(&index) = corners.iter().find(|&&v| v as usize >= positions.len()) {
                return Err(MeshError::Index { face, index, vertices: positions.len() });
            }
        }
        // Adding 0 makes −0 and 0 the same.
        for position in &mut positions {
            *position = position.map(|x| x + 0.0);
        }
        Ok(Self { positions, faces, ..Self::default() })
    }

    /// Triangles with corners of their own.
    #[must_use]
    pub fn from_corners(corners: &[[Vec3A; 3]]) -> Self {
        let positions = corners.iter().flatten().map(|corner| corner.to_array()).collect();
        let faces = (0..corners.len() as u32).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
        Self::new(positions, faces).expect("every face has its own corners")
    }

    /// The same with a normal per vertex, which is made a unit one; an empty list is none.
    ///
    /// # Errors
    /// If there are not as many as vertices.
    pub fn with_normals(mut self, normals: Vec<[f32; 3]>) -> Result<Self, MeshError> {
        self.fits("normals", normals.len())?;
        self.normals = normals
            .into_iter()
            .map(|n| Vec3A::from_array(n).normalize_or_zero().to_array())
            .collect();
        Ok(self)
    }

    /// The same with texture coordinates per vertex; an empty list is none.
    ///
    /// # Errors
    /// If there are not as many as vertices.
    pub fn with_uvs(mut self, uvs: Vec<[f32; 2]>) -> Result<Self, MeshError> {
        self.fits("texture coordinates", uvs.len())?;
        self.uvs = uvs;
        Ok(self)
    }

    /// The same with a linear colour and alpha per vertex; an empty list is none.
    ///
    /// # Errors
    /// If there are not as many as vertices.
    pub fn with_colors(mut self, colors: Vec<[f32; 4]>) -> Result<Self, MeshError> {
        self.fits("colours", colors.len())?;
        self.colors = colors;
        Ok(self)
    }

    fn fits(&self, what: &'static str, found: usize) -> Result<(), MeshError> {
        let vertices = self.positions.len();
        if found == 0 || found == vertices {
            Ok(())
        } else {
            Err(MeshError::Attribute { what, found, vertices })
        }
    }

    /// Places of the vertices.
    #[must_use]
    pub fn positions(&self) -> &[[f32; 3]] {
        &self.positions
    }

    /// The three vertices of each triangle.
    #[must_use]
    pub fn faces(&self) -> &[[u32; 3]] {
        &self.faces
    }

    /// One unit normal per vertex, or none at all.
    #[must_use]
    pub fn normals(&self) -> &[[f32; 3]] {
        &self.normals
    }

    /// One pair of texture coordinates per vertex, or none at all.
    #[must_use]
    pub fn uvs(&self) -> &[[f32; 2]] {
        &self.uvs
    }

    /// One linear colour with alpha per vertex, or none at all.
    #[must_use]
    pub fn colors(&self) -> &[[f32; 4]] {
        &self.colors
    }

    /// How many triangles there are.
    #[must_use]
    pub fn count(&self) -> u32 {
        self.faces.len() as u32
    }

    /// The corners of a triangle.
    #[inline]
    #[must_use]
    pub fn corners(&self, triangle: u32) -> [[f32; 3]; 3] {
        self.faces[triangle as usize].map(|vertex| self.positions[vertex as usize])
    }

    /// Whether triangles have few vertices in common: more than two of each three are their
    /// own. Then a layout without shared vertices is smaller.
    #[must_use]
    pub fn is_soup(&self) -> bool {
        self.positions.len() > 2 * self.faces.len()
    }

    /// Whether a triangle can be hit at all: its corners are in range.
    #[must_use]
    pub fn is_usable(&self, triangle: u32) -> bool {
        self.corners(triangle).as_flattened().iter().all(|x| x.abs() <= Ray::FARTHEST)
    }

    /// How many triangles cannot be hit; for warnings.
    #[must_use]
    pub fn unusable(&self) -> usize {
        (0..self.count()).filter(|&triangle| !self.is_usable(triangle)).count()
    }

    /// The box around a triangle; empty if it cannot be hit.
    #[must_use]
    pub fn bounds(&self, triangle: u32) -> Aabb {
        let [a, b, c] = self.corners(triangle).map(Vec3A::from_array);
        let largest = a.abs().max(b.abs()).max(c.abs());
        // NaN would not survive a maximum, but a sum.
        let is_usable = largest.cmple(Vec3A::splat(Ray::FARTHEST)).all() && !(a + b + c).is_nan();
        if !is_usable {
            return Aabb::EMPTY;
        }
        Aabb { min: a.min(b).min(c), max: a.max(b).max(c) }
    }

    /// How far a triangle reaches along `direction`.
    #[must_use]
    pub fn along(&self, triangle: u32, direction: Vec3A) -> [f32; 2] {
        let reach = self.corners(triangle).map(|corner| Vec3A::from_array(corner).dot(direction));
        [reach[0].min(reach[1]).min(reach[2]), reach[0].max(reach[1]).max(reach[2])]
    }

    /// A box around the part of a triangle inside `cell`, rounded outwards; empty if none is.
    #[must_use]
    pub fn clipped(&self, triangle: u32, cell: &Aabb) -> Aabb {
        let whole = self.bounds(triangle);
        if !whole.overlaps(cell) {
            return Aabb::EMPTY;
        }
        // Cut from one to the other and back.
        let mut parts = [Polygon::new(self.corners(triangle)), Polygon::EMPTY];
        let [part, room] = &mut parts;
        let (mut part, mut room) = (part, room);
        for axis in 0..3 {
            let walls = [(cell.min[axis], 1.0), (cell.max[axis], -1.0)];
            let is_cut = [whole.min[axis] < walls[0].0, whole.max[axis] > walls[1].0];
            for ((wall, side), _) in walls.into_iter().zip(is_cut).filter(|(_, is_cut)| *is_cut) {
                part.cut(axis, f64::from(wall), side, room);
                (part, room) = (room, part);
            }
        }
        if part.is_full {
            return whole.meet(*cell);
        }
        let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
        for corner in part.corners() {
            for axis in 0..3 {
                low[axis] = low[axis].min(corner[axis]);
                high[axis] = high[axis].max(corner[axis]);
            }
        }
        if part.corners().is_empty() {
            return Aabb::EMPTY;
        }
        crate::shape::bounds_from(low, high).meet(whole.meet(*cell))
    }
}
