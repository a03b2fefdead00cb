//! Simple shapes as triangles, where everybody is to shoot at triangles.

use nestray::glam::Vec3A;
use nestray::prelude::{AnyShape, Content, Scene, Shape as _, Triangles};
use nestray::shapes::cone::Cone;

/// Sides of what is round around an axis, and segments of a sphere from pole to pole.
const SIDES: u32 = 8;
const SEGMENTS: u32 = 6;

/// Turns shapes into triangles; says how many of each, or which kind it cannot turn.
pub(super) fn tessellate(scene: &mut Scene) -> Result<Option<String>, String> {
    let (mut count, mut made) = (0, 0);
    for geometry in &mut scene.geometries {
        let Content::Shapes(shapes) = &geometry.content else { continue };
        let mut out = Faces::default();
        for shape in shapes.iter() {
            out.add(shape).map_err(|kind| {
                let name = &geometry.name;
                format!("other libraries take triangles only: geometry {name:?} has a {kind}")
            })?;
        }
        count += shapes.len();
        made += out.faces.len();
        let triangles = Triangles::new(out.positions, out.faces);
        let triangles = triangles.map_err(|error| format!("geometry {:?}: {error}", geometry.name));
        geometry.content = Content::Mesh(triangles?.into());
    }
    Ok((count > 0).then(|| format!("{count} shapes are shot at as {made} triangles, by all")))
}

#[derive(Default)]
struct Faces {
    positions: Vec<[f32; 3]>,
    faces: Vec<[u32; 3]>,
}

impl Faces {
    fn add(&mut self, shape: &AnyShape) -> Result<(), &'static str> {
        match shape {
            AnyShape::Sphere(ball) => self.ball(ball.center, ball.radius),
            AnyShape::Cone(cone) => self.tube(cone),
            AnyShape::Cylinder(tube) => self.tube(&Cone {
                base: tube.base,
                base_radius: tube.radius,
                apex: tube.top,
                apex_radius: tube.radius,
            }),
            AnyShape::Polygon(polygon) => self.fan(polygon.vertices()),
            AnyShape::Patch(patch) => self.fan(patch.polygon().vertices()),
            other => return Err(other.kind()),
        }
        Ok(())
    }

    /// All triangles at the first corner.
    fn fan(&mut self, corners: &[[f32; 3]]) {
        let first = self.positions.len() as u32;
        self.positions.extend_from_slice(corners);
        let count = corners.len() as u32;
        self.faces.extend((2..count).map(|i| [first, first + i - 1, first + i]));
    }

    /// A prism or pyramid without its ends.
    fn tube(&mut self, cone: &Cone) {
        let axis = (cone.apex - cone.base).normalize_or(Vec3A::Z);
        let (x, y) = axis.any_orthonormal_pair();
        let ring = |center: Vec3A, radius: f32| {
            move |i: u32| {
                let [across, up] = on_circle(i, SIDES);
                (center + (x * across + y * up) * radius).to_array()
            }
        };
        let first = self.positions.len() as u32;
        self.positions.extend((0..SIDES).map(ring(cone.base, cone.base_radius)));
        self.positions.extend((0..SIDES).map(ring(cone.apex, cone.apex_radius)));
        self.band(first, SIDES);
    }

    /// Squares between a ring and the next, each of so many corners, as triangles.
    fn band(&mut self, first: u32, corners: u32) {
        for i in 0..corners {
            let [a, b] = [first + i, first + (i + 1) % corners];
            self.faces.extend([[a, b, a + corners], [b, b + corners, a + corners]]);
        }
    }

    /// Rings from pole to pole.
    fn ball(&mut self, center: Vec3A, radius: f32) {
        let around = 2 * SEGMENTS;
        let first = self.positions.len() as u32;
        for ring in 0..=SEGMENTS {
            let [z, thick] = on_circle(ring, around);
            for i in 0..around {
                let [x, y] = on_circle(i, around);
                let at = Vec3A::new(thick * x, thick * y, z);
                self.positions.push((center + at * radius).to_array());
            }
            if ring < SEGMENTS {
                self.band(first + ring * around, around);
            }
        }
    }
}

/// The `i`-th of `of` points, evenly around a circle.
fn on_circle(i: u32, of: u32) -> [f32; 2] {
    // A sine differs from machine to machine in its last bit, and then so would the scene.
    let turn = f64::from(i) / f64::from(of) * std::f64::consts::TAU;
    [libm::cos(turn) as f32, libm::sin(turn) as f32]
}

#[cfg(test)]
mod tests {
    use nestray::prelude::Sphere;

    use super::*;

    #[test]
    fn round_things_stay_round_and_closed() {
        let mut faces = Faces::default();
        let ball = Sphere { center: Vec3A::new(1.0, 2.0, 3.0), radius: 2.0 };
        faces.add(&ball.into()).expect("a ball is turned");
        for at in &faces.positions {
            assert!((Vec3A::from(*at).distance(ball.center) - 2.0).abs() < 1e-5);
        }
        let (mut tube, to) = (Faces::default(), Vec3A::new(0.0, 3.0, 4.0));
        tube.tube(&Cone { base: Vec3A::ZERO, base_radius: 1.0, apex: to, apex_radius: 0.5 });
        assert_eq!((tube.positions.len(), tube.faces.len()), (16, 16));
        for at in &tube.positions[..8] {
            let at = Vec3A::from(*at);
            assert!((at.length() - 1.0).abs() < 1e-5 && at.dot(to).abs() < 1e-4);
        }
    }
}
