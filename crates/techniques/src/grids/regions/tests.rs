//! What regions are, and that rays meet the same with and without.

use glam::Vec3A;
use nestray_core::aabb::Aabb;
use nestray_core::technique::{Index, Leaves, Step, Visit};

use super::super::tests::{made, rays, send};
use super::super::{Crowd, Grids, Rule};
use super::{EMPTY, REGION};
use crate::cells::Children;
use crate::cells::tests::boxes;
use crate::counted::walk;
use crate::macro_regions::MacroRegions;

/// A grid as fine as one with regions, without.
#[derive(Debug)]
struct Plain(MacroRegions);

impl Rule for Plain {
    fn part(&self, cell: Aabb, hull: Aabb) -> Aabb {
        self.0.part(cell, hull)
    }
    fn cut(&self, crowd: &Crowd<'_>) -> Option<[u32; 3]> {
        self.0.cut(crowd)
    }
}

#[test]
fn regions_are_empty_and_rays_meet_the_same_without_them() {
    let family = boxes(7, 500);
    let with = MacroRegions { density: 50.0 };
    let (grids, _) = made(&with, &family);
    let plain = Grids::new(&Plain(with), &Children::new(&family), &mut Leaves::default());
    assert!(grids.regions.len() > 20, "{} regions", grids.regions.len());
    let frame = &grids.frames[0];
    for region in &grids.regions {
        for cell in region.cells() {
            let slot = frame.slot(cell) as usize;
            assert!(grids.words[slot] & REGION != 0 && plain.words[slot] == EMPTY);
        }
    }
    for cell in frame.all().cells() {
        let word = grids.words[frame.slot(cell) as usize];
        if Step::from_word(word).is_onward() && word & REGION != 0 {
            let region = &grids.regions[(word & !REGION) as usize];
            assert!(region.cells().any(|inside| inside == cell), "{cell:?} {region:?}");
        }
    }
    let (mut fewer, mut all) = (0, 0);
    let most = grids.cells().into_iter().sum::<u32>() as usize;
    for (i, ray) in rays(8, &grids, 5000).iter().enumerate() {
        let (shown, steps) = send(&grids, &family, ray);
        let (same, without) = send(&plain, &family, ray);
        assert_eq!(shown, same, "ray {i}");
        if i % 6 < 2 {
            assert!(steps <= most, "ray {i}: {steps} steps");
            (fewer, all) = (fewer + steps, all + without);
        }
    }
    assert!(fewer * 2 < all, "{fewer} steps, {all} without regions");
}

#[test]
fn a_child_of_a_grid_with_regions_is_new_once() {
    let mut family = boxes(12, 500);
    family.0.push(Aabb { min: Vec3A::splat(0.05), max: Vec3A::splat(0.95) });
    let (grids, leaves) = made(&MacroRegions { density: 30.0 }, &family);
    assert!(!grids.regions.is_empty() && grids.wide.is_some());
    let mut asked = 0;
    for (i, ray) in rays(13, &grids, 6000).iter().enumerate() {
        let (mut new, mut shown) = (vec![0; family.0.len()], vec![false; family.0.len()]);
        let mut known = true;
        walk(&grids, &family, ray, |leaf, cursor| {
            for &child in leaves.of(leaf.0 as usize) {
                let visit = grids.visit(cursor, child);
                known &= visit != Visit::Unknown;
                shown[child as usize] = true;
                new[child as usize] += u32::from(visit == Visit::First);
            }
        });
        for (child, &shown) in shown.iter().enumerate().filter(|_| known) {
            assert_eq!(new[child], u32::from(shown), "ray {i}, child {child}");
            asked += new[child];
        }
        assert!(known || i % 6 > 1, "ray {i} is from near");
    }
    assert!(asked > 10_000, "{asked}");
}
