//! What a hit looks like, looked up by its ids.

use std::hint::black_box;
use std::sync::Arc;

use glam::Affine3A;
use nestray_core::hit::{Hit, InstancePath};
use nestray_core::instance::{Motion as _, Still};
use nestray_core::object::{DynObject, Object};
use nestray_core::ray::Ray;
use nestray_core::surface::Surface;
use nestray_shapes::shape::Single;

use crate::geometry::{Content, Geometry};
use crate::group::Motion;
use crate::paths::{Paths, PathsError, Step};
use crate::scene::Scene;
use crate::solid::{Shell, Solid};

/// Finds the surface of a hit in a scene, whatever nest found the hit.
#[expect(missing_debug_implementations, reason = "objects say what they are by other ways")]
pub struct Surfaces<'a> {
    scene: &'a Scene,
    paths: Paths,
    /// The solids of each geometry.
    solids: Vec<Vec<DynObject>>,
}

/// A surface, and what it is made of.
#[derive(Clone, Copy, Debug)]
pub struct Point {
    /// The surface, in the world.
    pub surface: Surface,
    /// Its material.
    pub material: usize,
    /// Linear colour and alpha of the vertices there, white if they have none.
    pub color: [f32; 4],
}

impl<'a> Surfaces<'a> {
    /// For hits of this scene.
    ///
    /// # Errors
    /// If its places cannot be numbered.
    pub fn new(scene: &'a Scene) -> Result<Self, PathsError> {
        let paths = Paths::new(scene)?;
        let solids = (0..).zip(&scene.geometries).map(|(id, geometry)| objects(id, geometry));
        Ok(Self { scene, paths, solids: solids.collect() })
    }

    /// The scene.
    #[must_use]
    pub fn scene(&self) -> &'a Scene {
        self.scene
    }

    /// The numbers of its places.
    #[must_use]
    pub fn paths(&self) -> &Paths {
        &self.paths
    }

    /// What `ray` sees at `hit`.
    ///
    /// # Panics
    /// If the hit is none, or not of this scene.
    #[must_use]
    pub fn at(&self, ray: &Ray, hit: &Hit) -> Point {
        let geometry = &self.scene.geometries[hit.geometry as usize];
        let (surface, color) = match &geometry.content {
            Content::Mesh(triangles) => {
                let uv = [hit.u, hit.v];
                let surface = triangles.surface(hit.primitive, uv);
                let path = (self.paths.root(), hit.path.number());
                (self.outside(path, ray.time(), surface), triangles.color(hit.primitive, uv))
            }
            Content::Shapes(shapes) => {
                let single = Single::new(hit.geometry, &shapes[hit.primitive as usize]);
                (self.asked(&single, ray, &Hit { primitive: 0, ..*hit }), None)
            }
            Content::Solids(_) => {
                let solid = &self.solids[hit.geometry as usize][hit.primitive as usize];
                (self.asked(solid, ray, hit), None)
            }
        };
        Point { surface, material: geometry.material, color: color.unwrap_or([1.0; 4]) }
    }

    /// Brings near what [`at`](Self::at) will read of each hit: memory answers many questions
    /// asked at once sooner than one after the other.
    ///
    /// # Panics
    /// If one is not of this scene.
    pub fn touch(&self, hits: &[Hit]) {
        let mut sum = 0.0;
        for hit in hits.iter().filter(|hit| hit.is_some()) {
            if let Content::Mesh(triangles) = &self.scene.geometries[hit.geometry as usize].content
            {
                sum += triangles.touch(hit.primitive);
            }
        }
        black_box(sum);
    }

    /// A surface seen from outside the places of a path that begins in a group.
    fn outside(&self, (group, path): (usize, u32), time: f32, surface: Surface) -> Surface {
        let Some(Step { place, group: inner, rest }) = self.paths.step(group, path) else {
            return surface;
        };
        let inside = self.outside((inner, rest), time, surface);
        inside.transformed(&match &self.scene.groups[group].places[place].motion {
            Motion::Still(at) => *at,
            Motion::Keys(keys) => keys.world_from_object(time),
            Motion::Node(node) => self.scene.animation.world_from_node(*node, 0.0),
        })
    }

    /// The surface that an object within the places of a hit tells of it.
    fn asked(&self, object: &impl Object, ray: &Ray, hit: &Hit) -> Surface {
        let places = self.places(hit.path, ray.time());
        let inside = places.iter().fold(*ray, |ray, (to_from, _)| ray.entering(to_from, 1, 1));
        let surface = object.surface(&inside, &Hit { path: InstancePath::NONE, ..*hit });
        let surface = surface.expect("the hit is of it");
        places.iter().rev().fold(surface, |surface, (_, from_to)| surface.transformed(from_to))
    }

    /// Into and out of each place on a path, outermost first.
    fn places(&self, path: InstancePath, time: f32) -> Vec<(Affine3A, Affine3A)> {
        let place =
            |(group, place): (usize, usize)| match &self.scene.groups[group].places[place].motion {
                Motion::Still(at) => both(&Still::new(*at), time),
                Motion::Keys(keys) => both(keys, time),
                Motion::Node(node) => {
                    both(&Still::new(self.scene.animation.world_from_node(*node, 0.0)), time)
                }
            };
        self.paths.places(path).into_iter().map(place).collect()
    }
}

/// The solids of a geometry, to be asked for surfaces: no technique is needed for that.
fn objects(number: u32, geometry: &Geometry) -> Vec<DynObject> {
    let Content::Solids(solids) = &geometry.content else { return Vec::new() };
    let object = |(primitive, solid): (u32, &Solid)| {
        solid.object([number, primitive], geometry.sides, &|mesh| Arc::new(Shell::new(mesh)))
    };
    (0..).zip(solids.iter()).map(object).collect()
}

fn both(motion: &impl nestray_core::instance::Motion, time: f32) -> (Affine3A, Affine3A) {
    let to_from = motion.object_from_world(time).unwrap_or(Affine3A::IDENTITY);
    (to_from, motion.world_from_object(time))
}
