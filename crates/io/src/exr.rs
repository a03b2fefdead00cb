//! EXR files: all layers of a picture, in floating point.

use std::io::{self, Cursor, Seek, Write};

use exr::prelude::{
    AnyChannel, AnyChannels, Encoding, FlatSamples, Image, LayerAttributes, ReadChannels as _,
    ReadLayers as _, WritableImage as _, f16,
};
use nestray_scene::picture::{Layer, Picture};

use crate::write::full_name;

/// How exactly colours are stored; other channels are always stored in full.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Precision {
    /// In 16 bits; what is too large for that becomes the largest there is.
    Half,
    /// In 32 bits.
    #[default]
    Float,
}

/// Writes all layers. Channels of a layer with a name are called `layer.R` and so on.
///
/// # Errors
/// Those of the sink, and if sizes do not agree.
pub fn write(out: impl Write + Seek, picture: &Picture, precision: Precision) -> io::Result<()> {
    let mut all = exr::prelude::SmallVec::new();
    for layer in &picture.layers {
        let count = layer.channels.len();
        for (i, channel) in layer.channels.iter().enumerate() {
            let samples = layer.samples.iter().skip(i).step_by(count).copied();
            let name = full_name(layer, channel);
            let Some(name) = exr::prelude::Text::new_or_none(&name) else {
                return Err(io::Error::other(format!("`{name}` cannot name a channel")));
            };
            all.push(AnyChannel::new(name, stored(samples, channel, precision)));
        }
    }
    // ZIP by sixteen rows, always in the same order, so that bytes do not depend on threads.
    let image = Image::from_layer(exr::prelude::Layer::new(
        (picture.width, picture.height),
        LayerAttributes::default(),
        Encoding::SMALL_LOSSLESS,
        AnyChannels::sort(all),
    ));
    image.write().to_buffered(out).map_err(|error| match error {
        exr::error::Error::Io(error) => error,
        other => io::Error::other(other.to_string()),
    })
}

fn stored(samples: impl Iterator<Item = f32>, channel: &str, precision: Precision) -> FlatSamples {
    let color = matches!(channel, "R" | "G" | "B" | "A" | "Y");
    if precision == Precision::Float || !color {
        return FlatSamples::F32(samples.collect());
    }
    let largest = f16::MAX.to_f32();
    let half = |x: f32| f16::from_f32(if x.is_finite() { x.clamp(-largest, largest) } else { x });
    FlatSamples::F16(samples.map(half).collect())
}

/// Reads all layers of a file. Channels with a dot in their name make up layers; so do the
/// parts of a file of many parts, as far as they are as large as the first.
///
/// # Errors
/// If it is not an EXR file, or one that cannot be decoded, or larger than can be believed of
/// so many bytes.
pub fn read(bytes: &[u8]) -> Result<Picture, String> {
    let meta = exr::meta::MetaData::read_from_buffered(Cursor::new(bytes), false)
        .map_err(|error| error.to_string())?;
    let mut samples = 0usize;
    for header in &meta.headers {
        let size = [header.layer_size.width(), header.layer_size.height()];
        let pixels = crate::image::believable(size, bytes.len())?;
        samples = samples.saturating_add(pixels.saturating_mul(header.channels.list.len()));
    }
    crate::image::believable([samples, 1], bytes.len()).map_err(|_| "too many channels")?;
    let reader = exr::prelude::read().no_deep_data().largest_resolution_level();
    let reader = reader.all_channels().all_layers().all_attributes().non_parallel();
    let image = reader.from_buffered(Cursor::new(bytes)).map_err(|error| error.to_string())?;
    let mut parts = image.layer_data.into_iter();
    let first = parts.next().ok_or("no layers")?;
    let size = first.size;
    let mut picture = Picture { width: size.width(), height: size.height(), layers: Vec::new() };
    for part in std::iter::once(first).chain(parts.filter(|part| part.size == size)) {
        let part_name = part.attributes.layer_name.as_ref().map(ToString::to_string);
        add_part(&mut picture, part_name.unwrap_or_default(), part.channel_data.list)?;
    }
    Ok(picture)
}

/// A channel and its samples.
type Samples = (String, Vec<f32>);

type Channels = exr::prelude::SmallVec<[AnyChannel<FlatSamples>; 4]>;

/// Sorts the channels of a part into layers, colours first.
fn add_part(picture: &mut Picture, part: String, channels: Channels) -> Result<(), String> {
    let pixels = picture.width * picture.height;
    let mut layers: Vec<(String, Vec<Samples>)> = Vec::new();
    for channel in channels {
        let full = channel.name.to_string();
        let (layer, name) = match full.rsplit_once('.') {
            Some((layer, name)) => (layer.to_string(), name.to_string()),
            None => (part.clone(), full),
        };
        let samples: Vec<f32> = channel.sample_data.values_as_f32().collect();
        if samples.len() != pixels {
            return Err(format!("channel {name} has {} samples", samples.len()));
        }
        match layers.iter_mut().find(|known| known.0 == layer) {
            Some(known) => known.1.push((name, samples)),
            None => layers.push((layer, vec![(name, samples)])),
        }
    }
    for (name, mut channels) in layers {
        let rank = |name: &str| "RGBA".find(name).unwrap_or(4);
        channels.sort_by(|a, b| rank(&a.0).cmp(&rank(&b.0)).then_with(|| a.0.cmp(&b.0)));
        let mut samples = Vec::with_capacity(pixels * channels.len());
        for pixel in 0..pixels {
            samples.extend(channels.iter().map(|(_, values)| values[pixel]));
        }
        let channels = channels.into_iter().map(|(name, _)| name).collect();
        picture.layers.push(Layer { name, channels, samples });
    }
    // The nameless layer is what people look at.
    picture.layers.sort_by_key(|layer| !layer.name.is_empty());
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn picture() -> Picture {
        let colors: Vec<[f32; 3]> =
            (0..12).map(|i| [i as f32, 1e5, -0.5 / (i + 1) as f32]).collect();
        let mut picture = Picture::rgb(4, 3, &colors);
        let normals = vec![[0.0, 1.0, f32::INFINITY]; 12];
        picture.layers.push(Layer::rgb("albedo.first", &normals));
        let channels = vec!["Z".into()];
        picture.layers.push(Layer { name: "depth".into(), channels, samples: vec![1e9; 12] });
        picture
    }

    #[test]
    fn all_layers_come_back_bit_for_bit() {
        let mut file = Cursor::new(Vec::new());
        write(&mut file, &picture(), Precision::Float).expect("memory");
        assert_eq!(read(file.get_ref()).expect("sound"), picture());
    }

    #[test]
    fn half_rounds_colours_and_nothing_else() {
        let mut file = Cursor::new(Vec::new());
        write(&mut file, &picture(), Precision::Half).expect("memory");
        let back = read(file.get_ref()).expect("sound");
        assert_eq!(back.layers[0].samples[..6], [0.0, 65504.0, -0.5, 1.0, 65504.0, -0.25]);
        assert_eq!(back.layers[2], picture().layers[2]);
    }

    #[test]
    fn a_file_cut_anywhere_is_an_error() {
        let mut file = Cursor::new(Vec::new());
        write(&mut file, &picture(), Precision::Float).expect("memory");
        let file = file.into_inner();
        for end in 0..file.len() {
            read(&file[..end]).expect_err("the end is missing");
        }
    }
}
