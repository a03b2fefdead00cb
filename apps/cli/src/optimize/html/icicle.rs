//! A nest as an icicle: parts below what they stand in, as wide as what rays spend in them.

use nestray::plan::describe::Spent;

use super::chart::{COLORS, Drawing};

const WIDTH: f64 = 960.0;
const ROW: f64 = 24.0;
/// Narrower parts are not drawn.
const LEAST: f64 = 1.0;
/// What a letter takes, about.
const LETTER: f64 = 6.6;
/// Nests deeper than this are cut off.
const DEEPEST: usize = 24;

pub(super) fn draw(spent: &Spent) -> String {
    let rows = levels(spent, WIDTH / spent.total.max(f64::MIN_POSITIVE), 0);
    let mut drawing = Drawing::new(WIDTH, ROW * rows as f64);
    part(spent, [0.0, 0.0], WIDTH / spent.total.max(f64::MIN_POSITIVE), spent.total, &mut drawing);
    drawing.done()
}

/// How many rows there are.
fn levels(spent: &Spent, scale: f64, level: usize) -> usize {
    let is_drawn = |inner: &&Spent| inner.total * scale >= LEAST && level + 1 < DEEPEST;
    let deepest = spent.inner.iter().filter(is_drawn).map(|inner| levels(inner, scale, level + 1));
    deepest.max().unwrap_or(0) + 1
}

fn part(spent: &Spent, [x, y]: [f64; 2], scale: f64, all: f64, drawing: &mut Drawing) {
    let width = spent.total * scale;
    let kind = spent.name.trim_start_matches(|c: char| c.is_numeric() || c == ' ' || c == '×');
    let kind = kind.split(' ').next().unwrap_or_default();
    let title = format!(
        "{}: {:.1} ns a ray, {:.0} %; {:.1} ns of its own",
        spent.name,
        spent.total,
        100.0 * spent.total / all.max(f64::MIN_POSITIVE),
        spent.own
    );
    let color = color(kind);
    drawing.shape(
        &format!(
            "rect x=\"{x:.1}\" y=\"{y:.1}\" width=\"{width:.1}\" height=\"{:.1}\" fill=\"{color}\" \
             fill-opacity=\"0.35\" stroke=\"#fff\"",
            ROW - 1.0
        ),
        &title,
    );
    let letters = ((width - 8.0) / LETTER).max(0.0) as usize;
    if letters >= 3 {
        let label = format!("{}, {:.0} ns", spent.name, spent.total);
        drawing.words([x + 4.0, y + ROW - 8.0], "start", "#111", &cut(&label, letters));
    }
    let (mut left, below) = (x, y + ROW);
    if below / ROW >= DEEPEST as f64 {
        return;
    }
    for inner in &spent.inner {
        let wide = inner.total * scale;
        if wide >= LEAST {
            part(inner, [left, below], scale, all, drawing);
        }
        left += wide;
    }
}

/// The same for the same technique, everywhere.
pub(super) fn color(kind: &str) -> &'static str {
    let sum = kind.bytes().fold(7usize, |sum, byte| sum.wrapping_mul(31).wrapping_add(byte.into()));
    COLORS[sum % (COLORS.len() - 1)]
}

/// The first letters, and a sign that there are more.
fn cut(text: &str, letters: usize) -> String {
    if text.chars().count() <= letters {
        return text.to_owned();
    }
    text.chars().take(letters - 1).chain(['…']).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn spent(name: &str, own: f64, inner: Vec<Spent>) -> Spent {
        let total = own + inner.iter().map(|spent| spent.total).sum::<f64>();
        Spent { name: name.into(), own, total, inner }
    }

    #[test]
    fn every_part_that_can_be_seen_is_drawn() {
        let nest = spent(
            "grid",
            10.0,
            vec![spent("3 × bvh", 50.0, Vec::new()), spent("list", 1e-6, Vec::new())],
        );
        let drawn = draw(&nest);
        assert_eq!(drawn.matches("<rect").count(), 2, "{drawn}");
        assert!(drawn.contains("3 × bvh: 50.0 ns a ray, 83 %"), "{drawn}");
        assert_eq!(draw(&spent("list", 0.0, Vec::new())).matches("<rect").count(), 1);
        let tower =
            (0..500).fold(spent("a", 1.0, Vec::new()), |inner, _| spent("b", 0.0, vec![inner]));
        assert_eq!(draw(&tower).matches("<rect").count(), DEEPEST);
    }
}
