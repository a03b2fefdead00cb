//! Primitives that glow.

use glam::{Affine3A, Vec3A};
use nestray_core::instance::{Motion as _, Still};
use nestray_core::surface::Surface;
use nestray_scene::geometry::Content;
use nestray_scene::group::Motion;
use nestray_scene::scene::Scene;
use nestray_scene::surfaces::Point;
use nestray_shapes::any::AnyShape;

use super::outline::{Outline, is_mirrored};
use crate::look;

/// One glowing primitive in one place.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Emitter {
    pub(crate) geometry: u32,
    pub(crate) primitive: u32,
    /// Number of its path.
    pub(crate) path: u32,
    /// Which [`Standing`].
    pub(crate) standing: u32,
}

/// Where an instance stands.
#[derive(Clone, Debug)]
pub(crate) enum Standing {
    /// Always here.
    Still(Affine3A),
    /// In places, outermost first, some of which move.
    Moving(Vec<Motion>),
}

/// A place on an emitter.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Spot {
    pub(crate) position: Vec3A,
    pub(crate) emission: Vec3A,
    /// Per solid angle.
    pub(crate) density: f32,
}

impl Standing {
    /// `world_from_object`.
    pub(crate) fn at(&self, time: f32) -> Affine3A {
        match self {
            Self::Still(at) => *at,
            Self::Moving(motions) => {
                motions.iter().fold(Affine3A::IDENTITY, |all, motion| all * place(motion, time))
            }
        }
    }
}

/// `world_from_object` of one place; nodes are those of a frame already.
pub(crate) fn place(motion: &Motion, time: f32) -> Affine3A {
    match motion {
        Motion::Still(at) => Still::new(*at).world_from_object(time),
        Motion::Keys(keys) => keys.world_from_object(time),
        Motion::Node(_) => Affine3A::IDENTITY,
    }
}

impl Emitter {
    /// What hits of it are called.
    pub(crate) fn name(&self) -> (u32, u32, u32) {
        (self.geometry, self.primitive, self.path)
    }

    /// Its surface, placed by `to`; none if places on it cannot be picked.
    pub(crate) fn outline(&self, scene: &Scene, to: &Affine3A) -> Option<Outline> {
        match &scene.geometries[self.geometry as usize].content {
            Content::Mesh(triangles) => {
                if !triangles.is_usable(self.primitive) {
                    return None;
                }
                let corner = |c: [f32; 3]| to.transform_point3a(Vec3A::from_array(c));
                let [a, b, c] = triangles.corners(self.primitive).map(corner);
                let mirrored = is_mirrored(to);
                Some(Outline::Triangle { corner: a, sides: [b - a, c - a], mirrored })
            }
            Content::Shapes(shapes) => outline_of(&shapes[self.primitive as usize], to),
            Content::Solids(_) => None,
        }
    }

    /// A place on it that can be seen from `at`.
    pub(crate) fn sample(
        &self,
        scene: &Scene,
        standing: &[Standing],
        at: Vec3A,
        time: f32,
        u: [f32; 2],
    ) -> Option<Spot> {
        let to = standing[self.standing as usize].at(time);
        let place = self.outline(scene, &to)?.sample(at, u)?;
        let front = place.normal.dot(at - place.position) > 0.0;
        let geometry = &scene.geometries[self.geometry as usize];
        if !geometry.sides.show(front) {
            return None;
        }
        let emission = self.emission(scene, place.uv);
        let position = Surface {
            error: place.position.abs() * 1e-6,
            ..Surface::new(place.position, place.normal)
        }
        .leave(at - place.position);
        (emission.max_element() > 0.0).then_some(Spot {
            position,
            emission,
            density: place.density,
        })
    }

    /// How often [`sample`](Self::sample) picks what is seen there.
    pub(crate) fn density(
        &self,
        scene: &Scene,
        standing: &[Standing],
        at: Vec3A,
        time: f32,
        seen: &Surface,
    ) -> f32 {
        let to = standing[self.standing as usize].at(time);
        let outline = self.outline(scene, &to);
        outline.map_or(0.0, |outline| outline.density(at, seen.position, seen.normal))
    }

    /// What it gives off at coordinates of a triangle; less where it is not all there.
    pub(crate) fn emission(&self, scene: &Scene, uv: [f32; 2]) -> Vec3A {
        let geometry = &scene.geometries[self.geometry as usize];
        let material = &scene.materials[geometry.material];
        let Content::Mesh(triangles) = &geometry.content else {
            return Vec3A::from(material.emission) * material.alpha_there();
        };
        let surface = triangles.surface(self.primitive, uv);
        let color = triangles.color(self.primitive, uv).unwrap_or([1.0; 4]);
        let point = Point { surface, material: geometry.material, color };
        look::emission(scene, material, surface.uv) * look::opacity(scene, &point)
    }
}

/// Opacity where nothing varies it.
trait AlphaThere {
    fn alpha_there(&self) -> f32;
}

impl AlphaThere for nestray_scene::material::Material {
    fn alpha_there(&self) -> f32 {
        use nestray_scene::material::AlphaMode;
        match self.alpha_mode {
            AlphaMode::Opaque => 1.0,
            AlphaMode::Mask(least) => f32::from(u8::from(self.alpha >= least)),
            AlphaMode::Blend => self.alpha.clamp(0.0, 1.0),
        }
    }
}

/// The surface of a shape that places can be picked on.
fn outline_of(shape: &AnyShape, to: &Affine3A) -> Option<Outline> {
    match shape {
        AnyShape::Sphere(sphere) => {
            (sphere.radius > 0.0).then(|| Outline::sphere(sphere.center, sphere.radius, to))
        }
        AnyShape::Disk(disk) => Outline::disk(disk.center, disk.normal, disk.radius, to),
        AnyShape::Parallelogram(flat) => {
            Some(Outline::parallelogram(flat.corner, [flat.u, flat.v], to))
        }
        _ => None,
    }
}
