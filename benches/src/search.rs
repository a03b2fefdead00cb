//! What searches find: the program looks for the fastest plan of many scenes, and what it expected is
//! held against what it measured.

use std::fmt::Write as _;
use std::fs;
use std::path::Path;
use std::process::Command;

use serde_json::Value;

use crate::machine;
use crate::scenes::{self, Scene, builtin};

/// Scenes of many kinds that the program makes.
#[rustfmt::skip]
const BUILTIN: &[Scene] = &[
    builtin("balls", "builtin:balls"),
    builtin("gears", "builtin:gears"),
    builtin("jacks", "builtin:jacks@4"),
    builtin("lattice", "builtin:lattice"),
    builtin("mount", "builtin:mount"),
    builtin("rings", "builtin:rings"),
    builtin("shells", "builtin:shells"),
    builtin("sombrero", "builtin:sombrero@4"),
    builtin("teapot", "builtin:teapot"),
    builtin("tetra", "builtin:tetra"),
    builtin("stadium-10", "builtin:stadium@10"),
    builtin("stadium-100000", "builtin:stadium@100000"),
    builtin("clusters", "builtin:clusters"),
    builtin("hair", "builtin:hair@5000"),
    builtin("mixed", "builtin:mixed@10"),
    builtin("bezier-teapot", "builtin:bezier-teapot"),
    builtin("needles-20000", "builtin:needles@20000"),
    builtin("scatter-100000", "builtin:scatter@100000"),
    builtin("truss-12", "builtin:truss@12"),
    builtin("terrain-224", "builtin:terrain@224"),
];
/// Those of the comparison with other libraries that are searched, too.
const SHARED: [&str; 6] = ["bunny", "dragon", "sponza", "tree", "forest", "stadium"];
/// How long each search may take; timing as long again.
const BUDGET: &str = "10s";

/// What a search of one scene found.
struct Found {
    scene: String,
    report: Value,
}

/// A plan that was timed.
struct Timed {
    single: bool,
    /// What a ray of the mix was expected to take, and took; and with building spread over all.
    expected: Option<f64>,
    mix: f64,
    total: f64,
    /// Nanoseconds for each set.
    nanos: Vec<f64>,
    name: String,
}

/// Searches all scenes that `asked` says, and writes the page.
pub(crate) fn run(
    program: &Path,
    (shared, results): (&Path, &Path),
    docs: Option<&Path>,
    asked: &dyn Fn(&str) -> bool,
    keep: bool,
) -> Result<(), String> {
    let others = scenes::ALL.iter().filter(|scene| SHARED.contains(&scene.name));
    let mut all = Vec::new();
    for scene in BUILTIN.iter().chain(others).filter(|scene| asked(scene.name)) {
        match scene.prepare(shared, &results.join("scenes")) {
            Ok(named) => all.push(search(program, scene.name, &named, results, keep)?),
            Err(missing) => eprintln!("{} is left out: {missing}", scene.name),
        }
    }
    let Some(docs) = docs else { return Ok(()) };
    let path = docs.join("searches.md");
    fs::write(&path, page(&all)).map_err(|error| format!("{}: {error}", path.display()))
}

fn search(
    program: &Path,
    scene: &str,
    named: &str,
    results: &Path,
    keep: bool,
) -> Result<Found, String> {
    let output = results.join(format!("search-{scene}.json"));
    let wrong = |error: &dyn std::fmt::Display| format!("{}: {error}", output.display());
    if !(keep && output.is_file()) {
        eprintln!("\n> a plan for {scene}");
        let mut command = Command::new(program);
        command.args(["optimize", named, "--budget", BUDGET, "--rays-expected", "1e9", "--quiet"]);
        command.arg("-o").arg(results.join(format!("search-{scene}.plan.json")));
        match command.arg("--report").arg(&output).status() {
            Ok(status) if status.success() => {}
            Ok(status) => return Err(format!("optimize {named}: {status}")),
            Err(error) => return Err(format!("nestray cannot be started: {error}")),
        }
    }
    let text = fs::read_to_string(&output).map_err(|error| wrong(&error))?;
    let report = serde_json::from_str(&text).map_err(|error| wrong(&error))?;
    Ok(Found { scene: scene.into(), report })
}

impl Found {
    /// All that was timed, the winner first.
    fn timed(&self) -> Vec<Timed> {
        let weights: Vec<f64> = self.sets().iter().map(|(_, weight)| *weight).collect();
        let numbers = |value: &Value| -> Option<Vec<f64>> {
            value.as_array()?.iter().map(Value::as_f64).collect()
        };
        let one = |one: &Value| {
            let mix = |nanos: Vec<f64>| nanos.iter().zip(&weights).map(|(n, w)| n * w).sum::<f64>();
            Timed {
                single: one["single"] == true,
                expected: numbers(&one["expected_nanos"]).map(mix),
                mix: one["measured_mix"].as_f64().unwrap_or(f64::NAN),
                total: one["total"].as_f64().unwrap_or(f64::NAN),
                nanos: numbers(&one["measured_nanos"]).unwrap_or_default(),
                name: one["name"].as_str().unwrap_or_default().into(),
            }
        };
        self.report["finalists"].as_array().map_or(&[][..], Vec::as_slice).iter().map(one).collect()
    }

    /// Kinds of rays and their shares.
    fn sets(&self) -> Vec<(String, f64)> {
        let sets = self.report["rays"].as_array().map_or(&[][..], Vec::as_slice);
        let one = |set: &Value| {
            let weight = set["weight"].as_f64().unwrap_or(0.0);
            (set["kind"].as_str().unwrap_or_default().to_owned(), weight)
        };
        sets.iter().map(one).collect()
    }
}

fn median(mut of: Vec<f64>) -> f64 {
    of.retain(|x| x.is_finite());
    of.sort_by(f64::total_cmp);
    of.get(of.len() / 2).copied().unwrap_or(f64::NAN)
}

fn mean(of: &[f64]) -> f64 {
    (of.iter().map(|x| x.ln()).sum::<f64>() / of.len().max(1) as f64).exp()
}

/// A row of the table, and what sums are made of.
struct Row {
    gain: f64,
    spearman: f64,
    regret: f64,
    error: f64,
    text: String,
}

fn row(found: &Found) -> Option<Row> {
    let timed = found.timed();
    let winner = timed.first()?;
    let single =
        timed.iter().filter(|one| one.single).min_by(|a, b| a.total.total_cmp(&b.total))?;
    let pairs: Vec<[f64; 2]> = timed
        .iter()
        .filter_map(|one| Some([one.expected.filter(|e| e.is_finite())?, one.mix]))
        .collect();
    let best = timed.iter().map(|one| one.mix).fold(f64::INFINITY, f64::min);
    let chosen = pairs.iter().min_by(|a, b| a[0].total_cmp(&b[0]))?[1];
    let errors = pairs.iter().map(|[expected, taken]| (expected / taken - 1.0).abs()).collect();
    let (gain, regret) = (single.total / winner.total, chosen / best);
    let spearman = found.report["rank_correlation"].as_f64().unwrap_or(f64::NAN);
    let error = median(errors);
    let singles = timed.iter().filter(|one| one.single).count();
    let mut text =
        format!("| {} | {} | {} of {singles} | {gain:.2} |", found.scene, winner.name, single.name);
    for (kind, _) in KINDS {
        let at = found.sets().iter().position(|(name, _)| name == kind);
        let least = |all: &mut dyn Iterator<Item = &Timed>, at: usize| {
            all.filter_map(|one| one.nanos.get(at).copied()).fold(f64::INFINITY, f64::min)
        };
        let cell = at.and_then(|at| {
            let best = least(&mut timed.iter().filter(|one| one.single), at);
            Some(best / winner.nanos.get(at)?)
        });
        let _ = write!(text, " {} |", cell.map_or("–".into(), |times| format!("{times:.2}")));
    }
    let seconds = found.report["search_seconds"].as_f64().unwrap_or(f64::NAN);
    let plans = found.report["evaluations"].as_u64().unwrap_or(0);
    let _ = writeln!(
        text,
        " {} | {spearman:.2} | {regret:.2} | {:.0} % | {plans} | {seconds:.1} |",
        pairs.len(),
        100.0 * error
    );
    Some(Row { gain, spearman, regret, error, text })
}

/// Kinds of rays, and what they are called in the table.
const KINDS: [(&str, &str); 4] =
    [("camera", "camera"), ("shadow", "shadow"), ("reflect", "reflect"), ("diffuse", "diffuse")];

fn page(all: &[Found]) -> String {
    let mut text = String::from(
        "# What searches find\n\n`nestray optimize` looks for the fastest plan of each scene; what is fastest \
         in the end is measured, single techniques among the rest, on rays that the search has not \
         seen. A ray of the mix is one from the eye to four to lights, one mirrored and four scattered; \
         building is spread over 10⁹ rays. Written by `nestray-benches --search`; nothing on this page is \
         put in by hand.\n\n| | |\n|---|---|\n",
    );
    for [name, fact] in machine::describe() {
        let _ = writeln!(text, "| {name} | {fact} |");
    }
    let _ = writeln!(text, "| commit | {} |", machine::commit());
    let _ = writeln!(
        text,
        "| repeat with | `cargo xtask bench --search --docs docs`; one scene: `nestray optimize \
         builtin:truss -o plan.json --budget {BUDGET} --rays-expected 1e9` |\n"
    );
    text.push_str(
        "*Gain* is how many times as fast the plan is as the best single technique of those that there was \
         time to time, for the mix; then for each kind, over the single technique that is best for that kind. *Plans* are those that \
         were both priced and timed: how alike the two orders are (Spearman), how much slower the one \
         that was expected to be best is than the best (regret), and how far prices are off in the \
         median. Then how many plans were tried, and in what time.\n\n| scene | plan | best single | gain |",
    );
    KINDS.iter().for_each(|(_, name)| text.push_str(&format!(" {name} |")));
    text.push_str(" plans | Spearman | regret | error | tried | s |\n|");
    text.push_str(&"---|".repeat(10 + KINDS.len()));
    text.push('\n');
    let rows: Vec<Row> = all.iter().filter_map(row).collect();
    rows.iter().for_each(|row| text.push_str(&row.text));
    let of = |value: fn(&Row) -> f64| rows.iter().map(value).collect::<Vec<f64>>();
    let least = |of: &[f64]| of.iter().copied().fold(f64::INFINITY, f64::min);
    let most = |of: &[f64]| of.iter().copied().fold(0.0, f64::max);
    let (gains, orders) = (of(|row| row.gain), of(|row| row.spearman));
    let _ = writeln!(
        text,
        "\nGain in the geometric mean {:.2}, at least {:.2}, at most {:.2}. Spearman {:.2} in the median, \
         {:.2} at least; regret {:.2} in the mean, {:.2} at most; error {:.0} % in the median.",
        mean(&gains),
        least(&gains),
        most(&gains),
        median(orders.clone()),
        least(&orders),
        mean(&of(|row| row.regret)),
        most(&of(|row| row.regret)),
        100.0 * median(of(|row| row.error)),
    );
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_row_tells_gains_and_errors() {
        let one = |name: &str, single: bool, expected: f64, nanos: f64| {
            serde_json::json!({ "name": name, "single": single, "expected_nanos": [expected],
                "measured_nanos": [nanos], "measured_mix": nanos, "total": nanos })
        };
        let report = serde_json::json!({ "rank_correlation": 0.8, "rays": [{ "kind": "camera", "weight": 1.0 }],
            "finalists": [one("nest", false, 120.0, 100.0), one("bvh", true, 150.0, 200.0),
                one("grid", true, 110.0, 110.0), one("list", true, 900.0, 800.0)] });
        let row = row(&Found { scene: "any".into(), report }).expect("there is a winner");
        assert!((row.gain - 1.1).abs() < 1e-9 && (row.regret - 1.1).abs() < 1e-9);
        assert_eq!(row.spearman, 0.8);
        assert!(
            row.text.starts_with("| any | nest | grid of 3 | 1.10 | 1.10 | – |"),
            "{}",
            row.text
        );
    }
}
