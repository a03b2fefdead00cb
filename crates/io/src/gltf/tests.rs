//! What real files and made-up ones become.

mod broken;
mod made;
mod real;

use nestray_scene::geometry::Content;
use nestray_scene::scene::Scene;

use crate::error::LoadError;
use crate::load::{LoadOptions, Loaded, Source};

/// Reads a document that is given as text.
fn text(json: &str) -> Result<Loaded, LoadError> {
    bytes(json.as_bytes())
}

/// Reads the bytes of a file, as they are: nothing is added.
fn bytes(bytes: &[u8]) -> Result<Loaded, LoadError> {
    let options = LoadOptions { complete: false, ..LoadOptions::default() };
    crate::load::read(bytes, &Source { path: "made.glb".into(), options })
}

/// Triangles, each counted once.
fn triangles(scene: &Scene) -> usize {
    scene.geometries.iter().map(|geometry| geometry.primitives() as usize).sum()
}

/// The mesh of a geometry.
fn mesh(scene: &Scene, geometry: usize) -> &nestray_shapes::triangle_mesh::Triangles {
    match &scene.geometries[geometry].content {
        Content::Mesh(triangles) => triangles,
        other => panic!("a mesh, not {other:?}"),
    }
}
