//! How often random lines meet any of several boxes: what a child is tested for that stands in
//! several leaves, and is tested once.
//!
//! Where the boxes fill the box around them, that is convex, and its surface says it. Otherwise
//! lines are sent through boxes picked by their surface, and each counts as one over how many of
//! the boxes it meets [Karp 83].

use glam::Vec3A;
use nestray_core::aabb::Aabb;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;
use rayon::prelude::*;

use crate::lines;
use crate::wide_tree::area;

/// Lines sent for all children together, about.
const LINES: u32 = 1 << 17;
/// Lines sent for one child: no fewer, no more.
const EACH: [u32; 2] = [8, 64];

/// The boxes of leaves, and who stands in which.
#[derive(Debug, Default)]
pub(crate) struct Standing {
    boxes: Vec<Aabb>,
    /// Who, and in which box.
    entries: Vec<[u32; 2]>,
}

impl Standing {
    /// Adds a box and who stands in it.
    pub(crate) fn add(&mut self, bounds: Aabb, members: &[u32]) {
        let number = self.boxes.len() as u32;
        self.boxes.push(bounds);
        self.entries.extend(members.iter().map(|&member| [member, number]));
    }

    /// For each of `count` how often lines that meet a box of surface `whole` meet one of its
    /// boxes at least.
    pub(crate) fn chances(self, count: u32, whole: f64) -> Vec<f32> {
        let chance = |area: &f64| (area / whole).min(1.0) as f32;
        self.areas(count).iter().map(chance).collect()
    }

    /// For each of `count` the surface of a convex body that lines meet as often as its boxes; 0
    /// for who stands in none.
    pub(crate) fn areas(mut self, count: u32) -> Vec<f64> {
        self.entries.par_sort_unstable();
        let starts: Vec<usize> = (0..=count)
            .into_par_iter()
            .map(|member| self.entries.partition_point(|entry| entry[0] < member))
            .collect();
        let lines = (LINES / count.max(1)).clamp(EACH[0], EACH[1]);
        let area = |member: u32| {
            let at = member as usize;
            let own = &self.entries[starts[at]..starts[at + 1]];
            let own: Vec<Aabb> = own.iter().map(|entry| self.boxes[entry[1] as usize]).collect();
            joint_area(&own, lines, member.into())
        };
        (0..count).into_par_iter().map(area).collect()
    }
}

/// The same for some boxes.
fn joint_area(boxes: &[Aabb], lines: u32, seed: u64) -> f64 {
    match boxes {
        [] => return 0.0,
        [only] => return area(*only),
        _ => {}
    }
    let hull = boxes.iter().fold(Aabb::EMPTY, |hull, part| hull.join(*part));
    let volume = |bounds: &Aabb| bounds.size().as_dvec3().element_product();
    let full = volume(&hull);
    let share = boxes.iter().map(volume).sum::<f64>() / full;
    if (0.999..1.001).contains(&share) {
        return area(hull);
    }
    let mut total = 0.0;
    let ends: Vec<f64> = boxes
        .iter()
        .map(|part| {
            total += area(*part);
            total
        })
        .collect();
    let mut numbers = Pcg64Mcg::seed_from_u64(seed);
    let mut parts = 0.0;
    for line in 0..lines {
        // One of each of as many equal shares of the surface.
        let pick = (f64::from(line) + numbers.random::<f64>()) / f64::from(lines) * total;
        let from = ends.partition_point(|&end| end <= pick).min(boxes.len() - 1);
        let (point, dir) = lines::through(&boxes[from], &mut numbers);
        let others = boxes.iter().enumerate().filter(|&(other, _)| other != from);
        let met = others.filter(|(_, part)| crosses(point, dir.recip(), part)).count();
        parts += 1.0 / (1 + met) as f64;
    }
    (total * parts / f64::from(lines)).min(area(hull))
}

/// Whether a line crosses a box.
fn crosses(point: Vec3A, inverse: Vec3A, bounds: &Aabb) -> bool {
    let (a, b) = ((bounds.min - point) * inverse, (bounds.max - point) * inverse);
    a.min(b).max_element() <= a.max(b).min_element()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cube(at: [f32; 3]) -> Aabb {
        Aabb { min: at.into(), max: Vec3A::from(at) + 1.0 }
    }

    /// The mean over many seeds.
    fn mean(boxes: &[Aabb]) -> f64 {
        (0..4000).map(|seed| joint_area(boxes, EACH[0], seed)).sum::<f64>() / 4000.0
    }

    #[test]
    fn boxes_that_fill_one_have_its_surface() {
        assert_eq!(joint_area(&[], 8, 1), 0.0);
        assert_eq!(joint_area(&[cube([0.0; 3])], 8, 1), 6.0);
        let row = [cube([0.0; 3]), cube([1.0, 0.0, 0.0])];
        assert_eq!(joint_area(&row, 8, 1), 10.0);
    }

    #[test]
    fn boxes_far_apart_add_up_and_boxes_in_one_place_do_not() {
        let far = mean(&[cube([0.0; 3]), cube([1000.0, 500.0, 200.0])]);
        assert!((far / 12.0 - 1.0).abs() < 0.01, "{far}");
        let flat = Aabb { min: Vec3A::ZERO, max: Vec3A::new(1.0, 1.0, 0.0) };
        assert!((mean(&[flat; 5]) / 2.0 - 1.0).abs() < 1e-6);
    }

    #[test]
    fn lines_that_meet_a_corner_of_boxes_are_counted_once() {
        // Three cubes around a corner: what lines do that meet the box around them.
        let boxes = [cube([0.0; 3]), cube([1.0, 0.0, 0.0]), cube([0.0, 1.0, 0.0])];
        let hull = boxes[0].join(boxes[1]).join(boxes[2]);
        let mut numbers = Pcg64Mcg::seed_from_u64(7);
        let lines = 100_000;
        let met = (0..lines)
            .filter(|_| {
                let (point, dir) = lines::through(&hull, &mut numbers);
                boxes.iter().any(|part| crosses(point, dir.recip(), part))
            })
            .count();
        let expected = area(hull) * met as f64 / f64::from(lines);
        let found = mean(&boxes);
        assert!((found / expected - 1.0).abs() < 0.01, "{found} for {expected}");
    }

    #[test]
    fn each_child_has_the_boxes_it_stands_in() {
        let mut standing = Standing::default();
        standing.add(cube([0.0; 3]), &[2, 0]);
        standing.add(cube([1.0, 0.0, 0.0]), &[2]);
        assert_eq!(standing.areas(4), [6.0, 0.0, 10.0, 0.0]);
    }
}
