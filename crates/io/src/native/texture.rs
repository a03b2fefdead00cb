//! Textures, and the images in them.

use std::collections::BTreeMap;
use std::io::Cursor;
use std::path::Path;
use std::sync::Arc;

use nestray_scene::picture::Layer;
use nestray_scene::texture::{
    Image as SceneImage, Pixels, Texture as SceneTexture, Wrap as SceneWrap,
};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::number;
use crate::error::Warning;
use crate::image::{Curve, image_from};
use crate::load::Source;
use crate::{pfm, png, uri};

/// A picture file.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct Image {
    /// A PNG, JPEG, HDR, EXR or PFM file beside this one, or a `data:` URI that holds one.
    file: String,
    /// What numbers of eight bits mean.
    #[serde(default)]
    curve: ImageCurve,
}

/// What numbers of eight bits mean.
#[derive(Clone, Copy, Debug, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub(super) enum ImageCurve {
    /// Colours on the sRGB curve.
    #[default]
    Srgb,
    /// Amounts of something.
    Linear,
}

/// An image, and how it is laid on a surface.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct Texture {
    /// What it is called.
    #[serde(default)]
    name: String,
    /// Which of the images.
    image: usize,
    /// How it goes on beyond its edges, along u and v.
    #[serde(default)]
    wrap: [Wrap; 2],
    /// Whether it is sampled without blending neighbours.
    #[serde(default)]
    nearest: bool,
    /// Texture coordinates are scaled, then rotated, then moved.
    #[serde(default = "ones")]
    scale: [f32; 2],
    /// In radians.
    #[serde(default)]
    rotation: f32,
    /// Along u and v.
    #[serde(default)]
    offset: [f32; 2],
}

/// How a texture goes on beyond its edges.
#[derive(Clone, Copy, Debug, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub(super) enum Wrap {
    /// From the start again.
    #[default]
    Repeat,
    /// Back and forth.
    Mirror,
    /// With the colour of the edge.
    Clamp,
}

fn ones() -> [f32; 2] {
    [1.0; 2]
}

impl Image {
    /// The image; a white pixel and a warning if it cannot be read.
    pub(super) fn build(&self, source: &Source, warnings: &mut Vec<Warning>) -> Arc<SceneImage> {
        let curve = match self.curve {
            ImageCurve::Srgb => Curve::Srgb,
            ImageCurve::Linear => Curve::Linear,
        };
        let read = match uri::data(&self.file) {
            Some(bytes) => bytes.and_then(|bytes| {
                image_from(&bytes, Path::new("data URI"), curve).map_err(|error| error.to_string())
            }),
            None => {
                let path = source.companion(&self.file);
                let bytes =
                    source.companion_bytes(&path).and_then(|b| image_from(&b, &path, curve));
                bytes.map_err(|error| error.to_string())
            }
        };
        read.unwrap_or_else(|why| {
            warnings.push(source.spot().warning(format!("an image is left white: {why}")));
            let pixels = Pixels::Float(vec![[1.0; 3]]);
            Arc::new(SceneImage { width: 1, height: 1, pixels })
        })
    }

    fn of(image: &SceneImage) -> Result<Self, String> {
        let size = [image.width, image.height];
        let (curve, kind, bytes) = match &image.pixels {
            Pixels::Srgb(pixels) => (ImageCurve::Srgb, "png", packed(size, pixels)?),
            Pixels::Linear(pixels) => (ImageCurve::Linear, "png", packed(size, pixels)?),
            Pixels::Float(pixels) => {
                let mut bytes = Vec::new();
                pfm::write(&mut bytes, size, &Layer::rgb("", pixels)).map_err(|e| e.to_string())?;
                (ImageCurve::Linear, "x-portable-floatmap", bytes)
            }
        };
        let file = format!("data:image/{kind};base64,{}", uri::encoded(&bytes));
        Ok(Self { file, curve })
    }
}

fn packed(size: [usize; 2], pixels: &[[u8; 4]]) -> Result<Vec<u8>, String> {
    let mut bytes = Cursor::new(Vec::new());
    png::write(&mut bytes, size, pixels.as_flattened()).map_err(|error| error.to_string())?;
    Ok(bytes.into_inner())
}

impl Texture {
    pub(super) fn build(&self, images: &[Arc<SceneImage>]) -> Result<SceneTexture, String> {
        let wrap = |wrap: Wrap| match wrap {
            Wrap::Repeat => SceneWrap::Repeat,
            Wrap::Mirror => SceneWrap::Mirror,
            Wrap::Clamp => SceneWrap::Clamp,
        };
        Ok(SceneTexture {
            name: self.name.clone(),
            image: images[number(".image", self.image, images.len(), "image")?].clone(),
            wrap: self.wrap.map(wrap),
            nearest: self.nearest,
            scale: self.scale,
            rotation: self.rotation,
            offset: self.offset,
        })
    }
}

/// Textures for writing, and the images they share.
pub(super) fn textures(all: &[SceneTexture]) -> Result<(Vec<Texture>, Vec<Image>), String> {
    let mut known: BTreeMap<*const SceneImage, usize> = BTreeMap::new();
    let (mut textures, mut images) = (Vec::new(), Vec::new());
    let wrap = |wrap: SceneWrap| match wrap {
        SceneWrap::Repeat => Wrap::Repeat,
        SceneWrap::Mirror => Wrap::Mirror,
        SceneWrap::Clamp => Wrap::Clamp,
    };
    for texture in all {
        let image = match known.get(&Arc::as_ptr(&texture.image)) {
            Some(&image) => image,
            None => {
                images.push(Image::of(&texture.image)?);
                known.insert(Arc::as_ptr(&texture.image), images.len() - 1);
                images.len() - 1
            }
        };
        textures.push(Texture {
            name: texture.name.clone(),
            image,
            wrap: texture.wrap.map(wrap),
            nearest: texture.nearest,
            scale: texture.scale,
            rotation: texture.rotation,
            offset: texture.offset,
        });
    }
    Ok((textures, images))
}
