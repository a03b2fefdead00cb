//! The volumes: how far they reach along each direction, and their surface.

use glam::{DVec3, Vec3A};
use nestray_core::aabb::Aabb;
use nestray_core::family::Family;
use nestray_core::technique::{Expected, Leaves, Step};
use rayon::prelude::*;

use super::{SlabsIndex, planes};
use crate::wide_tree::{WideTree, area};

/// For each node of `tree`, and each direction, how far its eight parts reach.
pub(super) fn rows(
    tree: &WideTree,
    family: &dyn Family,
    leaves: &Leaves,
    directions: &[Vec3A],
) -> Vec<[[f32; 8]; 2]> {
    let nodes: Vec<Vec<(Aabb, Step)>> = tree.nodes().collect();
    let nowhere = [[f32::INFINITY; 8], [f32::NEG_INFINITY; 8]];
    let mut rows = vec![nowhere; nodes.len() * directions.len()];
    // Nodes come before what is below them.
    for (at, parts) in nodes.iter().enumerate().rev() {
        for (set, &direction) in directions.iter().enumerate() {
            for (lane, (bounds, step)) in parts.iter().enumerate() {
                let [low, high] = if step.is_onward() {
                    let [lows, highs] = &rows[step.word() as usize * directions.len() + set];
                    [
                        lows.iter().copied().fold(f32::INFINITY, f32::min),
                        highs.iter().copied().fold(f32::NEG_INFINITY, f32::max),
                    ]
                } else {
                    let children = leaves.of(step.as_leaf().0 as usize).iter();
                    children
                        .map(|&child| reach(family, child, direction))
                        .fold([f32::INFINITY, f32::NEG_INFINITY], |[low, high], [a, b]| {
                            [low.min(a), high.max(b)]
                        })
                };
                let [least, most] = bounds.along(direction);
                let [lows, highs] = &mut rows[at * directions.len() + set];
                (lows[lane], highs[lane]) = (low.max(least), high.min(most));
            }
        }
    }
    rows
}

/// How far a child reaches: no farther than its box does.
fn reach(family: &dyn Family, child: u32, direction: Vec3A) -> [f32; 2] {
    let [least, most] = family.bounds(child).along(direction);
    let [low, high] = family.along(child, direction);
    // A NaN is no answer.
    [low.max(least), high.min(most)]
}

/// What a random line does that meets the box around all.
pub(super) fn expected(index: &SlabsIndex, family: &dyn Family, leaves: &Leaves) -> Expected {
    let mut tests = vec![0.0; family.count() as usize];
    let directions = &planes::SLANTING[index.from..index.to];
    let volume = |node: usize, lane: usize, bounds: Aabb| {
        let rows = index.rows(node).iter().map(|row| [row[0][lane], row[1][lane]]);
        Volume { bounds, reach: rows.collect() }
    };
    let nodes: Vec<Vec<(Aabb, Step)>> = index.tree.nodes().collect();
    let root = nodes[0].iter().fold(Aabb::EMPTY, |all, part| all.join(part.0));
    let whole = area(root).max(f64::MIN_POSITIVE);
    let areas: Vec<Vec<f64>> = (0..nodes.len())
        .into_par_iter()
        .map(|node| {
            let parts = nodes[node].iter().enumerate();
            parts.map(|(lane, part)| volume(node, lane, part.0).area(directions)).collect()
        })
        .collect();
    let mut steps = 1.0;
    for (parts, areas) in nodes.iter().zip(&areas) {
        for (&(_, step), area) in parts.iter().zip(areas) {
            let share = (area / whole).min(1.0);
            if step.is_onward() {
                steps += share;
            } else {
                for &child in leaves.of(step.as_leaf().0 as usize) {
                    tests[child as usize] += share as f32;
                }
            }
        }
    }
    Expected { steps, tests }
}

/// What lies between several pairs of parallel planes.
pub(super) struct Volume {
    pub(super) bounds: Aabb,
    /// For each slanting direction.
    pub(super) reach: Vec<[f32; 2]>,
}

impl Volume {
    /// Surface area: each face is its plane, cut by all others.
    pub(super) fn area(&self, directions: &[Vec3A]) -> f64 {
        if directions.is_empty() {
            return area(self.bounds);
        }
        let center = self.bounds.center().as_dvec3();
        let mut planes = Vec::with_capacity(2 * (3 + directions.len()));
        let axes = [Vec3A::X, Vec3A::Y, Vec3A::Z].into_iter().enumerate();
        let along_axes =
            axes.map(|(axis, dir)| (dir, [self.bounds.min[axis], self.bounds.max[axis]]));
        let slanting = directions.iter().copied().zip(self.reach.iter().copied());
        for (direction, [low, high]) in along_axes.chain(slanting) {
            let direction = direction.as_dvec3();
            let (length, middle) = (direction.length(), direction.dot(center));
            planes.push((-direction / length, (middle - f64::from(low)) / length));
            planes.push((direction / length, (f64::from(high) - middle) / length));
        }
        let size = self.bounds.size().as_dvec3().length();
        (0..planes.len()).map(|face| face_area(&planes, face, size)).sum()
    }
}

/// The area of one face of the body `normal · point ≤ distance`, which is no wider than `size`.
fn face_area(planes: &[(DVec3, f64)], face: usize, size: f64) -> f64 {
    let (normal, distance) = planes[face];
    let (u, v) = normal.any_orthonormal_pair();
    let (u, v, middle) = (u * size, v * size, normal * distance);
    let mut corners = vec![middle - u - v, middle + u - v, middle + u + v, middle - u + v];
    for (_, &(normal, distance)) in planes.iter().enumerate().filter(|&(other, _)| other != face) {
        if corners.is_empty() {
            return 0.0;
        }
        corners = cut(&corners, normal, distance);
    }
    let fan = corners.windows(2).map(|side| (side[0] - middle).cross(side[1] - middle));
    let last = corners.last().zip(corners.first());
    let last = last.map_or(DVec3::ZERO, |(a, &b)| (*a - middle).cross(b - middle));
    (fan.sum::<DVec3>() + last).length() / 2.0
}

/// The part of a convex polygon on the inner side of a plane [Sutherland 74].
fn cut(corners: &[DVec3], normal: DVec3, distance: f64) -> Vec<DVec3> {
    let mut inside = Vec::with_capacity(corners.len() + 1);
    for (i, &a) in corners.iter().enumerate() {
        let b = corners[(i + 1) % corners.len()];
        let (from, to) = (normal.dot(a) - distance, normal.dot(b) - distance);
        if from <= 0.0 {
            inside.push(a);
        }
        if (from < 0.0 && to > 0.0) || (from > 0.0 && to < 0.0) {
            inside.push(a + (b - a) * (from / (from - to)));
        }
    }
    inside
}
