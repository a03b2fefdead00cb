//! The command line.

mod names;
mod optimize;
mod render;
mod values;

use std::path::PathBuf;

use clap::error::ErrorKind;
use clap::{Parser, Subcommand};

use crate::errors::Failure;

pub(crate) use self::names::{CurveName, FilterName, IntegratorName, ListName, ProgressMode};
pub(crate) use self::optimize::{Budget, OptimizeArgs, Weights};
pub(crate) use self::render::RenderArgs;
pub(crate) use self::values::{Frames, Numbers};

/// Ray tracing by nested acceleration techniques.
#[derive(Debug, Parser)]
#[command(name = "nestray", version, arg_required_else_help = true)]
#[command(after_help = "Exit codes: 0 done, 1 failed, 2 asked for in the wrong way, 3 a file \
    cannot be read, 4 answers differ, 130 interrupted.")]
pub(crate) struct Args {
    #[command(subcommand)]
    pub(crate) verb: Verb,
    #[command(flatten)]
    pub(crate) talk: Talk,
}

/// How much is said on the error stream.
#[derive(Debug, clap::Args)]
pub(crate) struct Talk {
    /// Say nothing but errors.
    #[arg(short, long, global = true, conflicts_with = "verbose")]
    pub(crate) quiet: bool,
    /// Say more.
    #[arg(short, long, global = true)]
    pub(crate) verbose: bool,
    /// How progress is shown on the error stream.
    #[arg(long, global = true, default_value = "auto")]
    pub(crate) progress: ProgressMode,
}

/// What to do.
#[derive(Debug, Subcommand)]
pub(crate) enum Verb {
    /// Render the built-in scene and report on it; needs no file.
    Demo(DemoArgs),
    /// Render a scene.
    Render(Box<RenderArgs>),
    /// Shoot rays from a file.
    Query(QueryArgs),
    /// Write a scene made by program.
    Generate(GenerateArgs),
    /// Write a scene in another format.
    Convert(ConvertArgs),
    /// Say what is in a scene or plan, and what there is to choose from.
    Inspect(InspectArgs),
    /// Let plans shoot the same rays, in turns.
    Bench(BenchArgs),
    /// Find the plan that is fastest for a scene.
    Optimize(OptimizeArgs),
    /// Find out what steps and tests cost on this machine, for searches to go by.
    Calibrate(CalibrateArgs),
}

/// `nestray calibrate`.
#[derive(Debug, clap::Args)]
#[command(
    after_help = "Takes some minutes, in which nothing else should run. What is found is kept in the \
    user's cache folder, and searches go by it from then on; without, they go by the prices of \
    another machine."
)]
pub(crate) struct CalibrateArgs {
    /// Write the prices as JSON instead of keeping them in the cache.
    #[arg(short, long, value_name = "FILE")]
    pub(crate) output: Option<PathBuf>,
}

/// `nestray demo`.
#[derive(Debug, clap::Args)]
#[command(after_help = "Writes nestray-demo.png and nestray-demo.txt.")]
pub(crate) struct DemoArgs {}

/// `nestray query`.
#[derive(Debug, clap::Args)]
#[command(after_help = "Rays are an array of shape (n, 6) or (n, 8), f32 or f64: origin, \
    direction, and if there are 8 the least and largest distance. Distances count in lengths of \
    the direction.\n\nHits are a structured array, one each: t, u, v (f32), geometry, \
    primitive, instance (u32). A miss has t = inf and 4294967295 for the rest, and so has a ray \
    that is none (NaN, infinite, without direction). With --any they are booleans; with --all, \
    hits of all rays in order, with the number of the ray as first field, u64.")]
pub(crate) struct QueryArgs {
    /// A file, `-` for standard input, or `builtin:NAME`.
    pub(crate) scene: String,
    /// The rays, .npy.
    #[arg(long, value_name = "FILE")]
    pub(crate) rays: PathBuf,
    /// Where to, .npy.
    #[arg(short, long, value_name = "FILE")]
    pub(crate) output: PathBuf,
    /// `auto`, a technique or a preset over everything, or a plan file.
    #[arg(long, default_value = "auto")]
    pub(crate) plan: String,
    /// Only whether anything is hit.
    #[arg(long, conflicts_with = "all")]
    pub(crate) any: bool,
    /// Every hit, not only the nearest.
    #[arg(long)]
    pub(crate) all: bool,
    /// How many threads; all of the machine if 0.
    #[arg(long, default_value_t = 0, value_parser = values::threads)]
    pub(crate) threads: usize,
    /// Write times, ray counts and memory as JSON.
    #[arg(long, value_name = "FILE")]
    pub(crate) stats: Option<PathBuf>,
}

/// `nestray generate`.
#[derive(Debug, clap::Args)]
#[command(after_help = "`nestray inspect --list scenes` names them.")]
pub(crate) struct GenerateArgs {
    /// Which scene.
    pub(crate) name: String,
    /// Its size factor.
    #[arg(long)]
    pub(crate) size: Option<u32>,
    /// Where to: .nff or .json.
    #[arg(short, long, value_name = "FILE")]
    pub(crate) output: PathBuf,
}

/// `nestray convert`.
#[derive(Debug, clap::Args)]
pub(crate) struct ConvertArgs {
    /// A file, `-` for standard input, or `builtin:NAME`.
    pub(crate) scene: String,
    /// Where to: .nff or .json.
    #[arg(short, long, value_name = "FILE")]
    pub(crate) output: PathBuf,
}

/// `nestray inspect`.
#[derive(Debug, clap::Args)]
#[command(after_help = "Examples:\n  \
    nestray inspect --list techniques\n  \
    nestray inspect --list presets\n  \
    nestray inspect scene.gltf --plan grid\n  \
    nestray inspect scene.gltf --ray 320,240\n  \
    nestray inspect plan.json\n  \
    nestray inspect scene.gltf --plan plan.json --explain root/nest/children/1\n  \
    nestray inspect --diff old.json new.json")]
pub(crate) struct InspectArgs {
    /// A scene (a file, `-`, or `builtin:NAME`) or a plan file.
    #[arg(required_unless_present_any = ["list", "diff"], conflicts_with_all = ["list", "diff"])]
    pub(crate) scene: Option<String>,
    /// Show the nest that a plan makes, and what it does for rays of each kind: visits of each
    /// part per ray, steps and tests per visit.
    #[arg(long)]
    pub(crate) tree: bool,
    /// The plan for `--ray`, or whose nest to show: `auto`, a technique, a preset, or a plan file.
    #[arg(long)]
    pub(crate) plan: Option<String>,
    /// Follow the ray through the middle of a pixel.
    #[arg(long, value_name = "X,Y", value_parser = values::pixel)]
    pub(crate) ray: Option<Numbers<2>>,
    /// Pixels across and down that `--ray` counts in; that of the scene, or 640x480.
    #[arg(long, value_name = "WxH", value_parser = values::resolution)]
    pub(crate) resolution: Option<[u32; 2]>,
    /// Say why a technique stands where it does in a plan: the cost of each other in its place, what
    /// it expected, and what was counted. Nodes are told by their path, as `root/nest/children/1`.
    #[arg(long, value_name = "NODE", requires = "scene", conflicts_with_all = ["tree", "ray"])]
    pub(crate) explain: Option<String>,
    /// Say what differs between two plan files.
    #[arg(long, value_names = ["PLAN", "PLAN"], num_args = 2, conflicts_with = "list")]
    pub(crate) diff: Option<Vec<PathBuf>>,
    /// Name what there is to choose from.
    #[arg(long)]
    pub(crate) list: Option<ListName>,
    /// As JSON.
    #[arg(long)]
    pub(crate) json: bool,
}

/// `nestray bench`.
#[derive(Debug, clap::Args)]
#[command(after_help = "Rays: from the eye; from what those hit to the first light, mirrored and \
    scattered; random lines. One thread; medians.\n\nExamples:\n  \
    nestray bench scene.gltf\n  \
    nestray bench scene.gltf --plans bvh,grid,mine.json --verify\n  \
    nestray bench bunny.ply --vs embree,obvhs -o bunny.json")]
pub(crate) struct BenchArgs {
    /// A file, `-` for standard input, or `builtin:NAME`.
    pub(crate) scene: String,
    /// Techniques, presets, `auto` or plan files; every technique if none is named, or with
    /// `--vs` only `bvh`.
    #[arg(long, value_name = "PLAN,…", value_delimiter = ',')]
    pub(crate) plans: Vec<String>,
    /// Other libraries to shoot the same rays: embree, tinybvh, obvhs, parry3d, bvh. Takes scenes
    /// of triangles, and rays of its own: primary, bounce, chords, shadow, ao, long.
    #[arg(long, value_name = "LIBRARY,…", value_delimiter = ',', conflicts_with = "verify")]
    pub(crate) vs: Vec<String>,
    /// Most rays of each kind; 65536, or with `--vs` a picture of 800 by 608.
    #[arg(long, value_parser = values::rays)]
    pub(crate) rays: Option<usize>,
    /// Another number gives other random rays, with `--vs`.
    #[arg(long, default_value_t = 1, requires = "vs")]
    pub(crate) seed: u64,
    /// Where to, with `--vs`: .json, or tables; may be given several times.
    #[arg(short, long, value_name = "FILE", requires = "vs")]
    pub(crate) output: Vec<PathBuf>,
    /// Turns of each plan.
    #[arg(long, default_value_t = 5, value_parser = values::rounds)]
    pub(crate) rounds: usize,
    /// Check answers by exhaustive search.
    #[arg(long)]
    pub(crate) verify: bool,
    /// As JSON.
    #[arg(long)]
    pub(crate) json: bool,
}

/// Reads the command line; help and version are said right away.
pub(crate) fn parse() -> Result<Args, Failure> {
    Args::try_parse().map_err(|error| match error.kind() {
        ErrorKind::DisplayHelp
        | ErrorKind::DisplayVersion
        | ErrorKind::DisplayHelpOnMissingArgumentOrSubcommand => error.exit(),
        _ => {
            let text = error.to_string();
            // What is wrong comes first, then an empty line, then advice.
            let mut parts = text.splitn(2, "\n\n");
            let what = parts.next().unwrap_or_default().trim_start_matches("error: ");
            let words: Vec<&str> = what.split_whitespace().collect();
            let tip = parts
                .next()
                .and_then(|rest| rest.lines().find_map(|line| line.trim().strip_prefix("tip: ")));
            let tip = tip.unwrap_or("--help says more");
            Failure::usage(words.join(" ")).hint(tip)
        }
    })
}
