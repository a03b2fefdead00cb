use glam::Vec3A;

use super::*;

/// Boxes of all sizes, some flat.
fn boxes(count: u32, seed: u32) -> Vec<Aabb> {
    let part = |i: u32, k: u32| {
        let mut x = (i * 8 + k) ^ seed.wrapping_mul(0x9e37_79b9);
        for _ in 0..3 {
            x = (x ^ (x >> 16)).wrapping_mul(0x7feb_352d);
            x ^= x >> 15;
        }
        (x >> 8) as f32 / (1 << 24) as f32
    };
    let one = |i: u32| {
        let at = |k: u32| Vec3A::new(part(i, k), part(i, k + 1), part(i, k + 2));
        let min = at(0) * 10.0;
        let mut size = at(3) * if i.is_multiple_of(7) { 5.0 } else { 0.2 };
        if i.is_multiple_of(5) {
            size.y = 0.0;
        }
        Aabb { min, max: min + size }
    };
    (0..count).map(one).collect()
}

/// The tree after a child went to a place.
fn cost_with(tree: &Grown<'_>, place: Place, child: u32) -> f64 {
    let mut after = Grown::new(tree.boxes, tree.visits);
    after.root = tree.root;
    after.volumes = tree.volumes.clone();
    after.put(place, child);
    after.whole()
}

#[test]
fn no_place_is_cheaper_than_the_one_found_and_its_price_is_right() {
    for seed in 0..4 {
        let boxes = boxes(200, seed);
        let mut tree = Grown::new(&boxes, usize::MAX);
        tree.insert(0);
        for child in 1..200 {
            let root = tree.root.expect("there is one");
            let before = tree.whole();
            let (place, price) = tree.best(root, boxes[child as usize]);
            let paid = cost_with(&tree, place, child) - before;
            assert!((paid - price).abs() <= 1e-9 * (before + paid), "seed {seed}: {paid} {price}");
            let mut places = vec![Place::With(root, None)];
            for (volume, at) in tree.volumes.iter().zip(boxes.len() as u32..) {
                if usize::from(volume.count) < ROOM {
                    places.push(Place::In(at));
                }
                let parts = &volume.parts[..usize::from(volume.count)];
                places.extend(parts.iter().map(|&part| Place::With(part, Some(at))));
            }
            for other in places {
                let cost = cost_with(&tree, other, child) - before;
                assert!(cost >= paid - 1e-9 * (before + paid), "seed {seed}: {other:?} is cheaper");
            }
            tree.insert(child);
        }
    }
}

#[test]
fn volumes_hold_their_parts_and_pairs_hold_every_child_once() {
    let mut boxes = boxes(500, 9);
    boxes.extend(vec![boxes[0]; 500]);
    let mut tree = Grown::new(&boxes, 32);
    (0..1000).for_each(|child| tree.insert(child));
    for (volume, at) in tree.volumes.iter().zip(boxes.len() as u32..) {
        for &part in &volume.parts[..usize::from(volume.count)] {
            assert!(volume.bounds.contains(&tree.bounds(part)));
            if part as usize >= boxes.len() {
                assert_eq!(tree.volumes[part as usize - boxes.len()].parent, Some(at));
            }
        }
    }
    let merges = tree.merges();
    assert_eq!(merges.len(), 999);
    let mut seen = vec![false; 1999];
    for (side, merge) in merges.iter().zip(1000u32..).flat_map(|(m, i)| m.map(|side| (side, i))) {
        assert!(side < merge, "made of what was there");
        assert!(!std::mem::replace(&mut seen[side as usize], true), "{side} is merged twice");
    }
    assert_eq!(seen.iter().filter(|&&seen| !seen).count(), 1, "the root");
}
