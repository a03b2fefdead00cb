//! The faces of one object and material, and the mesh they make.

use std::collections::HashMap;

use glam::Vec3A;
use nestray_shapes::triangle_mesh::{MeshError, Triangles};

use crate::polygon::Cutter;

/// Stands for no texture coordinate or normal.
pub(super) const NONE: u32 = u32::MAX;

/// The place, texture coordinate and normal of a corner, counted from 0.
pub(super) type Corner = [u32; 3];

/// What corners name.
#[derive(Debug, Default)]
pub(super) struct Pools {
    pub(super) positions: Vec<[f32; 3]>,
    /// None, or one per position.
    pub(super) colors: Vec<[f32; 4]>,
    pub(super) uvs: Vec<[f32; 2]>,
    pub(super) normals: Vec<[f32; 3]>,
}

/// Faces that become one geometry.
#[derive(Debug)]
pub(super) struct Part {
    pub(super) name: String,
    pub(super) material: usize,
    pub(super) corners: Vec<Corner>,
    /// Where each face ends.
    pub(super) ends: Vec<usize>,
}

impl Part {
    pub(super) fn new(name: String, material: usize) -> Self {
        Self { name, material, corners: Vec::new(), ends: Vec::new() }
    }

    /// The mesh, one vertex for all corners that are alike. Where only some corners have
    /// normals, the others get that of their face.
    pub(super) fn build(
        mut self,
        pools: &Pools,
        cutter: &mut Cutter,
    ) -> Result<Triangles, MeshError> {
        let own = |index: u32, count: usize| if (index as usize) < count { index } else { NONE };
        for corner in &mut self.corners {
            corner[1] = own(corner[1], pools.uvs.len());
            corner[2] = own(corner[2], pools.normals.len());
        }
        let extra = self.fill_normals(pools);
        let mut vertices: Vec<Corner> = Vec::new();
        let mut numbers: HashMap<Corner, u32> = HashMap::new();
        let mut faces = Vec::with_capacity(self.ends.len());
        let (mut start, mut places, mut face) = (0, Vec::new(), Vec::new());
        for &end in &self.ends {
            let corners = &self.corners[start..end];
            start = end;
            face.clear();
            face.extend(corners.iter().map(|corner| {
                *numbers.entry(*corner).or_insert_with(|| {
                    vertices.push(*corner);
                    vertices.len() as u32 - 1
                })
            }));
            places.clear();
            places.extend(corners.iter().map(|corner| pools.positions[corner[0] as usize]));
            cutter.cut(&places, |triangle| faces.push(triangle.map(|i| face[i])));
        }
        let all = |which: usize| vertices.iter().map(move |vertex| vertex[which] as usize);
        let mesh = Triangles::new(all(0).map(|i| pools.positions[i]).collect(), faces)?;
        let uv = |i: usize| pools.uvs.get(i).copied().unwrap_or_default();
        let normal = |i: usize| {
            let made = || extra.get(i - pools.normals.len()).copied().unwrap_or_default();
            pools.normals.get(i).copied().unwrap_or_else(made)
        };
        let some = |which: usize| all(which).any(|i| i != NONE as usize);
        let (uvs, normals) = (some(1), some(2));
        let mesh = mesh.with_uvs(if uvs { all(1).map(uv).collect() } else { vec![] })?;
        let mesh =
            mesh.with_normals(if normals { all(2).map(normal).collect() } else { vec![] })?;
        let colored = !pools.colors.is_empty();
        mesh.with_colors(if colored { all(0).map(|i| pools.colors[i]).collect() } else { vec![] })
    }

    /// Gives corners without a normal that of their face, if others have one. The new normals
    /// are numbered on from those there are.
    fn fill_normals(&mut self, pools: &Pools) -> Vec<[f32; 3]> {
        let lacks = |corner: &Corner| corner[2] == NONE;
        let mut extra = Vec::new();
        if self.corners.iter().all(lacks) || !self.corners.iter().any(lacks) {
            return extra;
        }
        let mut start = 0;
        for &end in &self.ends {
            let corners = &mut self.corners[start..end];
            start = end;
            if !corners.iter().any(lacks) {
                continue;
            }
            let at = |i: usize| {
                Vec3A::from_array(pools.positions[corners[i % corners.len()][0] as usize])
            };
            let first = at(0);
            let normal: Vec3A =
                (1..corners.len()).map(|i| (at(i) - first).cross(at(i + 1) - first)).sum();
            let number = pools.normals.len() + extra.len();
            extra.push(normal.normalize_or_zero().to_array());
            for corner in corners.iter_mut().filter(|corner| lacks(corner)) {
                corner[2] = number as u32;
            }
        }
        extra
    }
}
