//! What a search found, for people and for programs.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use nestray::plan::describe::bytes;
use nestray::plan::optimize::anneal::Round;
use nestray::plan::optimize::measure::Measured;
use nestray::plan::optimize::ray_log::RayLog;
use nestray::plan::optimize::{Optimized, Options};
use serde_json::{Value, json};

use super::nest::Nest;

/// A table: what was expected and what was measured.
pub(crate) fn text(found: &Optimized, log: &RayLog) -> String {
    let mut text = String::new();
    let Optimized { evaluations, search_seconds, finalists, .. } = found;
    let _ = writeln!(text, "{evaluations} plans tried in {search_seconds:.1} s");
    let mix: Vec<String> =
        log.sets.iter().map(|set| format!("{:.0} % {}", 100.0 * set.weight, set.name)).collect();
    let _ = writeln!(text, "a ray of the mix: {}", mix.join(", "));
    let _ = writeln!(text, "nanoseconds per ray, measured (expected):\n");
    let _ = write!(text, "{:<22} {:>16}", "plan", "mix");
    for set in &log.sets {
        let _ = write!(text, " {:>16}", set.name);
    }
    let _ = writeln!(text, " {:>8} {:>10}", "build s", "memory");
    for one in finalists {
        row(&mut text, one, log);
    }
    let winner = &finalists[0];
    if let Some(best) = best_single(finalists) {
        let _ = writeln!(
            text,
            "\nthe fastest, {}, is {:.2} times as fast as the best single technique, {}",
            winner.finalist.name,
            best.total / winner.total,
            best.finalist.name
        );
    }
    if let Some(rho) = spearman(finalists, log) {
        let _ = writeln!(text, "expected against measured: rank correlation {rho:.2}");
    }
    text
}

/// The fastest of those that are one technique over everything.
pub(super) fn best_single(finalists: &[Measured]) -> Option<&Measured> {
    let single = finalists.iter().filter(|one| one.finalist.is_single);
    single.min_by(|a, b| a.total.total_cmp(&b.total))
}

/// How often each move was proposed, and taken.
pub(super) fn moves(trace: &[Round]) -> BTreeMap<&'static str, [u64; 2]> {
    let mut moves = BTreeMap::<_, [u64; 2]>::new();
    for &(name, taken) in trace.iter().flat_map(|round| &round.steps) {
        let counts = moves.entry(name).or_default();
        counts[0] += 1;
        counts[1] += u64::from(taken);
    }
    moves
}

fn row(text: &mut String, one: &Measured, log: &RayLog) {
    let expected = one.finalist.predicted.as_ref();
    let cell = |measured: f64, expected: Option<f64>| match expected {
        Some(expected) if expected.is_finite() => format!("{measured:.0} ({expected:.0})"),
        _ => format!("{measured:.0}"),
    };
    let mix = cell(one.mix, expected.map(|score| score.mix(log)));
    let _ = write!(text, "{:<22} {mix:>16}", one.finalist.name);
    for (set, &measured) in one.nanos.iter().enumerate() {
        let cell = cell(measured, expected.map(|score| score.nanos[set]));
        let _ = write!(text, " {cell:>16}");
    }
    let _ = writeln!(text, " {:>8.2} {:>10}", one.build_seconds, bytes(one.bytes));
}

/// How alike the orders are that were expected and measured, for all kinds of rays together.
fn spearman(finalists: &[Measured], log: &RayLog) -> Option<f64> {
    let pairs: Vec<[f64; 2]> = finalists
        .iter()
        .filter_map(|one| Some([one.finalist.predicted.as_ref()?.mix(log), one.mix]))
        .filter(|[expected, _]| expected.is_finite())
        .collect();
    rank_correlation(&pairs)
}

/// How alike two orders are; none of less than three, or where all are equal.
fn rank_correlation(pairs: &[[f64; 2]]) -> Option<f64> {
    if pairs.len() < 3 {
        return None;
    }
    let ranks = |which: usize| -> Vec<f64> {
        let of = |pair: &[f64; 2]| {
            let below = pairs.iter().filter(|other| other[which] < pair[which]).count();
            let equal = pairs.iter().filter(|other| other[which] == pair[which]).count();
            below as f64 + 0.5 * (equal as f64 - 1.0)
        };
        pairs.iter().map(of).collect()
    };
    let (a, b) = (ranks(0), ranks(1));
    let mean = 0.5 * (pairs.len() as f64 - 1.0);
    let dot = |a: &[f64], b: &[f64]| -> f64 {
        a.iter().zip(b).map(|(a, b)| (a - mean) * (b - mean)).sum()
    };
    let size = (dot(&a, &a) * dot(&b, &b)).sqrt();
    (size > 0.0).then(|| dot(&a, &b) / size)
}

/// Everything, the trace of the search included.
pub(super) fn json(found: &Optimized, log: &RayLog, options: &Options, nest: &Nest) -> Value {
    let sets: Vec<Value> = log
        .sets
        .iter()
        .map(|set| json!({ "kind": set.name, "weight": set.weight, "rays": set.rays.len() }))
        .collect();
    let finalists: Vec<Value> = found
        .finalists
        .iter()
        .map(|one| {
            let expected = one.finalist.predicted.as_ref().map(|score| &score.nanos);
            json!({ "name": one.finalist.name, "single": one.finalist.is_single,
                "plan": one.finalist.plan, "expected_nanos": expected,
                "measured_nanos": one.nanos, "measured_mix": one.mix, "total": one.total,
                "build_seconds": one.build_seconds, "bytes": one.bytes, "rounds": one.rounds })
        })
        .collect();
    let trace: Vec<Value> = found
        .trace
        .iter()
        .map(|round| {
            json!({ "evaluations": round.evaluations, "best": round.best,
                "energies": round.energies, "temperatures": round.temperatures,
                "steps": round.steps, "exchanges": round.exchanges })
        })
        .collect();
    let candidates: Vec<Value> = found
        .candidates
        .iter()
        .map(|one| {
            json!({ "plan": one.plan, "expected_nanos": one.score.nanos,
                "expected_mix": one.score.mix(log), "bytes": one.score.bytes })
        })
        .collect();
    let moves: serde_json::Map<String, Value> = moves(&found.trace)
        .into_iter()
        .map(|(name, [proposed, taken])| {
            (name.to_owned(), json!({ "proposed": proposed, "taken": taken }))
        })
        .collect();
    let exchanges: usize = found.trace.iter().map(|round| round.exchanges).sum();
    json!({ "moves": moves, "exchanges": exchanges, "candidates": candidates, "nest": nest.part,
        "spent": nest.spent, "seed": options.seed, "evaluations": found.evaluations,
        "search_seconds": found.search_seconds, "rays_expected": options.rays_expected,
        "rank_correlation": spearman(&found.finalists, log), "rays": sets, "finalists": finalists,
        "trace": trace })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn orders_that_are_the_same_or_the_other_way_round() {
        let up =
            rank_correlation(&[[1.0, 10.0], [2.0, 20.0], [3.0, 90.0]]).expect("there are three");
        assert!((up - 1.0).abs() < 1e-12);
        let down =
            rank_correlation(&[[1.0, 30.0], [2.0, 20.0], [3.0, 1.0]]).expect("there are three");
        assert!((down + 1.0).abs() < 1e-12);
        assert_eq!(rank_correlation(&[[1.0, 2.0]; 3]), None, "all are equal");
        assert_eq!(rank_correlation(&[[1.0, 2.0], [2.0, 3.0]]), None, "there are two");
    }
}
