//! Scenes of one mesh, as the formats that hold nothing else make them.

use nestray_scene::geometry::Geometry;
use nestray_scene::material::Material;
use nestray_scene::scene::Scene;
use nestray_shapes::triangle_mesh::{MeshError, Triangles};

use crate::error::{LoadError, Warning};
use crate::load::{Loaded, Source};
use crate::polygon::Cutter;

/// Faces of any number of corners, checked to be in range.
#[derive(Debug, Default)]
pub(crate) struct Polygons {
    /// Corners of all, one after another.
    pub(crate) corners: Vec<u32>,
    /// Where each ends.
    pub(crate) ends: Vec<usize>,
}

impl Polygons {
    /// Ends a face that the latest corners make.
    pub(crate) fn end_face(&mut self) {
        self.ends.push(self.corners.len());
    }

    /// Cut into triangles. Says if faces were left out or could not be cut well.
    pub(crate) fn triangles(
        &self,
        positions: &[[f32; 3]],
        source: &Source,
        warnings: &mut Vec<Warning>,
    ) -> Vec<[u32; 3]> {
        let (mut faces, mut places) = (Vec::with_capacity(self.ends.len()), Vec::new());
        let (mut cutter, mut start, mut lines) = (Cutter::default(), 0, 0);
        for &end in &self.ends {
            let corners = &self.corners[start..end];
            start = end;
            match *corners {
                [a, b, c] => faces.push([a, b, c]),
                [] | [_] | [_, _] => lines += 1,
                _ => {
                    places.clear();
                    places.extend(corners.iter().map(|&corner| positions[corner as usize]));
                    cutter.cut(&places, |triangle| faces.push(triangle.map(|i| corners[i])));
                }
            }
        }
        if lines > 0 {
            let message = format!("{lines} faces of fewer than three corners are left out");
            warnings.push(source.spot().warning(message));
        }
        warn_given_up(&cutter, source, warnings);
        faces
    }
}

/// Says if polygons could not be cut well.
pub(crate) fn warn_given_up(cutter: &Cutter, source: &Source, warnings: &mut Vec<Warning>) {
    if cutter.given_up() > 0 {
        let message = format!("{} polygons are too intricate and cut roughly", cutter.given_up());
        warnings.push(source.spot().warning(message));
    }
}

/// Says if some triangles cannot be hit.
pub(crate) fn warn_unusable(triangles: &Triangles, source: &Source, warnings: &mut Vec<Warning>) {
    let unusable = triangles.unusable();
    if unusable > 0 {
        let message = format!("{unusable} triangles have corners out of range and are not seen");
        warnings.push(source.spot().warning(message));
    }
}

/// What vertices have, one each, or none at all but places.
#[derive(Debug, Default)]
pub(crate) struct Vertices {
    pub(crate) positions: Vec<[f32; 3]>,
    pub(crate) normals: Vec<[f32; 3]>,
    pub(crate) uvs: Vec<[f32; 2]>,
    pub(crate) colors: Vec<[f32; 4]>,
}

impl Vertices {
    /// The mesh of these faces, as a [`scene`].
    pub(crate) fn finish(
        self,
        faces: Vec<[u32; 3]>,
        source: &Source,
        warnings: Vec<Warning>,
    ) -> Result<Loaded, LoadError> {
        let triangles = Triangles::new(self.positions, faces)
            .and_then(|mesh| mesh.with_normals(self.normals))
            .and_then(|mesh| mesh.with_uvs(self.uvs))
            .and_then(|mesh| mesh.with_colors(self.colors))
            .map_err(|error| refused(source, &error))?;
        Ok(scene(triangles, source, warnings))
    }
}

/// That a mesh cannot be made.
pub(crate) fn refused(source: &Source, error: &MeshError) -> LoadError {
    source.spot().error(error.to_string())
}

/// A scene of one mesh of grey plaster, or of its own colours; empty if it has no triangle.
pub(crate) fn scene(triangles: Triangles, source: &Source, mut warnings: Vec<Warning>) -> Loaded {
    warn_unusable(&triangles, source, &mut warnings);
    let mut scene = Scene::new();
    if triangles.count() == 0 {
        let message = match triangles.positions().len() {
            0 => "holds nothing".to_owned(),
            points => format!("holds {points} points without faces, which are not seen"),
        };
        warnings.push(source.spot().warning(message));
        return Loaded { scene, warnings };
    }
    let mut material = Material::default();
    if !triangles.colors().is_empty() {
        material.base_color = [1.0; 3];
    }
    let material = scene.add_material(material);
    let name = source.path.file_stem().unwrap_or_default().to_string_lossy();
    scene.add(Geometry::mesh(name, material, triangles));
    Loaded { scene, warnings }
}
