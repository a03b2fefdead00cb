//! Worlds and scenes for tests.

use std::sync::Arc;

use glam::Vec3A;
use nestray_core::accel::Accel;
use nestray_core::instance::Instance;
use nestray_core::moving::Moving;
use nestray_core::object::DynObject;
use nestray_scene::camera::Camera;
use nestray_scene::geometry::{Content, Geometry};
use nestray_scene::group::Motion;
use nestray_scene::light::Background;
use nestray_scene::material::Material;
use nestray_scene::paths::Paths;
use nestray_scene::picture::{Layer, Picture};
use nestray_scene::scene::Scene;
use nestray_scene::solid::Solid;
use nestray_shapes::any::AnyShape;
use nestray_shapes::parallelogram::Parallelogram;
use nestray_shapes::shape::Single;
use nestray_shapes::sphere::Sphere;
use nestray_shapes::triangle_mesh::TriangleMesh;
use nestray_techniques::bvh::Bvh;

use crate::options::{Integrator, Options};
use crate::render::{Rendered, render};
use crate::watch::Unwatched;

/// Everything in the scene, in plain hierarchies.
pub(crate) fn world(scene: &Scene) -> DynObject {
    let paths = Paths::new(scene).expect("the scene can be numbered");
    group(scene, &paths, scene.root)
}

fn group(scene: &Scene, paths: &Paths, which: usize) -> DynObject {
    let parts = &scene.groups[which];
    let mut objects: Vec<DynObject> = Vec::new();
    for &number in &parts.geometries {
        objects.push(geometry(number as u32, &scene.geometries[number]));
    }
    for (place, &number) in parts.places.iter().zip(paths.numbers(which)) {
        let inside = group(scene, paths, place.group);
        objects.push(match &place.motion {
            Motion::Still(at) => Arc::new(Instance::new(number, inside, *at)),
            Motion::Keys(keys) => Arc::new(Moving::new(number, inside, keys.clone())),
            Motion::Node(_) => panic!("frames have no nodes"),
        });
    }
    Arc::new(Accel::new(Bvh::default(), objects))
}

fn geometry(number: u32, geometry: &Geometry) -> DynObject {
    match &geometry.content {
        Content::Mesh(triangles) => {
            let mesh = TriangleMesh::new(number, Arc::clone(triangles));
            Arc::new(Accel::new(Bvh::default(), mesh.seen_from(geometry.sides)))
        }
        Content::Shapes(shapes) => {
            let single = |(primitive, shape): (usize, &AnyShape)| Single {
                geometry: number,
                primitive: primitive as u32,
                sides: geometry.sides,
                shape: shape.clone(),
            };
            let singles: Vec<Single<AnyShape>> = shapes.iter().enumerate().map(single).collect();
            Arc::new(Accel::new(Bvh::default(), singles))
        }
        Content::Solids(solids) => {
            let mesh = |mesh| Arc::new(Accel::new(Bvh::default(), mesh)) as DynObject;
            let object = |(primitive, solid): (u32, &Solid)| {
                solid.object([number, primitive], geometry.sides, &mesh)
            };
            let objects: Vec<DynObject> = (0..).zip(solids.iter()).map(object).collect();
            Arc::new(Accel::new(Bvh::default(), objects))
        }
    }
}

/// A scene without light, seen from +z.
pub(crate) fn empty() -> Scene {
    let mut scene = Scene::new();
    scene.cameras.push(Camera::default());
    scene
}

/// Adds a shape of a material.
pub(crate) fn add(scene: &mut Scene, shape: impl Into<AnyShape>, material: Material) -> usize {
    let material = scene.add_material(material);
    scene.add(Geometry::shapes("", material, vec![shape.into()]))
}

/// A sphere about a point.
pub(crate) fn sphere(center: [f32; 3], radius: f32) -> Sphere {
    Sphere { center: Vec3A::from_array(center), radius }
}

/// A square in the plane z = `height`, its front up, `half` to each side of the z-axis.
pub(crate) fn floor(height: f32, half: f32) -> Parallelogram {
    Parallelogram {
        corner: Vec3A::new(-half, -half, height),
        u: Vec3A::X * (2.0 * half),
        v: Vec3A::Y * (2.0 * half),
    }
}

/// Chalk that gives back this share of light, by Lambert's law alone.
pub(crate) fn chalk(share: f32) -> Material {
    Material { base_color: [share; 3], ior: 1.0, ..Material::default() }
}

/// A lamp.
pub(crate) fn lamp(radiance: f32) -> Material {
    Material { emission: [radiance; 3], ..chalk(0.0) }
}

/// Even light from everywhere.
pub(crate) fn sky(radiance: f32) -> Background {
    Background::Color([radiance; 3])
}

/// Few pixels, few samples.
pub(crate) fn quick(integrator: Integrator, samples: u32) -> Options {
    Options { resolution: [24, 18], samples, integrator, threads: 1, ..Options::default() }
}

/// [`render`] with a world made for it.
pub(crate) fn picture(scene: &Scene, options: &Options) -> Rendered {
    render(scene, &*world(scene), options, &Unwatched).expect("it can be rendered")
}

/// One pixel of a layer.
pub(crate) fn pixel(picture: &Picture, name: &str, x: usize, y: usize) -> Vec<f32> {
    let layer = layer(picture, name);
    let channels = layer.channels.len();
    layer.samples[(y * picture.width + x) * channels..][..channels].to_vec()
}

pub(crate) fn layer<'a>(picture: &'a Picture, name: &str) -> &'a Layer {
    picture.layers.iter().find(|layer| layer.name == name).expect("there is such a layer")
}

/// The mean of the main layer.
pub(crate) fn mean(picture: &Picture) -> f64 {
    let samples = &picture.layers[0].samples;
    samples.iter().map(|&x| f64::from(x)).sum::<f64>() / samples.len() as f64
}
