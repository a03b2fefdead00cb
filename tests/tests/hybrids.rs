//! Techniques whose leaves are put in order by others answer as exhaustive search does.

use nestray_core::aim::Aims;
use nestray_core::object::DynObject;
use nestray_plan::presets::PRESETS;
use nestray_registry::hybrid::{self, Filling};
use nestray_registry::{Entry, TECHNIQUES};
use nestray_tests::compare::assert_equal;
use nestray_tests::rays::{following, hard, lamps, lit};
use nestray_tests::worlds::{World, crowds, families};
use serde_json::Value;

/// Leaves of a few children by this technique.
fn leaves(entry: &'static Entry, aims: &Aims, is_lazy: bool) -> Filling {
    let params = (entry.aimed)(&Value::Null, aims).expect("defaults");
    Filling { params, more_than: 2, per_leaf: 8, is_lazy, ..Filling::new(entry) }
}

fn build(entry: &Entry, filling: &Filling, aims: &Aims, world: &World) -> DynObject {
    let params = (entry.aimed)(&Value::Null, aims).expect("defaults");
    hybrid::build(entry, &params, Some(filling), world.members.clone()).expect("defaults")
}

#[test]
fn every_technique_over_every_other_agrees_with_the_list() {
    for (seed, world) in (0..).zip(families(11)) {
        let oracle = world.oracle();
        let lamps = lamps(world.bounds());
        let mut rays = hard(seed, world.bounds(), &world.aims, 160);
        rays.extend(following(seed, &oracle, &rays[..80]));
        rays.extend(lit(seed, &lamps, &rays[..40]));
        for (i, above) in TECHNIQUES.iter().enumerate() {
            for (j, below) in TECHNIQUES.iter().enumerate() {
                let filling = leaves(below, &lamps, (i + j) % 3 == 0);
                let nest = build(above, &filling, &lamps, &world);
                let what = format!("{} over {} over {}", above.name, below.name, world.name);
                assert_equal(&oracle, &nest, &rays, &what);
            }
        }
    }
}

#[test]
fn presets_agree_with_the_list_on_every_family_and_on_crowds() {
    for (seed, world) in (0..).zip(families(12).into_iter().chain(crowds(13))) {
        let oracle = world.oracle();
        let mut rays = hard(seed, world.bounds(), &world.aims, 1_000);
        rays.extend(following(seed, &oracle, &rays[..500]));
        for preset in PRESETS {
            let nest = preset.build(world.members.clone());
            assert_equal(&oracle, &nest, &rays, &format!("{} over {}", preset.name, world.name));
        }
    }
}

#[test]
fn presets_make_hybrids_of_crowds() {
    for world in crowds(14).into_iter().filter(|world| world.members.count() > 1_000) {
        for preset in PRESETS {
            let nest = preset.build(world.members.clone());
            let leaves = preset.nest().leaves.expect("it is a hybrid");
            let is_filled = |kind: &str| kind == "lazy" || kind == leaves.technique;
            let (mut filled, mut all) = (0, 0);
            nest.visit_children(&mut |child| {
                (filled, all) = (filled + usize::from(is_filled(child.kind())), all + 1);
            });
            // A crowd may also be one leaf as a whole.
            let is_whole = preset.nest().technique != nest.kind() && is_filled(nest.kind());
            let what = format!("{} over {}: {filled} of {all}", preset.name, world.name);
            assert!(filled > 0 || is_whole, "{what}");
        }
    }
}
