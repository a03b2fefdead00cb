//! What a shape does to a beam: which side it shows, and whether it shades all that is behind.

use glam::DVec3;
use nestray_core::aabb::Aabb;
use nestray_core::beam::{Beam, Facing};

use crate::rounding::slack;

/// Which side a plane with this unit normal shows. A hair of doubt is left to rays that are
/// in the beam up to rounding.
pub(crate) fn facing(normal: DVec3, beam: &Beam) -> Facing {
    let slopes = directions(beam).map(|dir| normal.dot(dir) / dir.length());
    if slopes.iter().all(|&slope| slope < -1e-6) {
        Facing::Front
    } else if slopes.iter().all(|&slope| slope > 1e-6) {
        Facing::Back
    } else {
        Facing::Mixed
    }
}

/// The directions at the corners of the rectangle; all others lie between them.
fn directions(beam: &Beam) -> [DVec3; 4] {
    let along = if beam.backward { -1.0 } else { 1.0 };
    [(0, 0), (0, 1), (1, 0), (1, 1)].map(|(i, j)| {
        let mut dir = DVec3::ZERO;
        dir[beam.axis % 3] = along;
        dir[(beam.axis + 1) % 3] = f64::from(beam.u[i]);
        dir[(beam.axis + 2) % 3] = f64::from(beam.v[j]);
        dir
    })
}

/// Where the outermost rays of a beam pass through a plane.
pub(crate) struct Images {
    /// All rays pass through the plane within the hull of these points: a point depends
    /// linearly on where the ray starts, and projectively on where it goes.
    pub(crate) points: [DVec3; 32],
    /// The greatest distance to one of them along the main axis.
    pub(crate) farthest: f64,
    /// How far a point moves along a ray, at most, when the plane is moved by one.
    pub(crate) lean: f64,
}

impl Images {
    /// On the plane through `point`; none unless all rays come to it, from one side.
    pub(crate) fn new(beam: &Beam, point: DVec3, normal: DVec3) -> Option<Self> {
        if facing(normal, beam) == Facing::Mixed {
            return None;
        }
        let reach = beam.origin.reach().max(point.abs().max_element() as f32);
        let mut images = Self { points: [DVec3::ZERO; 32], farthest: 0.0, lean: 0.0 };
        for (i, dir) in directions(beam).into_iter().enumerate() {
            images.lean = images.lean.max(dir.length() / normal.dot(dir).abs());
            for corner in 0..8 {
                let origin = beam.origin.corner(corner).as_dvec3();
                let s = normal.dot(point - origin) / normal.dot(dir);
                if s.is_nan() || s < slack(reach) {
                    return None;
                }
                images.points[i * 8 + corner as usize] = origin + dir * s;
                images.farthest = images.farthest.max(s);
            }
        }
        Some(images)
    }
}

/// The part of a plane across the main axis that the rays of a beam pass through.
pub(crate) struct Section {
    /// Its lower corner, along the two axes that follow the main one.
    pub(crate) low: [f64; 2],
    /// Its upper corner.
    pub(crate) high: [f64; 2],
    /// The greatest distance to it along the main axis.
    pub(crate) farthest: f64,
}

impl Section {
    /// With the plane at a coordinate of the main axis; none unless it is ahead of all rays.
    pub(crate) fn new(beam: &Beam, at: f64) -> Option<Self> {
        let (axis, Aabb { min, max }) = (beam.axis % 3, beam.origin);
        let (from, to) = (f64::from(min[axis]), f64::from(max[axis]));
        let s = if beam.backward { [from - at, to - at] } else { [at - to, at - from] };
        if s[0].is_nan() || s[0] < slack(beam.origin.reach().max(at.abs() as f32)) {
            return None;
        }
        let mut section = Self { low: [0.0; 2], high: [0.0; 2], farthest: s[1] };
        for (i, slopes) in [beam.u, beam.v].into_iter().enumerate() {
            let [low, high] = slopes.map(f64::from);
            let aside = (axis + 1 + i) % 3;
            section.low[i] = f64::from(min[aside]) + (low * s[0]).min(low * s[1]);
            section.high[i] = f64::from(max[aside]) + (high * s[0]).max(high * s[1]);
        }
        Some(section)
    }
}

/// A distance along the main axis as an answer, rounded up with a hair to spare.
pub(crate) fn beyond(farthest: f64) -> Option<f32> {
    let distance = (farthest * (1.0 + 1e-6)) as f32;
    distance.is_finite().then(|| distance.next_up())
}
