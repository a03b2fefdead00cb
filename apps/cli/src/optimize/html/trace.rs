//! The trace of the annealing: what the plans of all replicas cost, and how hot it was.

use nestray::plan::optimize::anneal::Round;

use super::chart::{Axis, COLORS, Drawing, short};

const SIDE: [f64; 2] = [960.0, 400.0];
/// Left and right of what is drawn, top and bottom of the costs, and of the temperatures.
const ACROSS: [f64; 2] = [60.0, 940.0];
const COSTS: [f64; 2] = [270.0, 30.0];
const HEAT: [f64; 2] = [360.0, 300.0];
/// Most points of a line.
const POINTS: usize = 400;

/// `goals` are those of the replicas, which are as many for each.
pub(super) fn draw(trace: &[Round], goals: &[&str]) -> String {
    if trace.is_empty() {
        return "<p>There was no time for a step: only single techniques were tried.</p>\n".into();
    }
    let step = trace.len().div_ceil(POINTS);
    let rounds: Vec<&Round> = trace.iter().step_by(step).chain(trace.last()).collect();
    let tried = |round: &&Round| round.evaluations as f64;
    let across = Axis::over(rounds.iter().map(tried), ACROSS, false);
    let energies = || rounds.iter().flat_map(|round| round.energies.iter().copied());
    let costs = Axis::over(energies().chain(rounds.iter().map(|r| r.best)), COSTS, true);
    let warmth = rounds.iter().flat_map(|round| round.temperatures.iter().copied());
    let heat = Axis::over(warmth, HEAT, true);
    let mut drawing = Drawing::new(SIDE[0], SIDE[1]);
    for (axis, name) in [(&costs, "ns"), (&heat, "temperature, of the best")] {
        let top = axis.at(f64::INFINITY);
        drawing.words([8.0, top - 8.0], "start", "#333", name);
        for y in axis.ticks() {
            drawing.line([ACROSS[0], axis.at(y)], [ACROSS[1], axis.at(y)], "#e8e8e8");
            let label = if y < 1.0 { format!("{y:.3}") } else { short(y) };
            drawing.words([54.0, axis.at(y) + 4.0], "end", "#555", &label);
        }
    }
    for x in across.ticks() {
        drawing.words([across.at(x), SIDE[1] - 20.0], "middle", "#555", &short(x));
    }
    drawing.words([500.0, SIDE[1] - 4.0], "middle", "#333", "plans tried");
    let line = |axis: &Axis, of: &dyn Fn(&Round) -> Option<f64>| -> Vec<[f64; 2]> {
        let point = |round: &&Round| Some([across.at(tried(round)), axis.at(of(round)?)]);
        rounds.iter().filter_map(point).collect()
    };
    let replicas = trace[0].energies.len();
    let each = (replicas / goals.len().max(1)).max(1);
    for replica in 0..replicas {
        let color = COLORS[replica / each % COLORS.len()];
        let energy = line(&costs, &|round| round.energies.get(replica).copied());
        drawing.curve(&energy, color, 1.0, 0.6);
        let warm = line(&heat, &|round| round.temperatures.get(replica).copied());
        drawing.curve(&warm, color, 1.0, 0.6);
    }
    drawing.curve(&line(&costs, &|round| Some(round.best)), "#000", 2.0, 1.0);
    legend(&mut drawing, goals);
    drawing.done()
}

fn legend(drawing: &mut Drawing, goals: &[&str]) {
    let names = goals.iter().enumerate().map(|(i, goal)| (COLORS[i % COLORS.len()], *goal));
    let mut x = 100.0;
    for (color, name) in names.chain([("#000", "best for the mix")]) {
        drawing.line([x, 14.0], [x + 18.0, 14.0], color);
        drawing.words([x + 24.0, 18.0], "start", "#333", name);
        x += 50.0 + 7.0 * name.chars().count() as f64;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn long_traces_are_thinned_and_short_ones_drawn() {
        let round = |i: usize| Round {
            evaluations: i,
            best: 100.0,
            energies: vec![100.0, 120.0, f64::INFINITY],
            temperatures: vec![0.1, 0.2, 0.3],
            steps: Vec::new(),
            exchanges: 0,
        };
        let check = |rounds: usize| {
            let trace: Vec<Round> = (0..rounds).map(round).collect();
            let drawn = draw(&trace, &["mix"]);
            assert_eq!(drawn.matches("<polyline").count(), 7, "{drawn}");
            assert!(!drawn.contains("NaN") && !drawn.contains("inf"), "{drawn}");
            drawn.len()
        };
        assert!(check(1) < check(POINTS));
        assert!(check(50 * POINTS) < 2 * check(POINTS));
        assert!(draw(&[], &["mix"]).contains("no time"));
    }
}
