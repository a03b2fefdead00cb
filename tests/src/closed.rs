//! Which meshes are closed, and points inside them.

use std::collections::{BTreeMap, HashMap};

use glam::Vec3A;
use nestray_core::aabb::Aabb;
use nestray_core::object::Object;
use nestray_core::ray::{Ray, RayKind};
use nestray_core::scratch::Scratch;
use nestray_registry::{Members, TECHNIQUES};
use nestray_scene::geometry::Content;
use nestray_scene::scene::Scene;
use nestray_shapes::triangle_mesh::{TriangleMesh, Triangles};
use serde_json::Value;

use crate::numbers::Numbers;

/// All meshes of a scene as one: vertices in the same place become one vertex, faces that then
/// have two corners in the same place are left out.
///
/// # Panics
/// If there are more vertices than a mesh can have.
#[must_use]
pub fn welded(scene: &Scene) -> Triangles {
    let (mut positions, mut faces) = (Vec::new(), Vec::new());
    let mut vertices = HashMap::new();
    for geometry in &scene.geometries {
        let Content::Mesh(mesh) = &geometry.content else { continue };
        for face in mesh.faces() {
            let [a, b, c] = face.map(|corner| {
                // −0 and 0 are the same place.
                let position = mesh.positions()[corner as usize].map(|x| x + 0.0);
                *vertices.entry(position.map(f32::to_bits)).or_insert_with(|| {
                    positions.push(position);
                    positions.len() as u32 - 1
                })
            });
            if a != b && b != c && c != a {
                faces.push([a, b, c]);
            }
        }
    }
    Triangles::new(positions, faces).expect("indices in range")
}

/// The edges of a mesh, the lower vertex first, with how often faces run along each and how
/// often against it.
#[must_use]
pub fn edges(mesh: &Triangles) -> BTreeMap<[u32; 2], [u32; 2]> {
    let mut edges = BTreeMap::new();
    for &[a, b, c] in mesh.faces() {
        for [from, to] in [[a, b], [b, c], [c, a]] {
            let count: &mut [u32; 2] = edges.entry([from.min(to), from.max(to)]).or_default();
            count[usize::from(from > to)] += 1;
        }
    }
    edges
}

/// How many times the mesh winds around a point: not 0 if the point is inside, whatever parts
/// overlap. The solid angle of all faces [Oosterom 83].
#[must_use]
pub fn winding(mesh: &Triangles, point: Vec3A) -> f64 {
    let half_angles = (0..mesh.count()).map(|face| {
        let [a, b, c] =
            mesh.corners(face).map(|v| Vec3A::from_array(v).as_dvec3() - point.as_dvec3());
        let (x, y, z) = (a.length(), b.length(), c.length());
        let volume = a.dot(b.cross(c));
        libm::atan2(volume, x * y * z + a.dot(b) * z + b.dot(c) * x + c.dot(a) * y)
    });
    half_angles.sum::<f64>() / (2.0 * std::f64::consts::PI)
}

/// Points inside a closed mesh: some deep inside, of few digits, from where most directions
/// to a vertex need no rounding, some anywhere, also close to a face.
///
/// # Panics
/// If there are hardly any.
#[must_use]
pub fn points_inside(mesh: &Triangles, count: usize) -> Vec<Vec3A> {
    let members = Members::Triangles(TriangleMesh::new(0, mesh.clone().into()));
    let nest = (TECHNIQUES[1].build)(&Value::Null, members).expect("defaults");
    let bounds = nest.bounds();
    let mut numbers = Numbers::new(9);
    let mut points = Vec::new();
    for _ in 0..100 * count {
        if points.len() == count {
            return points;
        }
        let point = between_faces(&*nest, bounds, &mut numbers, points.len().is_multiple_of(2));
        let is_inside = |point: &Vec3A| {
            let turns = winding(mesh, *point);
            turns.abs() > 0.5 && (turns - turns.round()).abs() < 1e-6
        };
        points.extend(point.filter(is_inside));
    }
    panic!("seed 9: only {} of {count} points are inside", points.len());
}

/// A point between two crossings of a line through the mesh.
fn between_faces(
    nest: &dyn Object,
    bounds: Aabb,
    numbers: &mut Numbers,
    round: bool,
) -> Option<Vec3A> {
    let size = bounds.size().length();
    let dir = numbers.direction();
    let start = bounds.min + bounds.size() * numbers.point() - dir * size;
    let mut hits = Vec::new();
    nest.all_hits(&Ray::new(start, dir, RayKind::Camera), &mut hits, &mut Scratch::new());
    hits.sort_by(|a, b| a.t.total_cmp(&b.t));
    let first = numbers.below(hits.len().max(2) - 1);
    let (a, b) = (hits.get(first)?.t, hits.get(first + 1)?.t);
    if !round {
        let part = *numbers.pick(&[1e-3, 0.03, 0.3, 0.6, 0.99, 0.9999]);
        return Some(start + dir * (a + (b - a) * part));
    }
    let digit = libm::exp2f(libm::floorf(libm::log2f(size / 256.0)));
    Some(((start + dir * ((a + b) * 0.5)) / digit).round() * digit)
}
