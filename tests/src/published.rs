//! What Havran counted in Haines' standard scenes, and what our techniques do there, counted as he
//! counted: all rays of Whitted's picture, on average, shadow rays until something blocks them,
//! and a child tested anew in every cell that it is in.

pub mod faces;

pub mod figures;

pub mod plain;

pub mod ranks;

pub mod witness;

use std::collections::BTreeMap;
use std::thread;

use glam::DVec3;
use nestray_core::hit::Hit;
use nestray_core::object::DynObject;
use nestray_core::ray::{Ray, RayKind};
use nestray_core::scratch::Scratch;
use nestray_plan::build::build;
use nestray_plan::single::single;
use nestray_scene::geometry::Content;
use nestray_scene::procedural::generate;
use nestray_scene::scene::Scene;
use nestray_shapes::shape::Shape;
use serde_json::Value;

use self::plain::{Part, Plain, Shot};

/// What is done for a ray, on average.
#[derive(Clone, Copy, Debug, Default)]
pub struct PerRay {
    /// Tests of primitives.
    pub tests: f64,
    /// Steps from cell to cell.
    pub steps: f64,
}

/// A scene and all rays of a picture of it.
#[derive(Debug)]
pub struct Subject {
    scene: Scene,
    rays: Vec<Ray>,
}

impl Subject {
    /// A built-in scene, and the rays of a picture with about so many from the eye.
    ///
    /// # Panics
    /// If there is no such scene.
    #[must_use]
    pub fn new(name: &str, size: u32, rays: usize) -> Self {
        let scene = generate(name, Some(size)).expect("it is built in").frame(0.0, 0.0);
        let rays = witness::rays(&scene, world(&scene, "bvh", &Value::Null), rays);
        Self { scene, rays }
    }

    /// The same rays, and what `change` makes of the scene.
    #[must_use]
    pub fn with(self, change: impl FnOnce(&mut Scene)) -> Self {
        let Self { mut scene, rays } = self;
        change(&mut scene);
        Self { scene, rays }
    }

    /// How many rays there are.
    #[must_use]
    pub fn rays(&self) -> usize {
        self.rays.len()
    }

    /// What one technique over everything does, with these settings.
    ///
    /// # Panics
    /// If there is no such technique or setting.
    #[must_use]
    pub fn counted(&self, technique: &str, settings: &Value) -> PerRay {
        let world = world(&self.scene, technique, settings);
        let half = self.rays.len().div_ceil(2).max(1);
        let tallies = thread::scope(|scope| {
            let halves: Vec<_> =
                self.rays.chunks(half).map(|rays| scope.spawn(|| send(&world, rays))).collect();
            halves.into_iter().map(|half| half.join().expect("nothing panics")).collect::<Vec<_>>()
        });
        let sum = |of: fn([u64; 2]) -> u64| tallies.iter().map(|&tally| of(tally)).sum::<u64>();
        let each = |count: u64| count as f64 / self.rays.len() as f64;
        PerRay { tests: each(sum(|tally| tally[0])), steps: each(sum(|tally| tally[1])) }
    }

    /// All that plain cells need to know of it.
    ///
    /// # Panics
    /// If it holds anything but single shapes.
    #[must_use]
    pub fn plain(&self) -> Plain {
        let (mut parts, mut numbers) = (Vec::new(), BTreeMap::new());
        for (geometry, of) in (0..).zip(&self.scene.geometries) {
            let Content::Shapes(shapes) = &of.content else { panic!("single shapes only") };
            for (primitive, shape) in (0..).zip(shapes.iter()) {
                numbers.insert((geometry, primitive), parts.len() as u32);
                let bounds = shape.bounds();
                let (min, max) = (bounds.min.as_dvec3(), bounds.max.as_dvec3());
                parts.push(Part { min, max });
            }
        }
        let world = world(&self.scene, "bvh", &Value::Null);
        let mut scratch = Scratch::new();
        let shot = |ray: &Ray| {
            let (mut nearest, mut hits) = (Hit::none(ray.t_max()), Vec::new());
            if is_shadow(ray) {
                world.all_hits(ray, &mut hits, &mut scratch);
            } else {
                world.closest_hit(ray, &mut nearest, &mut scratch);
            }
            let number = |hit: &Hit| numbers[&(hit.geometry, hit.primitive)];
            Shot {
                origin: DVec3::from_array(ray.origin().to_array().map(f64::from)),
                dir: DVec3::from_array(ray.dir().to_array().map(f64::from)),
                end: f64::from(nearest.t),
                blockers: hits.iter().map(number).collect(),
            }
        };
        let shots = self.rays.iter().map(shot).collect();
        Plain::new(parts, shots)
    }
}

fn is_shadow(ray: &Ray) -> bool {
    matches!(ray.kind(), RayKind::Shadow { .. })
}

/// Everything in a scene by one technique.
fn world(scene: &Scene, technique: &str, settings: &Value) -> DynObject {
    let settings = settings.as_object().cloned().unwrap_or_default();
    let plan = single(technique, settings, scene).expect("it is in the registry");
    build(&plan, scene).expect("it fits every scene")
}

/// Tests, those included that were saved because the child had been tested, and steps.
fn send(world: &DynObject, rays: &[Ray]) -> [u64; 2] {
    let mut scratch = Scratch::counting();
    for ray in rays {
        if is_shadow(ray) {
            world.any_hit(ray, &mut scratch);
        } else {
            world.closest_hit(ray, &mut Hit::none(ray.t_max()), &mut scratch);
        }
    }
    let total = scratch.counters.total();
    [total.all_tests() + total.repeats, total.all_steps()]
}
