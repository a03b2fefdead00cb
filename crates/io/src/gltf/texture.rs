//! Textures, and the images in them.

use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Arc;

use nestray_scene::texture::{Image, Texture, Wrap};

use super::Reader;
use super::document::TextureOf;
use crate::image::{Curve, image_from};
use crate::uri::fetch;

/// Textures made so far.
#[derive(Debug, Default)]
pub(super) struct Textures {
    /// None for images that could not be read.
    images: BTreeMap<(usize, bool), Option<Arc<Image>>>,
    textures: BTreeMap<(usize, bool, [u32; 5]), Option<usize>>,
    /// Pixels so far, and bytes they came from.
    pixels: usize,
    bytes: usize,
}

impl Textures {
    /// Whether there is room for one more image of so many bytes.
    fn make_room(&mut self, bytes: usize) -> Result<(), String> {
        /// Pixels that any file may have, however few its bytes.
        const FREE: usize = 1 << 26;
        /// Pixels for each byte beyond that.
        const DENSE: usize = 64;
        self.bytes = self.bytes.saturating_add(bytes);
        if self.pixels > self.bytes.saturating_mul(DENSE).saturating_add(FREE) {
            return Err("images are far larger than their bytes can mean".into());
        }
        Ok(())
    }
}

impl Reader<'_> {
    /// The number of a texture; none, and a warning, if it cannot be read.
    pub(super) fn texture(
        &mut self,
        wanted: Option<&TextureOf>,
        curve: Curve,
    ) -> Result<Option<usize>, String> {
        let Some(wanted) = wanted else { return Ok(None) };
        let (offset, rotation, scale) = match &wanted.extensions.transform {
            Some(t) => (t.offset.unwrap_or_default(), t.rotation, t.scale.unwrap_or([1.0; 2])),
            None => ([0.0; 2], 0.0, [1.0; 2]),
        };
        let laid = [offset[0], offset[1], rotation, scale[0], scale[1]];
        let key = (wanted.index, curve == Curve::Srgb, laid.map(f32::to_bits));
        if let Some(&known) = self.textures.textures.get(&key) {
            return Ok(known);
        }
        let found = self.document.textures.get(wanted.index);
        let found = found.ok_or_else(|| format!("there is no textures[{}]", wanted.index))?;
        let image = match found.source {
            Some(image) => self.image(image, curve)?,
            None => {
                self.warn(format!("textures[{}] has no image that is read", wanted.index));
                None
            }
        };
        let number = match image {
            None => None,
            Some(image) => {
                let mut texture =
                    Texture { scale, rotation, offset, ..Texture::new(&*found.name, image) };
                self.sample(&mut texture, found.sampler)?;
                self.scene.textures.push(texture);
                Some(self.scene.textures.len() - 1)
            }
        };
        self.textures.textures.insert(key, number);
        Ok(number)
    }

    /// Which set of coordinates a texture is laid by.
    pub(super) fn set_of(wanted: &TextureOf) -> usize {
        let transform = wanted.extensions.transform.as_ref();
        transform.and_then(|transform| transform.tex_coord).unwrap_or(wanted.tex_coord)
    }

    fn sample(&self, texture: &mut Texture, sampler: Option<usize>) -> Result<(), String> {
        let Some(number) = sampler else { return Ok(()) };
        let sampler = self.document.samplers.get(number);
        let sampler = sampler.ok_or_else(|| format!("there is no samplers[{number}]"))?;
        texture.wrap = [sampler.wrap_s, sampler.wrap_t].map(|code| match code {
            Some(33071) => Wrap::Clamp,
            Some(33648) => Wrap::Mirror,
            _ => Wrap::Repeat,
        });
        texture.nearest = sampler.mag_filter == Some(9728);
        Ok(())
    }

    fn image(&mut self, number: usize, curve: Curve) -> Result<Option<Arc<Image>>, String> {
        let key = (number, curve == Curve::Srgb);
        if let Some(known) = self.textures.images.get(&key) {
            return Ok(known.clone());
        }
        let found = self.document.images.get(number);
        let found = found.ok_or_else(|| format!("there is no images[{number}]"))?;
        let bytes = match (&found.uri, found.buffer_view) {
            (Some(uri), _) => fetch(uri, self.source),
            (None, Some(view)) => self.view(view).map(|(bytes, _)| bytes.to_vec()),
            (None, None) => Err("has neither a name nor bytes".into()),
        };
        let image = bytes.and_then(|bytes| {
            self.textures.make_room(bytes.len())?;
            let shown = match &found.uri {
                Some(uri) if !uri.starts_with("data:") => uri.as_str(),
                _ => found.name.as_str(),
            };
            image_from(&bytes, Path::new(shown), curve).map_err(|error| error.to_string())
        });
        let image = match image {
            Ok(image) => {
                self.textures.pixels += image.width * image.height;
                Some(image)
            }
            Err(why) => {
                self.warn(format!("images[{number}] is left out: {why}"));
                None
            }
        };
        self.textures.images.insert(key, image.clone());
        Ok(image)
    }
}
