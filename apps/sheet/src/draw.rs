//! One picture of one file, or of all meshes of a folder together.

use std::path::{Path, PathBuf};

use nestray::prelude::*;
use nestray::render::tone_map::{Encoding, ToneMap};

/// How a picture is made.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Manner {
    /// Whitted's model by the rules of the standard scenes.
    Standard,
    /// All light, with so many samples.
    Path(u32),
    /// How open the surroundings are, with so many samples: for rooms, whose lights are not in
    /// their meshes.
    Open(u32),
    /// Whitted's model, with so many samples: quick, and without noise.
    Plain(u32),
}

/// The picture of a scene, three bytes a pixel.
pub(crate) fn draw(scene: &Scene, manner: Manner, [width, height]: [usize; 2]) -> Vec<u8> {
    let (integrator, samples) = match manner {
        Manner::Standard => return smaller(&standard(scene), [width, height]),
        Manner::Path(samples) => (Integrator::Path, samples),
        Manner::Open(samples) => {
            let size = scene.bounds().size().max_element();
            (Integrator::AmbientOcclusion { radius: Some(0.15 * size) }, samples)
        }
        Manner::Plain(samples) => (Integrator::Whitted(Default::default()), samples),
    };
    let resolution = [width as u32, height as u32];
    // What the program does for files to look at.
    let clamp = Some(10.0);
    let options = Options { resolution, integrator, samples, clamp, ..Options::default() };
    rendered(scene, &options, ToneMap::default())
}

/// The 512 × 512 pixels that the published pictures have.
fn standard(scene: &Scene) -> image::RgbImage {
    let options = Options::standard_test();
    let tone_map = ToneMap { encoding: Encoding::Linear, ..ToneMap::default() };
    let [width, height] = options.resolution;
    let bytes = rendered(scene, &options, tone_map);
    image::RgbImage::from_raw(width, height, bytes).expect("three bytes a pixel")
}

/// A picture at another size.
pub(crate) fn smaller(picture: &image::RgbImage, [width, height]: [usize; 2]) -> Vec<u8> {
    let filter = image::imageops::FilterType::CatmullRom;
    image::imageops::resize(picture, width as u32, height as u32, filter).into_raw()
}

fn rendered(scene: &Scene, options: &Options, tone_map: ToneMap) -> Vec<u8> {
    let scene = scene.frame(0.0, 0.0);
    let plan = single("auto", Default::default(), &scene).expect("`auto` is a technique");
    let world = build(&plan, &scene).expect("readers make sound scenes");
    let rendered = render(&scene, &world, options, &Unwatched).expect("the options make sense");
    tone_map.bytes(&rendered.picture)
}

/// Reads a file; says what was odd about it.
pub(crate) fn read(path: &Path) -> Result<Scene, String> {
    let loaded = load(path, &LoadOptions::default()).map_err(|error| error.to_string())?;
    for warning in &loaded.warnings {
        eprintln!("{warning}");
    }
    Ok(loaded.scene)
}

/// All meshes of a folder in one scene of plaster, seen through `camera`.
pub(crate) fn together(files: &[PathBuf], camera: Camera) -> Result<Scene, String> {
    let mut all = Scene::new();
    let plaster = all.add_material(Material::default());
    for path in files {
        let options = LoadOptions { complete: false, ..LoadOptions::default() };
        let loaded = load(path, &options).map_err(|error| error.to_string())?;
        for geometry in loaded.scene.geometries {
            all.add(Geometry { material: plaster, ..geometry });
        }
    }
    all.cameras.push(camera);
    Ok(all)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The folder of real scenes, if it is there.
    fn scenes() -> Option<PathBuf> {
        let named = std::env::var_os("NESTRAY_SCENES").map(PathBuf::from);
        let usual = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/scenes");
        let folder = named.unwrap_or(usual);
        if folder.is_dir() {
            return Some(folder);
        }
        eprintln!("skipped: there is no folder {}", folder.display());
        None
    }

    /// By how many bytes the pixels of two pictures differ: the median, and which part of
    /// them by more than 25.
    fn difference(a: &image::RgbImage, b: &image::RgbImage) -> (u8, f64) {
        let most = |(a, b): (&image::Rgb<u8>, &image::Rgb<u8>)| {
            (0..3).map(|i| a[i].abs_diff(b[i])).max().unwrap_or(0)
        };
        let mut all: Vec<u8> = a.pixels().zip(b.pixels()).map(most).collect();
        all.sort_unstable();
        let far = all.iter().filter(|&&by| by > 25).count();
        (all[all.len() / 2], far as f64 / all.len() as f64)
    }

    #[test]
    fn standard_scenes_look_as_published() {
        let Some(folder) = scenes() else { return };
        for name in ["mount", "teapot", "tetra", "tree"] {
            let scene = read(&folder.join(format!("nff/{name}.nff"))).expect("it is sound");
            let published = image::open(folder.join(format!("nff/reference/{name}.png")));
            let published = published.expect("it is a picture").into_rgb8();
            let (median, far) = difference(&standard(&scene), &published);
            eprintln!("{name}: median {median}, {far:.3} of the pixels by more than 25");
            assert!(median <= 2 && far < 0.1, "{name}: median {median}, {far} far off");
        }
    }
}
