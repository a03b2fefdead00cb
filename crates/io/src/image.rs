//! Pictures in: textures and environments.

use std::fs::File;
use std::io::{Cursor, Read as _};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;
use std::sync::Arc;

use nestray_scene::picture::Picture;
use nestray_scene::texture::{Image, Pixels};

use crate::error::{LoadError, Spot};
use crate::{exr, pfm, png};

/// What the numbers of a picture with eight bits a channel mean. Pictures in floating point are
/// always linear.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Curve {
    /// Colours on the sRGB curve.
    #[default]
    Srgb,
    /// Amounts of something: roughness, directions.
    Linear,
}

/// The longest file of a picture that is read.
const MOST_BYTES: u64 = 1 << 32;

/// Reads a texture from a file: PNG, JPEG, Radiance HDR, EXR or PFM, whatever its name.
///
/// # Errors
/// If there is no such file, or none of a picture.
pub fn load_image(path: &Path, curve: Curve) -> Result<Arc<Image>, LoadError> {
    let bytes = read_file(path)?;
    image_from(&bytes, path, curve)
}

/// Reads a texture from the bytes of a file; `name` is for errors.
///
/// # Errors
/// If they are none of a picture.
pub fn image_from(bytes: &[u8], name: &Path, curve: Curve) -> Result<Arc<Image>, LoadError> {
    guarded(name, || match kind(bytes) {
        Kind::Exr => exr::read(bytes).and_then(float_image),
        Kind::Pfm => pfm::read(bytes).and_then(float_image),
        Kind::Other => decode(bytes, curve),
    })
    .map(Arc::new)
}

/// Reads all layers of an EXR or PFM file.
///
/// # Errors
/// If there is no such file, or it is of another kind.
pub fn read_picture(path: &Path) -> Result<Picture, LoadError> {
    let bytes = read_file(path)?;
    guarded(path, || match kind(&bytes) {
        Kind::Exr => exr::read(&bytes),
        Kind::Pfm => pfm::read(&bytes),
        Kind::Other => Err("neither an EXR nor a PFM file".into()),
    })
}

fn read_file(path: &Path) -> Result<Vec<u8>, LoadError> {
    let failed = |error| Spot::file(path).error(format!("cannot be read: {error}"));
    let file = File::open(path).map_err(failed)?;
    if !file.metadata().map_err(failed)?.is_file() {
        return Err(failed(std::io::Error::other("it is no plain file")));
    }
    let mut bytes = Vec::new();
    file.take(MOST_BYTES).read_to_end(&mut bytes).map_err(failed)?;
    Ok(bytes)
}

enum Kind {
    Exr,
    Pfm,
    Other,
}

fn kind(bytes: &[u8]) -> Kind {
    match bytes {
        [0x76, 0x2f, 0x31, 0x01, ..] => Kind::Exr,
        [b'P', b'F' | b'f', space, ..] if space.is_ascii_whitespace() => Kind::Pfm,
        _ => Kind::Other,
    }
}

/// Decoders are not ours: if one panics, that is an error like any other.
fn guarded<T>(name: &Path, read: impl FnOnce() -> Result<T, String>) -> Result<T, LoadError> {
    let result =
        catch_unwind(AssertUnwindSafe(read)).unwrap_or_else(|_| Err("it cannot be decoded".into()));
    result.map_err(|reason| {
        Spot::file(name).error(reason.lines().next().unwrap_or("it cannot be decoded"))
    })
}

/// The number of pixels, if so many can come from so few bytes.
pub(crate) fn believable([width, height]: [usize; 2], bytes: usize) -> Result<usize, String> {
    /// More than any file holds that can still be worked with.
    const MOST: usize = 1 << 28;
    /// No compression packs more pixels of a real picture into a byte.
    const DENSEST: usize = 1 << 12;
    let most = bytes.saturating_mul(DENSEST).saturating_add(1 << 16).min(MOST);
    match width.checked_mul(height) {
        Some(pixels) if pixels > 0 && pixels <= most => Ok(pixels),
        _ => Err(format!("{width} × {height} pixels from {bytes} bytes cannot be")),
    }
}

fn decode(bytes: &[u8], curve: Curve) -> Result<Image, String> {
    let format = match image::guess_format(bytes) {
        Ok(format) if format.reading_enabled() => format,
        Ok(format) => return Err(format!("{format:?} pictures are not read")),
        Err(_) => return Err("not a PNG, JPEG, HDR, EXR or PFM picture".into()),
    };
    let reader = |limits: image::Limits| {
        let mut reader = image::ImageReader::with_format(Cursor::new(bytes), format);
        reader.limits(limits);
        reader
    };
    let mut limits = image::Limits::default();
    limits.max_alloc = Some(1 << 34);
    let (width, height) = reader(limits.clone()).into_dimensions().map_err(|e| e.to_string())?;
    let pixels = believable([width as usize, height as usize], bytes.len())?;
    limits.max_image_width = Some(width);
    limits.max_image_height = Some(height);
    // Sixteen bytes a pixel is the most that decoders make of one, and they may make two of it.
    limits.max_alloc = Some(pixels as u64 * 32 + (1 << 24));
    let reader = reader(limits);
    let decoded = reader.decode().map_err(|e| e.to_string())?;
    let (width, height) = (decoded.width() as usize, decoded.height() as usize);
    let float = matches!(decoded.color(), image::ColorType::Rgb32F | image::ColorType::Rgba32F);
    let pixels = if float {
        Pixels::Float(decoded.into_rgb32f().pixels().map(|pixel| pixel.0).collect())
    } else {
        let pixels = decoded.into_rgba8().pixels().map(|pixel| pixel.0).collect();
        match curve {
            Curve::Srgb => Pixels::Srgb(pixels),
            Curve::Linear => Pixels::Linear(pixels),
        }
    };
    Ok(Image { width, height, pixels })
}

/// The first layer that has colours; negative light and what is no number become black.
fn float_image(picture: Picture) -> Result<Image, String> {
    let (samples, channels) = png::colors(&picture)?;
    let clean = |x: f32| if x > 0.0 { x.min(f32::MAX) } else { 0.0 };
    let pixels = samples.chunks_exact(channels).map(|p| [clean(p[0]), clean(p[1]), clean(p[2])]);
    let pixels = Pixels::Float(pixels.collect());
    Ok(Image { width: picture.width, height: picture.height, pixels })
}

#[cfg(test)]
mod tests {
    use std::io::Write as _;

    use super::*;

    /// A small picture in every format that is read.
    fn samples() -> Vec<(&'static str, Vec<u8>)> {
        let mut files = Vec::new();
        for (name, format) in [("png", image::ImageFormat::Png), ("jpeg", image::ImageFormat::Jpeg)]
        {
            let picture =
                image::RgbImage::from_fn(9, 7, |x, y| image::Rgb([x as u8 * 20, y as u8 * 30, 7]));
            let mut file = Cursor::new(Vec::new());
            picture.write_to(&mut file, format).expect("memory");
            files.push((name, file.into_inner()));
        }
        let light = Picture::rgb(9, 7, &[[2.0, 0.5, 1e-3]; 63]);
        let mut file = Cursor::new(Vec::new());
        exr::write(&mut file, &light, exr::Precision::Half).expect("memory");
        files.push(("exr", file.into_inner()));
        let mut file = Vec::new();
        pfm::write(&mut file, [9, 7], &light.layers[0]).expect("memory");
        files.push(("pfm", file));
        let mut file = b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 7 +X 9\n".to_vec();
        file.write_all(&[128, 64, 32, 129].repeat(63)).expect("memory");
        files.push(("hdr", file));
        files
    }

    #[test]
    fn every_format_is_known_by_its_bytes() {
        for (name, file) in samples() {
            let picture = image_from(&file, Path::new(name), Curve::Srgb).expect(name);
            assert_eq!((picture.width, picture.height), (9, 7), "{name}");
            let light = matches!(picture.pixels, Pixels::Float(_));
            assert_eq!(light, !matches!(name, "png" | "jpeg"), "{name}");
        }
    }

    #[test]
    fn the_curve_is_what_was_asked_for() {
        let (_, png) = samples().remove(0);
        for curve in [Curve::Srgb, Curve::Linear] {
            let picture = image_from(&png, Path::new("png"), curve).expect("sound");
            let found =
                if matches!(picture.pixels, Pixels::Srgb(_)) { Curve::Srgb } else { Curve::Linear };
            assert_eq!(found, curve);
            let blue = picture.pixel(0, 0)[2];
            assert_eq!(curve == Curve::Linear, blue == 7.0 / 255.0, "{blue}");
        }
    }

    #[test]
    fn broken_pictures_are_errors_in_one_line() {
        const SEED: u64 = 11;
        eprintln!("seed {SEED}");
        let mut state = SEED;
        let mut random = move || {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            (state >> 33) as usize
        };
        for (name, file) in samples() {
            for end in 0..file.len().min(400) {
                let _ = image_from(&file[..end], Path::new(name), Curve::Srgb);
            }
            for _ in 0..1_000 {
                let mut broken = file.clone();
                for _ in 0..1 + random() % 4 {
                    let at = random() % broken.len();
                    broken[at] = random() as u8;
                }
                if let Err(error) = image_from(&broken, Path::new(name), Curve::Srgb) {
                    assert!(!error.to_string().contains('\n'), "{error}");
                }
            }
        }
    }

    #[test]
    fn sizes_that_cannot_be_are_refused_before_memory_is_taken() {
        let mut png = samples().remove(0).1;
        // The width, and the checksum of the head that then fits.
        png[16..20].copy_from_slice(&0x00ff_ffffu32.to_be_bytes());
        let mut hash = flate2::Crc::new();
        hash.update(&png[12..29]);
        png[29..33].copy_from_slice(&hash.sum().to_be_bytes());
        let error =
            image_from(&png, Path::new("big.png"), Curve::Srgb).expect_err("too large").to_string();
        assert!(error.starts_with("big.png: 16777215 × 7 pixels"), "{error}");
        let hdr = b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 999999 +X 999999\n";
        image_from(hdr, Path::new("big.hdr"), Curve::Srgb).expect_err("too large");
    }

    #[test]
    fn what_is_no_picture_is_told_by_name() {
        let error = image_from(b"hello", Path::new("a.txt"), Curve::Srgb).expect_err("no picture");
        assert_eq!(error.to_string(), "a.txt: not a PNG, JPEG, HDR, EXR or PFM picture");
        let error =
            image_from(b"GIF89a......", Path::new("a.gif"), Curve::Srgb).expect_err("not read");
        assert_eq!(error.to_string(), "a.gif: Gif pictures are not read");
        let error = load_image(Path::new("none/here.png"), Curve::Srgb).expect_err("not there");
        assert!(error.to_string().starts_with("none/here.png: cannot be read"), "{error}");
    }
}
