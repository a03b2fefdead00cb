//! How much rough glass gives back and lets through, worked out once, as a table: the rest
//! is what bounces between its small mirrors, which is added in proportion.

use std::sync::LazyLock;

use glam::Vec3A;

use crate::directions::{mirrored, refracted};
use crate::sampler::{Sampler, Set};

use super::fresnel::dielectric;
use super::ggx::{Ggx, SMOOTHEST};

static TABLE: LazyLock<Vec<f32>> = LazyLock::new(|| {
    let cells = (0..ETAS * ROUGHNESSES * COSINES).map(|i| {
        let (eta, row, column) =
            (i / (ROUGHNESSES * COSINES), i / COSINES % ROUGHNESSES, i % COSINES);
        let part = |i: usize, of: usize| i as f32 / (of - 1) as f32;
        let across = part(column, COSINES);
        let roughness = SMOOTHEST + (1.0 - SMOOTHEST) * part(row, ROUGHNESSES);
        let bend = MOST_BEND * (2.0 * part(eta, ETAS) - 1.0);
        cell(across * across, roughness, (1.0 + bend) / (1.0 - bend))
    });
    cells.collect()
});

/// By `(eta − 1) / (eta + 1)`, from minus this to this: indices from 1/3 to 3.
const MOST_BEND: f32 = 0.5;
/// Even, so that there is none in the middle, where there is no glass.
const ETAS: usize = 20;
const ROUGHNESSES: usize = 12;
/// Cosines are squares of even steps.
const COSINES: usize = 12;
/// Directions looked at for one cell.
const DIRECTIONS: u32 = 256;

/// The share of light from one side that leaves the glass after one bounce, either way.
pub(super) fn kept(cosine: f32, roughness: f32, eta: f32) -> f32 {
    let place = |part: f32, of: usize| {
        let place = part.clamp(0.0, 1.0) * (of - 1) as f32;
        let below = (place as usize).min(of - 2);
        (below, place - below as f32)
    };
    let (column, across) = place(cosine.max(0.0).sqrt(), COSINES);
    let (row, down) = place((roughness - SMOOTHEST) / (1.0 - SMOOTHEST), ROUGHNESSES);
    let bend = (eta - 1.0) / (eta + 1.0);
    let (layer, deep) = place(0.5 + 0.5 * bend / MOST_BEND, ETAS);
    let at = |layer: usize, row: usize, column: usize| {
        TABLE[(layer * ROUGHNESSES + row) * COSINES + column]
    };
    let mix = |a: f32, b: f32, part: f32| a + (b - a) * part;
    let line = |l: usize, r: usize| mix(at(l, r, column), at(l, r, column + 1), across);
    let plane = |l: usize| mix(line(l, row), line(l, row + 1), down);
    mix(plane(layer), plane(layer + 1), deep).max(0.05)
}

fn cell(cosine: f32, roughness: f32, eta: f32) -> f32 {
    let cosine = cosine.max(1e-3);
    let v = Vec3A::new((1.0 - cosine * cosine).max(0.0).sqrt(), 0.0, cosine);
    let viewed = Ggx::new(roughness * roughness).viewed(v);
    let mut kept = 0.0;
    for i in 0..DIRECTIONS {
        let [a, b, ..] = Sampler::new(0, i, 0).four(Set::Eye);
        let h = viewed.sample([a, b]);
        let mirror = dielectric(v.dot(h), eta);
        let back = mirrored(v, h);
        if back.z > 0.0 {
            kept += mirror * viewed.both(back);
        }
        if let Some(through) = refracted(v, h, eta).filter(|through| through.z < 0.0) {
            kept += (1.0 - mirror) * viewed.both(through);
        }
    }
    kept / DIRECTIONS as f32
}
