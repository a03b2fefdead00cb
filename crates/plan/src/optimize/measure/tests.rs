//! Races by a clock that says what it is told to.

use std::collections::VecDeque;
use std::sync::Mutex;

use nestray_core::ray::{Ray, RayKind};
use nestray_scene::procedural::generate;

use super::*;
use crate::optimize::clock::Clock;
use crate::optimize::ray_log::RaySet;
use crate::optimize::{Observer, Options};
use crate::single::single;

struct Nobody;
impl Observer for Nobody {}

/// Says for each two questions how long the thread worked between them.
#[derive(Debug)]
struct Script(Mutex<(VecDeque<f64>, bool)>);

impl Clock for Script {
    fn seconds(&self) -> f64 {
        0.0
    }

    fn worked(&self) -> f64 {
        let mut script = self.0.lock().expect("free");
        script.1 = !script.1;
        if script.1 { 0.0 } else { script.0.pop_front().expect("nobody asks for more") }
    }
}

/// Whether one that takes `slow` is left behind one that takes `fast`, turn by turn.
fn is_left_behind(turns: &[[f64; 2]]) -> bool {
    let script = turns.iter().flat_map(|[fast, slow]| [*fast, *slow]).collect();
    let clock = Script(Mutex::new((script, false)));
    let options = Options { time: None, ..Options::default() };
    let limits = Limits::new(&clock, &options, &Nobody);
    let scene = generate("balls", Some(1)).expect("there is one");
    let rays = vec![Ray::new(scene.bounds().center(), glam::Vec3A::X, RayKind::Camera)];
    let log = RayLog::new(vec![RaySet { name: "camera".into(), rays, any: false, weight: 1.0 }]);
    let (few, shelf) = (log.clone(), Shelf::default());
    let race = Race { scene: &scene, limits: &limits, shelf, few, all: log };
    let runner = || {
        let plan = single("bvh", Default::default(), &scene).expect("it is sound");
        let world = build(&plan, &scene).expect("it is sound");
        let finalist = Finalist { name: "bvh".into(), plan, predicted: None, is_single: true };
        let (nanos, mix, total) = (vec![1e9], 1e9, 1e9);
        let (build_seconds, bytes) = (0.0, 0);
        let measured = Measured { finalist, nanos, mix, total, build_seconds, bytes, rounds: 1 };
        Runner { world, measured, times: vec![Vec::new()] }
    };
    let (mut slow, mut fast) = (runner(), runner());
    let behind = race.is_left_behind([&mut slow, &mut fast], &race.all, STILL_FAR, &[1e9]);
    assert!(clock.0.lock().expect("free").0.is_empty(), "no turn is left");
    assert_eq!(slow.times[0].len(), turns.len(), "all are kept");
    behind
}

#[test]
fn only_what_is_slow_in_every_turn_is_left_behind() {
    assert!(is_left_behind(&[[1.0, 1.5], [1.0, 1.6], [1.0, 9.0]]));
    assert!(!is_left_behind(&[[1.0, 9.0], [1.0, 9.0], [1.0, 1.3]]), "it was slow by chance");
    assert!(!is_left_behind(&[[1.0, 9.0], [8.0, 9.0]]), "both were");
    assert!(!is_left_behind(&[[0.1, 0.9]]), "it is the best for a kind");
}
