//! Finished pictures: what a render yields and writers store.

/// Layers of the same size, all linear and unbounded; tone mapping comes later.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Picture {
    /// Pixels in a row.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// The layers; the first, if it has channels `R`, `G`, `B`, is what people look at.
    pub layers: Vec<Layer>,
}

/// Some channels that belong together.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Layer {
    /// What it is called; the main one is empty.
    pub name: String,
    /// Names of the channels: `R`, `G`, `B`, `A`, `Z`, …
    pub channels: Vec<String>,
    /// Row by row from the top, pixel by pixel, channel by channel.
    pub samples: Vec<f32>,
}

impl Layer {
    /// A layer of three colours.
    #[must_use]
    pub fn rgb(name: impl Into<String>, pixels: &[[f32; 3]]) -> Self {
        let channels = ["R", "G", "B"].map(String::from).to_vec();
        Self { name: name.into(), channels, samples: pixels.as_flattened().to_vec() }
    }
}

impl Picture {
    /// A picture of one layer of three colours.
    #[must_use]
    pub fn rgb(width: usize, height: usize, pixels: &[[f32; 3]]) -> Self {
        Self { width, height, layers: vec![Layer::rgb("", pixels)] }
    }
}
