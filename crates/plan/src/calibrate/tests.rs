use glam::Vec3A;
use nestray_core::ray::{Ray, RayKind};
use nestray_registry as registry;
use nestray_scene::procedural::generate;

use super::*;
use crate::optimize::ray_log::RaySet;

struct Nobody;
impl Observer for Nobody {}

/// Stops before anything was done.
struct Impatient;
impl Observer for Impatient {
    fn stop(&self) -> bool {
        true
    }
}

fn sample(name: &str, size: u32) -> Sample {
    let scene = generate(name, Some(size)).expect("there is one");
    let bounds = scene.bounds();
    let ray = |i: usize| {
        let part = |step: f64| ((i as f64 + 0.5) * step).fract() as f32;
        let to = bounds.min + bounds.size() * Vec3A::new(part(0.7549), part(0.5698), 0.5);
        Ray::new(bounds.center() + bounds.size() * 1.5, to - bounds.center(), RayKind::Diffuse)
    };
    let rays = (0..500).map(ray).collect();
    let set = RaySet { name: "diffuse".into(), rays, any: false, weight: 1.0 };
    Sample { name: name.into(), scene, log: RayLog::new(vec![set]) }
}

#[test]
fn every_technique_is_timed_and_prices_are_sound() {
    let samples = [sample("balls", 2), sample("tetra", 4), sample("mixed", 1)];
    let found = calibrate(samples, &Nobody).expect("they are sound");
    assert!(found.prices.are_sound());
    let techniques = registry::names().count();
    assert!(found.runs > 2 * techniques, "{} runs", found.runs);
    assert!(found.error.is_finite());
}

#[test]
fn a_calibration_that_is_stopped_keeps_the_usual_prices() {
    let found = calibrate([sample("balls", 1)], &Impatient).expect("it is sound");
    assert_eq!((found.runs, found.prices), (0, Prices::usual().clone()));
}
