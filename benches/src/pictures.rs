//! What batches bring to whole pictures: the same renderer is given rays in batches, and one at a
//! time.

use std::fmt::Write as _;
use std::fs;
use std::path::Path;
use std::process::Command;

use serde_json::{Value, json};

use crate::results::QUALITY;

/// Scenes that are rendered, of those that are measured.
pub(crate) const SCENES: [&str; 2] = ["sponza", "dragon"];
const INTEGRATORS: [&str; 2] = ["whitted", "path"];
/// Rays that are traced together.
const BATCHES: [&str; 2] = ["1", "1024"];
const ROUNDS: usize = 5;

/// Medians of seconds for a picture, by the numbers of [`BATCHES`].
pub(crate) struct Picture {
    scene: String,
    integrator: String,
    seconds: [f64; 2],
}

/// Renders a scene in all ways, in turns; or reads what was measured before if that is to be kept.
pub(crate) fn measure(
    program: &Path,
    (scene, named): (&str, &str),
    results: &Path,
    keep: bool,
) -> Result<Vec<Picture>, String> {
    let output = results.join(format!("pictures-{scene}.json"));
    let wrong = |error: &dyn std::fmt::Display| format!("{}: {error}", output.display());
    if !(keep && output.is_file()) {
        eprintln!("\n> pictures of {scene}");
        let mut all = Vec::new();
        for integrator in INTEGRATORS {
            let mut taken = [const { Vec::new() }; 2];
            for _ in 0..ROUNDS {
                for (batch, taken) in BATCHES.iter().zip(&mut taken) {
                    taken.push(rendered(program, named, integrator, batch, results)?);
                }
            }
            let seconds = taken.map(|mut taken| {
                taken.sort_by(f64::total_cmp);
                taken[taken.len() / 2]
            });
            all.push(json!({ "integrator": integrator, "seconds": seconds }));
        }
        fs::write(&output, Value::from(all).to_string()).map_err(|error| wrong(&error))?;
    }
    let text = fs::read_to_string(&output).map_err(|error| wrong(&error))?;
    let value: Value = serde_json::from_str(&text).map_err(|error| wrong(&error))?;
    let picture = |one: &Value| Picture {
        scene: scene.into(),
        integrator: one["integrator"].as_str().unwrap_or_default().into(),
        seconds: [0, 1].map(|i| one["seconds"][i].as_f64().unwrap_or(f64::NAN)),
    };
    Ok(value.as_array().map_or(&[][..], Vec::as_slice).iter().map(picture).collect())
}

/// Seconds that rendering alone takes.
fn rendered(
    program: &Path,
    named: &str,
    integrator: &str,
    batch: &str,
    results: &Path,
) -> Result<f64, String> {
    let (picture, stats) = (results.join("picture.pfm"), results.join("picture.json"));
    let mut command = Command::new(program);
    command.args(["render", named, "--plan", QUALITY, "--integrator", integrator]);
    command.args(["--resolution", "512x512", "--spp", "4", "--threads", "1", "--batch", batch]);
    command.arg("--quiet").arg("-o").arg(&picture).arg("--stats").arg(&stats);
    match command.status() {
        Ok(status) if status.success() => {}
        Ok(status) => return Err(format!("render {named}: {status}")),
        Err(error) => return Err(format!("nestray cannot be started: {error}")),
    }
    let text = fs::read_to_string(&stats).map_err(|error| error.to_string())?;
    let value: Value = serde_json::from_str(&text).map_err(|error| error.to_string())?;
    value["stages"]["render"].as_f64().ok_or_else(|| format!("{}: no time", stats.display()))
}

/// The part of the page.
pub(crate) fn section(all: &[Picture]) -> String {
    let mut text = String::from(
        "\n## Pictures\n\nThe same renderer, given rays in batches and one at a time: the same \
         bytes. 512 × 512 pixels, 4 samples each, one thread, the clock on the wall, medians of 5 \
         in turns; repeat with `nestray render SCENE --batch 1`. To reach: 1.5 times.\n\n| scene \
         | integrator | one at a time, s | batches, s | times |\n|---|---|---|---|---|\n",
    );
    for Picture { scene, integrator, seconds: [one, batch] } in all {
        let times = one / batch;
        let _ = writeln!(text, "| {scene} | {integrator} | {one:.2} | {batch:.2} | {times:.2} |");
    }
    text
}
