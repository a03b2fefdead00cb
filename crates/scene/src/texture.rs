//! Pictures on surfaces.

use std::sync::Arc;

/// A picture and how it is laid on a surface.
#[derive(Clone, Debug)]
pub struct Texture {
    /// What it is called; may be empty.
    pub name: String,
    /// The picture.
    pub image: Arc<Image>,
    /// How it goes on beyond its edges, along u and v.
    pub wrap: [Wrap; 2],
    /// Whether it is sampled without blending neighbours.
    pub nearest: bool,
    /// Texture coordinates are scaled, then rotated by this many radians, then moved.
    pub scale: [f32; 2],
    /// See [`scale`](Self::scale).
    pub rotation: f32,
    /// See [`scale`](Self::scale).
    pub offset: [f32; 2],
}

/// How a texture goes on beyond its edges.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Wrap {
    /// From the start again.
    #[default]
    Repeat,
    /// Back and forth.
    Mirror,
    /// With the colour of the edge.
    Clamp,
}

/// Pixels, row by row from the top.
#[derive(Clone, Debug)]
pub struct Image {
    /// Pixels in a row, at least 1.
    pub width: usize,
    /// Rows, at least 1.
    pub height: usize,
    /// The pixels, `width × height` of them.
    pub pixels: Pixels,
}

/// How pixels are stored.
#[derive(Clone, Debug)]
pub enum Pixels {
    /// Eight bits a channel, sRGB curve on colours, alpha linear.
    Srgb(Vec<[u8; 4]>),
    /// Eight bits a channel, linear.
    Linear(Vec<[u8; 4]>),
    /// Linear, of any size; for light.
    Float(Vec<[f32; 3]>),
}

impl Texture {
    /// A picture that repeats, its neighbours blended.
    #[must_use]
    pub fn new(name: impl Into<String>, image: Arc<Image>) -> Self {
        Self {
            name: name.into(),
            image,
            wrap: [Wrap::Repeat; 2],
            nearest: false,
            scale: [1.0; 2],
            rotation: 0.0,
            offset: [0.0; 2],
        }
    }

    /// Linear colour and alpha at texture coordinates; `v` runs down from the top.
    #[must_use]
    pub fn sample(&self, [u, v]: [f32; 2]) -> [f32; 4] {
        let (sine, cosine) = (libm::sinf(self.rotation), libm::cosf(self.rotation));
        let (u, v) = (u * self.scale[0], v * self.scale[1]);
        let (u, v) =
            (cosine * u + sine * v + self.offset[0], cosine * v - sine * u + self.offset[1]);
        let (width, height) = (self.image.width, self.image.height);
        let (x, y) = (u * width as f32, v * height as f32);
        if !(x.is_finite() && y.is_finite()) {
            return self.image.pixel(0, 0);
        }
        let pixel = |x: f32, y: f32| {
            self.image.pixel(self.wrap[0].index(x, width), self.wrap[1].index(y, height))
        };
        if self.nearest {
            return pixel(x.floor(), y.floor());
        }
        let (x, y) = (x - 0.5, y - 0.5);
        let (left, top) = (x.floor(), y.floor());
        let (a, b) = (x - left, y - top);
        let [p, q] = [pixel(left, top), pixel(left + 1.0, top)];
        let [r, s] = [pixel(left, top + 1.0), pixel(left + 1.0, top + 1.0)];
        [0, 1, 2, 3]
            .map(|i| (p[i] * (1.0 - a) + q[i] * a) * (1.0 - b) + (r[i] * (1.0 - a) + s[i] * a) * b)
    }
}

impl Wrap {
    /// Which of `count` pixels is meant by `at`, a whole number.
    fn index(self, at: f32, count: usize) -> usize {
        let n = count as i64;
        let at = at as i64;
        let within = match self {
            Self::Repeat => at.rem_euclid(n),
            Self::Clamp => at.clamp(0, n - 1),
            Self::Mirror => {
                let twice = at.rem_euclid(2 * n);
                twice.min(2 * n - 1 - twice)
            }
        };
        within as usize
    }
}

impl Image {
    /// Linear colour and alpha of a pixel.
    ///
    /// # Panics
    /// If there is no such pixel.
    #[must_use]
    pub fn pixel(&self, x: usize, y: usize) -> [f32; 4] {
        let at = y * self.width + x;
        let unit = |x: u8| f32::from(x) / 255.0;
        match &self.pixels {
            Pixels::Srgb(pixels) => {
                let [r, g, b, a] = pixels[at];
                [
                    linear_from_srgb(unit(r)),
                    linear_from_srgb(unit(g)),
                    linear_from_srgb(unit(b)),
                    unit(a),
                ]
            }
            Pixels::Linear(pixels) => pixels[at].map(unit),
            Pixels::Float(pixels) => {
                let [r, g, b] = pixels[at];
                [r, g, b, 1.0]
            }
        }
    }
}

/// Undoes the sRGB curve; in and out in `[0, 1]`.
#[must_use]
pub fn linear_from_srgb(x: f32) -> f32 {
    if x <= 0.04045 { x / 12.92 } else { libm::powf((x + 0.055) / 1.055, 2.4) }
}

/// The sRGB curve; in and out in `[0, 1]`.
#[must_use]
pub fn srgb_from_linear(x: f32) -> f32 {
    if x <= 0.003_130_8 { x * 12.92 } else { 1.055 * libm::powf(x, 1.0 / 2.4) - 0.055 }
}
