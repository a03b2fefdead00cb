//! No child is tested twice for one ray inside one aggregate, however many cells it spans.

use std::sync::Arc;
use std::sync::atomic::{AtomicU32, Ordering};

use nestray_core::aabb::Aabb;
use nestray_core::cost::{Cost, CostModel};
use nestray_core::hit::Hit;
use nestray_core::object::{DynObject, Object};
use nestray_core::ray::Ray;
use nestray_core::scratch::Scratch;
use nestray_core::surface::Surface;
use nestray_registry::hybrid::{self, Filling};
use nestray_registry::{Members, TECHNIQUES, find};
use nestray_tests::numbers::Numbers;
use nestray_tests::rays::hard;
use serde_json::Value;

/// A box that is never hit and counts how often it is asked.
#[derive(Debug)]
struct Counted {
    bounds: Aabb,
    asked: AtomicU32,
}

impl Object for Counted {
    fn kind(&self) -> &'static str {
        "counted"
    }
    fn bounds(&self) -> Aabb {
        self.bounds
    }
    fn closest_hit(&self, _ray: &Ray, _hit: &mut Hit, _scratch: &mut Scratch) -> bool {
        self.asked.fetch_add(1, Ordering::Relaxed);
        false
    }
    fn all_hits(&self, _ray: &Ray, _hits: &mut Vec<Hit>, _scratch: &mut Scratch) {
        self.asked.fetch_add(1, Ordering::Relaxed);
    }
    fn surface(&self, _ray: &Ray, _hit: &Hit) -> Option<Surface> {
        None
    }
    fn cost(&self, _model: &CostModel) -> Cost {
        Cost::primitive(10.0, 0.0, 0)
    }
}

/// Boxes of all sizes: some in one cell, some in nearly all.
fn boxes(numbers: &mut Numbers) -> Vec<Arc<Counted>> {
    (0..200)
        .map(|_| {
            let size = *numbers.pick(&[0.01, 0.1, 0.3, 0.8]);
            let min = numbers.point();
            let bounds = Aabb { min, max: min + numbers.point() * size };
            Arc::new(Counted { bounds, asked: AtomicU32::new(0) })
        })
        .collect()
}

/// Each technique alone, and with leaves by another; what it is comes first.
fn nests(children: &[DynObject]) -> Vec<(String, DynObject)> {
    let mut nests = Vec::new();
    for entry in TECHNIQUES {
        for inner in [None, Some("octree"), Some("bvh")] {
            let filling = inner.map(|name| {
                let inner = Filling::new(find(name).expect("it is in the registry"));
                Filling { more_than: 3, per_leaf: 12, is_lazy: name == "bvh", ..inner }
            });
            let members = Members::Objects(children.to_vec());
            let nest = hybrid::build(entry, &Value::Null, filling.as_ref(), members);
            nests.push((format!("{} over {inner:?}", entry.name), nest.expect("defaults")));
        }
    }
    nests
}

#[test]
fn every_query_asks_each_child_once_at_most() {
    let mut seen = 0;
    for seed in 0..20 {
        let children = boxes(&mut Numbers::new(seed));
        let bounds = children.iter().fold(Aabb::EMPTY, |all, child| all.join(child.bounds));
        let aims: Vec<_> = children.iter().map(|child| child.bounds.min).collect();
        let rays = hard(seed, bounds, &aims, 200);
        let objects: Vec<_> = children.iter().map(|child| Arc::clone(child) as DynObject).collect();
        for (name, nest) in nests(&objects) {
            let mut scratch = Scratch::new();
            for (i, ray) in rays.iter().enumerate() {
                let queries: [&mut dyn FnMut(); 4] = [
                    &mut || _ = nest.closest_hit(ray, &mut Hit::none(ray.t_max()), &mut scratch),
                    &mut || _ = nest.any_hit(ray, &mut Scratch::counting()),
                    &mut || nest.all_hits(ray, &mut Vec::new(), &mut Scratch::new()),
                    &mut || {
                        nest.closest_hits(
                            &[*ray],
                            &mut [Hit::none(ray.t_max())],
                            &mut Scratch::new(),
                        )
                    },
                ];
                for (query, ask) in queries.into_iter().enumerate() {
                    ask();
                    for child in &children {
                        let asked = child.asked.swap(0, Ordering::Relaxed);
                        seen += asked;
                        assert!(
                            asked <= 1,
                            "{name}, query {query}, seed {seed}, ray {i}: {asked} times"
                        );
                    }
                }
            }
        }
    }
    assert!(seen > 100_000, "children were hardly asked: {seen}");
}
