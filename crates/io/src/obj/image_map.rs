//! Pictures that materials of OBJ files name, with their options.

use nestray_scene::texture::{Image, Pixels, Texture, Wrap};

use crate::words::Words;

/// A picture and how it is laid on a surface.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Map {
    /// As the file has it.
    pub(super) name: String,
    pub(super) line: usize,
    scale: [f32; 2],
    offset: [f32; 2],
    clamped: bool,
    /// What heights or slopes are multiplied by.
    pub(super) strength: f32,
    /// Whether it may hold heights instead of directions.
    pub(super) may_be_height: bool,
}

impl Map {
    /// Options and a name, which may have blanks in it; none if there is no name.
    pub(super) fn read(words: &mut Words<'_>) -> Option<Self> {
        let line = words.line();
        let rest = words.rest();
        let mut map = Self { line, scale: [1.0; 2], strength: 1.0, ..Self::default() };
        let mut rest = rest.as_ref();
        while rest.starts_with('-') {
            let (option, after) = split(rest);
            // Numbers: `-s 2` and `-s 2 2 1` are the same.
            let most = match option {
                "-s" | "-o" | "-t" => 3,
                "-mm" => 2,
                "-bm" | "-boost" | "-texres" => 1,
                _ => 0,
            };
            let (mut numbers, mut after) = (Vec::new(), after);
            while numbers.len() < most
                && let (word, further) = split(after)
                && let Ok(number) = word.parse::<f32>()
            {
                numbers.push(number);
                after = further;
            }
            let two = |usual: f32| {
                let first = numbers.first().copied().unwrap_or(usual);
                [first, numbers.get(1).copied().unwrap_or(usual)]
            };
            match option {
                "-s" => map.scale = two(1.0),
                "-o" => map.offset = two(0.0),
                "-bm" => map.strength = two(1.0)[0],
                "-blendu" | "-blendv" | "-cc" | "-clamp" | "-imfchan" | "-type" => {
                    let (word, further) = split(after);
                    map.clamped |= option == "-clamp" && word == "on";
                    after = further;
                }
                _ => {}
            }
            rest = after;
        }
        map.name = rest.to_owned();
        (!rest.is_empty()).then_some(map)
    }

    /// The same for a picture that may hold heights.
    pub(super) fn or_heights(self) -> Self {
        Self { may_be_height: true, ..self }
    }

    /// A texture laid as the options say. They count from the bottom, textures from the top.
    pub(super) fn lay(&self, mut texture: Texture) -> Texture {
        let [_, v] = self.scale;
        texture.scale = self.scale;
        texture.offset = [self.offset[0], 1.0 - v - self.offset[1]];
        if self.clamped {
            texture.wrap = [Wrap::Clamp; 2];
        }
        texture
    }
}

/// The first word and the rest.
fn split(text: &str) -> (&str, &str) {
    let (word, rest) = text.split_once(char::is_whitespace).unwrap_or((text, ""));
    (word, rest.trim_start())
}

/// A picture with the alpha of another: its own alpha if it has any, or else how bright it is.
pub(super) fn with_alpha(base: &Image, opacity: &Image) -> Image {
    let pixel = |x: usize, y: usize| {
        let (at, up) = (x * opacity.width / base.width, y * opacity.height / base.height);
        opacity.pixel(at, up)
    };
    let of = |which: usize| {
        let all = (0..opacity.height).flat_map(|y| (0..opacity.width).map(move |x| (x, y)));
        all.map(|(x, y)| opacity.pixel(x, y)[which]).any(|value| value < 1.0)
    };
    let channel = if of(3) { 3 } else { 0 };
    let mut pixels = Vec::with_capacity(base.width * base.height);
    for y in 0..base.height {
        for x in 0..base.width {
            let alpha = (pixel(x, y)[channel].clamp(0.0, 1.0) * 255.0).round() as u8;
            let at = y * base.width + x;
            pixels.push(match &base.pixels {
                Pixels::Srgb(pixels) | Pixels::Linear(pixels) => {
                    let [r, g, b, _] = pixels[at];
                    [r, g, b, alpha]
                }
                Pixels::Float(pixels) => {
                    let [r, g, b] = pixels[at].map(|x| {
                        let curved = nestray_scene::texture::srgb_from_linear(x.clamp(0.0, 1.0));
                        (curved * 255.0).round() as u8
                    });
                    [r, g, b, alpha]
                }
            });
        }
    }
    let pixels = match base.pixels {
        Pixels::Linear(_) => Pixels::Linear(pixels),
        _ => Pixels::Srgb(pixels),
    };
    Image { width: base.width, height: base.height, pixels }
}

/// Whether all pixels are grey: heights, not directions.
pub(super) fn is_grey(image: &Image) -> bool {
    match &image.pixels {
        Pixels::Srgb(pixels) | Pixels::Linear(pixels) => {
            pixels.iter().all(|[r, g, b, _]| r == g && g == b)
        }
        Pixels::Float(pixels) => pixels.iter().all(|[r, g, b]| r == g && g == b),
    }
}
