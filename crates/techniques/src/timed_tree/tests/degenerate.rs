//! Input that builders go deep or long over.

use std::sync::Arc;

use glam::Vec3A;
use nestray_core::aabb::Aabb;
use nestray_core::cost::{Cost, CostModel};
use nestray_core::hit::Hit;
use nestray_core::object::{DynObject, Object};
use nestray_core::ray::Ray;
use nestray_core::scratch::Scratch;
use nestray_core::surface::Surface;
use nestray_core::technique::Technique;

use super::{Objects, tree};
use crate::counted::Numbers;
use crate::motion_bvh::MotionBvh;
use crate::spacetime::Spacetime;
use crate::timed_tree::TimedTree;

/// A box that slides, and is never hit.
#[derive(Debug)]
struct Sliding {
    bounds: Aabb,
    by: Vec3A,
}

impl Object for Sliding {
    fn kind(&self) -> &'static str {
        "sliding"
    }
    fn bounds(&self) -> Aabb {
        self.bounds_during([0.0, 1.0])
    }
    fn bounds_during(&self, time: [f32; 2]) -> Aabb {
        let at = time.map(|time| self.by * time);
        let Aabb { min, max } = self.bounds;
        Aabb { min: min + at[0], max: max + at[0] }
            .join(Aabb { min: min + at[1], max: max + at[1] })
    }
    fn closest_hit(&self, _ray: &Ray, _hit: &mut Hit, _scratch: &mut Scratch) -> bool {
        false
    }
    fn all_hits(&self, _ray: &Ray, _hits: &mut Vec<Hit>, _scratch: &mut Scratch) {}
    fn surface(&self, _ray: &Ray, _hit: &Hit) -> Option<Surface> {
        None
    }
    fn cost(&self, _model: &CostModel) -> Cost {
        Cost::primitive(10.0, 0.0, 0)
    }
}

/// The name of an input, and its boxes.
fn inputs(count: usize) -> Vec<(&'static str, Vec<Aabb>)> {
    let mut numbers = Numbers::new(1);
    let around = |at: Vec3A, half: f32| Aabb { min: at - half, max: at + half };
    let mut each = |name, of: &mut dyn FnMut(usize, &mut Numbers) -> Aabb| {
        (name, (0..count).map(|i| of(i, &mut numbers)).collect())
    };
    let halving = |i: usize| 1.0 / (1u64 << (i % 60)) as f32;
    vec![
        each("random", &mut |_, numbers| around(numbers.point(), 0.003)),
        each("in one place", &mut |_, _| around(Vec3A::ONE, 0.5)),
        each("shells", &mut |i, _| around(Vec3A::ZERO, halving(i))),
        each("towards a corner", &mut |i, _| around(Vec3A::splat(halving(i)), 0.1 * halving(i))),
        each("one huge", &mut |i, numbers| match i {
            0 => around(Vec3A::ZERO, 1000.0),
            _ => around(numbers.point(), 1e-4),
        }),
        each("about one centre", &mut |_, numbers| around(Vec3A::ONE, numbers.next())),
        each("on a line", &mut |_, numbers| around(Vec3A::X * numbers.next(), 0.0)),
        each("flat", &mut |_, numbers| {
            let min = numbers.point();
            Aabb { min, max: min + Vec3A::new(0.01, 0.01, 0.0) }
        }),
    ]
}

fn leaves_hold_all<T: Technique<Index = TimedTree>>(count: usize, by: Vec3A) {
    for (name, boxes) in inputs(count) {
        let child = |bounds| -> DynObject { Arc::new(Sliding { bounds, by }) };
        let family = Objects(boxes.into_iter().map(child).collect());
        let (tree, leaves) = tree(&T::default(), &family);
        let mut seen = vec![false; count];
        let entries = (0..leaves.count()).flat_map(|leaf| leaves.of(leaf));
        let entries = entries.map(|&child| seen[child as usize] = true).count();
        assert!(seen.iter().all(|&seen| seen), "{} {name}: a child is lost", T::NAME);
        assert!(entries <= 9 * count, "{} {name}: {entries} references", T::NAME);
        let nodes = tree.nodes().count();
        assert!(nodes <= 9 * count, "{} {name}: {nodes} nodes", T::NAME);
    }
}

#[test]
fn odd_input_is_built_on_a_small_stack() {
    let build = || {
        for by in [Vec3A::ZERO, Vec3A::X * 0.1] {
            leaves_hold_all::<MotionBvh>(3000, by);
            leaves_hold_all::<Spacetime>(3000, by);
        }
    };
    let thread = std::thread::Builder::new().stack_size(256 << 10).spawn(build);
    thread.expect("there are threads").join().expect("the stack is enough");
}
