//! How much rough mirrors give back, worked out once, as a table.

use std::sync::OnceLock;

use glam::{Vec3A, Vec4};

use crate::directions::mirrored;
use crate::sampler::{Sampler, Set};

use super::fresnel::grazing;
use super::ggx::{Ggx, SMOOTHEST};

/// Sums that tell the share mirrored for any colour of mirror.
///
/// In this order: of what is mirrored straight on, of what is mirrored edge-on, and the same two
/// times what is lost between the small mirrors.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Albedo(Vec4);

impl Albedo {
    /// Of a smooth mirror from all sides.
    pub(crate) const SMOOTH_AVERAGE: Self = Self(Vec4::new(20.0 / 21.0, 1.0 / 21.0, 0.0, 0.0));

    /// Of a smooth mirror.
    pub(crate) fn smooth(cosine: f32) -> Self {
        let edge = grazing(cosine);
        Self(Vec4::new(1.0 - edge, edge, 0.0, 0.0))
    }

    /// The share that a mirror gives back that mirrors `coat` straight on and `edge` edge-on.
    pub(crate) fn of(&self, coat: f32, edge: f32) -> f32 {
        let [straight, grazing, straight_lost, grazing_lost] = self.0.to_array();
        let once = straight * coat + grazing * edge;
        let again = straight_lost * coat + grazing_lost * edge;
        (once + coat * again).min(1.0)
    }

    /// What a perfect mirror loses between its small mirrors, over what it gives back.
    pub(crate) fn lost(&self) -> f32 {
        let [straight, edge, straight_lost, edge_lost] = self.0.to_array();
        (straight_lost + edge_lost) / (straight + edge)
    }

    fn blend(self, other: Self, part: f32) -> Self {
        Self(self.0 + (other.0 - self.0) * part)
    }
}

/// Rough mirrors by roughness, each row worked out when it is first asked for.
static ROWS: [OnceLock<Cells>; ROUGHNESSES] = [const { OnceLock::new() }; ROUGHNESSES];

/// Mirrors of a roughness of the table, by the cosine of the angle of view.
#[derive(Debug)]
struct Cells {
    columns: [Albedo; COSINES],
    average: Albedo,
}

/// Mirrors of one roughness.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Row {
    /// The rows above and below.
    rows: [&'static Cells; 2],
    /// How far it is to the one below.
    down: f32,
}

/// Cosines in a row: `i / (COSINES − 1)`, squared, since albedos change most near 0.
const COSINES: usize = 32;
const ROUGHNESSES: usize = 32;
/// Directions looked at for one cell.
const DIRECTIONS: u32 = 512;

impl Cells {
    fn of_row(row: usize) -> &'static Self {
        ROWS[row].get_or_init(|| {
            let part = row as f32 / (ROUGHNESSES - 1) as f32;
            let roughness = SMOOTHEST + (1.0 - SMOOTHEST) * part;
            let columns = COLUMNS.map(|cosine| cell(cosine, roughness));
            Self { columns, average: average(&columns) }
        })
    }
}

impl Row {
    pub(crate) fn new(roughness: f32) -> Self {
        let part = ((roughness - SMOOTHEST) / (1.0 - SMOOTHEST)).clamp(0.0, 1.0);
        let place = part * (ROUGHNESSES - 1) as f32;
        let row = (place as usize).min(ROUGHNESSES - 2);
        Self { rows: [row, row + 1].map(Cells::of_row), down: place - row as f32 }
    }

    /// Seen from this angle.
    pub(crate) fn at(&self, cosine: f32) -> Albedo {
        let place = cosine.clamp(0.0, 1.0).sqrt() * (COSINES - 1) as f32;
        let column = (place as usize).min(COSINES - 2);
        // Even in the cosine, as `average` has it.
        let (from, to) = (COLUMNS[column], COLUMNS[column + 1]);
        let across = ((cosine - from) / (to - from)).clamp(0.0, 1.0);
        let [upper, lower] = self
            .rows
            .map(|Cells { columns, .. }| columns[column].blend(columns[column + 1], across));
        upper.blend(lower, self.down)
    }

    /// In even light.
    pub(crate) fn average(&self) -> Albedo {
        let [upper, lower] = self.rows;
        upper.average.blend(lower.average, self.down)
    }
}

/// The cosines of a row.
const COLUMNS: [f32; COSINES] = {
    let mut columns = [0.0; COSINES];
    let mut i = 0;
    while i < COSINES {
        let part = i as f32 / (COSINES - 1) as f32;
        columns[i] = part * part;
        i += 1;
    }
    columns
};

/// Of a mirror of this roughness seen from this angle.
fn cell(cosine: f32, roughness: f32) -> Albedo {
    let cosine = cosine.max(1e-4);
    let v = Vec3A::new((1.0 - cosine * cosine).max(0.0).sqrt(), 0.0, cosine);
    let (mut straight, mut edge) = (0.0, 0.0);
    let viewed = Ggx::new(roughness * roughness).viewed(v);
    for i in 0..DIRECTIONS {
        let [a, b, ..] = Sampler::new(0, i, 0).four(Set::Eye);
        let h = viewed.sample([a, b]);
        let l = mirrored(v, h);
        if l.z > 0.0 {
            let both = viewed.both(l);
            let grazing = grazing(v.dot(h));
            straight += both * (1.0 - grazing);
            edge += both * grazing;
        }
    }
    let (straight, edge) = (straight / DIRECTIONS as f32, edge / DIRECTIONS as f32);
    let lost = (1.0 - straight - edge) / (straight + edge);
    Albedo(Vec4::new(straight, edge, straight * lost, edge * lost))
}

/// `2 ∫ albedo(cosine) cosine`, of straight lines between cells.
fn average(row: &[Albedo; COSINES]) -> Albedo {
    let mut sum = Vec4::ZERO;
    for i in 0..COSINES - 1 {
        let (a, b) = (COLUMNS[i], COLUMNS[i + 1]);
        // Of the two ends of a straight line from a to b, times twice the cosine.
        let near = (b - a) * (2.0 * a + b) / 3.0;
        let far = (b - a) * (a + 2.0 * b) / 3.0;
        for (end, weight) in [(row[i], near), (row[i + 1], far)] {
            sum += end.0 * weight;
        }
    }
    Albedo(sum)
}
