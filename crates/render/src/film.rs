//! What becomes of samples: pixels in layers.

use glam::{DVec3, Vec3A};
use nestray_scene::picture::{Layer, Picture};

use crate::eye::Seen;
use crate::options::Crop;
use crate::tile::Tile;

/// The sums of one pixel. In doubles, added in order of samples.
#[derive(Clone, Copy, Debug)]
struct Sums {
    weighted: DVec3,
    weight: f64,
    plain: DVec3,
    count: f64,
    albedo: DVec3,
    normal: DVec3,
    cost: f64,
    first: Seen,
}

/// The pixels of one tile, while it is rendered.
#[derive(Default)]
pub(crate) struct TileFilm {
    pub(crate) tile: Tile,
    pixels: Vec<Sums>,
}

impl TileFilm {
    /// Starts with another tile.
    pub(crate) fn begin(&mut self, tile: Tile) {
        self.tile = tile;
        self.pixels.clear();
        self.pixels.resize(tile.pixels(), Sums::NONE);
    }

    /// Adds a sample. One whose colour is no number counts as black: a single one would
    /// otherwise spoil its pixel for good.
    pub(crate) fn add(&mut self, pixel: usize, seen: &Seen, weight: f32) {
        let sums = &mut self.pixels[pixel];
        let color = if seen.color.is_finite() { seen.color } else { Vec3A::ZERO };
        let (color, weight) = (color.as_dvec3(), f64::from(weight));
        if sums.count == 0.0 {
            sums.first = *seen;
        }
        sums.weighted += color * weight;
        sums.weight += weight;
        sums.plain += color;
        sums.count += 1.0;
        sums.albedo += seen.albedo.as_dvec3();
        sums.normal += seen.normal.as_dvec3();
        sums.cost += f64::from(seen.cost);
    }
}

impl Sums {
    const NONE: Self = Self {
        weighted: DVec3::ZERO,
        weight: 0.0,
        plain: DVec3::ZERO,
        count: 0.0,
        albedo: DVec3::ZERO,
        normal: DVec3::ZERO,
        cost: 0.0,
        first: Seen::NOTHING,
    };

    /// Its colour. Where negative weights leave too little to divide by, the plain mean.
    fn color(&self) -> DVec3 {
        if self.count == 0.0 {
            DVec3::ZERO
        } else if self.weight > 0.25 * self.count {
            self.weighted / self.weight
        } else {
            self.plain / self.count
        }
    }
}

/// All pixels of a picture.
pub(crate) struct Film {
    window: Crop,
    corners: bool,
    layers: Vec<Plane>,
}

/// One layer, and where its samples come from.
struct Plane {
    name: &'static str,
    channels: &'static [&'static str],
    samples: Vec<f32>,
    value: fn(&Sums) -> [f32; 3],
    /// Whether the mean of two values means anything.
    blends: bool,
}

/// What is kept of a render.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Keep {
    pub(crate) layers: bool,
    pub(crate) cost: bool,
}

impl Film {
    /// For the pixels of `window`, or for their corners.
    pub(crate) fn new(window: Crop, corners: bool, keep: Keep) -> Self {
        let more = u32::from(corners);
        let window = Crop { to: window.to.map(|x| x + more), ..window };
        let mut film = Self { window, corners, layers: Vec::new() };
        film.layer("", &["R", "G", "B"], true, |s| s.color().as_vec3().to_array());
        if keep.cost {
            film.layer("cost", &["N"], true, |s| [mean(s.cost, s) as f32; 3]);
        }
        if keep.layers {
            film.layer("albedo", &["R", "G", "B"], true, |s| {
                (s.albedo / s.count.max(1.0)).as_vec3().to_array()
            });
            film.layer("normal", &["X", "Y", "Z"], true, |s| {
                (s.normal / s.count.max(1.0)).as_vec3().to_array()
            });
            film.layer("depth", &["Z"], false, |s| [s.first.depth; 3]);
            film.layer("geometry", &["ID"], false, |s| [s.first.geometry; 3]);
        }
        film
    }

    fn layer(
        &mut self,
        name: &'static str,
        channels: &'static [&'static str],
        blends: bool,
        value: fn(&Sums) -> [f32; 3],
    ) {
        let [width, height] = self.size();
        let empty = value(&Sums::NONE);
        let samples = empty[..channels.len()].repeat(width * height);
        self.layers.push(Plane { name, channels, samples, value, blends });
    }

    /// The pixels, or corners, to render.
    pub(crate) fn window(&self) -> Crop {
        self.window
    }

    fn size(&self) -> [usize; 2] {
        [0, 1].map(|i| (self.window.to[i] - self.window.from[i]) as usize)
    }

    /// Puts a tile in its place.
    pub(crate) fn put(&mut self, tile: &TileFilm) {
        let [width, _] = self.size();
        for (i, sums) in tile.pixels.iter().enumerate() {
            let [x, y] = tile.tile.pixel(i);
            let [x, y] = [x - self.window.from[0], y - self.window.from[1]];
            let pixel = y as usize * width + x as usize;
            for layer in &mut self.layers {
                let channels = layer.channels.len();
                let value = (layer.value)(sums);
                layer.samples[pixel * channels..][..channels].copy_from_slice(&value[..channels]);
            }
        }
    }

    /// The picture.
    pub(crate) fn develop(self) -> Picture {
        let [width, height] = self.size();
        let corners = self.corners;
        let layer = |plane: Plane| {
            let channels = plane.channels.iter().map(ToString::to_string).collect();
            let samples = if corners { from_corners(&plane, width, height) } else { plane.samples };
            Layer { name: plane.name.into(), channels, samples }
        };
        let less = usize::from(corners);
        Picture {
            width: width - less,
            height: height - less,
            layers: self.layers.into_iter().map(layer).collect(),
        }
    }
}

fn mean(sum: f64, sums: &Sums) -> f64 {
    sum / sums.count.max(1.0)
}

/// Pixels as the means of their corners; what has no mean is taken from the upper left one.
fn from_corners(plane: &Plane, width: usize, height: usize) -> Vec<f32> {
    let channels = plane.channels.len();
    let mut pixels = Vec::with_capacity((width - 1) * (height - 1) * channels);
    for y in 0..height - 1 {
        for x in 0..width - 1 {
            for channel in 0..channels {
                let at = |x: usize, y: usize| plane.samples[(y * width + x) * channels + channel];
                let sum = (at(x, y) + at(x + 1, y)) + (at(x, y + 1) + at(x + 1, y + 1));
                pixels.push(if plane.blends { sum * 0.25 } else { at(x, y) });
            }
        }
    }
    pixels
}
