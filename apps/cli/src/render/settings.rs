//! From the command line to the options of a render.

use std::path::PathBuf;

use nestray::io::write::PictureFormat;
use nestray::plan::error::nearest;
use nestray::render::filter::Filter;
use nestray::render::options::{Crop, Integrator, Options, WhittedOptions};
use nestray::render::tone_map::{Curve, ToneMap};
use nestray::scene::scene::Scene;

use crate::args::{CurveName, FilterName, IntegratorName, RenderArgs};
use crate::errors::Failure;

/// Pixels across and down if nobody says otherwise.
pub(crate) const RESOLUTION: [u32; 2] = [640, 480];

/// Refuses words that contradict each other.
pub(super) fn check(args: &RenderArgs) -> Result<(), Failure> {
    if args.spd && args.integrator != IntegratorName::Whitted {
        return Err(Failure::usage("--spd: goes with --integrator whitted only"));
    }
    Ok(())
}

pub(super) fn options(args: &RenderArgs, scene: &Scene) -> Result<Options, Failure> {
    let camera = camera(args.camera.as_deref(), scene)?;
    let mut options = if args.spd {
        Options::standard_test()
    } else {
        Options {
            resolution: scene.cameras.get(camera).and_then(|c| c.resolution).unwrap_or(RESOLUTION),
            samples: args.spp,
            integrator: integrator(args),
            filter: filter(args.filter),
            ..Options::default()
        }
    };
    options.resolution = args.resolution.unwrap_or(options.resolution);
    options.max_depth = args.max_depth.unwrap_or(options.max_depth);
    options.crop = args.crop.map(|[x0, x1, y0, y1]| Crop { from: [x0, y0], to: [x1, y1] });
    let keeps = |path| matches!(PictureFormat::of(path), Ok(PictureFormat::Exr));
    Ok(Options {
        clamp: clamp(args),
        seed: args.seed,
        wave: args.batch,
        threads: args.threads,
        camera,
        layers: args.output.iter().any(|path| keeps(path)),
        ..options
    })
}

/// Times white that a picture to look at keeps of one path. Fireflies are a hundred times as bright
/// and more; what a mirror or a lens gathers of a lit surface is rarely ten.
pub(crate) const WHITES: f32 = 10.0;

/// What is asked for, or ten times white where only bytes to look at are kept.
fn clamp(args: &RenderArgs) -> Option<f32> {
    let is_png = |path: &PathBuf| matches!(PictureFormat::of(path), Ok(PictureFormat::Png));
    let usual = if args.output.iter().all(is_png) { WHITES } else { 0.0 };
    let whites = args.clamp.unwrap_or(usual);
    let shown = ToneMap { exposure: args.exposure, ..ToneMap::default() };
    let limit = whites / shown.gain();
    (whites > 0.0 && limit > 0.0 && limit.is_finite()).then_some(limit)
}

/// The camera of that number or name; the first if none is asked for.
pub(crate) fn camera(text: Option<&str>, scene: &Scene) -> Result<usize, Failure> {
    let Some(text) = text else { return Ok(0) };
    if let Ok(number) = text.parse() {
        return Ok(number);
    }
    scene.cameras.iter().position(|camera| camera.name == text).ok_or_else(|| {
        let failure = Failure::usage(format!("--camera: no camera is called {text:?}"));
        match nearest(text, scene.cameras.iter().map(|camera| camera.name.as_str())) {
            Some(near) => failure.hint(format!("did you mean \"{near}\"?")),
            None => failure,
        }
    })
}

fn integrator(args: &RenderArgs) -> Integrator {
    match args.integrator {
        IntegratorName::Whitted => Integrator::Whitted(WhittedOptions::default()),
        IntegratorName::Path => Integrator::Path,
        IntegratorName::Ao => Integrator::AmbientOcclusion { radius: args.radius },
        IntegratorName::Cost => Integrator::Cost,
    }
}

fn filter(name: FilterName) -> Filter {
    match name {
        FilterName::Box => Filter::Box,
        FilterName::Tent => Filter::Tent,
        FilterName::Gaussian => Filter::Gaussian,
        FilterName::Mitchell => Filter::Mitchell,
    }
}

pub(super) fn curve(args: &RenderArgs) -> Curve {
    match args.tonemap {
        CurveName::None => Curve::None,
        CurveName::Reinhard => Curve::Reinhard,
        CurveName::Aces => Curve::Aces,
        CurveName::Filmic => Curve::Filmic,
    }
}
