//! The materials that an OBJ file uses, made when first used.

use std::collections::{HashMap, HashSet};
use std::sync::Arc;

use nestray_scene::material::{AlphaMode, Material};
use nestray_scene::scene::Scene;
use nestray_scene::texture::{Image, Texture};

use crate::error::{LoadError, Spot, Warning};
use crate::image::{self, Curve};
use crate::load::Source;
use crate::obj::image_map::{self, Map};
use crate::obj::mtl::{self, Definition};

/// Definitions of all libraries named so far, and the materials made of them.
#[derive(Debug)]
pub(super) struct Materials<'a> {
    source: &'a Source,
    /// By name; with the library it comes from.
    definitions: HashMap<String, (Definition, Arc<Source>)>,
    /// By name, what it is in the scene.
    made: HashMap<String, usize>,
    chosen: Option<usize>,
    /// Libraries named so far.
    opened: HashSet<String>,
    materials: Vec<Material>,
    textures: Vec<Texture>,
    /// Pictures by path, none if they cannot be read.
    images: HashMap<(String, bool), Option<Arc<Image>>>,
    warnings: Vec<Warning>,
}

impl<'a> Materials<'a> {
    pub(super) fn new(source: &'a Source) -> Self {
        Self {
            source,
            definitions: HashMap::new(),
            made: HashMap::new(),
            chosen: None,
            opened: HashSet::new(),
            materials: Vec::new(),
            textures: Vec::new(),
            images: HashMap::new(),
            warnings: Vec::new(),
        }
    }

    /// Reads libraries: one whose name has blanks, or several.
    ///
    /// # Errors
    /// If there is one and it makes no sense.
    pub(super) fn open(&mut self, names: &str, line: usize) -> Result<(), LoadError> {
        let whole = self.source.companion(names).is_file();
        let parts = names.split_whitespace();
        let names: Vec<&str> = if whole { vec![names] } else { parts.collect() };
        for name in names {
            if !self.opened.insert(name.to_owned()) {
                continue;
            }
            let path = self.source.companion(name);
            let bytes = match self.source.companion_bytes(&path) {
                Ok(bytes) => bytes,
                Err(error) => {
                    let message = format!("materials of `{name}`: {}; left out", error.message);
                    self.warnings.push(self.source.line(line).warning(message));
                    continue;
                }
            };
            let source = Arc::new(Source { path, options: self.source.options });
            for definition in mtl::read(&bytes, &source, &mut self.warnings)? {
                let entry = (definition, Arc::clone(&source));
                self.definitions.insert(entry.0.name.clone(), entry);
            }
        }
        Ok(())
    }

    /// What the next faces are made of.
    pub(super) fn choose(&mut self, name: &str, line: usize) {
        if let Some(&made) = self.made.get(name) {
            self.chosen = Some(made);
            return;
        }
        let material = match self.definitions.get(name).cloned() {
            Some((definition, source)) => self.make(&definition, &source),
            None => {
                let message = format!("there is no material `{name}`; grey is taken instead");
                self.warnings.push(self.source.line(line).warning(message));
                Material { name: name.to_owned(), ..Material::default() }
            }
        };
        self.chosen = Some(self.add(name, material));
    }

    /// What faces are made of now; grey if nothing was chosen.
    pub(super) fn chosen(&mut self) -> usize {
        match self.chosen {
            Some(chosen) => chosen,
            None => {
                let grey = self.add("", Material::default());
                *self.chosen.insert(grey)
            }
        }
    }

    /// Hands everything over to a scene.
    pub(super) fn finish(&mut self, scene: &mut Scene) -> Vec<Warning> {
        scene.materials = std::mem::take(&mut self.materials);
        scene.textures = std::mem::take(&mut self.textures);
        std::mem::take(&mut self.warnings)
    }

    fn add(&mut self, name: &str, material: Material) -> usize {
        self.materials.push(material);
        let number = self.materials.len() - 1;
        self.made.insert(name.to_owned(), number);
        number
    }

    fn make(&mut self, definition: &Definition, source: &Source) -> Material {
        let mut material = definition.material();
        material.base_texture = self.base(definition, source, &mut material.alpha_mode);
        if let Some(map) = &definition.emission_map
            && let Some(image) = self.image(map, Curve::Srgb, source)
        {
            if !material.glows() {
                material.emission = [1.0; 3];
            }
            material.emission_texture = Some(self.texture(map, image));
        }
        if let Some(map) = &definition.normal_map
            && let Some(image) = self.image(map, Curve::Linear, source)
        {
            if map.may_be_height && image_map::is_grey(&image) {
                let message = format!("`{}` holds heights, which are not read; left out", map.name);
                self.warnings.push(source.line(map.line).warning(message));
            } else {
                material.normal_scale = map.strength;
                material.normal_texture = Some(self.texture(map, image));
            }
        }
        material
    }

    /// The texture of colour and opacity.
    fn base(
        &mut self,
        definition: &Definition,
        source: &Source,
        mode: &mut AlphaMode,
    ) -> Option<usize> {
        let color = definition.diffuse_map.as_ref();
        let image = color.and_then(|map| self.image(map, Curve::Srgb, source));
        let opacity = definition.opacity_map.as_ref();
        let cut = opacity.and_then(|map| self.image(map, Curve::Linear, source));
        let (map, image) = match (image, cut) {
            (None, None) => return None,
            (Some(image), None) => (color?, image),
            (Some(image), Some(cut)) => {
                *mode = AlphaMode::Mask(0.5);
                (color?, Arc::new(image_map::with_alpha(&image, &cut)))
            }
            (None, Some(cut)) => {
                *mode = AlphaMode::Mask(0.5);
                let pixels = vec![[255; 4]; cut.width * cut.height];
                let pixels = nestray_scene::texture::Pixels::Srgb(pixels);
                let white = Image { width: cut.width, height: cut.height, pixels };
                (opacity?, Arc::new(image_map::with_alpha(&white, &cut)))
            }
        };
        Some(self.texture(map, image))
    }

    fn texture(&mut self, map: &Map, image: Arc<Image>) -> usize {
        let texture = map.lay(Texture::new(map.name.clone(), image));
        let same = |old: &Texture| {
            Arc::ptr_eq(&old.image, &texture.image)
                && (old.scale, old.offset, old.wrap)
                    == (texture.scale, texture.offset, texture.wrap)
        };
        self.textures.iter().position(same).unwrap_or_else(|| {
            self.textures.push(texture);
            self.textures.len() - 1
        })
    }

    /// A picture; none, with a warning the first time, if it cannot be read.
    fn image(&mut self, map: &Map, curve: Curve, source: &Source) -> Option<Arc<Image>> {
        let path = source.companion(&map.name);
        let key = (path.to_string_lossy().into_owned(), curve == Curve::Srgb);
        if let Some(known) = self.images.get(&key) {
            return known.clone();
        }
        let image = image::load_image(&path, curve).map_err(|error| {
            let message = format!("texture `{}`: {}; left out", map.name, error.message);
            let spot = Spot { line: map.line, ..source.spot() };
            self.warnings.push(spot.warning(message));
        });
        self.images.entry(key).or_insert(image.ok()).clone()
    }
}
