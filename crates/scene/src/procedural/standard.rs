//! Scenes as Haines' programs write them: fills, and the primitives after each [Haines 87].

use std::sync::Arc;

use glam::{DMat3, DVec3, Vec3A};
use nestray_shapes::any::AnyShape;
use nestray_shapes::cone::Cone;
use nestray_shapes::cylinder::Cylinder;
use nestray_shapes::patch::Patch;
use nestray_shapes::polygon::Polygon;
use nestray_shapes::shape::Sides;
use nestray_shapes::sphere::Sphere;

use crate::camera::Camera;
use crate::geometry::{Content, Geometry};
use crate::light::{Background, Light, LightKind};
use crate::material::Material;
use crate::scene::Scene;

/// The sky of most of the scenes.
pub(super) const SKY: [f32; 3] = [0.078, 0.361, 0.753];

/// Where a picture is taken from.
pub(super) struct Eye {
    pub(super) from: DVec3,
    pub(super) at: DVec3,
    pub(super) up: DVec3,
    pub(super) degrees: f32,
    pub(super) hither: f32,
    pub(super) resolution: u32,
}

/// What the primitives after it are made of.
pub(super) struct Fill {
    pub(super) color: [f64; 3],
    pub(super) kd: f32,
    pub(super) ks: f32,
    /// Half-angle of highlights, in degrees.
    pub(super) angle: f64,
    pub(super) t: f32,
    pub(super) ior: f32,
}

/// A scene that grows in the order of a file.
pub(super) struct Standard {
    scene: Scene,
    sides: Sides,
    name: String,
    shapes: Vec<AnyShape>,
}

impl Eye {
    /// An eye above the xy-plane with an angle of 45°.
    pub(super) fn above(from: [f64; 3], at: [f64; 3], hither: f32) -> Self {
        let [from, at] = [from, at].map(DVec3::from_array);
        Self { from, at, up: DVec3::Z, degrees: 45.0, hither, resolution: 512 }
    }
}

impl Fill {
    /// Without highlights.
    pub(super) fn matte(color: [f64; 3], kd: f32) -> Self {
        Self { color, kd, ks: 0.0, angle: 0.0, t: 0.0, ior: 0.0 }
    }

    /// Part mirror, with the highlight that most of the scenes use.
    pub(super) fn mirror(color: [f64; 3], kd: f32, ks: f32) -> Self {
        Self { color, kd, ks, angle: 37.0, t: 0.0, ior: 0.0 }
    }

    /// The Phong exponent that halves a highlight at the angle.
    fn shine(&self) -> f32 {
        if self.angle <= 0.0 {
            return 100_000.0;
        }
        if self.angle >= 90.0 {
            return 1.0;
        }
        (libm::log(0.5) / libm::log(libm::cos(self.angle.to_radians()))) as f32
    }
}

impl Standard {
    /// Nothing but an eye, lights, and the sky. The lights together are as bright as the root
    /// of their number, and nothing shines from everywhere: so the published pictures were
    /// made.
    pub(super) fn new(sky: [f32; 3], eye: &Eye, lights: &[[f64; 3]]) -> Self {
        let mut scene = Scene::new();
        let color = [1.0 / (lights.len() as f32).sqrt(); 3];
        scene.background = Background::Color(sky);
        for &light in lights {
            let position = single(DVec3::from_array(light));
            let kind = LightKind::Point { position, fades: false };
            scene.lights.push(Light { color, kind, ..Light::point(position, color) });
        }
        let (from, at) = (single(eye.from), single(eye.at));
        scene.cameras.push(Camera {
            forward: single(eye.at - eye.from),
            hither: eye.hither,
            resolution: Some([eye.resolution; 2]),
            ..Camera::looking(from, at, single(eye.up), eye.degrees)
        });
        Self { scene, sides: Sides::Both, name: String::new(), shapes: Vec::new() }
    }

    /// The primitives from here on are made of this, and seen from the front only unless
    /// it is transparent.
    pub(super) fn fill(&mut self, name: &str, fill: &Fill) {
        self.flush();
        let color = fill.color.map(|x| x as f32);
        let material = Material::from_nff(color, fill.kd, fill.ks, fill.shine(), fill.t, fill.ior);
        self.scene.add_material(Material { name: name.into(), ..material });
        self.name = name.into();
        self.sides = if fill.t > 0.0 { Sides::Both } else { Sides::Front };
    }

    /// The primitives of this fill are seen from both sides all the same.
    pub(super) fn two_sided(&mut self) {
        self.sides = Sides::Both;
    }

    pub(super) fn shape(&mut self, shape: impl Into<AnyShape>) {
        self.shapes.push(shape.into());
    }

    pub(super) fn sphere(&mut self, center: DVec3, radius: f64) {
        self.shape(Sphere { center: single(center), radius: radius as f32 });
    }

    pub(super) fn cylinder(&mut self, base: DVec3, apex: DVec3, radius: f64) {
        let (base, top) = (single(base), single(apex));
        self.shape(Cylinder { base, top, radius: radius as f32 });
    }

    pub(super) fn cone(&mut self, base: (DVec3, f64), apex: (DVec3, f64)) {
        self.shape(Cone {
            base: single(base.0),
            base_radius: base.1 as f32,
            apex: single(apex.0),
            apex_radius: apex.1 as f32,
        });
    }

    pub(super) fn polygon(&mut self, corners: &[DVec3]) {
        let corners: Vec<[f32; 3]> = corners.iter().map(|&v| single(v).to_array()).collect();
        self.shape(Polygon::new(corners));
    }

    /// A level square about the z-axis.
    pub(super) fn floor(&mut self, half: f64, z: f64) {
        let corner = |x: f64, y: f64| DVec3::new(x * half, y * half, z);
        self.polygon(&[corner(1.0, 1.0), corner(-1.0, 1.0), corner(-1.0, -1.0), corner(1.0, -1.0)]);
    }

    /// A triangle with a place and a normal for each corner.
    pub(super) fn patch(&mut self, corners: [(DVec3, DVec3); 3]) {
        let corners = corners.map(|(v, n)| (single(v).to_array(), single(n).to_array()));
        self.shape(Patch::new(&corners));
    }

    pub(super) fn finish(mut self) -> Scene {
        self.flush();
        self.scene
    }

    fn flush(&mut self) {
        if self.shapes.is_empty() {
            return;
        }
        let content = Content::Shapes(Arc::new(std::mem::take(&mut self.shapes)));
        let material = self.scene.materials.len() - 1;
        let name = std::mem::take(&mut self.name);
        self.scene.add(Geometry { name, material, sides: self.sides, content });
    }
}

/// Rounded to single precision; −0 becomes 0.
fn single(v: DVec3) -> Vec3A {
    v.as_vec3a() + 0.0
}

/// A turn by an angle about a unit vector, counter-clockwise seen from its tip.
pub(super) fn rotation(axis: DVec3, radians: f64) -> DMat3 {
    turn(axis, libm::sin(radians), libm::cos(radians))
}

/// A turn about a unit vector by an angle given by its sine and cosine.
pub(super) fn turn(axis: DVec3, sine: f64, cosine: f64) -> DMat3 {
    let column =
        |v: DVec3| v * cosine + axis.cross(v) * sine + axis * (axis.dot(v) * (1.0 - cosine));
    DMat3::from_cols(column(DVec3::X), column(DVec3::Y), column(DVec3::Z))
}
