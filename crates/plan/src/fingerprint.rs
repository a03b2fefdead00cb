//! What scenes are told apart by: a hash of their primitives, and of which groups hold them.

use blake3::Hasher;
use glam::{Affine3A, Vec3A};
use nestray_core::aabb::Aabb;
use nestray_scene::geometry::{Content, Geometry};
use nestray_scene::scene::Scene;
use nestray_scene::solid::{Operand, Part, Solid};
use nestray_shapes::any::AnyShape;
use nestray_shapes::csg::Operation;
use nestray_shapes::shape::{Shape, Sides};
use nestray_shapes::triangle_mesh::Triangles;

use crate::error::{PlanError, Problem};
use crate::plan::Plan;

/// The BLAKE3 hash of all primitives, to the bit, and of which group holds which geometries
/// and groups. Names, materials, lights and where instances are do not count: all frames of
/// an animated scene have the same.
#[must_use]
pub fn fingerprint(scene: &Scene) -> String {
    let mut words = Words(Hasher::new());
    words.count(scene.geometries.len());
    for geometry in &scene.geometries {
        words.geometry(geometry);
    }
    words.count(scene.root);
    words.count(scene.groups.len());
    for group in &scene.groups {
        words.count(group.geometries.len());
        group.geometries.iter().for_each(|&geometry| words.count(geometry));
        words.count(group.places.len());
        group.places.iter().for_each(|place| words.count(place.group));
    }
    words.0.finalize().to_hex().to_string()
}

/// Refuses a plan that is made for another scene.
pub(crate) fn check(plan: &Plan, scene: &Scene) -> Result<(), PlanError> {
    let Some(expected) = plan.scene.as_deref().filter(|text| !text.is_empty()) else {
        return Ok(());
    };
    let found = fingerprint(scene);
    if expected == found {
        return Ok(());
    }
    let expected = expected.to_owned();
    let geometries = scene.geometries.len();
    let primitives = scene.geometries.iter().map(|g| u64::from(g.primitives())).sum();
    let problem = Problem::OtherScene { expected, found, geometries, primitives };
    Err(PlanError::at("scene", problem))
}

/// Numbers on their way into a hash, little end first.
struct Words(Hasher);

impl Words {
    fn count(&mut self, number: usize) {
        self.0.update(&(number as u64).to_le_bytes());
    }

    fn text(&mut self, text: &str) {
        self.count(text.len());
        self.0.update(text.as_bytes());
    }

    fn numbers(&mut self, numbers: &[f32]) {
        /// So many at a time.
        const ROW: usize = 256;
        let mut row = [0; 4 * ROW];
        self.count(numbers.len());
        for numbers in numbers.chunks(ROW) {
            for (bytes, x) in row.chunks_exact_mut(4).zip(numbers) {
                bytes.copy_from_slice(&x.to_bits().to_le_bytes());
            }
            self.0.update(&row[..4 * numbers.len()]);
        }
    }

    fn points(&mut self, points: &[Vec3A]) {
        points.iter().for_each(|point| self.numbers(&point.to_array()));
    }

    fn boxed(&mut self, bounds: &Aabb) {
        self.points(&[bounds.min, bounds.max]);
    }

    fn geometry(&mut self, geometry: &Geometry) {
        self.text(match geometry.sides {
            Sides::Both => "both",
            Sides::Front => "front",
            Sides::Back => "back",
        });
        self.count(geometry.primitives() as usize);
        match &geometry.content {
            Content::Mesh(mesh) => self.mesh(mesh),
            Content::Shapes(shapes) => shapes.iter().for_each(|shape| self.shape(shape)),
            Content::Solids(solids) => solids.iter().for_each(|solid| self.solid(solid)),
        }
    }

    fn mesh(&mut self, mesh: &Triangles) {
        self.text("mesh");
        self.numbers(mesh.positions().as_flattened());
        self.count(mesh.faces().len());
        for face in mesh.faces() {
            let [a, b, c] = face.map(u32::to_le_bytes);
            self.0.update([a, b, c].as_flattened());
        }
    }

    fn shape(&mut self, shape: &AnyShape) {
        self.text(shape.kind());
        match shape {
            AnyShape::Sphere(s) => {
                self.points(&[s.center]);
                self.numbers(&[s.radius]);
            }
            AnyShape::Cone(s) => {
                self.points(&[s.base, s.apex]);
                self.numbers(&[s.base_radius, s.apex_radius]);
            }
            AnyShape::Cylinder(s) => {
                self.points(&[s.base, s.top]);
                self.numbers(&[s.radius]);
            }
            AnyShape::Plane(s) => self.points(&[s.point, s.normal]),
            AnyShape::Disk(s) => {
                self.points(&[s.center, s.normal]);
                self.numbers(&[s.radius]);
            }
            AnyShape::Parallelogram(s) => self.points(&[s.corner, s.u, s.v]),
            AnyShape::Block(s) => self.boxed(&s.extent),
            AnyShape::Polygon(s) => self.numbers(s.vertices().as_flattened()),
            AnyShape::Patch(s) => {
                self.numbers(s.polygon().vertices().as_flattened());
                self.numbers(s.normals().as_flattened());
            }
            AnyShape::Torus(s) => {
                self.points(&[s.center, s.axis]);
                self.numbers(&[s.major, s.minor]);
            }
            AnyShape::Quadric(s) => {
                self.numbers([s.squares, s.products, s.linear].as_flattened());
                self.numbers(&[s.constant]);
                self.boxed(&s.clip);
            }
            AnyShape::Bezier(s) => self.points(s.points.as_flattened()),
            AnyShape::HeightField(s) => {
                let [columns, rows] = s.counts();
                self.count(columns);
                self.points(&[s.sample(0, 0), s.sample(columns - 1, rows - 1)]);
                self.text(&format!("{:?}", s.relief()));
                self.numbers(s.heights());
            }
        }
    }

    fn solid(&mut self, solid: &Solid) {
        self.text(match solid.operation() {
            Operation::Union => "union",
            Operation::Intersection => "intersection",
            Operation::Difference => "difference",
        });
        solid.operands().iter().for_each(|operand| self.operand(operand));
    }

    fn operand(&mut self, operand: &Operand) {
        if *operand.place() != Affine3A::IDENTITY {
            self.text("at");
            self.numbers(&operand.place().to_cols_array());
        }
        match operand.part() {
            Part::Shape(shape) => self.shape(shape),
            Part::Mesh(mesh) => self.mesh(mesh),
            Part::Solid(solid) => self.solid(solid),
        }
    }
}

#[cfg(test)]
mod tests {
    use nestray_scene::group::Motion;
    use nestray_scene::procedural::generate;

    use super::*;
    use crate::build::build;
    use crate::check::check;
    use crate::single::single;

    fn scene() -> Scene {
        generate("mixed", Some(1)).expect("it can be made")
    }

    #[test]
    fn scenes_of_the_same_content_have_the_same_fingerprint_on_every_machine() {
        let mut scene = scene();
        let first = fingerprint(&scene);
        assert_eq!(first, KNOWN);
        scene.geometries[0].name = "other".into();
        scene.materials.clear();
        scene.groups[0].places[0].motion = Motion::Still(Affine3A::IDENTITY);
        assert_eq!(fingerprint(&scene), first);
        let mut changed = scene.clone();
        changed.geometries[0].sides = Sides::Back;
        assert_ne!(fingerprint(&changed), first);
        scene.groups[0].geometries.swap(0, 1);
        assert_ne!(fingerprint(&scene), first);
    }

    #[test]
    fn a_bit_of_any_primitive_counts() {
        let first = scene();
        let mut seen = vec![fingerprint(&first)];
        for (i, geometry) in first.geometries.iter().enumerate() {
            // All primitives but the last.
            let content = match &geometry.content {
                Content::Mesh(mesh) => {
                    let mut positions = mesh.positions().to_vec();
                    positions[0][1] = positions[0][1].next_up();
                    let mesh = Triangles::new(positions, mesh.faces().to_vec()).expect("sound");
                    Content::Mesh(mesh.into())
                }
                Content::Shapes(_) => Content::Shapes(Vec::new().into()),
                Content::Solids(_) => Content::Solids(Vec::new().into()),
            };
            let mut changed = first.clone();
            changed.geometries[i].content = content;
            seen.push(fingerprint(&changed));
        }
        let count = seen.len();
        seen.sort_unstable();
        seen.dedup();
        assert_eq!(seen.len(), count);
    }

    #[test]
    fn a_plan_is_refused_for_another_scene_only() {
        let scene = scene();
        let mut plan = single("bvh", Default::default(), &scene).expect("known");
        for mark in [None, Some(String::new()), Some(fingerprint(&scene))] {
            plan.scene = mark;
            assert_eq!(check(&plan, &scene), Ok(()));
            assert!(build(&plan, &scene.frame(1.0, 0.5)).is_ok());
        }
        let mut other = scene.clone();
        other.geometries[1].sides = Sides::Front;
        let told = check(&plan, &other).expect_err("it is another").to_string();
        let expected = format!(
            "scene: made for the scene {}, but this one is {}: 16 geometries and 27 primitives",
            fingerprint(&scene),
            fingerprint(&other)
        );
        assert_eq!(told, expected);
        assert_eq!(build(&plan, &other).err().map(|error| error.to_string()), Some(told));
    }

    /// Of the mixed scene at size 1.
    const KNOWN: &str = "f84b84be9e639b71ec16604b7105c7173d2cd5960cbb428672f941604b16d0a1";
}
