//! A forest: one tree, stored once, in thousands of places.

use std::f64::consts::TAU;

use glam::DVec3;
use nestray_shapes::triangle_mesh::Triangles;

use super::look::{camera, matte, outdoors, paint, still, upright};
use super::mesh::{Mesh, across};
use super::random::Random;
use crate::geometry::Geometry;
use crate::group::Group;
use crate::scene::Scene;

/// Metres between trees.
const APART: f64 = 4.5;

/// Cells along a side of the ground.
const GROUND: u32 = 128;

/// Triangles of the tree and of the ground; how many trees there are does not matter.
pub(super) fn count(_size: u32) -> u64 {
    tree_count() + 2 * u64::from(GROUND).pow(2)
}

pub(super) fn build(size: u32) -> Scene {
    let mut scene = outdoors();
    let earth = scene.add_material(matte("earth", [0.16, 0.14, 0.06]));
    let side = libm::ceil(f64::from(size).sqrt()) as u32;
    let half = f64::from(side) * APART / 2.0;
    scene.add(Geometry::mesh("ground", earth, ground(half + 3.0 * APART)));
    let tree = add_tree(&mut scene);
    let mut random = Random::new(4);
    for i in 0..size {
        let place =
            |i: u32, random: &mut Random| (f64::from(i) + random.between(0.1, 0.9)) * APART - half;
        let (x, y) = (place(i % side, &mut random), place(i / side, &mut random));
        let at = DVec3::new(x, y, hills(x, y) - 0.05);
        let (turn, scale) = (random.between(0.0, TAU), random.between(0.7, 1.25));
        scene.place(tree, still(upright(turn, scale, at)));
    }
    let reach = half.min(80.0);
    let from = DVec3::new(-0.3 * reach, -half - 12.0, 9.0 + 0.25 * reach);
    let at = DVec3::new(0.0, -half + reach, 2.0);
    scene.cameras.push(camera("over", from, at, 42.0));
    scene
}

/// Height of the ground.
fn hills(x: f64, y: f64) -> f64 {
    2.5 * libm::sin(0.031 * x + 0.4) * libm::cos(0.027 * y) + 0.6 * libm::sin(0.11 * x - 0.07 * y)
}

fn ground(half: f64) -> Triangles {
    let mut mesh = Mesh::default();
    let place = |i: u32| half * (2.0 * f64::from(i) / f64::from(GROUND) - 1.0);
    let first = mesh.corners(GROUND, |row, column| {
        let (x, y) = (place(column), place(row));
        let slope = |dx: f64, dy: f64| hills(x + dx, y + dy) - hills(x - dx, y - dy);
        let normal = DVec3::new(-slope(0.5, 0.0), -slope(0.0, 0.5), 1.0);
        (DVec3::new(x, y, hills(x, y)), normal.normalize())
    });
    mesh.cells(GROUND, first);
    mesh.finish()
}

/// Levels of branches, the trunk being the first.
const LEVELS: u32 = 6;

/// Branches that grow from each.
const FORKS: u32 = 3;

/// Pieces of a branch, and sides of each.
const PIECES: u32 = 2;
const SIDES: u32 = 8;

/// Leaves on each branch of the last two levels.
const LEAVES: u32 = 75;

/// Triangles of a tree.
pub(super) fn tree_count() -> u64 {
    let branches: u32 = (0..LEVELS).map(|level| FORKS.pow(level)).sum();
    let leafy = FORKS.pow(LEVELS - 1) + FORKS.pow(LEVELS - 2);
    u64::from(branches * PIECES * SIDES * 2 + leafy * LEAVES * 2)
}

/// Adds a tree of about 60,000 triangles and 6 m to a scene, in no place yet; returns its
/// group.
pub(super) fn add_tree(scene: &mut Scene) -> usize {
    let bark = scene.add_material(matte("bark", [0.19, 0.12, 0.07]));
    let green = scene.add_material(paint("leaves", [0.13, 0.3, 0.05], 0.6));
    let mut tree = Tree { random: Random::new(5), wood: Mesh::default(), leaves: Mesh::default() };
    tree.branch(0, DVec3::ZERO, DVec3::Z, 2.0, 0.16);
    let wood = scene.add_apart(Geometry::mesh("wood", bark, tree.wood.finish()));
    let leaves = scene.add_apart(Geometry::mesh("leaves", green, tree.leaves.finish()));
    let geometries = vec![wood, leaves];
    scene.add_group(Group { name: "tree".into(), geometries, places: Vec::new() })
}

struct Tree {
    random: Random,
    wood: Mesh,
    leaves: Mesh,
}

impl Tree {
    /// A branch, its leaves, and the branches that grow from it.
    fn branch(&mut self, level: u32, root: DVec3, dir: DVec3, length: f64, thick: f64) {
        let bend = (dir + self.random.in_cube() * 0.25).normalize();
        let knee = root + dir * (length / 2.0);
        let end = knee + bend * (length / 2.0);
        self.wood.tube([root, knee], [thick, thick * 0.85], SIDES);
        self.wood.tube([knee, end], [thick * 0.85, thick * 0.65], SIDES);
        if level + 2 >= LEVELS {
            for _ in 0..LEAVES {
                let on = knee + (end - root) * self.random.between(-0.4, 0.6);
                self.leaf(on, length);
            }
        }
        if level + 1 == LEVELS {
            return;
        }
        let [side, other] = across(bend);
        let first = self.random.between(0.0, TAU);
        for fork in 0..FORKS {
            let angle = first + TAU * f64::from(fork) / f64::from(FORKS);
            let out = side * libm::cos(angle) + other * libm::sin(angle);
            let lean = self.random.between(0.55, 1.0);
            // Towards the light.
            let dir = (bend + out * lean + DVec3::Z * 0.15).normalize();
            let shorter = length * self.random.between(0.62, 0.76);
            self.branch(level + 1, end, dir, shorter, thick * 0.62);
        }
    }

    /// Two triangles, folded along the middle.
    fn leaf(&mut self, at: DVec3, spread: f64) {
        let out = self.random.direction();
        let root = at + self.random.in_cube() * (0.35 * spread);
        let [side, up] = across(out);
        let length = self.random.between(0.07, 0.13);
        let tip = root + out * length;
        let half = side * (0.35 * length);
        let middle = root + out * (0.45 * length) + up * (0.08 * length);
        let [a, b] = [middle - half, middle + half];
        self.leaves.quad([root, a, tip, b]);
    }
}
