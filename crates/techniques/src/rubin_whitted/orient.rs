//! Which way the boxes of a node are best turned.

use glam::{DMat3, DVec3, Vec3A};
use nestray_core::aabb::Aabb;
use nestray_core::family::Family;
use nestray_core::technique::{Expected, Leaves, Step};

use super::{RubinWhitted, RubinWhittedIndex, Turned};
use crate::wide_tree::{WideTree, area};

/// The parts of each node: boxes, and what they are.
type Nodes = Vec<Vec<(Aabb, Step)>>;

/// A note for each node, and the boxes of those that are turned.
pub(super) fn turned(
    params: &RubinWhitted,
    tree: &WideTree,
    family: &dyn Family,
    leaves: &Leaves,
) -> (Vec<u32>, Vec<Turned>) {
    let nodes: Nodes = tree.nodes().collect();
    let below = below(&nodes, leaves);
    let (mut notes, mut turned) = (vec![0; nodes.len()], Vec::new());
    for (node, parts) in nodes.iter().enumerate() {
        if below[node] > params.most_below {
            continue;
        }
        let children: Vec<Vec<u32>> =
            parts.iter().map(|&(_, step)| children(&nodes, leaves, step)).collect();
        let mut least = parts.iter().map(|part| area(part.0)).sum::<f64>() / f64::from(params.gain);
        for axes in candidates(family, &children) {
            let boxes = around(family, &children, axes);
            let all = (0..parts.len()).map(|lane| boxes.area(lane)).sum::<f64>();
            if all < least {
                least = all;
                turned.truncate(turned.len() - usize::from(notes[node] != 0));
                turned.push(boxes);
                notes[node] = turned.len() as u32;
            }
        }
    }
    (notes, turned)
}

/// How many children are below each node.
fn below(nodes: &Nodes, leaves: &Leaves) -> Vec<usize> {
    let mut below = vec![0; nodes.len()];
    // Nodes come before what is below them.
    for (node, parts) in nodes.iter().enumerate().rev() {
        let one = |step: Step| {
            if step.is_onward() {
                below[step.word() as usize]
            } else {
                leaves.of(step.as_leaf().0 as usize).len()
            }
        };
        below[node] = parts.iter().map(|part| one(part.1)).sum();
    }
    below
}

/// All children in a part.
fn children(nodes: &Nodes, leaves: &Leaves, step: Step) -> Vec<u32> {
    let (mut open, mut found) = (vec![step], Vec::new());
    while let Some(step) = open.pop() {
        if step.is_onward() {
            open.extend(nodes[step.word() as usize].iter().map(|part| part.1));
        } else {
            found.extend(leaves.of(step.as_leaf().0 as usize));
        }
    }
    found
}

/// Ways to turn the boxes of a node: by an eighth about each axis, as all children together lie,
/// as most parts do, and as the largest does.
fn candidates(family: &dyn Family, children: &[Vec<u32>]) -> Vec<[Vec3A; 3]> {
    let half = std::f32::consts::FRAC_1_SQRT_2;
    let mut frames = vec![
        [Vec3A::X, Vec3A::new(0.0, half, half), Vec3A::new(0.0, half, -half)],
        [Vec3A::Y, Vec3A::new(half, 0.0, half), Vec3A::new(half, 0.0, -half)],
        [Vec3A::Z, Vec3A::new(half, half, 0.0), Vec3A::new(half, -half, 0.0)],
    ];
    let reaches: Vec<[[f32; 2]; 9]> = children.iter().map(|part| reaches(family, part)).collect();
    let all = reaches.iter().copied().reduce(joined).map(shape);
    let parts: Vec<DMat3> = reaches.iter().copied().map(shape).collect();
    let size = |shape: &DMat3| shape.col(0).x + shape.col(1).y + shape.col(2).z;
    let largest = parts.iter().copied().max_by(|a, b| size(a).total_cmp(&size(b)));
    let most = parts.iter().fold(DMat3::ZERO, |all, part| all + *part);
    frames.extend([all, Some(most), largest].into_iter().flatten().filter_map(principal));
    frames
}

/// The axes, then the diagonals of a cube's faces by twos.
const NINE: [Vec3A; 9] = [
    Vec3A::X,
    Vec3A::Y,
    Vec3A::Z,
    Vec3A::new(0.0, 1.0, 1.0),
    Vec3A::new(0.0, 1.0, -1.0),
    Vec3A::new(1.0, 0.0, 1.0),
    Vec3A::new(1.0, 0.0, -1.0),
    Vec3A::new(1.0, 1.0, 0.0),
    Vec3A::new(1.0, -1.0, 0.0),
];

const NOWHERE: [f32; 2] = [f32::INFINITY, f32::NEG_INFINITY];

fn reaches(family: &dyn Family, children: &[u32]) -> [[f32; 2]; 9] {
    NINE.map(|direction| reach(family, children, direction))
}

fn joined(mut a: [[f32; 2]; 9], b: [[f32; 2]; 9]) -> [[f32; 2]; 9] {
    for (a, b) in a.iter_mut().zip(b) {
        *a = [a[0].min(b[0]), a[1].max(b[1])];
    }
    a
}

/// How far children reach along a direction: no farther than their boxes do.
fn reach(family: &dyn Family, children: &[u32], direction: Vec3A) -> [f32; 2] {
    children.iter().fold(NOWHERE, |[low, high], &child| {
        let [least, most] = family.bounds(child).along(direction);
        let [a, b] = family.along(child, direction);
        // A NaN is no answer.
        [low.min(a.max(least)), high.max(b.min(most))]
    })
}

/// The quadratic form that gives the squared width along each of nine directions; for an ellipsoid
/// or a line segment along all there are.
fn shape(reaches: [[f32; 2]; 9]) -> DMat3 {
    let square = reaches.map(|[low, high]| (f64::from(high) - f64::from(low)).powi(2));
    let [xx, yy, zz] = [square[0], square[1], square[2]];
    let mixed = |first: usize| (square[first] - square[first + 1]) / 4.0;
    let (yz, xz, xy) = (mixed(3), mixed(5), mixed(7));
    DMat3::from_cols(DVec3::new(xx, xy, xz), DVec3::new(xy, yy, yz), DVec3::new(xz, yz, zz))
}

/// The main axes of a quadratic form, by Jacobi's rotations; none if they are those of space.
fn principal(shape: DMat3) -> Option<[Vec3A; 3]> {
    let mut form = shape.to_cols_array_2d();
    let mut axes = DMat3::IDENTITY.to_cols_array_2d();
    let size = form[0][0] + form[1][1] + form[2][2];
    let slant = form[0][1].abs() + form[0][2].abs() + form[1][2].abs();
    // Not so for what is not finite, either.
    if !(slant > 1e-4 * size && size.is_finite()) {
        return None;
    }
    for turn in 0..24 {
        let (p, q) = [(0, 1), (0, 2), (1, 2)][turn % 3];
        if form[p][q] == 0.0 {
            continue;
        }
        let ratio = (form[q][q] - form[p][p]) / (2.0 * form[p][q]);
        let tan = ratio.signum() / (ratio.abs() + (ratio * ratio + 1.0).sqrt());
        let cos = 1.0 / (tan * tan + 1.0).sqrt();
        let sin = tan * cos;
        for row in &mut form {
            (row[p], row[q]) = (cos * row[p] - sin * row[q], sin * row[p] + cos * row[q]);
        }
        for k in 0..3 {
            let (a, b) = (form[p][k], form[q][k]);
            (form[p][k], form[q][k]) = (cos * a - sin * b, sin * a + cos * b);
            let (a, b) = (axes[p][k], axes[q][k]);
            (axes[p][k], axes[q][k]) = (cos * a - sin * b, sin * a + cos * b);
        }
    }
    Some(axes.map(|axis| DVec3::from_array(axis).as_vec3a()))
}

/// Boxes around parts, turned.
fn around(family: &dyn Family, children: &[Vec<u32>], axes: [Vec3A; 3]) -> Turned {
    let mut rows = [[[f32::INFINITY; 8], [f32::NEG_INFINITY; 8]]; 3];
    for (rows, &axis) in rows.iter_mut().zip(&axes) {
        for (lane, part) in children.iter().enumerate() {
            [rows[0][lane], rows[1][lane]] = reach(family, part, axis);
        }
    }
    Turned { axes, rows }
}

impl Turned {
    /// Surface area of one box.
    pub(super) fn area(&self, lane: usize) -> f64 {
        let [a, b, c] = self.rows.map(|[low, high]| f64::from(high[lane]) - f64::from(low[lane]));
        2.0 * (a * b + b * c + c * a)
    }
}

/// What a random line does that meets the box around all. Turned boxes may stick out of those
/// above, and are met no more often.
pub(super) fn expected(
    index: &RubinWhittedIndex,
    family: &dyn Family,
    leaves: &Leaves,
) -> Expected {
    let mut tests = vec![0.0; family.count() as usize];
    let nodes: Nodes = index.tree.nodes().collect();
    let root = nodes[0].iter().fold(Aabb::EMPTY, |all, part| all.join(part.0));
    let whole = area(root).max(f64::MIN_POSITIVE);
    let mut shares = vec![1.0f64; nodes.len()];
    for (node, parts) in nodes.iter().enumerate() {
        let note = index.tree.note(Step::onward(node as u32));
        for (lane, &(bounds, step)) in parts.iter().enumerate() {
            let area = match note {
                0 => area(bounds),
                note => index.turned[note as usize - 1].area(lane),
            };
            let share = (area / whole).min(shares[node]);
            if step.is_onward() {
                shares[step.word() as usize] = share;
            } else {
                for &child in leaves.of(step.as_leaf().0 as usize) {
                    tests[child as usize] += share as f32;
                }
            }
        }
    }
    Expected { steps: shares.iter().sum(), tests }
}
