//! Drawings: a canvas, axes, colours that differ also for those who see few.

use std::fmt::Write as _;

use super::escaped;

/// Told apart by most eyes, after Okabe and Ito.
pub(super) const COLORS: [&str; 7] =
    ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#000000"];

/// A drawing of some size.
pub(super) struct Drawing {
    text: String,
}

impl Drawing {
    pub(super) fn new(width: f64, height: f64) -> Self {
        let text = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width} {height}\" \
             font-family=\"system-ui,sans-serif\" font-size=\"12\" role=\"img\">\n"
        );
        Self { text }
    }

    /// A piece of it; `title` is shown to who points at it.
    pub(super) fn shape(&mut self, shape: &str, title: &str) {
        let name = shape.split(' ').next().unwrap_or_default();
        let title = escaped(title);
        let _ = writeln!(self.text, "<{shape}><title>{title}</title></{name}>");
    }

    pub(super) fn line(&mut self, [x0, y0]: [f64; 2], [x1, y1]: [f64; 2], color: &str) {
        let _ = writeln!(
            self.text,
            "<path d=\"M{x0:.1} {y0:.1}L{x1:.1} {y1:.1}\" stroke=\"{color}\" fill=\"none\"/>"
        );
    }

    /// A line through points.
    pub(super) fn curve(&mut self, points: &[[f64; 2]], color: &str, width: f64, opacity: f64) {
        let list: Vec<String> = points.iter().map(|[x, y]| format!("{x:.1},{y:.1}")).collect();
        let _ = writeln!(
            self.text,
            "<polyline points=\"{}\" fill=\"none\" stroke=\"{color}\" stroke-width=\"{width}\" \
             stroke-opacity=\"{opacity}\"/>",
            list.join(" ")
        );
    }

    /// Words; `anchor` is the end of them that is at the point.
    pub(super) fn words(&mut self, [x, y]: [f64; 2], anchor: &str, color: &str, words: &str) {
        let words = escaped(words);
        let _ = writeln!(
            self.text,
            "<text x=\"{x:.1}\" y=\"{y:.1}\" text-anchor=\"{anchor}\" fill=\"{color}\">{words}</text>"
        );
    }

    pub(super) fn done(mut self) -> String {
        self.text.push_str("</svg>\n");
        self.text
    }
}

/// From numbers to places along one side of a chart.
#[derive(Clone, Copy, Debug)]
pub(super) struct Axis {
    numbers: [f64; 2],
    places: [f64; 2],
    is_log: bool,
}

impl Axis {
    /// Over all the numbers, with a little room; by ratios if `is_log`.
    pub(super) fn over(
        numbers: impl IntoIterator<Item = f64>,
        places: [f64; 2],
        is_log: bool,
    ) -> Self {
        let fits = |x: &f64| x.is_finite() && (!is_log || *x > 0.0);
        let [low, high] = numbers
            .into_iter()
            .filter(fits)
            .fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], x| [a.min(x), b.max(x)]);
        let numbers = match (low <= high, is_log) {
            (false, _) => [1.0, 2.0],
            (true, true) => [low / 1.1, high * 1.1],
            (true, false) => [low, if high > low { high } else { low + 1.0 }],
        };
        Self { numbers, places, is_log }
    }

    /// Where a number is; those beyond the ends are at the ends.
    pub(super) fn at(&self, x: f64) -> f64 {
        let scale = |x: f64| if self.is_log { x.max(f64::MIN_POSITIVE).ln() } else { x };
        let [low, high] = self.numbers.map(scale);
        let part = ((scale(x) - low) / (high - low)).clamp(0.0, 1.0);
        self.places[0] + part * (self.places[1] - self.places[0])
    }

    /// The least and the largest number.
    pub(super) fn ends(&self) -> [f64; 2] {
        self.numbers
    }

    /// Round numbers in it.
    pub(super) fn ticks(&self) -> Vec<f64> {
        let [low, high] = self.numbers;
        if !self.is_log {
            let step = round_step((high - low) / 5.0);
            return (0..=10)
                .map(|i| ((low / step).ceil() + f64::from(i)) * step)
                .take_while(|x| *x <= high)
                .collect();
        }
        let few = high / low > 30.0;
        let digits: &[f64] = if few { &[1.0, 3.0] } else { &[1.0, 1.5, 2.0, 3.0, 5.0, 7.0] };
        let (first, last) = (low.log10().floor() as i32, high.log10().ceil() as i32);
        (first..=last)
            .flat_map(|power| digits.iter().map(move |digit| digit * 10f64.powi(power)))
            .filter(|x| (low..=high).contains(x))
            .collect()
    }
}

/// 1, 2 or 5 times a power of ten, no less than a number.
fn round_step(least: f64) -> f64 {
    let power = 10f64.powf(least.max(1e-12).log10().floor());
    [1.0, 2.0, 5.0, 10.0].into_iter().map(|x| x * power).find(|x| *x >= least).unwrap_or(power)
}

/// A number as it stands beside an axis.
pub(super) fn short(x: f64) -> String {
    if x >= 100.0 || x == x.round() { format!("{x:.0}") } else { format!("{x:.1}") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_are_round_and_within() {
        let axis = Axis::over([0.0, 437.0], [0.0, 100.0], false);
        assert_eq!(axis.ticks(), [0.0, 100.0, 200.0, 300.0, 400.0]);
        let axis = Axis::over([95.0, 2100.0], [0.0, 100.0], true);
        assert_eq!(axis.ticks().first(), Some(&100.0));
        assert!(axis.ticks().len() >= 4);
        assert!(axis.at(95.0) > 0.0 && axis.at(1e9) == 100.0 && axis.at(-1.0) == 0.0);
    }

    #[test]
    fn odd_numbers_leave_a_chart_whole() {
        for is_log in [false, true] {
            for numbers in [vec![], vec![f64::NAN, f64::INFINITY], vec![5.0], vec![0.0, 0.0]] {
                let axis = Axis::over(numbers, [0.0, 100.0], is_log);
                assert!((0.0..=100.0).contains(&axis.at(5.0)));
                assert!(axis.ticks().len() < 20);
            }
        }
    }
}
