//! Primitives: attributes and indices made into triangles.

use std::collections::BTreeMap;

use glam::{Affine3A, Vec3A};
use nestray_shapes::triangle_mesh::Triangles;

use super::Reader;
use super::document::Primitive;

/// What is to be made of a primitive.
pub(super) struct Wanted<'a> {
    /// Which set of texture coordinates.
    pub(super) uv_set: usize,
    /// How much of each morph target.
    pub(super) weights: &'a [f32],
    /// Where the joints of the skin put what hangs on them alone.
    pub(super) joints: Option<&'a [Affine3A]>,
}

impl Reader<'_> {
    /// The triangles of a primitive; none, and a warning, if it is made of points or lines.
    pub(super) fn triangles(
        &mut self,
        primitive: &Primitive,
        wanted: &Wanted<'_>,
    ) -> Result<Option<Triangles>, String> {
        let mode = primitive.mode.unwrap_or(4);
        if !(4..=6).contains(&mode) {
            self.warn("points and lines are left out".into());
            return Ok(None);
        }
        let Some(&position) = primitive.attributes.get("POSITION") else {
            self.warn("primitives without POSITION are left out".into());
            return Ok(None);
        };
        let packed = self.document.accessors.get(position).is_some_and(|a| a.buffer_view.is_none());
        if packed && primitive.extensions.draco.is_some() {
            return Err("needs KHR_draco_mesh_compression, which is not read".into());
        }
        let positions = self.elements(position, &[3])?;
        let corners = self.corners(primitive, positions.count)?;
        let faces = faces(mode, &corners);
        if mode == 4 && corners.len() % 3 != 0 {
            self.warn("corners left over at the end of a list of triangles".into());
        }
        let vertices = Vertices::of(faces, positions.count);
        self.keep(vertices.faces.len().saturating_add(vertices.used().count()))?;
        let mut places: Vec<[f32; 3]> = vertices.used().map(|v| positions.array(v)).collect();
        let mut normals = self.attribute(&primitive.attributes, "NORMAL", &vertices)?;
        for (target, &weight) in primitive.targets.iter().zip(wanted.weights) {
            if weight != 0.0 {
                self.morph(target, "POSITION", weight, &vertices, &mut places)?;
                self.morph(target, "NORMAL", weight, &vertices, &mut normals)?;
            }
        }
        if let Some(joints) = wanted.joints {
            let blends = self.blends(&primitive.attributes, joints, &vertices)?;
            bend(&blends, &mut places, &mut normals);
        }
        let set = format!("TEXCOORD_{}", wanted.uv_set);
        let uvs = self.attribute::<2>(&primitive.attributes, &set, &vertices)?;
        let colors = self.colors(&primitive.attributes, &vertices)?;
        let made = Triangles::new(places, vertices.faces)
            .and_then(|mesh| mesh.with_normals(normals))
            .and_then(|mesh| mesh.with_uvs(uvs))
            .and_then(|mesh| mesh.with_colors(colors));
        let triangles = made.map_err(|error| error.to_string())?;
        match triangles.unusable() {
            0 => {}
            _ => self.warn("triangles have corners out of range and are not seen".into()),
        }
        Ok(Some(triangles))
    }

    /// The vertex of each corner, checked to be there.
    fn corners(&mut self, primitive: &Primitive, vertices: usize) -> Result<Vec<u32>, String> {
        let Some(accessor) = primitive.indices else {
            let count = u32::try_from(vertices).map_err(|_| "too many vertices")?;
            return Ok((0..count).collect());
        };
        let indices = self.elements(accessor, &[1])?;
        let corner = |i: usize| match indices.index(i, 0) {
            Some(index) if (index as usize) < vertices => Ok(index),
            Some(index) => Err(format!("indices name vertex {index}, but there are {vertices}")),
            None => Err("indices are no whole numbers".to_owned()),
        };
        (0..indices.count).map(corner).collect()
    }

    /// An attribute of the used vertices; empty if there is none.
    fn attribute<const N: usize>(
        &mut self,
        attributes: &BTreeMap<String, usize>,
        name: &str,
        vertices: &Vertices,
    ) -> Result<Vec<[f32; N]>, String> {
        let Some(&accessor) = attributes.get(name) else { return Ok(Vec::new()) };
        let elements = self.elements(accessor, &[N])?;
        vertices.agree(name, elements.count)?;
        Ok(vertices.used().map(|vertex| elements.array(vertex)).collect())
    }

    fn colors(
        &mut self,
        attributes: &BTreeMap<String, usize>,
        vertices: &Vertices,
    ) -> Result<Vec<[f32; 4]>, String> {
        let Some(&accessor) = attributes.get("COLOR_0") else { return Ok(Vec::new()) };
        let elements = self.elements(accessor, &[3, 4])?;
        vertices.agree("COLOR_0", elements.count)?;
        let color = |vertex: usize| {
            let [r, g, b] = elements.array(vertex);
            let alpha = if elements.width == 4 { elements.float(vertex, 3) } else { 1.0 };
            [r, g, b, alpha].map(|x| if x > 0.0 { x.min(1.0) } else { 0.0 })
        };
        Ok(vertices.used().map(color).collect())
    }

    /// Adds so much of a morph target, if it has this attribute.
    fn morph(
        &mut self,
        target: &BTreeMap<String, usize>,
        name: &str,
        weight: f32,
        vertices: &Vertices,
        values: &mut [[f32; 3]],
    ) -> Result<(), String> {
        let Some(accessor) = target.get(name).filter(|_| !values.is_empty()) else {
            return Ok(());
        };
        let elements = self.elements(*accessor, &[3])?;
        vertices.agree(name, elements.count)?;
        for (value, vertex) in values.iter_mut().zip(vertices.used()) {
            let moved =
                Vec3A::from_array(*value) + Vec3A::from_array(elements.array(vertex)) * weight;
            *value = moved.to_array();
        }
        Ok(())
    }
}

/// Moves every vertex by its own blend of joints.
fn bend(blends: &[Affine3A], places: &mut [[f32; 3]], normals: &mut [[f32; 3]]) {
    for (place, blend) in places.iter_mut().zip(blends) {
        *place = blend.transform_point3a(Vec3A::from_array(*place)).to_array();
    }
    for (normal, blend) in normals.iter_mut().zip(blends) {
        // Normals go by the cofactors, which are there even if a joint is flattened.
        let [x, y, z] = [blend.matrix3.x_axis, blend.matrix3.y_axis, blend.matrix3.z_axis];
        let [a, b, c] = *normal;
        *normal = (y.cross(z) * a + z.cross(x) * b + x.cross(y) * c).to_array();
    }
}

/// Corners grouped by threes, as lists, strips and fans do it.
fn faces(mode: u32, corners: &[u32]) -> Vec<[u32; 3]> {
    match mode {
        4 => corners.chunks_exact(3).map(|c| [c[0], c[1], c[2]]).collect(),
        5 => {
            let turned = |(i, c): (usize, &[u32])| match i % 2 {
                0 => [c[0], c[1], c[2]],
                _ => [c[0], c[2], c[1]],
            };
            corners.windows(3).enumerate().map(turned).collect()
        }
        _ => match corners.split_first() {
            Some((&hub, rim)) => rim.windows(2).map(|c| [c[0], c[1], hub]).collect(),
            None => Vec::new(),
        },
    }
}

/// Faces, and the vertices they use: often a few of a table that many primitives share.
pub(super) struct Vertices {
    faces: Vec<[u32; 3]>,
    /// In ascending order; none if all are used.
    some: Option<Vec<u32>>,
    all: usize,
}

impl Vertices {
    fn of(mut faces: Vec<[u32; 3]>, all: usize) -> Self {
        let mut used = vec![false; all];
        for &vertex in faces.as_flattened() {
            used[vertex as usize] = true;
        }
        if used.iter().all(|&used| used) {
            return Self { faces, some: None, all };
        }
        let mut renamed = vec![0; all];
        let mut some = Vec::new();
        for (vertex, _) in used.iter().enumerate().filter(|(_, used)| **used) {
            renamed[vertex] = some.len() as u32;
            some.push(vertex as u32);
        }
        for vertex in faces.as_flattened_mut() {
            *vertex = renamed[*vertex as usize];
        }
        Self { faces, some: Some(some), all }
    }

    /// The numbers of the used ones in the file.
    pub(super) fn used(&self) -> impl Iterator<Item = usize> + '_ {
        let count = self.some.as_ref().map_or(self.all, Vec::len);
        (0..count).map(|i| self.some.as_ref().map_or(i, |some| some[i] as usize))
    }

    /// Whether an attribute is there for each.
    pub(super) fn agree(&self, name: &str, count: usize) -> Result<(), String> {
        let vertices = self.all;
        if count >= vertices {
            return Ok(());
        }
        Err(format!("{count} of {name} for {vertices} vertices"))
    }
}
