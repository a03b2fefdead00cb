//! What a render is asked for, and what is refused.

use nestray_core::simd::Level;
use nestray_scene::check::SceneError;
use nestray_scene::scene::Scene;
use thiserror::Error;

use crate::filter::Filter;

/// What to render, and how. All but [`threads`](Self::threads), [`wave`](Self::wave),
/// [`shuffle`](Self::shuffle) and [`level`](Self::level) decide what the picture is; those
/// only how fast it comes.
#[derive(Clone, Debug)]
pub struct Options {
    /// Pixels across and down.
    pub resolution: [u32; 2],
    /// The part to render, if not all; the picture is of its size.
    pub crop: Option<Crop>,
    /// Samples per pixel.
    pub samples: u32,
    /// The number of the first sample: renders of the samples 0 to 3 and 4 to 7 have nothing
    /// in common, and their mean is one of 0 to 7.
    pub first_sample: u32,
    /// Most rays in a row, the one from the eye counted, shadow rays not.
    pub max_depth: u32,
    /// How light is followed.
    pub integrator: Integrator,
    /// Most that light counts for in [`Integrator::Path`] that came over two surfaces or
    /// more, per light and sample: fewer lone bright pixels, for a loss where light is
    /// focused. In the scene's own units, so none unless asked for; ten times what is shown
    /// as white is seldom missed.
    pub clamp: Option<f32>,
    /// How samples become pixels.
    pub filter: Filter,
    /// Another number gives another noise.
    pub seed: u64,
    /// How many threads; 0 for as many as the machine has.
    pub threads: usize,
    /// Rays per batch, at least 1; 1 asks for one ray at a time, not in batches.
    pub wave: usize,
    /// Which camera of the scene.
    pub camera: usize,
    /// Renders tiles in an order made from this number, for tests.
    pub shuffle: Option<u64>,
    /// Vector instructions, if not the best there are.
    pub level: Option<Level>,
    /// Whether the picture also has layers of what was seen first: `albedo`, `normal`,
    /// `depth`, `geometry`.
    pub layers: bool,
}

/// A rectangle of pixels, counted from the top left.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Crop {
    /// The first column and row.
    pub from: [u32; 2],
    /// The column and row after the last.
    pub to: [u32; 2],
}

/// How light is followed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Integrator {
    /// Mirrors, glass, and lights without a surface [Whitted 80].
    Whitted(WhittedOptions),
    /// All light, as noise that vanishes with many samples [Kajiya 86].
    Path,
    /// How open the surroundings are.
    AmbientOcclusion {
        /// How far something may be to count; any distance if none.
        radius: Option<f32>,
    },
    /// How much work each ray from the eye was, in colours. Counts, so it is slow.
    Cost,
}

/// Settings of [`Integrator::Whitted`].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct WhittedOptions {
    /// Which rays are followed.
    pub tree: Tree,
}

/// Which rays of Whitted's tree are followed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Tree {
    /// Those that may count for at least 1/512 of a pixel.
    #[default]
    Pruned,
    /// All, as Haines' standard procedural databases prescribe so that counts can be
    /// compared: a reflected ray from every surface that mirrors or transmits, a refracted
    /// one from every one that transmits, and a shadow ray to every light a surface faces.
    Full,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            resolution: [640, 480],
            crop: None,
            samples: 16,
            first_sample: 0,
            max_depth: 8,
            integrator: Integrator::Path,
            clamp: None,
            filter: Filter::default(),
            seed: 0,
            threads: 0,
            wave: 1024,
            camera: 0,
            shuffle: None,
            level: None,
            layers: true,
        }
    }
}

impl Options {
    /// The test procedure of Haines' standard procedural databases: 512 × 512 pixels, each
    /// the mean of the rays through its four corners, five rays in a row.
    #[must_use]
    pub fn standard_test() -> Self {
        Self {
            resolution: [512, 512],
            samples: 1,
            max_depth: 5,
            integrator: Integrator::Whitted(WhittedOptions { tree: Tree::Full }),
            filter: Filter::Corners,
            ..Self::default()
        }
    }

    /// The pixels to render.
    #[must_use]
    pub fn window(&self) -> Crop {
        self.crop.unwrap_or(Crop { from: [0, 0], to: self.resolution })
    }

    /// Refuses what cannot be rendered.
    ///
    /// # Errors
    /// By the name of the setting.
    pub fn check(&self, scene: &Scene) -> Result<(), RenderError> {
        let [width, height] = self.resolution;
        if width == 0 || height == 0 || width.max(height) > MOST_A_SIDE {
            return Err(RenderError::Resolution { width, height });
        }
        if u64::from(width) * u64::from(height) > MOST_PIXELS {
            return Err(RenderError::Pixels { width, height });
        }
        let Crop { from, to } = self.window();
        if (0..2).any(|i| from[i] >= to[i] || to[i] > self.resolution[i]) {
            return Err(RenderError::Crop { from, to, resolution: self.resolution });
        }
        if self.samples == 0 || self.first_sample.checked_add(self.samples).is_none() {
            return Err(RenderError::Samples(self.samples));
        }
        if self.filter == Filter::Corners && self.samples != 1 {
            return Err(RenderError::Corners(self.samples));
        }
        if self.wave == 0 {
            return Err(RenderError::Wave);
        }
        self.check_depth()?;
        if let Integrator::AmbientOcclusion { radius: Some(radius) } = self.integrator
            && (radius.is_nan() || radius <= 0.0)
        {
            return Err(RenderError::Radius(radius));
        }
        if let Some(most) = self.clamp
            && (most.is_nan() || most <= 0.0)
        {
            return Err(RenderError::Clamp(most));
        }
        let cameras = scene.cameras.len();
        if self.camera >= cameras {
            return Err(RenderError::Camera { camera: self.camera, cameras });
        }
        Ok(())
    }

    fn check_depth(&self) -> Result<(), RenderError> {
        let full = Integrator::Whitted(WhittedOptions { tree: Tree::Full });
        let most = if self.integrator == full { DEEPEST_FULL } else { DEEPEST };
        if self.max_depth == 0 || self.max_depth > most {
            return Err(RenderError::Depth { depth: self.max_depth, most });
        }
        Ok(())
    }
}

/// Most pixels across or down.
const MOST_A_SIDE: u32 = 65_536;
/// Most pixels in all.
const MOST_PIXELS: u64 = 1 << 28;
/// Most rays in a row.
const DEEPEST: u32 = 4096;
/// The same where each may split in two: a full tree of this depth has 4095 rays.
const DEEPEST_FULL: u32 = 12;

/// Why a picture cannot be rendered.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum RenderError {
    /// A side is 0 or too long.
    #[error("resolution: {width} x {height} pixels; each side must be 1 to {MOST_A_SIDE}")]
    Resolution {
        /// Pixels across.
        width: u32,
        /// Pixels down.
        height: u32,
    },
    /// There are too many pixels.
    #[error("resolution: {width} x {height} is more than {MOST_PIXELS} pixels")]
    Pixels {
        /// Pixels across.
        width: u32,
        /// Pixels down.
        height: u32,
    },
    /// The part to render is empty or not inside the picture.
    #[error(
        "crop: from {},{} to {},{} is no part of {} x {} pixels",
        from[0], from[1], to[0], to[1], resolution[0], resolution[1]
    )]
    Crop {
        /// See [`Crop::from`].
        from: [u32; 2],
        /// See [`Crop::to`].
        to: [u32; 2],
        /// See [`Options::resolution`].
        resolution: [u32; 2],
    },
    /// There are no samples, or their numbers do not fit 32 bits.
    #[error("samples: {0} a pixel; there must be 1 or more, numbered within 32 bits")]
    Samples(u32),
    /// Corners of pixels have one ray each.
    #[error("samples: {0} a pixel, but the corners of pixels take 1")]
    Corners(u32),
    /// A batch of no rays.
    #[error("wave: a batch must have 1 ray or more")]
    Wave,
    /// No rays, or more than can be followed.
    #[error("max_depth: {depth} rays in a row; there must be 1 to {most}")]
    Depth {
        /// What was asked for.
        depth: u32,
        /// Most that can be.
        most: u32,
    },
    /// A distance that is none.
    #[error("radius: {0} is not a positive distance")]
    Radius(f32),
    /// A limit that lets nothing through.
    #[error("clamp: {0} is not a positive brightness")]
    Clamp(f32),
    /// There is no such camera.
    #[error("camera: number {camera} of {cameras} (counted from 0)")]
    Camera {
        /// What was asked for.
        camera: usize,
        /// How many there are.
        cameras: usize,
    },
    /// The scene makes no sense.
    #[error("scene: {0}")]
    Scene(#[from] SceneError),
    /// Threads could not be started.
    #[error("threads: {0}")]
    Threads(String),
}
