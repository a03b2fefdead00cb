//! PNG files: eight bits a channel, for looking at.

use std::io::{self, Write};

use nestray_scene::picture::Picture;
use nestray_scene::texture::srgb_from_linear;

/// Writes three or four bytes a pixel, on the sRGB curve.
///
/// # Errors
/// Those of the sink.
pub fn write(out: impl Write, [width, height]: [usize; 2], bytes: &[u8]) -> io::Result<()> {
    let size = |n: usize| u32::try_from(n).map_err(io::Error::other);
    let mut encoder = png::Encoder::new(out, size(width)?, size(height)?);
    let alpha = bytes.len() == 4 * width * height;
    encoder.set_color(if alpha { png::ColorType::Rgba } else { png::ColorType::Rgb });
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_source_srgb(png::SrgbRenderingIntent::Perceptual);
    let mut writer = encoder.write_header().map_err(plain)?;
    writer.write_image_data(bytes).map_err(plain)?;
    writer.finish().map_err(plain)
}

fn plain(error: png::EncodingError) -> io::Error {
    match error {
        png::EncodingError::IoError(error) => error,
        other => io::Error::other(other),
    }
}

/// The first layer of colours on the sRGB curve; what is brighter than 1 is cut off, and what
/// is no number is black.
pub(crate) fn bytes(picture: &Picture) -> Result<Vec<u8>, String> {
    let (samples, channels) = colors(picture)?;
    // A channel `A` stays linear.
    let byte = |x: f32, linear: bool| {
        let x = if x > 0.0 { x.min(1.0) } else { 0.0 };
        ((if linear { x } else { srgb_from_linear(x) }) * 255.0 + 0.5) as u8
    };
    Ok(samples.iter().enumerate().map(|(i, &x)| byte(x, i % channels == 3)).collect())
}

/// Samples of `R`, `G`, `B`, and `A` if there is one, of the first layer that has colours; and
/// how many channels that makes. A layer of one channel counts as grey.
pub(crate) fn colors(picture: &Picture) -> Result<(Vec<f32>, usize), String> {
    for layer in &picture.layers {
        let find = |name: &str| layer.channels.iter().position(|channel| channel == name);
        let mut chosen: Vec<usize> = ["R", "G", "B"].iter().filter_map(|name| find(name)).collect();
        match (chosen.len(), layer.channels.len()) {
            (3, _) => chosen.extend(find("A")),
            (_, 1) => chosen = vec![0; 3],
            _ => continue,
        }
        let pixels = layer.samples.chunks_exact(layer.channels.len());
        let samples = pixels.flat_map(|pixel| chosen.iter().map(|&i| pixel[i])).collect();
        return Ok((samples, chosen.len()));
    }
    Err("no layer with channels R, G and B".into())
}

#[cfg(test)]
mod tests {
    use nestray_scene::picture::Layer;

    use super::*;

    fn read(file: &[u8]) -> (Vec<u8>, png::ColorType) {
        let decoder = png::Decoder::new(io::Cursor::new(file));
        let mut reader = decoder.read_info().expect("a PNG file");
        let mut bytes = vec![0; reader.output_buffer_size().expect("small")];
        let info = reader.next_frame(&mut bytes).expect("whole");
        bytes.truncate(info.buffer_size());
        (bytes, info.color_type)
    }

    #[test]
    fn bytes_come_back_as_they_were() {
        for channels in [3, 4] {
            let bytes: Vec<u8> = (0..7 * 5 * channels).map(|i| (i * 37 % 256) as u8).collect();
            let mut file = Vec::new();
            write(&mut file, [7, 5], &bytes).expect("memory");
            let (back, kind) = read(&file);
            assert_eq!(back, bytes);
            assert_eq!(kind == png::ColorType::Rgba, channels == 4);
        }
    }

    #[test]
    fn linear_colours_are_put_on_the_curve_and_alpha_is_not() {
        let channels = ["R", "G", "B", "A"].map(String::from).to_vec();
        let samples = vec![0.5, 2.0, f32::NAN, 0.5];
        let layer = Layer { name: String::new(), channels, samples };
        let picture = Picture { width: 1, height: 1, layers: vec![layer] };
        assert_eq!(bytes(&picture).expect("colours"), [188, 255, 0, 128]);
    }

    #[test]
    fn one_channel_is_grey_and_two_are_nothing_to_look_at() {
        let named = |channels: &[&str]| {
            let channels: Vec<String> = channels.iter().map(|&c| c.into()).collect();
            let samples = vec![1.0; channels.len()];
            let layer = Layer { name: String::new(), channels, samples };
            Picture { width: 1, height: 1, layers: vec![layer] }
        };
        assert_eq!(bytes(&named(&["Z"])).expect("grey"), [255; 3]);
        assert!(bytes(&named(&["R", "G"])).is_err());
    }
}
