//! Rays from inside a closed mesh at its weakest places.

use std::sync::Arc;

use glam::Vec3A;
use nestray_core::hit::Hit;
use nestray_core::object::Object;
use nestray_core::ray::{Ray, RayKind};
use nestray_core::scratch::Scratch;
use nestray_core::simd::Level;
use nestray_registry::{Members, TECHNIQUES};
use nestray_shapes::triangle_mesh::{TriangleMesh, Triangles};
use serde_json::Value;

use crate::closed::{edges, points_inside};

/// Points aimed at on every edge, ends not counted.
const PER_EDGE: usize = 100;

/// A closed mesh, points inside it, and everything worth aiming at.
#[derive(Debug)]
pub struct Closed {
    name: String,
    mesh: Arc<Triangles>,
    edges: Vec<[u32; 2]>,
    inside: Vec<Vec3A>,
}

impl Closed {
    /// None unless as many faces run along every edge one way as the other: two faces, or four
    /// where parts touch.
    #[must_use]
    pub fn new(name: impl Into<String>, mesh: Triangles) -> Option<Self> {
        let edges = edges(&mesh);
        if mesh.count() == 0 || edges.values().any(|&[along, against]| along != against) {
            return None;
        }
        let inside = points_inside(&mesh, 64);
        Some(Self {
            name: name.into(),
            mesh: mesh.into(),
            edges: edges.into_keys().collect(),
            inside,
        })
    }

    /// How many points there are to aim at: every vertex, and 100 points of every edge.
    #[must_use]
    pub fn aims(&self) -> usize {
        self.mesh.positions().len() + PER_EDGE * self.edges.len()
    }

    fn aim(&self, number: usize) -> Vec3A {
        let vertices = self.mesh.positions();
        let Some(number) = number.checked_sub(vertices.len()) else {
            return Vec3A::from_array(vertices[number]);
        };
        let [a, b] = self.edges[number / PER_EDGE].map(|v| Vec3A::from_array(vertices[v as usize]));
        a + (b - a) * ((number % PER_EDGE + 1) as f32 / (PER_EDGE + 1) as f32)
    }

    /// Ray by ray through all aims before any comes again, far apart one after the other; each
    /// round from another point.
    fn ray(&self, number: usize) -> Ray {
        let aims = self.aims();
        let step = step(aims);
        let aim = self.aim((number % aims) * step % aims);
        let origin = self.inside[(number + number / aims) % self.inside.len()];
        Ray::new(origin, aim - origin, RayKind::Camera)
    }

    /// Shoots `count` rays through every technique, through lists as many as bearable. Says
    /// how many.
    ///
    /// # Panics
    /// If one does not hit.
    #[must_use]
    pub fn assert_no_leak(&self, count: usize) -> String {
        let mut report =
            format!("{}: {} triangles, {} aims:", self.name, self.mesh.count(), self.aims());
        for entry in TECHNIQUES {
            let members = Members::Triangles(TriangleMesh::new(0, Arc::clone(&self.mesh)));
            let nest = (entry.build)(&Value::Null, members).expect("defaults");
            // Lists test every triangle.
            let count = match entry.name {
                "list" => count.min(count * 200 / self.mesh.count() as usize).max(1000),
                _ => count,
            };
            self.shoot(entry.name, &*nest, count);
            report += &format!(" {} {count}", entry.name);
        }
        report
    }

    fn shoot(&self, technique: &str, nest: &dyn Object, count: usize) {
        const BATCH: usize = 1 << 14;
        let levels = Level::available();
        let (mut blocked, mut hits) = (Vec::new(), Vec::new());
        for (round, start) in (0..count).step_by(BATCH).enumerate() {
            let mut scratch = Scratch::with_level(levels[round % levels.len()]);
            let rays: Vec<Ray> =
                (start..count.min(start + BATCH)).map(|number| self.ray(number)).collect();
            blocked.clear();
            blocked.resize(rays.len(), false);
            nest.any_hits(&rays, &mut blocked, &mut scratch);
            hits.clear();
            hits.resize(rays.len(), Hit::none(f32::INFINITY));
            nest.closest_hits(&rays, &mut hits, &mut scratch);
            for ((ray, any), hit) in rays.iter().zip(&blocked).zip(&hits) {
                let level = scratch.level;
                assert!(*any && hit.is_some(), "{}, {technique}, {level:?}: {ray:?}", self.name);
            }
            for ray in rays.iter().step_by(8) {
                let mut hit = Hit::none(f32::INFINITY);
                let found = nest.closest_hit(ray, &mut hit, &mut scratch);
                assert!(
                    found && nest.any_hit(ray, &mut scratch),
                    "{}, {technique}: {ray:?}",
                    self.name
                );
            }
        }
    }
}

/// A number without a common divisor with `count`, about 0.618 of it.
fn step(count: usize) -> usize {
    let common = |mut a: usize, mut b: usize| {
        while b > 0 {
            (a, b) = (b, a % b);
        }
        a
    };
    let around = (count as f64 * 0.618) as usize;
    (around.max(1)..).find(|&step| common(step, count) == 1).expect("one of the next few primes")
}
