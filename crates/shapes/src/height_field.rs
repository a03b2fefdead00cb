//! Height fields: a grid of heights as one object, walked through cell by cell.

mod cell;
mod walk;

use std::fmt;
use std::sync::Arc;

use glam::{DVec3, Vec3A};
use nestray_core::aabb::Aabb;
use nestray_core::ray::Ray;
use nestray_core::surface::Surface;

use self::cell::{Cell, Probe};
use self::walk::{Line, TILE, Tiles};
use crate::shape::{Crossing, Shape};

/// How a height field is shaded.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Relief {
    /// As the triangles it consists of.
    #[default]
    Facets,
    /// With normals that change evenly from sample to sample.
    Smooth,
}

/// Heights above a rectangle of the plane `y = 0`, two triangles between each four
/// neighbours. Its front is above.
///
/// Neighbouring triangles decide with the same numbers, so no ray slips through between.
#[derive(Clone, Debug, PartialEq)]
pub struct HeightField {
    from: [f32; 2],
    to: [f32; 2],
    counts: [usize; 2],
    heights: Arc<[f32]>,
    tiles: Tiles,
    relief: Relief,
}

/// Why numbers make no height field.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum HeightFieldError {
    /// Fewer than two samples along an axis.
    TooFew([usize; 2]),
    /// Not one height per sample.
    Count {
        /// How many there are.
        found: usize,
        /// How many samples there are along x and along z.
        counts: [usize; 2],
    },
    /// The rectangle has no area, or is not finite.
    Rectangle {
        /// Its lower corner, x and z.
        from: [f32; 2],
        /// Its upper corner.
        to: [f32; 2],
    },
    /// A height is not a number, or out of range.
    Height {
        /// Which one.
        index: usize,
        /// What it is.
        height: f32,
    },
}

impl fmt::Display for HeightFieldError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::TooFew([x, z]) => write!(f, "{x} × {z} heights, but both ways takes 2"),
            Self::Count { found, counts: [x, z] } => {
                write!(f, "{found} heights for {x} × {z} samples")
            }
            Self::Rectangle { from, to } => {
                write!(f, "a height field from {from:?} to {to:?} has no area")
            }
            Self::Height { index, height } => write!(f, "height {index} is {height}"),
        }
    }
}

impl std::error::Error for HeightFieldError {}

impl HeightField {
    /// `counts` samples along x and z over the rectangle `from … to` of x and z, those of a
    /// row along x one after the other.
    ///
    /// # Errors
    /// If the numbers do not fit together or are out of range.
    pub fn new(
        from: [f32; 2],
        to: [f32; 2],
        counts: [usize; 2],
        heights: impl Into<Arc<[f32]>>,
    ) -> Result<Self, HeightFieldError> {
        let heights = heights.into();
        if counts[0] < 2 || counts[1] < 2 {
            return Err(HeightFieldError::TooFew(counts));
        }
        if counts[0].checked_mul(counts[1]) != Some(heights.len()) {
            return Err(HeightFieldError::Count { found: heights.len(), counts });
        }
        let usable = |x: f32| x.abs() <= Ray::FARTHEST;
        let sound = |axis: usize| usable(from[axis]) && usable(to[axis]) && from[axis] < to[axis];
        if !sound(0) || !sound(1) {
            return Err(HeightFieldError::Rectangle { from, to });
        }
        if let Some(index) = heights.iter().position(|&height| !usable(height)) {
            return Err(HeightFieldError::Height { index, height: heights[index] });
        }
        let tiles = Tiles::new(counts, &heights);
        Ok(Self { from, to, counts, heights, tiles, relief: Relief::Facets })
    }

    /// The same field, shaded so.
    #[must_use]
    pub fn shaded(self, relief: Relief) -> Self {
        Self { relief, ..self }
    }

    /// How it is shaded.
    #[must_use]
    pub fn relief(&self) -> Relief {
        self.relief
    }

    /// How many samples there are along x and along z.
    #[must_use]
    pub fn counts(&self) -> [usize; 2] {
        self.counts
    }

    /// The heights, row after row along x.
    #[must_use]
    pub fn heights(&self) -> &[f32] {
        &self.heights
    }

    /// The place of a sample.
    ///
    /// # Panics
    /// If there is no such sample.
    #[must_use]
    pub fn sample(&self, x: usize, z: usize) -> Vec3A {
        let at = |axis: usize, i: usize| {
            if i + 1 == self.counts[axis] {
                return self.to[axis];
            }
            (f64::from(self.from[axis]) + self.step(axis) * i as f64) as f32
        };
        Vec3A::new(at(0, x), self.heights[z * self.counts[0] + x], at(1, z))
    }

    /// Width of a cell.
    fn step(&self, axis: usize) -> f64 {
        (f64::from(self.to[axis]) - f64::from(self.from[axis])) / (self.counts[axis] - 1) as f64
    }

    fn cell(&self, at: [usize; 2]) -> Cell {
        let corner = |x: usize, z: usize| self.sample(at[0] + x, at[1] + z);
        Cell { corners: [corner(0, 0), corner(1, 0), corner(0, 1), corner(1, 1)] }
    }

    /// What the probe meets in a cell.
    fn look(
        &self,
        probe: &Probe,
        at: [usize; 2],
        mut found: impl FnMut(Crossing, [f64; 3], usize),
    ) {
        let cell = self.cell(at);
        cell.each_hit(probe, |half, t, weights| {
            let inside = cell.place(half, weights);
            let uv = [0, 1].map(|axis| {
                ((at[axis] as f64 + inside[axis]) / (self.counts[axis] - 1) as f64) as f32
            });
            found(Crossing { t: t.0 as f32, uv, front: t.1 }, weights, half);
        });
    }

    /// Walks along the ray within a range; `found` answers up to where.
    fn walk(&self, ray: &Ray, mut wanted: [f64; 2], mut found: impl FnMut(Crossing) -> f64) {
        let probe = Probe::new(ray);
        let bounds = self.bounds();
        let line = Line::new(ray, &bounds, [self.step(0), self.step(1)]);
        let cells = self.counts.map(|count| count - 1);
        let Some(range) = line.range(&bounds, cells, wanted) else { return };
        line.each(TILE, [[0; 2], cells], range, |tile, range| {
            if range[0] > wanted[1] || line.misses(self.tiles.of(tile), range) {
                return;
            }
            let from = tile.map(|i| i * TILE);
            let to = [(from[0] + TILE).min(cells[0]), (from[1] + TILE).min(cells[1])];
            line.each(1, [from, to], range, |at, range| {
                let row = at[1] * self.counts[0] + at[0];
                let [a, b] = [self.heights[row], self.heights[row + 1]];
                let next = row + self.counts[0];
                let [c, d] = [self.heights[next], self.heights[next + 1]];
                let heights = [a.min(b).min(c.min(d)), a.max(b).max(c.max(d))];
                if range[0] <= wanted[1] && !line.misses(heights, range) {
                    self.look(&probe, at, |crossing, _, _| wanted[1] = found(crossing));
                }
            });
        });
    }

    /// The normal to shade a sample with, of any length.
    fn slope(&self, x: usize, z: usize) -> DVec3 {
        let [nx, nz] = self.counts;
        let rise = |a: Vec3A, b: Vec3A, axis: usize| {
            let run = f64::from(b[axis]) - f64::from(a[axis]);
            if run > 0.0 { (f64::from(b.y) - f64::from(a.y)) / run } else { 0.0 }
        };
        let by_x =
            rise(self.sample(x.saturating_sub(1), z), self.sample((x + 1).min(nx - 1), z), 0);
        let by_z =
            rise(self.sample(x, z.saturating_sub(1)), self.sample(x, (z + 1).min(nz - 1)), 2);
        DVec3::new(-by_x, 1.0, -by_z).normalize_or_zero()
    }

    /// The surface of half a cell, at weights of its corners.
    fn seen(&self, at: [usize; 2], half: usize, weights: [f64; 3], uv: [f32; 2]) -> Surface {
        let cell = self.cell(at);
        let [a, b, c] = cell.half(half).map(|which| cell.corners[which].as_dvec3());
        let position = a * weights[0] + b * weights[1] + c * weights[2];
        let normal = (b - a).cross(c - a).try_normalize().unwrap_or(DVec3::Y);
        let [low, high] = [[2, 3], [0, 1]][half].map(|which| cell.corners[which].as_dvec3());
        let mut surface = Surface {
            tangent: (high - low).normalize_or_zero().as_vec3a(),
            uv,
            ..Surface::new(position.as_vec3a(), normal.as_vec3a())
        };
        if self.relief == Relief::Smooth {
            let slopes = cell.half(half).map(|w| self.slope(at[0] + w % 2, at[1] + w / 2));
            let smooth = slopes[0] * weights[0] + slopes[1] * weights[1] + slopes[2] * weights[2];
            surface.shading = smooth.try_normalize().unwrap_or(normal).as_vec3a();
        }
        surface
    }
}

impl Shape for HeightField {
    fn kind(&self) -> &'static str {
        "height-field"
    }

    fn bounds(&self) -> Aabb {
        let [low, high] = self.tiles.all();
        Aabb {
            min: Vec3A::new(self.from[0], low, self.from[1]),
            max: Vec3A::new(self.to[0], high, self.to[1]),
        }
    }

    fn crossings(&self, ray: &Ray, mut found: impl FnMut(Crossing)) {
        let all = [f64::NEG_INFINITY, f64::INFINITY];
        self.walk(ray, all, |crossing| {
            found(crossing);
            f64::INFINITY
        });
    }

    fn crossings_until(&self, ray: &Ray, limit: f32, mut found: impl FnMut(Crossing) -> f32) {
        // A hair more, for what rounds into the range.
        let farthest = ray.t_max().next_up();
        let up_to = |limit: f32| f64::from(limit.next_up().min(farthest));
        let range = [f64::from(ray.t_min().next_down()), up_to(limit)];
        self.walk(ray, range, |crossing| up_to(found(crossing)));
    }

    fn surface(&self, ray: &Ray, crossing: &Crossing) -> Surface {
        let probe = Probe::new(ray);
        let cell = [0, 1].map(|axis| {
            let last = self.counts[axis] - 2;
            ((f64::from(crossing.uv[axis]) * (last + 1) as f64) as usize).min(last)
        });
        let mut seen = None;
        // Near an edge the coordinates may have been rounded into the next cell.
        for x in cell[0].saturating_sub(1)..=(cell[0] + 1).min(self.counts[0] - 2) {
            for z in cell[1].saturating_sub(1)..=(cell[1] + 1).min(self.counts[1] - 2) {
                self.look(&probe, [x, z], |found, weights, half| {
                    if found == *crossing && seen.is_none() {
                        seen = Some(self.seen([x, z], half, weights, crossing.uv));
                    }
                });
            }
        }
        seen.unwrap_or_else(|| {
            let inside = [0, 1].map(|axis| {
                f64::from(crossing.uv[axis]) * (self.counts[axis] - 1) as f64 - cell[axis] as f64
            });
            let (half, weights) = cell::weights(inside);
            self.seen(cell, half, weights, crossing.uv)
        })
    }
}
