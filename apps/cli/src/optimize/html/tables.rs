//! Tables: what was timed, and which moves were made.

use std::fmt::Write as _;

use nestray::plan::describe::bytes;
use nestray::plan::optimize::Optimized;
use nestray::plan::optimize::anneal::Round;
use nestray::plan::optimize::measure::Measured;
use nestray::plan::optimize::ray_log::RayLog;

use super::escaped;
use crate::optimize::report::{best_single, moves as counted};

/// What came of it, in a sentence.
pub(super) fn verdict(found: &Optimized) -> String {
    let winner = &found.finalists[0];
    let name = escaped(&winner.finalist.name);
    match best_single(&found.finalists) {
        Some(best) => format!(
            "The fastest is <b>{name}</b>: {:.2} times as fast as the best single technique, {}.",
            best.total / winner.total,
            escaped(&best.finalist.name)
        ),
        None => format!("The fastest is <b>{name}</b>."),
    }
}

/// All that was timed, the chosen one first.
pub(super) fn timed(found: &Optimized, log: &RayLog) -> String {
    let least: Vec<f64> = (0..log.sets.len())
        .map(|set| {
            let nanos = found.finalists.iter().map(|one| one.nanos[set]);
            nanos.fold(f64::INFINITY, f64::min)
        })
        .collect();
    let fastest = found.finalists.iter().map(|one| one.mix).fold(f64::INFINITY, f64::min);
    let mut table = String::from("<div class=\"wide\"><table>\n<tr><th>plan<th>mix");
    for set in &log.sets {
        let _ = write!(table, "<th>{}", escaped(&set.name));
    }
    table.push_str("<th>build s<th>memory<th>turns\n");
    for (i, one) in found.finalists.iter().enumerate() {
        let class = if i == 0 { " class=\"chosen\"" } else { "" };
        let kind = if one.finalist.is_single { "" } else { " <small>nest</small>" };
        let _ = write!(table, "<tr{class}><td>{}{kind}", escaped(&one.finalist.name));
        row(&mut table, one, log, fastest, &least);
    }
    table.push_str("</table></div>\n");
    table
}

fn row(table: &mut String, one: &Measured, log: &RayLog, fastest: f64, least: &[f64]) {
    let predicted = one.finalist.predicted.as_ref();
    cell(table, one.mix, predicted.map(|score| score.mix(log)), fastest);
    for (set, (&nanos, &least)) in one.nanos.iter().zip(least).enumerate() {
        cell(table, nanos, predicted.map(|score| score.nanos[set]), least);
    }
    let Measured { build_seconds, rounds, .. } = one;
    let _ = writeln!(table, "<td>{build_seconds:.2}<td>{}<td>{rounds}", bytes(one.bytes));
}

/// As dark as it is near the fastest: white at three times as slow.
fn cell(table: &mut String, nanos: f64, expected: Option<f64>, fastest: f64) {
    let near = 1.0 - (nanos / fastest.max(1e-9)).ln() / 3f64.ln();
    let _ = write!(
        table,
        "<td style=\"background:rgba(0,114,178,{:.2})\">",
        0.4 * near.clamp(0.0, 1.0)
    );
    let _ = write!(table, "{nanos:.0}");
    if let Some(expected) = expected.filter(|expected| expected.is_finite()) {
        let _ = write!(table, " <small>({expected:.0})</small>");
    }
}

/// How often each move was proposed and taken, and replicas changed places.
pub(super) fn moves(trace: &[Round]) -> String {
    let mut table = String::from("<table>\n<tr><th>move<th>proposed<th>taken<th>%\n");
    for (name, [proposed, taken]) in counted(trace) {
        let percent = 100.0 * taken as f64 / proposed.max(1) as f64;
        let _ = writeln!(table, "<tr><td>{name}<td>{proposed}<td>{taken}<td>{percent:.0}");
    }
    let exchanges: usize = trace.iter().map(|round| round.exchanges).sum();
    let _ = writeln!(table, "</table>\n<p>Replicas changed places {exchanges} times.</p>");
    table
}
