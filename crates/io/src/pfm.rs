//! PFM files: rows of floats from the bottom to the top, behind three lines of text.

use std::io::{self, Write};

use nestray_scene::picture::{Layer, Picture};

use crate::png;

/// What a PFM file can hold of a picture: one channel if that is all there is, else colours.
pub(crate) fn layer(picture: &Picture) -> Result<Layer, String> {
    match picture.layers.first() {
        Some(first) if first.channels.len() == 1 => Ok(first.clone()),
        _ => {
            let (samples, channels) = png::colors(picture)?;
            let colors: Vec<[f32; 3]> =
                samples.chunks_exact(channels).map(|p| [p[0], p[1], p[2]]).collect();
            Ok(Layer::rgb("", &colors))
        }
    }
}

/// Writes a layer of one or three channels, little-endian.
///
/// # Errors
/// Those of the sink.
pub fn write(mut out: impl Write, [width, height]: [usize; 2], layer: &Layer) -> io::Result<()> {
    let kind = if layer.channels.len() == 1 { "Pf" } else { "PF" };
    write!(out, "{kind}\n{width} {height}\n-1.0\n")?;
    for row in layer.samples.chunks_exact(width * layer.channels.len()).rev() {
        for sample in row {
            out.write_all(&sample.to_le_bytes())?;
        }
    }
    Ok(())
}

/// Reads a file of either byte order; one channel is called `Y`.
///
/// # Errors
/// If it is not a PFM file, or not all of one.
pub fn read(bytes: &[u8]) -> Result<Picture, String> {
    let mut rest = bytes;
    let channels: &[&str] = match word(&mut rest)? {
        "PF" => &["R", "G", "B"],
        "Pf" => &["Y"],
        other => return Err(format!("`{other}` where PF or Pf should be")),
    };
    let size = |word: &str| match word.parse::<u32>() {
        Ok(size) if size > 0 => Ok(size as usize),
        _ => Err(format!("`{word}` is no number of pixels")),
    };
    let (width, height) = (size(word(&mut rest)?)?, size(word(&mut rest)?)?);
    let scale = word(&mut rest)?;
    let little = match scale.parse::<f32>() {
        Ok(scale) if scale != 0.0 && scale.is_finite() => scale < 0.0,
        _ => return Err(format!("`{scale}` where the byte order should be")),
    };
    let needed = width.checked_mul(height).and_then(|n| n.checked_mul(4 * channels.len()));
    let Some(data) = needed.and_then(|needed| rest.get(..needed)) else {
        let here = rest.len();
        return Err(format!("{width} × {height} pixels are promised, {here} bytes are there"));
    };
    let sample = |b: &[u8]| {
        let b = [b[0], b[1], b[2], b[3]];
        if little { f32::from_le_bytes(b) } else { f32::from_be_bytes(b) }
    };
    let rows = data.chunks_exact(4 * width * channels.len()).rev();
    let samples = rows.flat_map(|row| row.chunks_exact(4).map(sample)).collect();
    let channels = channels.iter().map(|&name| name.into()).collect();
    Ok(Picture { width, height, layers: vec![Layer { name: String::new(), channels, samples }] })
}

/// The next word of the head, and the one byte of space behind it.
fn word<'a>(rest: &mut &'a [u8]) -> Result<&'a str, String> {
    /// No word of a head is longer.
    const LONGEST: usize = 64;
    let start = rest.iter().position(|b| !b.is_ascii_whitespace()).unwrap_or(rest.len());
    let bytes = &rest[start..];
    let Some(end) = bytes.iter().take(LONGEST).position(u8::is_ascii_whitespace) else {
        return Err("no PFM head".into());
    };
    *rest = &bytes[end + 1..];
    std::str::from_utf8(&bytes[..end]).map_err(|_| "no PFM head".into())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn floats_come_back_bit_for_bit() {
        let pixels = [
            [0.0, -0.0, 1e30],
            [f32::INFINITY, -1.5, 1e-40],
            [1.0; 3],
            [2.0; 3],
            [3.0; 3],
            [4.0; 3],
        ];
        let picture = Picture::rgb(2, 3, &pixels);
        let mut file = Vec::new();
        write(&mut file, [2, 3], &layer(&picture).expect("colours")).expect("memory");
        assert_eq!(read(&file).expect("sound"), picture);
        let Picture { layers, .. } = read(&file).expect("sound");
        assert!(layers[0].samples[1].is_sign_negative());
    }

    #[test]
    fn both_byte_orders_are_read_and_rows_run_upwards() {
        for (scale, bytes) in [("-1", 2.0f32.to_le_bytes()), ("1.0", 2.0f32.to_be_bytes())] {
            let mut file = format!("Pf\n1 2\n{scale}\n").into_bytes();
            file.extend([0; 4]);
            file.extend(bytes);
            let picture = read(&file).expect("sound");
            assert_eq!(picture.layers[0].samples, [2.0, 0.0]);
            assert_eq!(picture.layers[0].channels, ["Y"]);
        }
    }

    #[test]
    fn promises_that_are_not_kept_are_refused() {
        for file in [
            "",
            "PF",
            "PF\n",
            "P6\n1 1\n-1\n",
            "PF\n0 1\n-1\n",
            "PF\n1 1\n0\n0123456789ab",
            "PF\n1 1\n-1\n0123456789a",
            "PF\n4294967295 4294967295\n-1\n",
            "PF\n-1 1\n-1\n",
            "PF\n1 1\nnan\n0123456789ab",
            "PF\n99999999999 1\n-1\n",
        ] {
            read(file.as_bytes()).expect_err(file);
        }
    }
}
