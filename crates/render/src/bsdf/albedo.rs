//! How much rough mirrors give back, worked out once, as a table.

use std::sync::LazyLock;

use glam::Vec3A;

use crate::directions::mirrored;
use crate::sampler::{Sampler, Set};

use super::fresnel::grazing;
use super::ggx::{Ggx, SMOOTHEST};

/// Sums that tell the share mirrored for any colour of mirror.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Albedo {
    /// Of what is mirrored straight on.
    straight: f32,
    /// Of what is mirrored edge-on.
    edge: f32,
    /// The same two, times what is lost between the small mirrors.
    straight_lost: f32,
    edge_lost: f32,
}

impl Albedo {
    /// Of a smooth mirror from all sides.
    pub(crate) const SMOOTH_AVERAGE: Self =
        Self { straight: 20.0 / 21.0, edge: 1.0 / 21.0, straight_lost: 0.0, edge_lost: 0.0 };

    /// Of a smooth mirror.
    pub(crate) fn smooth(cosine: f32) -> Self {
        let edge = grazing(cosine);
        Self { straight: 1.0 - edge, edge, ..Self::default() }
    }

    /// The share that a mirror gives back that mirrors `coat` straight on and `edge` edge-on.
    pub(crate) fn of(&self, coat: f32, edge: f32) -> f32 {
        let once = self.straight * coat + self.edge * edge;
        let again = self.straight_lost * coat + self.edge_lost * edge;
        (once + coat * again).min(1.0)
    }

    /// What a perfect mirror loses between its small mirrors, over what it gives back.
    pub(crate) fn lost(&self) -> f32 {
        (self.straight_lost + self.edge_lost) / (self.straight + self.edge)
    }

    fn blend(self, other: Self, part: f32) -> Self {
        let mix = |a: f32, b: f32| a + (b - a) * part;
        Self {
            straight: mix(self.straight, other.straight),
            edge: mix(self.edge, other.edge),
            straight_lost: mix(self.straight_lost, other.straight_lost),
            edge_lost: mix(self.edge_lost, other.edge_lost),
        }
    }
}

/// Of all rough mirrors.
pub(crate) static ROUGH: LazyLock<Table> = LazyLock::new(Table::new);

/// By the cosine of the angle of view and by roughness.
#[derive(Debug)]
pub(crate) struct Table {
    /// Row by row, one row for each roughness.
    cells: Vec<Albedo>,
    averages: Vec<Albedo>,
}

/// Cosines in a row: `i / (COSINES − 1)`, squared, since albedos change most near 0.
const COSINES: usize = 32;
const ROUGHNESSES: usize = 32;
/// Directions looked at for one cell.
const DIRECTIONS: u32 = 512;

impl Table {
    fn new() -> Self {
        let mut cells = Vec::with_capacity(COSINES * ROUGHNESSES);
        let mut averages = Vec::with_capacity(ROUGHNESSES);
        for row in 0..ROUGHNESSES {
            let part = row as f32 / (ROUGHNESSES - 1) as f32;
            let roughness = SMOOTHEST + (1.0 - SMOOTHEST) * part;
            let row: Vec<Albedo> = (0..COSINES).map(|i| cell(cosine(i), roughness)).collect();
            averages.push(average(&row));
            cells.extend(row);
        }
        Self { cells, averages }
    }

    /// Of a mirror of this roughness seen from this angle.
    pub(crate) fn at(&self, cosine: f32, roughness: f32) -> Albedo {
        let (row, down) = row_of(roughness);
        let place = cosine.clamp(0.0, 1.0).sqrt() * (COSINES - 1) as f32;
        let column = (place as usize).min(COSINES - 2);
        // Even in the cosine, as `average` has it.
        let (from, to) = (self::cosine(column), self::cosine(column + 1));
        let across = ((cosine - from) / (to - from)).clamp(0.0, 1.0);
        let cell = |row: usize, column: usize| self.cells[row * COSINES + column];
        let upper = cell(row, column).blend(cell(row, column + 1), across);
        let lower = cell(row + 1, column).blend(cell(row + 1, column + 1), across);
        upper.blend(lower, down)
    }

    /// Of a mirror of this roughness in even light.
    pub(crate) fn average(&self, roughness: f32) -> Albedo {
        let (row, down) = row_of(roughness);
        self.averages[row].blend(self.averages[row + 1], down)
    }
}

fn cosine(i: usize) -> f32 {
    let part = i as f32 / (COSINES - 1) as f32;
    part * part
}

/// The row above a roughness, and how far it is to the next.
fn row_of(roughness: f32) -> (usize, f32) {
    let part = ((roughness - SMOOTHEST) / (1.0 - SMOOTHEST)).clamp(0.0, 1.0);
    let place = part * (ROUGHNESSES - 1) as f32;
    let row = (place as usize).min(ROUGHNESSES - 2);
    (row, place - row as f32)
}

fn cell(cosine: f32, roughness: f32) -> Albedo {
    let ggx = Ggx::new(roughness * roughness);
    let cosine = cosine.max(1e-4);
    let v = Vec3A::new((1.0 - cosine * cosine).max(0.0).sqrt(), 0.0, cosine);
    let (mut straight, mut edge) = (0.0, 0.0);
    for i in 0..DIRECTIONS {
        let [a, b, ..] = Sampler::new(0, i, 0).four(Set::Eye);
        let u = [a, b];
        let h = ggx.sample(v, u);
        let l = mirrored(v, h);
        if l.z > 0.0 {
            let both = ggx.seen_by_both(v, l) / ggx.seen(v);
            let grazing = grazing(v.dot(h));
            straight += both * (1.0 - grazing);
            edge += both * grazing;
        }
    }
    let (straight, edge) = (straight / DIRECTIONS as f32, edge / DIRECTIONS as f32);
    let lost = (1.0 - straight - edge) / (straight + edge);
    Albedo { straight, edge, straight_lost: straight * lost, edge_lost: edge * lost }
}

/// `2 ∫ albedo(cosine) cosine`, of straight lines between cells.
fn average(row: &[Albedo]) -> Albedo {
    let mut sum = Albedo::default();
    for i in 0..COSINES - 1 {
        let (a, b) = (cosine(i), cosine(i + 1));
        // Of the two ends of a straight line from a to b, times twice the cosine.
        let near = (b - a) * (2.0 * a + b) / 3.0;
        let far = (b - a) * (a + 2.0 * b) / 3.0;
        for (end, weight) in [(row[i], near), (row[i + 1], far)] {
            sum.straight += end.straight * weight;
            sum.edge += end.edge * weight;
            sum.straight_lost += end.straight_lost * weight;
            sum.edge_lost += end.edge_lost * weight;
        }
    }
    sum
}
