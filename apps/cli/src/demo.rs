//! `nestray demo`.

use std::fmt::Write as _;
use std::path::Path;
use std::time::{Duration, Instant};

use nestray::core::cost::CostModel;
use nestray::io::write::write_picture;
use nestray::plan::build::build;
use nestray::plan::describe::{bytes, describe};
use nestray::plan::optimize as search;
use nestray::prelude::{DynObject, Scene};
use nestray::render::options::{Integrator, Options};
use nestray::render::ray_counts::RayCounts;
use nestray::render::render::{Rendered, render};
use nestray::render::tone_map::{Curve, ToneMap};
use nestray::render::watch::Watch;
use nestray::scene::picture::Picture;

use crate::args::{DemoArgs, Talk, Weights};
use crate::cache::Cache;
use crate::errors::Failure;
use crate::input;
use crate::optimize::{self, report};
use crate::progress::{Progress, Watching, rate};
use crate::render::settings::WHITES;
use crate::stats::{self, Stats};
use crate::{output, stop};

const PICTURE: &str = "nestray-demo.png";
const REPORT: &str = "nestray-demo.txt";

/// Pixels across and down.
const RESOLUTION: [u32; 2] = [800, 450];

/// Most samples per pixel.
const SAMPLES: u32 = 64;

/// Samples per pixel between two looks at the clock.
const PASS: u32 = 4;

/// How long a nest is searched for; timing the best takes about as long again.
const SEARCH: Duration = Duration::from_secs(6);

/// Rays of each kind to search with and to time with.
const RAYS: usize = 32_768;

/// Rays that the picture takes, about.
const EXPECTED: f64 = 1e8;

/// When the picture is good enough, counted from the start of the program.
const ENOUGH: Duration = Duration::from_secs(40);

/// When everything is brought to an end, whatever the machine.
const END: Duration = Duration::from_secs(50);

pub(crate) fn run(_args: &DemoArgs, talk: &Talk) -> Result<(), Failure> {
    let (progress, mut stats, begun) = (Progress::new(talk), Stats::new(), Instant::now());
    output::check(Path::new(PICTURE))?;
    output::check(Path::new(REPORT))?;
    let scene = stats.stage("make", || input::builtin("demo", None))?;
    let log = optimize::log(&scene, &Weights::default(), RAYS)?;
    let options = search::Options {
        time: Some(SEARCH),
        rays_expected: EXPECTED,
        rounds: 3,
        ..search::Options::default()
    };
    let prices = Cache::open(true, progress).prices();
    let search = || optimize::search(&scene, &log, &prices, &options, progress);
    let found = stats.stage("optimize", search)?;
    stop::check()?;
    let failure = |error| input::plan_failure(&error, None);
    let world = stats.stage("build", || build(&found.plan, &scene)).map_err(failure)?;
    let clock = Clock { watching: progress.watch("demo"), begun };
    let painted = stats.stage("render", || paint(&scene, &world, &clock))?;
    drop(clock);
    let shown = ToneMap { curve: Curve::Aces, ..ToneMap::default() }.bytes(&painted.picture);
    stats.stage("write", || write_picture(Path::new(PICTURE), &painted.picture, Some(&shown)))?;
    let mut text = about(&scene, &found.plan.hash(), &world);
    text.push_str("\nHow it was chosen\n");
    text.push_str(&report::text(&found, &log));
    text.push_str(&about_picture(&painted, &stats));
    output::write(Path::new(REPORT), text.as_bytes())?;
    output::say(&text)?;
    progress.note(&format!("{PICTURE} and {REPORT} written"));
    if stop::asked() { Err(stop::interrupted("the picture may not be finished")) } else { Ok(()) }
}

/// A picture that got better until time was up.
struct Painted {
    picture: Picture,
    rays: RayCounts,
    samples: u32,
    /// Whether at least one sample of every pixel was taken.
    complete: bool,
}

/// Renders a few samples at a time; the picture is the mean of all.
fn paint(scene: &Scene, world: &DynObject, clock: &Clock) -> Result<Painted, Failure> {
    let options = Options {
        resolution: RESOLUTION,
        integrator: Integrator::Path,
        clamp: Some(WHITES),
        layers: false,
        ..Options::default()
    };
    let mut painted: Option<Painted> = None;
    let mut pass = 1;
    loop {
        let (first_sample, begun) = (painted.as_ref().map_or(0, |p| p.samples), Instant::now());
        let options = Options { first_sample, samples: pass, ..options.clone() };
        let rendered = render(scene, world, &options, clock)?;
        let one = begun.elapsed() / pass;
        let (done, stopped) = match painted {
            None => (Painted::first(rendered, pass), false),
            Some(done) if rendered.complete => (done.with(&rendered, pass), false),
            // A part of a pass is of no use.
            Some(done) => (done, true),
        };
        let left = ENOUGH.saturating_sub(clock.begun.elapsed()).as_secs_f64();
        let fit = (left / one.as_secs_f64().max(1e-6)) as u32;
        pass = PASS.min(SAMPLES.saturating_sub(done.samples)).min(fit);
        if stopped || pass == 0 || stop::asked() {
            return Ok(done);
        }
        painted = Some(done);
    }
}

impl Painted {
    fn first(rendered: Rendered, samples: u32) -> Self {
        let Rendered { picture, rays, complete, .. } = rendered;
        Self { picture, rays, samples, complete }
    }

    fn with(mut self, rendered: &Rendered, samples: u32) -> Self {
        let (old, new) = (self.samples as f32, samples as f32);
        for (mine, other) in self.picture.layers.iter_mut().zip(&rendered.picture.layers) {
            for (a, b) in mine.samples.iter_mut().zip(&other.samples) {
                *a = (*a * old + *b * new) / (old + new);
            }
        }
        self.rays.add(&rendered.rays);
        self.samples += samples;
        self
    }
}

/// Shows how much time is left, and ends it.
struct Clock {
    watching: Watching,
    begun: Instant,
}

impl Watch for Clock {
    fn advanced(&self, _done: u64, _total: u64, rays: u64) {
        let total = ENOUGH.as_millis() as u64;
        let done = (self.begun.elapsed().as_millis() as u64).min(total);
        self.watching.advanced(done, total, rays);
    }

    fn stop(&self) -> bool {
        self.watching.stop() || self.begun.elapsed() > END
    }
}

/// The scene and its nest.
fn about(scene: &Scene, hash: &str, world: &DynObject) -> String {
    let stored: u64 = scene.geometries.iter().map(|g| u64::from(g.primitives())).sum();
    let part = describe(world, CostModel::usual());
    let mut text = String::new();
    let version = env!("CARGO_PKG_VERSION");
    let _ = writeln!(text, "nestray {version}, vector level {}", stats::level());
    let _ =
        writeln!(text, "\nThe scene: {} primitives, {stored} of them stored", scene.primitives());
    let _ = writeln!(text, "\nThe nest that was found for it, plan {hash}");
    let _ = writeln!(text, "Times beside it are expected from rough prices, not measured.");
    text.push_str(&part.to_text());
    text
}

/// The picture and what it took.
fn about_picture(painted: &Painted, stats: &Stats) -> String {
    let [width, height] = RESOLUTION;
    let seconds = stats.seconds("render");
    let mut text = String::new();
    let samples = painted.samples;
    let _ = writeln!(text, "\nThe picture: {width} x {height} pixels, {samples} samples each");
    if !painted.complete {
        let _ = writeln!(text, "  not finished: time was up");
    }
    for (kind, count) in painted.rays.each() {
        if count.cast > 0 {
            let percent = 100.0 * count.hit as f64 / count.cast as f64;
            let _ = writeln!(text, "  {kind:<8} {:>12} rays, {percent:.0} % hit", count.cast);
        }
    }
    let rays = painted.rays.total().cast;
    let _ = writeln!(text, "  together {rays:>12} rays in {seconds:.2} s, {}", rate(rays, seconds));
    let _ = writeln!(text, "\nTimes");
    for stage in ["make", "optimize", "build", "render", "write"] {
        let _ = writeln!(text, "  {stage:<8} {:>6.2} s", stats.seconds(stage));
    }
    if let Some(peak) = stats::peak_memory() {
        let _ = writeln!(text, "  memory   {} at most", bytes(peak));
    }
    text
}
