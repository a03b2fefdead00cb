//! The command line of `nestray render`.

use std::path::PathBuf;
use std::time::Duration;

use super::names::{CurveName, FilterName, IntegratorName};
use super::values::{Frames, Window};

/// `nestray render`.
#[derive(Debug, clap::Args)]
#[command(after_help = "Examples:\n  \
    nestray render builtin:balls -o balls.png\n  \
    nestray render scene.gltf -o out.exr -o out.png --resolution 1280x720 --spp 64\n  \
    nestray render scene.nff -o out.png --integrator whitted --plan grid\n  \
    nestray render scene.gltf -o film.png --frames 0-47 --fps 24 --shutter 0.5")]
pub(crate) struct RenderArgs {
    /// A file, `-` for standard input, or `builtin:NAME`.
    pub(crate) scene: String,
    /// Where to: .png, .exr or .pfm; may be given several times.
    #[arg(short, long = "output", required = true, value_name = "FILE")]
    pub(crate) output: Vec<PathBuf>,
    /// `auto`, a technique or a preset over everything, or a plan file. `auto` searches for the
    /// fastest if the picture takes long enough, and keeps what it found in the user's cache folder.
    #[arg(long, default_value = "auto")]
    pub(crate) plan: String,
    /// How long `--plan auto` may search, as in 30s or 2m, instead of as long as seems worth it; 0s
    /// for not at all.
    #[arg(long, value_name = "TIME", value_parser = super::optimize::time)]
    pub(crate) search: Option<Duration>,
    /// Take no plan from the cache, and keep none there.
    #[arg(long)]
    pub(crate) no_cache: bool,
    /// How light is followed.
    #[arg(long, default_value = "path", default_value_if("spd", "true", "whitted"))]
    pub(crate) integrator: IntegratorName,
    /// Pixels across and down; that of the scene, or 640x480.
    #[arg(long, value_name = "WxH", value_parser = super::values::resolution)]
    pub(crate) resolution: Option<[u32; 2]>,
    /// Samples per pixel.
    #[arg(long, default_value_t = 16)]
    pub(crate) spp: u32,
    /// Most rays in a row.
    #[arg(long)]
    pub(crate) max_depth: Option<u32>,
    /// Only the pixels from x0 to before x1, from y0 to before y1.
    #[arg(long, value_name = "x0,x1,y0,y1", value_parser = super::values::window)]
    pub(crate) crop: Option<Window>,
    /// Frames A to B, every S-th: files are numbered.
    #[arg(long, value_name = "A-BxS", value_parser = super::values::frames)]
    pub(crate) frames: Option<Frames>,
    /// Frames per second.
    #[arg(long, default_value_t = 24.0, value_parser = super::values::positive)]
    pub(crate) fps: f32,
    /// Part of a frame that the shutter is open.
    #[arg(long, default_value_t = 0.0, value_parser = super::values::part)]
    pub(crate) shutter: f32,
    /// Another number gives another noise.
    #[arg(long, default_value_t = 0)]
    pub(crate) seed: u64,
    /// How many threads; all of the machine if 0.
    #[arg(long, default_value_t = 0, value_parser = super::values::threads)]
    pub(crate) threads: usize,
    /// Rays that are traced together; 1 is one at a time. The picture is the same.
    #[arg(long, default_value_t = 1024, value_name = "RAYS", value_parser = super::values::batch)]
    pub(crate) batch: usize,
    /// Which camera, by number or name.
    #[arg(long)]
    pub(crate) camera: Option<String>,
    /// How light becomes colours of a .png.
    #[arg(long, default_value = "none")]
    pub(crate) tonemap: CurveName,
    /// Stops brighter, for a .png.
    #[arg(long, default_value_t = 0.0, allow_negative_numbers = true, value_parser = super::values::finite)]
    pub(crate) exposure: f32,
    /// Most that light counts for which came over several surfaces, per sample, in multiples
    /// of what is shown as white; 0 for no limit. Path tracing only. [default: 10 if nothing
    /// but .png is written, else 0]
    #[arg(long, value_name = "WHITES", value_parser = super::values::limit)]
    pub(crate) clamp: Option<f32>,
    /// How samples become pixels.
    #[arg(long, default_value = "gaussian")]
    pub(crate) filter: FilterName,
    /// Render by the rules of the standard procedural databases: Whitted's model, 512x512
    /// pixels, their corners, the full tree of rays to depth 5, bytes in proportion to light.
    #[arg(long, conflicts_with_all = ["spp", "filter"])]
    pub(crate) spd: bool,
    /// How far something may be to count for ambient occlusion.
    #[arg(long, value_name = "DISTANCE")]
    pub(crate) radius: Option<f32>,
    /// Write times, ray counts and memory as JSON.
    #[arg(long, value_name = "FILE")]
    pub(crate) stats: Option<PathBuf>,
}
