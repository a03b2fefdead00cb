//! Expected against measured, of all plans that were timed.

use nestray::plan::optimize::Optimized;
use nestray::plan::optimize::ray_log::RayLog;

use super::chart::{Axis, COLORS, Drawing, short};

const SIDE: [f64; 2] = [960.0, 420.0];

pub(super) fn draw(found: &Optimized, log: &RayLog) -> String {
    let points: Vec<_> = found
        .finalists
        .iter()
        .filter_map(|one| Some((one, one.finalist.predicted.as_ref()?.mix(log))))
        .filter(|(_, expected)| expected.is_finite())
        .collect();
    let across =
        Axis::over(points.iter().map(|(_, expected)| *expected), [60.0, SIDE[0] - 20.0], true);
    let up = Axis::over(points.iter().map(|(one, _)| one.mix), [SIDE[1] - 44.0, 14.0], true);
    let mut drawing = Drawing::new(SIDE[0], SIDE[1]);
    for x in across.ticks() {
        drawing.line([across.at(x), 14.0], [across.at(x), SIDE[1] - 44.0], "#e8e8e8");
        drawing.words([across.at(x), SIDE[1] - 28.0], "middle", "#555", &short(x));
    }
    for y in up.ticks() {
        drawing.line([60.0, up.at(y)], [SIDE[0] - 20.0, up.at(y)], "#e8e8e8");
        drawing.words([54.0, up.at(y) + 4.0], "end", "#555", &short(y));
    }
    // Where they agree, as far as both sides have the numbers.
    let [[left, right], [low, high]] = [across.ends(), up.ends()];
    let (from, to) = (left.max(low), right.min(high));
    if from < to {
        drawing.line([across.at(from), up.at(from)], [across.at(to), up.at(to)], "#888");
    }
    let middle = 0.5 * (60.0 + SIDE[0] - 20.0);
    drawing.words([middle, SIDE[1] - 8.0], "middle", "#333", "expected ns");
    drawing.words([66.0, 12.0], "start", "#333", "measured ns");
    for (i, (one, expected)) in points.iter().enumerate().rev() {
        let [x, y] = [across.at(*expected), up.at(one.mix)];
        let color = if one.finalist.is_single { COLORS[0] } else { COLORS[1] };
        let title = format!("{}: {:.0} ns, expected {expected:.0}", one.finalist.name, one.mix);
        let size = if i == 0 { 8.0 } else { 5.0 };
        drawing.shape(
            &format!(
                "circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"{size}\" fill=\"{color}\" \
                 fill-opacity=\"0.6\" stroke=\"{color}\""
            ),
            &title,
        );
    }
    legend(&mut drawing);
    drawing.done()
}

fn legend(drawing: &mut Drawing) {
    for (i, (color, words)) in
        [(COLORS[0], "one technique"), (COLORS[1], "a nest")].into_iter().enumerate()
    {
        let y = 34.0 + 18.0 * i as f64;
        drawing.shape(&format!("circle cx=\"80\" cy=\"{y}\" r=\"5\" fill=\"{color}\""), words);
        drawing.words([92.0, y + 4.0], "start", "#333", words);
    }
}
