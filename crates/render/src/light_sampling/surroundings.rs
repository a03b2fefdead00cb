//! Picking directions by how bright a picture of the surroundings is there.

use std::f32::consts::PI;

use glam::Vec3A;
use nestray_scene::scene::Scene;
use nestray_scene::texture::Image;

use super::chances::Chances;
use super::{luminance, picture_of};
use crate::background::{direction_of, place_of};

/// A picture of all directions, made ready for picking.
pub(crate) struct Surroundings {
    radians: f32,
    rows: Chances,
    columns: Vec<Chances>,
    /// Mean radiance.
    pub(crate) mean: f32,
}

/// Cells across and down, at most: enough to find the sun, and small enough to search.
const MOST: [usize; 2] = [1024, 512];

impl Surroundings {
    /// Of the background, if it is a picture and not black.
    pub(crate) fn new(scene: &Scene) -> Option<Self> {
        let (texture, radians, scale) = picture_of(scene)?;
        let image = &scene.textures[texture].image;
        let (width, height) = (image.width.min(MOST[0]), image.height.min(MOST[1]));
        let mut cells: Vec<Vec<f64>> = (0..height)
            .map(|row| {
                (0..width).map(|column| mean(image, [width, height], [column, row])).collect()
            })
            .collect();
        let total: f64 = cells.iter().flatten().sum();
        // Blending lends every cell some of its neighbours' light.
        let floor = 0.01 * total / (width * height) as f64;
        let mut sums = Vec::with_capacity(height);
        let mut bright = 0.0;
        for (row, cells) in cells.iter_mut().enumerate() {
            let fall = f64::from(libm::sinf(PI * (row as f32 + 0.5) / height as f32));
            for cell in cells.iter_mut() {
                *cell += floor;
            }
            let sum: f64 = cells.iter().sum::<f64>() * fall;
            bright += sum;
            sums.push(sum);
        }
        let columns: Option<Vec<Chances>> = cells.iter().map(|row| Chances::new(row)).collect();
        let mean = bright / (width * height) as f64 * f64::from(PI / 2.0) * f64::from(scale);
        Some(Self { radians, rows: Chances::new(&sums)?, columns: columns?, mean: mean as f32 })
    }

    /// A direction, and its density.
    pub(crate) fn sample(&self, [u, v]: [f32; 2]) -> Option<(Vec3A, f32)> {
        let (row, row_chance, down) = self.rows.pick_within(v);
        let columns = &self.columns[row];
        let (column, chance, across) = columns.pick_within(u);
        let place = [
            (column as f32 + across) / self.width() as f32,
            (row as f32 + down) / self.columns.len() as f32,
        ];
        let (dir, fall) = direction_of(place, self.radians);
        let density = self.per_angle(row_chance * chance, fall);
        (density > 0.0 && density.is_finite()).then_some((dir, density))
    }

    /// The density of a direction.
    pub(crate) fn density(&self, dir: Vec3A) -> f32 {
        let [u, v] = place_of(dir, self.radians);
        let row = ((v * self.columns.len() as f32) as usize).min(self.columns.len() - 1);
        let column = ((u * self.width() as f32) as usize).min(self.width() - 1);
        let fall = (dir.x * dir.x + dir.z * dir.z).sqrt();
        let density = self.per_angle(self.rows.of(row) * self.columns[row].of(column), fall);
        if density.is_finite() { density } else { 0.0 }
    }

    fn width(&self) -> usize {
        self.columns[0].len()
    }

    /// The chance of a cell, spread over the solid angle it takes.
    fn per_angle(&self, chance: f32, fall: f32) -> f32 {
        let cells = (self.width() * self.columns.len()) as f32;
        chance * cells / (2.0 * PI * PI * fall)
    }
}

/// The mean brightness of the pixels of one of some cells.
fn mean(image: &Image, size: [usize; 2], cell: [usize; 2]) -> f64 {
    let range = |axis: usize, pixels: usize| {
        let from = cell[axis] * pixels / size[axis];
        from..((cell[axis] + 1) * pixels / size[axis]).max(from + 1)
    };
    let (rows, columns) = (range(1, image.height), range(0, image.width));
    let count = rows.len() * columns.len();
    let mut sum = 0.0;
    for y in rows {
        for x in columns.clone() {
            let [r, g, b, _] = image.pixel(x, y);
            let bright = f64::from(luminance(Vec3A::new(r, g, b)));
            sum += if bright > 0.0 && bright.is_finite() { bright } else { 0.0 };
        }
    }
    sum / count as f64
}
