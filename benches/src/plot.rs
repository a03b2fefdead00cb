//! Charts with logarithmic axes, as SVG.

use std::fmt::Write as _;

/// A chart.
pub(crate) struct Chart<'a> {
    pub(crate) title: String,
    pub(crate) lines: Vec<Line<'a>>,
}

/// Points joined by lines.
pub(crate) struct Line<'a> {
    pub(crate) name: &'a str,
    pub(crate) color: &'a str,
    pub(crate) points: Vec<[f64; 2]>,
}

/// Size of a chart, and what its axes leave free: left, above, right, below.
const SIZE: [f64; 2] = [340.0, 260.0];
const FREE: [f64; 4] = [46.0, 56.0, 12.0, 38.0];

/// Charts side by side, so many in a row; all count `across` along x.
pub(crate) fn draw(charts: &[Chart<'_>], columns: usize, across: &str) -> String {
    let rows = charts.len().div_ceil(columns.max(1));
    let (width, height) = (SIZE[0] * columns as f64, SIZE[1] * rows as f64);
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width} {height}\" \
         width=\"{width}\" height=\"{height}\" font-family=\"sans-serif\" font-size=\"10\">\n\
         <rect width=\"{width}\" height=\"{height}\" fill=\"white\"/>\n"
    );
    for (i, chart) in charts.iter().enumerate() {
        let at = [SIZE[0] * (i % columns) as f64, SIZE[1] * (i / columns) as f64];
        let _ = writeln!(svg, "<g transform=\"translate({},{})\">", at[0], at[1]);
        svg.push_str(&inside(chart, across));
        svg.push_str("</g>\n");
    }
    svg.push_str("</svg>\n");
    svg
}

/// From what is shown to where, along one axis.
#[derive(Clone, Copy)]
struct Axis {
    /// Logarithms of the ends.
    ends: [f64; 2],
    /// Where those are.
    at: [f64; 2],
}

impl Axis {
    /// From a round number below to one above.
    fn around(values: impl Iterator<Item = f64>, at: [f64; 2]) -> Self {
        let logs = values.filter(|&value| value > 0.0).map(f64::log10);
        let ends = logs.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], log| {
            [low.min(log), high.max(log)]
        });
        // Half decades at most beyond.
        let ends = [(ends[0] * 4.0).floor() / 4.0, (ends[1] * 4.0 + 0.01).ceil() / 4.0];
        Self { ends, at }
    }

    fn place(self, value: f64) -> f64 {
        let part = (value.log10() - self.ends[0]) / (self.ends[1] - self.ends[0]);
        self.at[0] + (self.at[1] - self.at[0]) * part
    }

    /// 1, 2 and 5 times powers of ten; more where there are few.
    fn marks(self) -> Vec<f64> {
        let decades = self.ends[0].floor() as i32..=self.ends[1].ceil() as i32;
        let [low, high] = self.ends;
        let few: &[f64] = &[1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 7.0];
        let steps = if high - low < 0.8 { few } else { &[1.0, 2.0, 5.0] };
        let all = decades.flat_map(|decade| steps.iter().map(move |m| m * 10_f64.powi(decade)));
        all.filter(|mark| (low - 1e-9..=high + 1e-9).contains(&mark.log10())).collect()
    }
}

/// A number in few letters.
fn short(value: f64) -> String {
    match value {
        v if v >= 1e6 => format!("{}M", v / 1e6),
        v if v >= 1e3 => format!("{}k", v / 1e3),
        v => format!("{v}"),
    }
}

fn inside(Chart { title, lines }: &Chart<'_>, across: &str) -> String {
    let [left, above, right, below] = FREE;
    let (x0, x1, y0, y1) = (left, SIZE[0] - right, SIZE[1] - below, above);
    let values =
        |axis: usize| lines.iter().flat_map(move |l| l.points.iter().map(move |p| p[axis]));
    let mut svg = format!("<text x=\"{x0}\" y=\"16\" font-weight=\"bold\">{title}</text>\n");
    if values(0).next().is_none() {
        return svg;
    }
    let (x, y) = (Axis::around(values(0), [x0, x1]), Axis::around(values(1), [y0, y1]));
    for mark in x.marks().into_iter().filter(|mark| mark.log10().fract().abs() < 1e-9) {
        let (at, label) = (x.place(mark), short(mark));
        let _ = writeln!(svg, "<path d=\"M{at:.1} {y0}V{y1}\" stroke=\"#ddd\"/>");
        let _ = writeln!(
            svg,
            "<text x=\"{at:.1}\" y=\"{}\" text-anchor=\"middle\">{label}</text>",
            y0 + 13.0
        );
    }
    for mark in y.marks() {
        let (at, label) = (y.place(mark), short(mark));
        let _ = writeln!(svg, "<path d=\"M{x0} {at:.1}H{x1}\" stroke=\"#ddd\"/>");
        let _ = writeln!(
            svg,
            "<text x=\"{}\" y=\"{:.1}\" text-anchor=\"end\">{label}</text>",
            x0 - 4.0,
            at + 3.0
        );
    }
    let _ = writeln!(svg, "<path d=\"M{x0} {y1}V{y0}H{x1}\" stroke=\"#555\" fill=\"none\"/>");
    let _ =
        writeln!(svg, "<text x=\"{x1}\" y=\"{}\" text-anchor=\"end\">{across}</text>", y0 + 28.0);
    for (i, Line { name, color, points }) in lines.iter().enumerate() {
        let mut path = String::new();
        for (k, point) in points.iter().enumerate() {
            let (at_x, at_y) = (x.place(point[0]), y.place(point[1]));
            let _ = write!(path, "{}{at_x:.1} {at_y:.1}", if k == 0 { 'M' } else { 'L' });
            let _ = writeln!(
                svg,
                "<circle cx=\"{at_x:.1}\" cy=\"{at_y:.1}\" r=\"2.5\" fill=\"{color}\"/>"
            );
        }
        let _ = writeln!(
            svg,
            "<path d=\"{path}\" stroke=\"{color}\" stroke-width=\"1.6\" fill=\"none\"/>"
        );
        let key = [x0 + 140.0 * (i % 2) as f64, 28.0 + 13.0 * (i / 2) as f64];
        let _ = writeln!(
            svg,
            "<path d=\"M{} {}h14\" stroke=\"{color}\" stroke-width=\"3\"/>",
            key[0], key[1]
        );
        let _ = writeln!(svg, "<text x=\"{}\" y=\"{}\">{name}</text>", key[0] + 19.0, key[1] + 3.5);
    }
    svg
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn marks_are_round_and_in_range() {
        let axis = Axis::around([30.0, 400.0].into_iter(), [0.0, 100.0]);
        assert_eq!(axis.marks(), [20.0, 50.0, 100.0, 200.0, 500.0]);
        assert!(axis.place(30.0) >= 0.0 && axis.place(400.0) <= 100.0);
        assert!(axis.place(100.0) > axis.place(50.0));
        assert_eq!([short(2e6), short(5e4), short(20.0)], ["2M", "50k", "20"]);
    }
}
