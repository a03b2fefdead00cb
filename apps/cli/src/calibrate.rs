//! `nestray calibrate`: what steps and tests cost on this machine.

use std::fmt::Write as _;

use nestray::core::cost::CostModel;
use nestray::plan::calibrate::{Calibration, Sample, calibrate};
use nestray::plan::optimize::Observer;
use nestray::plan::prices::Prices;
use nestray::render::watch::Watch as _;
use nestray::scene::procedural::generate;

use crate::args::{CalibrateArgs, Talk, Weights};
use crate::cache::Cache;
use crate::errors::Failure;
use crate::optimize::log;
use crate::progress::{Progress, Watching};
use crate::{output, stop};

/// Scenes of all kinds, small ones for what shapes cost, large ones for what memory does.
const SAMPLES: &[(&str, u32)] = &[
    ("balls", 3),
    ("bezier-teapot", 6),
    ("clusters", 2),
    ("forest", 300),
    ("gears", 2),
    ("hair", 400),
    ("jacks", 4),
    ("lattice", 6),
    ("mixed", 10),
    ("mount", 5),
    ("needles", 3_000),
    ("rings", 5),
    ("scatter", 20_000),
    ("scatter", 300_000),
    ("sombrero", 3),
    ("stadium", 1_000),
    ("teapot", 8),
    ("terrain", 64),
    ("terrain", 350),
    ("tetra", 6),
    ("tree", 8),
    ("truss", 6),
];
/// Rays of each kind.
const RAYS: usize = 8192;

pub(crate) fn run(args: &CalibrateArgs, talk: &Talk) -> Result<(), Failure> {
    let progress = Progress::new(talk);
    args.output.iter().try_for_each(|path| output::check(path))?;
    let weights = Weights::all();
    let mut wrong = None;
    let samples = SAMPLES.iter().map_while(|&(name, size)| match sample(name, size, &weights) {
        Ok(sample) => Some(sample),
        Err(failure) => {
            wrong = Some(failure);
            None
        }
    });
    let screen = Screen { watching: progress.watch("calibrate") };
    let found = calibrate(samples, &screen)
        .map_err(|error| Failure::new(Failure::FAILED, error.to_string()))?;
    drop(screen);
    if let Some(failure) = wrong {
        return Err(failure);
    }
    stop::check()?;
    if let Some(path) = &args.output {
        output::write(path, &text_of(&found.prices))?;
    } else {
        Cache::open(true, progress).keep_prices(&found.prices);
    }
    output::say(&table(&found))
}

/// Prices as a file.
fn text_of(prices: &Prices) -> Vec<u8> {
    let mut text = serde_json::to_vec_pretty(prices).expect("prices are plain data");
    text.push(b'\n');
    text
}

fn sample(name: &str, size: u32, weights: &Weights) -> Result<Sample, Failure> {
    let failure = |error: &dyn std::fmt::Display| Failure::new(Failure::FAILED, error);
    let scene = generate(name, Some(size)).map_err(|error| failure(&error))?.frame(0.0, 0.0);
    let log = log(&scene, weights, RAYS)?;
    Ok(Sample { name: format!("{name}={size}"), scene, log })
}

/// Prices, for people.
fn table(found: &Calibration) -> String {
    let Calibration { prices, runs, error } = found;
    let mut text = format!(
        "nanoseconds, by {runs} runs; a scene that was not looked at is off by {:.0} % in the median\n\n\
         {:<24} {:>10} {:>10}\n",
        100.0 * error,
        "",
        "neighbours",
        "scattered"
    );
    let mut row = |name: &str, of: &dyn Fn(&CostModel) -> f64| {
        let [a, b] = [&prices.neighbours, &prices.scattered].map(of);
        let _ = writeln!(text, "{name:<24} {a:>10.1} {b:>10.1}");
    };
    row("a ray", &|model| model.ray);
    row("twice the memory", &|model| model.far);
    row("a call", &|model| model.call);
    row("an instance", &|model| model.transform);
    for kind in prices.scattered.primitive.keys() {
        row(&format!("test: {kind}"), &|model| model.primitive(kind));
    }
    for technique in prices.scattered.step.keys() {
        row(&format!("step: {technique}"), &|model| model.step(technique));
    }
    text
}

/// Shows how far it is.
struct Screen {
    watching: Watching,
}

impl Observer for Screen {
    fn tried(&self, scenes: usize, _best: f64) {
        self.watching.advanced(scenes as u64, SAMPLES.len() as u64, 0);
    }

    fn stop(&self) -> bool {
        stop::asked()
    }
}
