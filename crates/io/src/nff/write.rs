//! Scenes written as NFF.

use std::io::{self, Write};

use glam::{Affine3A, Vec3A};
use nestray_scene::camera::Projection;
use nestray_scene::geometry::{Content, Geometry};
use nestray_scene::group::Motion;
use nestray_scene::light::{Background, LightKind};
use nestray_scene::material::{AlphaMode, Material, Whitted};
use nestray_scene::paths::{Paths, PathsError};
use nestray_scene::scene::Scene;
use nestray_shapes::any::AnyShape;
use nestray_shapes::shape::{Shape, Sides};
use nestray_shapes::triangle_mesh::Triangles;

use crate::nff::general::General;

/// Why a scene cannot be written.
#[derive(Debug, thiserror::Error)]
pub enum NffError {
    /// NFF has no word for something.
    #[error("NFF cannot hold {0}")]
    Unknown(String),
    /// Groups that cannot be walked through.
    #[error(transparent)]
    Paths(#[from] PathsError),
    /// The bytes cannot be stored.
    #[error(transparent)]
    Io(#[from] io::Error),
}

/// Writes a scene, with six digits to each number: its first camera, lights that do not get
/// weaker, and shapes, instances each for itself; meshes become polygons or patches. That
/// something opaque is seen from both sides, names, and texture coordinates are left out.
///
/// # Errors
/// If the scene has what NFF has no word for, or the bytes cannot be stored.
pub fn write_nff(scene: &Scene, out: &mut impl Write) -> Result<(), NffError> {
    /// More make a file that nobody reads.
    const MOST: u64 = 100_000_000;
    Paths::new(scene)?;
    if scene.primitives() > MOST {
        return Err(unknown(format!("{} primitives, every instance counted", scene.primitives())));
    }
    let mut writer = Writer { scene, out };
    writer.view()?;
    writer.lights()?;
    writer.group(scene.root, &Affine3A::IDENTITY)
}

struct Writer<'a, W> {
    scene: &'a Scene,
    out: &'a mut W,
}

fn unknown(what: impl Into<String>) -> NffError {
    NffError::Unknown(what.into())
}

impl<W: Write> Writer<'_, W> {
    fn view(&mut self) -> Result<(), NffError> {
        match &self.scene.background {
            Background::Color([r, g, b]) => {
                writeln!(self.out, "b {} {} {}", General(*r), General(*g), General(*b))?;
            }
            Background::Gradient(..) => return Err(unknown("a background that is no even colour")),
            Background::Environment { .. } => return Err(unknown("an environment")),
        }
        let Some(camera) = self.scene.cameras.first() else { return Ok(()) };
        let Projection::Perspective { degrees } = camera.projection else {
            return Err(unknown("a camera without perspective"));
        };
        if camera.node.is_some() {
            return Err(unknown("a camera that moves"));
        }
        if camera.aperture > 0.0 {
            return Err(unknown("a camera with a lens"));
        }
        let [width, height] = camera.resolution.unwrap_or([512; 2]);
        let triple = |v: Vec3A| format!("{} {} {}", General(v.x), General(v.y), General(v.z));
        writeln!(self.out, "v\nfrom {}", triple(camera.from))?;
        writeln!(self.out, "at {}", triple(camera.from + camera.forward))?;
        writeln!(self.out, "up {}\nangle {}", triple(camera.up), General(degrees))?;
        writeln!(self.out, "hither {}\nresolution {width} {height}", General(camera.hither))?;
        Ok(())
    }

    fn lights(&mut self) -> Result<(), NffError> {
        let usual = [1.0 / (self.scene.lights.len() as f32).sqrt(); 3];
        for light in &self.scene.lights {
            let LightKind::Point { position, fades: false } = light.kind else {
                return Err(unknown("lights other than points that do not get weaker"));
            };
            if light.node.is_some() {
                return Err(unknown("a light that moves"));
            }
            write!(self.out, "l")?;
            self.numbers(&position.to_array())?;
            if light.color != usual {
                self.numbers(&light.color)?;
            }
            writeln!(self.out)?;
        }
        Ok(())
    }

    fn group(&mut self, group: usize, place: &Affine3A) -> Result<(), NffError> {
        let group = &self.scene.groups[group];
        for &geometry in &group.geometries {
            let geometry = &self.scene.geometries[geometry];
            self.fill(&self.scene.materials[geometry.material], geometry)?;
            match &geometry.content {
                Content::Mesh(triangles) => self.mesh(triangles, geometry.sides, place)?,
                Content::Shapes(shapes) => {
                    shapes.iter().try_for_each(|shape| self.shape(shape, geometry.sides, place))?;
                }
                Content::Solids(_) => return Err(unknown("solids made of solids")),
            }
        }
        for inner in &group.places {
            let Motion::Still(at) = &inner.motion else {
                return Err(unknown(format!("the moving place {:?}", inner.name)));
            };
            self.group(inner.group, &(*place * *at))?;
        }
        Ok(())
    }

    fn fill(&mut self, material: &Material, geometry: &Geometry) -> Result<(), NffError> {
        let name = &material.name;
        let textures = [
            material.base_texture,
            material.metallic_roughness_texture,
            material.normal_texture,
            material.emission_texture,
        ];
        if textures.iter().any(Option::is_some) {
            return Err(unknown(format!("the textures of material {name:?}")));
        }
        if material.glows() {
            return Err(unknown(format!("the glow of material {name:?}")));
        }
        if material.alpha_mode != AlphaMode::Opaque && material.alpha < 1.0 {
            return Err(unknown(format!("the opacity of material {name:?}")));
        }
        if let Content::Mesh(triangles) = &geometry.content
            && !triangles.colors().is_empty()
        {
            return Err(unknown(format!("the colours of vertices of {:?}", geometry.name)));
        }
        let Whitted { color: [r, g, b], kd, ks, shine, t } = whitted(material);
        write!(self.out, "f")?;
        self.numbers(&[r, g, b, kd, ks, shine, t, material.ior])?;
        writeln!(self.out)?;
        Ok(())
    }

    fn shape(&mut self, shape: &AnyShape, sides: Sides, at: &Affine3A) -> Result<(), NffError> {
        let sign = if sides == Sides::Back { -1.0 } else { 1.0 };
        let place = |v: Vec3A| at.transform_point3a(v).to_array();
        let scale =
            || scale_of(at).ok_or_else(|| unknown(format!("a {} that is distorted", shape.kind())));
        match shape {
            AnyShape::Sphere(sphere) => {
                let [x, y, z] = place(sphere.center);
                write!(self.out, "s")?;
                self.numbers(&[x, y, z, sign * sphere.radius * scale()?])?;
            }
            AnyShape::Cylinder(cylinder) => {
                let ([x, y, z], [u, v, w]) = (place(cylinder.base), place(cylinder.top));
                let radius = sign * cylinder.radius * scale()?;
                write!(self.out, "c")?;
                self.numbers(&[x, y, z, radius, u, v, w, radius])?;
            }
            AnyShape::Cone(cone) => {
                let ([x, y, z], [u, v, w]) = (place(cone.base), place(cone.apex));
                let scale = sign * scale()?;
                write!(self.out, "c")?;
                let (base, apex) = (scale * cone.base_radius, scale * cone.apex_radius);
                self.numbers(&[x, y, z, base, u, v, w, apex])?;
            }
            AnyShape::Polygon(polygon) => {
                return self.polygon(polygon.vertices(), &[], sides, at);
            }
            AnyShape::Patch(patch) => {
                return self.polygon(patch.polygon().vertices(), patch.normals(), sides, at);
            }
            other => return Err(unknown(format!("a {}", other.kind()))),
        }
        writeln!(self.out)?;
        Ok(())
    }

    fn mesh(&mut self, mesh: &Triangles, sides: Sides, at: &Affine3A) -> Result<(), NffError> {
        for face in mesh.faces() {
            let corners = face.map(|vertex| mesh.positions()[vertex as usize]);
            if mesh.normals().is_empty() {
                self.polygon(&corners, &[], sides, at)?;
            } else {
                let normals = face.map(|vertex| mesh.normals()[vertex as usize]);
                self.polygon(&corners, &normals, sides, at)?;
            }
        }
        Ok(())
    }

    /// A polygon, or with normals a patch, turned around if its back is what is seen; a mirror
    /// image turns it around, too.
    fn polygon(
        &mut self,
        corners: &[[f32; 3]],
        normals: &[[f32; 3]],
        sides: Sides,
        at: &Affine3A,
    ) -> Result<(), NffError> {
        let mirrored = at.matrix3.determinant() < 0.0;
        let turned = (sides == Sides::Back) != mirrored;
        let m = at.matrix3;
        let cofactors = glam::Mat3A::from_cols(
            m.y_axis.cross(m.z_axis),
            m.z_axis.cross(m.x_axis),
            m.x_axis.cross(m.y_axis),
        );
        let side = if turned { -1.0 } else { 1.0 };
        writeln!(self.out, "{} {}", if normals.is_empty() { "p" } else { "pp" }, corners.len())?;
        for i in 0..corners.len() {
            let i = if turned { corners.len() - 1 - i } else { i };
            let [x, y, z] = at.transform_point3a(Vec3A::from_array(corners[i])).to_array();
            write!(self.out, "{} {} {}", General(x), General(y), General(z))?;
            if let Some(&normal) = normals.get(i) {
                let moved = cofactors * Vec3A::from_array(normal) * side;
                self.numbers(&moved.normalize_or_zero().to_array())?;
            }
            writeln!(self.out)?;
        }
        Ok(())
    }

    /// Each with a blank before it.
    fn numbers(&mut self, numbers: &[f32]) -> io::Result<()> {
        numbers.iter().try_for_each(|&number| write!(self.out, " {}", General(number)))
    }
}

/// The coefficients of a material, made up if it has none.
fn whitted(material: &Material) -> Whitted {
    material.whitted.unwrap_or_else(|| {
        let (metallic, t) = (material.metallic, material.transmission);
        let width = material.roughness.powi(4).max(1e-5);
        Whitted {
            color: material.base_color,
            kd: (1.0 - metallic) * (1.0 - t),
            ks: metallic * (1.0 - t),
            shine: (2.0 / width - 2.0).clamp(1.0, 100_000.0),
            t,
        }
    })
}

/// How much a transform scales, if it does so alike in all directions.
fn scale_of(transform: &Affine3A) -> Option<f32> {
    /// As far as rounding may bend a rotation.
    const TOLERANCE: f32 = 1e-4;
    let [x, y, z] = [0, 1, 2].map(|axis| transform.matrix3.col(axis));
    let square = x.length_squared();
    let near = |value: f32, wanted: f32| (value - wanted).abs() <= TOLERANCE * square;
    (near(y.length_squared(), square)
        && near(z.length_squared(), square)
        && near(x.dot(y), 0.0)
        && near(y.dot(z), 0.0)
        && near(z.dot(x), 0.0))
    .then(|| square.sqrt())
}
