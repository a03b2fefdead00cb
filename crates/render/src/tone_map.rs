//! From light to what a screen shows.

use nestray_scene::picture::Picture;
use nestray_scene::texture::srgb_from_linear;

/// How light of any brightness is fitted between black and white.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Curve {
    /// Cut off at 1.
    #[default]
    None,
    /// `x / (1 + x)` of the luminance [Reinhard 02].
    Reinhard,
    /// A film-like curve near that of the Academy Color Encoding System, by the fit of
    /// [Narkowicz 16].
    Aces,
    /// A softer film-like curve, by the fit of [Hable 10].
    Filmic,
}

/// How a picture is shown.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ToneMap {
    /// The curve.
    pub curve: Curve,
    /// Stops: light is multiplied by two to the power of this first.
    pub exposure: f32,
    /// How values become bytes.
    pub encoding: Encoding,
}

/// How values from 0 to 1 become bytes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Encoding {
    /// By the sRGB curve: half the light is byte 188.
    #[default]
    Srgb,
    /// In proportion, as the published pictures of the standard scenes were made.
    Linear,
}

impl ToneMap {
    /// What light is multiplied by before it is shown.
    #[must_use]
    pub fn gain(&self) -> f32 {
        libm::exp2f(self.exposure)
    }

    /// The main layer as bytes, three a pixel, row by row from the top; black if it
    /// has fewer than three channels.
    #[must_use]
    pub fn bytes(&self, picture: &Picture) -> Vec<u8> {
        let black = vec![0; picture.width * picture.height * 3];
        let Some(layer) = picture.layers.first() else { return black };
        let channels = layer.channels.len();
        if channels < 3 {
            return black;
        }
        let gain = self.gain();
        let mut bytes = Vec::with_capacity(black.len());
        for pixel in layer.samples.chunks_exact(channels) {
            let color = [0, 1, 2].map(|i| pixel[i] * gain);
            bytes.extend(self.curve.apply(color).map(|x| self.encoding.byte(x)));
        }
        bytes
    }
}

impl Encoding {
    /// The byte of a value; 0 if it is no number.
    #[must_use]
    pub fn byte(self, x: f32) -> u8 {
        let x = x.clamp(0.0, 1.0);
        let shown = match self {
            Self::Srgb => srgb_from_linear(x),
            Self::Linear => x,
        };
        (shown * 255.0 + 0.5) as u8
    }
}

impl Curve {
    /// A linear colour, fitted into `[0, 1]` but for rounding. Negative light counts as none.
    #[must_use]
    pub fn apply(self, color: [f32; 3]) -> [f32; 3] {
        let color = color.map(|x| if x > 0.0 { x.min(1e6) } else { 0.0 });
        match self {
            Self::None => color,
            Self::Reinhard => {
                let [r, g, b] = color;
                let bright = 0.2126 * r + 0.7152 * g + 0.0722 * b;
                color.map(|x| x / (1.0 + bright))
            }
            Self::Aces => color.map(|x| {
                let x = 0.6 * x;
                x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14)
            }),
            Self::Filmic => {
                // As bright as 11.2 becomes white.
                let white = filmic(11.2);
                color.map(|x| filmic(2.0 * x) / white)
            }
        }
    }
}

fn filmic(x: f32) -> f32 {
    (x * (0.15 * x + 0.05) + 0.004) / (x * (0.15 * x + 0.5) + 0.06) - 0.02 / 0.3
}

#[cfg(test)]
mod tests {
    use super::*;

    const ALL: [Curve; 4] = [Curve::None, Curve::Reinhard, Curve::Aces, Curve::Filmic];

    #[test]
    fn brighter_light_never_looks_darker() {
        for curve in ALL {
            let mut last = -1.0;
            for i in 0..200 {
                let x = i as f32 * i as f32 * 1e-3;
                let [shown, ..] = curve.apply([x; 3]);
                assert!(shown >= last && shown.is_finite(), "{curve:?} at {x}");
                last = shown;
            }
            assert!(curve.apply([0.0; 3])[0].abs() < 1e-3, "{curve:?} keeps black");
            assert_eq!(curve.apply([f32::NAN; 3]), curve.apply([0.0; 3]));
        }
    }

    #[test]
    fn middle_grey_is_118_and_one_stop_doubles_light() {
        let picture = Picture::rgb(2, 1, &[[0.18; 3], [f32::INFINITY, -1.0, 1.0]]);
        assert_eq!(ToneMap::default().bytes(&picture), [118, 118, 118, 255, 0, 255]);
        let plain = ToneMap { encoding: Encoding::Linear, ..ToneMap::default() };
        assert_eq!(plain.bytes(&picture), [46, 46, 46, 255, 0, 255]);
        let brighter = ToneMap { exposure: 1.0, ..ToneMap::default() };
        let grey = Picture::rgb(1, 1, &[[0.36; 3]]);
        assert_eq!(brighter.bytes(&picture)[..3], ToneMap::default().bytes(&grey));
    }
}
