//! The list itself.

use crate::paths::Paths;
use crate::procedural::{GenerateError, MOST, SCENES, find, generate};

#[test]
fn a_name_that_is_not_known_is_answered_with_the_nearest() {
    for (asked, nearest) in
        [("ballz", "balls"), ("Gears", "gears"), ("moutn", "mount"), ("forrest", "forest")]
    {
        let GenerateError::Unknown { nearest: found, .. } = find(asked).expect_err("it is refused")
        else {
            panic!("{asked} is not known")
        };
        assert_eq!(found, nearest);
    }
    let message = generate("ballz", None).expect_err("it is refused").to_string();
    assert_eq!(message, "no scene is called \"ballz\"; did you mean \"balls\"?");
    let long = find(&"x".repeat(1_000_000)).expect_err("it is refused").to_string();
    assert!(long.len() < 120, "{long}");
    assert!(find("").is_err());
}

#[test]
fn a_size_that_is_too_small_or_too_large_is_refused_by_name() {
    let message = generate("mount", Some(8)).expect_err("it is refused").to_string();
    assert_eq!(message, "\"mount\" cannot be made at size 8: depth, from 1 to 7");
    for entry in SCENES {
        let large = entry.sizes.end().checked_add(1);
        let small = entry.sizes.start().checked_sub(1);
        for size in large.into_iter().chain(small).chain([u32::MAX]) {
            let error = generate(entry.name, Some(size)).expect_err("it is refused");
            assert!(matches!(error, GenerateError::Size { .. }), "{}: {error}", entry.name);
        }
    }
}

#[test]
fn no_scene_is_too_large_at_any_size() {
    for entry in SCENES {
        assert!(entry.sizes.contains(&entry.default), "{}", entry.name);
        let most = (entry.primitives)(*entry.sizes.end());
        assert!(most <= MOST, "{} has {most} primitives", entry.name);
    }
}

#[test]
fn names_are_different_words() {
    for (i, entry) in SCENES.iter().enumerate() {
        assert!(SCENES[..i].iter().all(|other| other.name != entry.name), "{}", entry.name);
        assert!(entry.name.bytes().all(|b| b.is_ascii_lowercase() || b == b'-'));
        assert!(!entry.about.is_empty() && !entry.unit.is_empty());
    }
}

#[test]
fn every_scene_is_whole_and_has_as_many_primitives_as_it_says() {
    for entry in SCENES {
        let small = *entry.sizes.start();
        for size in [small, small + 1, entry.default.min(20_000)] {
            let scene = (entry.build)(size);
            let stored: u64 = scene.geometries.iter().map(|g| u64::from(g.primitives())).sum();
            assert_eq!(stored, (entry.primitives)(size), "{} at {size}", entry.name);
            Paths::new(&scene).expect("places can be numbered");
            let known = |count: usize, index: usize| assert!(index < count, "{}", entry.name);
            for geometry in &scene.geometries {
                known(scene.materials.len(), geometry.material);
                let bounds = geometry.bounds();
                assert!(geometry.primitives() > 0, "{}: {}", entry.name, geometry.name);
                assert!(bounds.is_empty() || bounds.is_bounded(), "{}", entry.name);
            }
            for group in &scene.groups {
                group.geometries.iter().for_each(|&g| known(scene.geometries.len(), g));
                group.places.iter().for_each(|place| known(scene.groups.len(), place.group));
            }
            assert!(!scene.cameras.is_empty() && scene.bounds().is_bounded(), "{}", entry.name);
        }
    }
}
