//! Counts as colours, from blue through green and yellow to red, with a legend.

mod glyphs;

use nestray_scene::picture::{Layer, Picture};
use nestray_scene::texture::linear_from_srgb;

/// Colours as a screen shows them, evenly from few to many.
const PALETTE: [[u8; 3]; 8] = [
    [24, 15, 61],
    [46, 66, 170],
    [29, 132, 209],
    [22, 180, 166],
    [88, 207, 78],
    [219, 212, 40],
    [246, 138, 28],
    [190, 24, 20],
];

/// The linear colour of a part of the most, in `[0, 1]`; beyond is as 1.
#[must_use]
pub fn color(part: f32) -> [f32; 3] {
    let part = if part > 0.0 { part.min(1.0) } else { 0.0 };
    let place = part * (PALETTE.len() - 1) as f32;
    let below = (place as usize).min(PALETTE.len() - 2);
    let rest = place - below as f32;
    [0, 1, 2].map(|i| {
        let (a, b) = (f32::from(PALETTE[below][i]), f32::from(PALETTE[below + 1][i]));
        linear_from_srgb((a + (b - a) * rest) / 255.0)
    })
}

/// Paints the layer `cost` into the main one, with a legend below if there is room. The
/// most that the colours tell apart is a round number that one pixel in a hundred passes.
pub fn paint(picture: &mut Picture) {
    let Some(cost) = picture.layers.iter().find(|layer| layer.name == "cost") else { return };
    let most = round_up(most_but_few(&cost.samples));
    let mut pixels: Vec<[f32; 3]> = cost.samples.iter().map(|&x| color(x / most)).collect();
    legend(&mut pixels, picture.width, picture.height, most);
    if let Some(main) = picture.layers.first_mut() {
        *main = Layer::rgb("", &pixels);
    }
}

/// What at most one in a hundred is above.
fn most_but_few(samples: &[f32]) -> f32 {
    let mut sorted: Vec<f32> = samples.iter().copied().filter(|x| x.is_finite()).collect();
    sorted.sort_by(f32::total_cmp);
    let place = sorted.len().saturating_sub(1) - sorted.len() / 100;
    sorted.get(place).copied().unwrap_or(0.0)
}

/// The next number that is 1, 2 or 5 and zeros; at least 10.
fn round_up(x: f32) -> f32 {
    let mut unit = 10.0;
    while unit < 1e30 {
        for step in [1.0, 2.0, 5.0] {
            if x <= step * unit {
                return step * unit;
            }
        }
        unit *= 10.0;
    }
    unit
}

/// Draws a strip at the foot of the picture: all colours, and what they stand for.
fn legend(pixels: &mut [[f32; 3]], width: usize, height: usize, most: f32) {
    let size = if width >= 1024 && height >= 512 { 2 } else { 1 };
    let strip = (glyphs::HEIGHT + 11) * size;
    if width < 96 * size || height < 4 * strip {
        return;
    }
    let top = height - strip;
    for pixel in &mut pixels[top * width..] {
        *pixel = [0.01; 3];
    }
    let margin = 6 * size;
    let bar = width - 2 * margin;
    for y in top + 2 * size..top + 7 * size {
        for x in 0..bar {
            pixels[y * width + margin + x] = color(x as f32 / (bar - 1) as f32);
        }
    }
    let mut canvas = glyphs::Canvas { pixels, width, size };
    for (part, share) in [(0.0, 0.0), (0.5, 0.5), (1.0, 1.0)] {
        let plus = if part == 1.0 { "+" } else { "" };
        let text = format!("{}{plus}", short(most * part));
        let room = text.len() * glyphs::WIDTH * size;
        let left = margin + ((bar - room.min(bar)) as f32 * share) as usize;
        canvas.write(&text, left, top + 9 * size);
    }
}

/// A number in few characters: `500`, `2.5k`, `10M`.
fn short(x: f32) -> String {
    match x {
        x if x >= 1e6 => format!("{}M", x / 1e6),
        x if x >= 1e3 => format!("{}k", x / 1e3),
        x => format!("{x}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn more_is_further_along_the_colours_and_numbers_are_round() {
        assert_ne!(color(0.1), color(0.9));
        assert_eq!(color(7.0), color(1.0));
        assert_eq!(color(f32::NAN), color(0.0));
        for (x, round) in [(0.0, 10.0), (10.0, 10.0), (11.0, 20.0), (490.0, 500.0), (501.0, 1e3)] {
            assert_eq!(round_up(x), round);
        }
        assert_eq!(
            (short(2500.0), short(50.0), short(1e7)),
            ("2.5k".into(), "50".into(), "10M".into())
        );
    }

    #[test]
    fn a_picture_of_counts_is_painted_with_its_legend() {
        let samples: Vec<f32> = (0..200 * 100).map(|i| (i % 200) as f32).collect();
        let layer = Layer { name: "cost".into(), channels: vec!["N".into()], samples };
        let main = Layer::rgb("", &vec![[0.0; 3]; 200 * 100]);
        let mut picture = Picture { width: 200, height: 100, layers: vec![main, layer] };
        paint(&mut picture);
        let pixel =
            |x: usize, y: usize| picture.layers[0].samples[(y * 200 + x) * 3..][..3].to_vec();
        assert_eq!(pixel(100, 10), color(0.5).to_vec());
        assert_eq!(pixel(193, 100 - 18 + 3), color(1.0).to_vec(), "the end of the bar");
        assert_eq!(pixel(0, 99), [0.01; 3]);
        let white = (0..200).any(|x| (90..99).any(|y| pixel(x, y) == [0.8; 3]));
        assert!(white, "numbers are written");
    }
}
