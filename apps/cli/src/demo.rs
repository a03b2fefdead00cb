//! `nestray demo`.

mod race;

use std::fmt::Write as _;
use std::path::Path;
use std::time::{Duration, Instant};

use nestray::core::cost::CostModel;
use nestray::io::write::write_picture;
use nestray::plan::build::build;
use nestray::plan::describe::{bytes, describe};
use nestray::plan::single::AUTO;
use nestray::prelude::{DynObject, Scene};
use nestray::render::options::{Integrator, Options};
use nestray::render::render::{Rendered, render};
use nestray::render::tone_map::{Curve, ToneMap};
use nestray::render::watch::{Unwatched, Watch};

use crate::args::{DemoArgs, Talk};
use crate::errors::Failure;
use crate::input::{self, Choice};
use crate::progress::{Progress, Watching, rate};
use crate::stats::{self, Stats};
use crate::{output, stop};

const PICTURE: &str = "nestray-demo.png";
const REPORT: &str = "nestray-demo.txt";

/// Pixels across and down.
const RESOLUTION: [u32; 2] = [800, 450];

/// Samples per pixel: the most of these that there is time for.
const SAMPLES: [u32; 7] = [64, 32, 16, 8, 4, 2, 1];

/// How long the picture may take.
const PICTURE_TIME: Duration = Duration::from_secs(25);

/// When everything is brought to an end, whatever the machine.
const ALL_TIME: Duration = Duration::from_secs(50);

pub(crate) fn run(_args: &DemoArgs, talk: &Talk) -> Result<(), Failure> {
    let (progress, mut stats, begun) = (Progress::new(talk), Stats::new(), Instant::now());
    output::check(Path::new(PICTURE))?;
    output::check(Path::new(REPORT))?;
    let scene = stats.stage("make", || input::builtin("demo", None))?;
    let choice = Choice::Technique("auto".into());
    let plan = choice.plan(&scene)?;
    let world = stats.stage("build", || build(&plan, &scene)).map_err(|e| choice.failure(&e))?;
    stop::check()?;
    let race = stats.stage("compare", || race::run(&scene, &world, progress))?;
    stop::check()?;
    let options = settings(&scene, &world)?;
    let watch = Deadline { watching: progress.watch("demo"), end: begun + ALL_TIME };
    let rendered = stats.stage("render", || render(&scene, &world, &options, &watch))?;
    drop(watch);
    let shown = ToneMap { curve: Curve::Aces, ..ToneMap::default() }.bytes(&rendered.picture);
    stats.stage("write", || write_picture(Path::new(PICTURE), &rendered.picture, Some(&shown)))?;
    let mut text = about(&scene, &plan.hash(), &world);
    text.push_str(&race);
    text.push_str(&picture(&rendered, &options, &stats));
    output::write(Path::new(REPORT), text.as_bytes())?;
    output::say(&text)?;
    progress.note(&format!("{PICTURE} and {REPORT} written"));
    if stop::asked() { Err(stop::interrupted("the picture may not be finished")) } else { Ok(()) }
}

/// How to render it: as many samples as there is time for, by a small trial.
fn settings(scene: &Scene, world: &DynObject) -> Result<Options, Failure> {
    let trial = Options {
        resolution: RESOLUTION.map(|side| side / 5),
        samples: 1,
        integrator: Integrator::Path,
        layers: false,
        ..Options::default()
    };
    let begun = Instant::now();
    render(scene, world, &trial, &Unwatched)?;
    let one = begun.elapsed() * 25;
    let fits = |samples: &&u32| one * **samples <= PICTURE_TIME;
    let samples = SAMPLES.iter().find(fits).copied().unwrap_or(1);
    Ok(Options { resolution: RESOLUTION, samples, ..trial })
}

/// Ends the picture in time.
struct Deadline {
    watching: Watching,
    end: Instant,
}

impl Watch for Deadline {
    fn advanced(&self, done: u64, total: u64, rays: u64) {
        self.watching.advanced(done, total, rays);
    }

    fn stop(&self) -> bool {
        self.watching.stop() || Instant::now() > self.end
    }
}

/// The scene and its nest.
fn about(scene: &Scene, hash: &str, world: &DynObject) -> String {
    let stored: u64 = scene.geometries.iter().map(|g| u64::from(g.primitives())).sum();
    let part = describe(world, &CostModel::default());
    let mut text = String::new();
    let version = env!("CARGO_PKG_VERSION");
    let _ = writeln!(text, "nestray {version}, vector level {}", stats::level());
    let _ =
        writeln!(text, "\nThe scene: {} primitives, {stored} of them stored", scene.primitives());
    let _ = writeln!(text, "\nThe nest (auto is {AUTO} for now), plan {hash}");
    text.push_str(&part.to_text());
    text
}

/// The picture and what it took.
fn picture(rendered: &Rendered, options: &Options, stats: &Stats) -> String {
    let [width, height] = options.resolution;
    let seconds = stats.seconds("render");
    let mut text = String::new();
    let samples = options.samples;
    let _ = writeln!(text, "\nThe picture: {width} x {height} pixels, {samples} samples each");
    if !rendered.complete {
        let _ = writeln!(text, "  not finished: time was up");
    }
    for (kind, count) in rendered.rays.each() {
        if count.cast > 0 {
            let percent = 100.0 * count.hit as f64 / count.cast as f64;
            let _ = writeln!(text, "  {kind:<8} {:>12} rays, {percent:.0} % hit", count.cast);
        }
    }
    let rays = rendered.rays.total().cast;
    let _ = writeln!(text, "  together {rays:>12} rays in {seconds:.2} s, {}", rate(rays, seconds));
    let _ = writeln!(text, "\nTimes");
    for stage in ["make", "build", "compare", "render", "write"] {
        let _ = writeln!(text, "  {stage:<8} {:>6.2} s", stats.seconds(stage));
    }
    if let Some(peak) = stats::peak_memory() {
        let _ = writeln!(text, "  memory   {} at most", bytes(peak));
    }
    text
}
