//! Pictures of whole scenes through one technique after the other.

use nestray_core::object::{DynObject, Object};
use nestray_plan::build::build;
use nestray_plan::single::single;
use nestray_registry::TECHNIQUES;
use nestray_render::options::{Integrator, Options, WhittedOptions};
use nestray_render::ray_counts::RayCounts;
use nestray_render::render::render;
use nestray_render::watch::Unwatched;
use nestray_scene::scene::Scene;
use serde_json::Map;

/// A scene, and what it is called in messages.
#[derive(Debug)]
pub struct Subject {
    name: String,
    scene: Scene,
}

/// All there is to a picture: its layers, bit by bit, and how many rays it took.
#[derive(Clone, Debug, PartialEq)]
pub struct Print {
    layers: Vec<(String, Vec<u32>)>,
    rays: RayCounts,
}

impl Subject {
    /// The beginning of a scene's first frame.
    #[must_use]
    pub fn new(name: impl Into<String>, scene: &Scene) -> Self {
        Self { name: name.into(), scene: scene.frame(0.3, 0.2) }
    }

    /// What it is called.
    #[must_use]
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Everything in it by one technique, also below instances.
    ///
    /// # Panics
    /// If there is no such technique.
    #[must_use]
    pub fn world(&self, technique: &str) -> DynObject {
        let plan = single(technique, Map::new(), &self.scene).expect("it is in the registry");
        build(&plan, &self.scene).expect("it fits every scene")
    }

    /// A picture.
    ///
    /// # Panics
    /// If the options make no sense.
    #[must_use]
    pub fn print(&self, world: &dyn Object, options: &Options) -> Print {
        let rendered = render(&self.scene, world, options, &Unwatched).expect("sound options");
        let layers = rendered.picture.layers.into_iter();
        let bits = |samples: Vec<f32>| samples.into_iter().map(f32::to_bits).collect();
        Print {
            layers: layers.map(|layer| (layer.name, bits(layer.samples))).collect(),
            rays: rendered.rays,
        }
    }

    /// Renders it by Whitted's method through every technique, `rays` from the eye; through
    /// lists fewer, so that they test no more than `tests` primitives with each in all. Says
    /// what was done.
    ///
    /// # Panics
    /// If two pictures differ.
    #[must_use]
    pub fn assert_same_by_all(&self, rays: usize, tests: usize) -> String {
        let primitives = self.scene.primitives();
        let fewer = rays.min(tests / primitives.max(1) as usize).max(64);
        // Lists decide; where they take too long, the others are held against each other.
        let few = whitted(fewer);
        let expected = self.print(&*self.world("list"), &few);
        let mut first = None;
        for entry in TECHNIQUES.iter().filter(|entry| entry.name != "list") {
            let world = self.world(entry.name);
            self.assert_same(entry.name, &expected, &self.print(&*world, &few));
            if rays > fewer {
                let found = self.print(&*world, &whitted(rays));
                self.assert_same(entry.name, first.get_or_insert_with(|| found.clone()), &found);
            }
        }
        assert!(expected.shows_something(), "{}: there is nothing to see", self.name);
        format!(
            "{}: {primitives} primitives, {rays} rays from the eye, {fewer} by lists",
            self.name
        )
    }

    fn assert_same(&self, technique: &str, expected: &Print, found: &Print) {
        let name = &self.name;
        assert!(expected == found, "{name}: {technique}: {}", expected.difference(found));
    }
}

impl Print {
    /// The first that differs.
    #[must_use]
    pub fn difference(&self, other: &Self) -> String {
        for ((name, a), (_, b)) in self.layers.iter().zip(&other.layers) {
            if let Some(at) = (0..a.len()).find(|&i| a.get(i) != b.get(i)) {
                return format!("number {at} of layer {name:?}");
            }
        }
        format!("{:?} and {:?}", self.rays, other.rays)
    }

    /// Whether anything can be seen: not every number of the main layer is the same.
    #[must_use]
    pub fn shows_something(&self) -> bool {
        self.layers[0].1.chunks_exact(3).any(|pixel| pixel != &self.layers[0].1[..3])
    }
}

/// Whitted's method, a picture of about so many pixels.
#[must_use]
pub fn whitted(pixels: usize) -> Options {
    let height = ((pixels as f32 * 0.75).sqrt() as u32).max(1);
    Options {
        resolution: [height * 4 / 3 + 1, height],
        samples: 1,
        integrator: Integrator::Whitted(WhittedOptions::default()),
        threads: 2,
        ..Options::default()
    }
}
