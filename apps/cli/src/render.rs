//! `nestray render`.

mod auto;
pub(crate) mod settings;

use std::path::{Path, PathBuf};

use nestray::io::load::LoadOptions;
use nestray::io::write::{PictureFormat, write_picture};
use nestray::plan::build::Builder;
use nestray::plan::plan::Plan;
use nestray::prelude::DynObject;
use nestray::render::options::Options;
use nestray::render::ray_counts::RayCounts;
use nestray::render::render::{Rendered, render};
use nestray::render::tone_map::{Encoding, ToneMap};
use nestray::scene::scene::Scene;

use crate::args::{Frames, RenderArgs, Talk};
use crate::cache::Cache;
use crate::errors::Failure;
use crate::input::{self, Choice};
use crate::output;
use crate::progress::{Progress, rate};
use crate::stats::Stats;
use crate::stop;

use self::auto::{Auto, Chosen};
pub(crate) use self::settings::RESOLUTION;

pub(crate) fn run(args: &RenderArgs, talk: &Talk) -> Result<(), Failure> {
    let (progress, mut stats) = (Progress::new(talk), Stats::new());
    settings::check(args)?;
    for frame in args.frames.map_or_else(|| vec![None], some_frames) {
        output::check_pictures(
            &args.output.iter().map(|p| numbered(p, frame)).collect::<Vec<_>>(),
        )?;
    }
    if let Some(path) = &args.stats {
        output::check(path)?;
    }
    let choice = input::choose(&args.plan)?;
    let scene =
        stats.stage("load", || input::scene(&args.scene, &LoadOptions::default(), &progress))?;
    let options = settings::options(args, &scene)?;
    options.check(&scene)?;
    stats.set_scene(&scene);
    stop::check()?;
    let (plan, ready, why) = match choice.is_auto() {
        true => {
            let found = stats.stage("plan", || find(args, &scene, &options, progress))?;
            (found.plan, found.ready, Some(found.why))
        }
        false => (choice.plan(&scene)?, None, None),
    };
    stats.set("plan", serde_json::json!({ "name": args.plan, "hash": plan.hash(), "why": why }));
    progress.detail(&format!("plan {}", plan.hash()));
    let mut film = Film { args, progress, stats, scene, plan, ready, choice, options };
    let result = film.run();
    film.stats.write(args.stats.as_deref())?;
    result
}

/// What `--plan auto` means for this scene and picture.
fn find(
    args: &RenderArgs,
    scene: &Scene,
    options: &Options,
    progress: Progress,
) -> Result<Chosen, Failure> {
    let first = args.frames.map(|frames| frames.first);
    let scene = &frame_of(scene, first, args);
    let frames = args.frames.map_or(1, |frames| frames.numbers().count());
    let cache = Cache::open(!args.no_cache, progress);
    Auto { scene, options, frames, asked: args.search, cache, progress }.choose()
}

/// The scene as it is in a frame.
fn frame_of(scene: &Scene, frame: Option<u32>, args: &RenderArgs) -> Scene {
    scene.frame(frame.unwrap_or(0) as f32 / args.fps, args.shutter / args.fps)
}

/// The first and last frame, whose files are looked at before the work begins.
fn some_frames(frames: Frames) -> Vec<Option<u32>> {
    vec![Some(frames.first), Some(frames.last)]
}

/// Everything that does not change from frame to frame.
struct Film<'a> {
    args: &'a RenderArgs,
    progress: Progress,
    stats: Stats,
    scene: Scene,
    plan: Plan,
    /// The objects of the first frame, if they are there already.
    ready: Option<DynObject>,
    choice: Choice,
    options: Options,
}

impl Film<'_> {
    fn run(&mut self) -> Result<(), Failure> {
        let args = self.args;
        let frames: Vec<Option<u32>> =
            args.frames.map_or_else(|| vec![None], |frames| frames.numbers().map(Some).collect());
        let (mut rays, mut result) = (RayCounts::default(), Ok(()));
        let plan = self.plan.clone();
        let mut builder = Builder::new(&plan);
        for (i, &frame) in frames.iter().enumerate() {
            let rendered = match self.frame(frame, &mut builder) {
                Ok(rendered) => rendered,
                Err(failure) => {
                    result = Err(failure);
                    break;
                }
            };
            rays.add(&rendered.rays);
            if !rendered.complete || stop::asked() {
                let what = if rendered.complete { "complete" } else { "not finished" };
                let message =
                    format!("{} of {} pictures written, the last {what}", i + 1, frames.len());
                self.stats.set("complete", rendered.complete && i + 1 == frames.len());
                result = Err(stop::interrupted(message));
                break;
            }
        }
        self.stats.set_rays(&rays);
        if result.is_ok() {
            self.stats.set("complete", true);
        }
        result
    }

    /// Renders and writes one frame.
    fn frame(
        &mut self,
        frame: Option<u32>,
        builder: &mut Builder<'_>,
    ) -> Result<Rendered, Failure> {
        let args = self.args;
        let scene = frame_of(&self.scene, frame, args);
        let choice = &self.choice;
        let world = match self.ready.take() {
            Some(world) => world,
            None => self
                .stats
                .stage("build", || builder.build(&scene).map_err(|error| choice.failure(&error)))?,
        };
        stop::check()?;
        let name = frame.map_or_else(|| "render".into(), |frame| format!("frame {frame}"));
        let watching = self.progress.watch(&name);
        let (options, before) = (&self.options, self.stats.seconds("render"));
        let rendered = self.stats.stage("render", || render(&scene, &world, options, &watching))?;
        drop(watching);
        let seconds = self.stats.seconds("render") - before;
        let shown = self.shown(&rendered);
        for path in &args.output {
            let path = numbered(path, frame);
            self.stats
                .stage("write", || write_picture(&path, &rendered.picture, shown.as_deref()))?;
            let (width, height) = (rendered.picture.width, rendered.picture.height);
            let rate = rate(rendered.rays.total().cast, seconds);
            self.progress.note(&format!(
                "{}: {width} x {height} pixels, {seconds:.2} s, {rate}",
                path.display()
            ));
        }
        Ok(rendered)
    }

    /// The bytes of a picture to look at, if one is asked for.
    fn shown(&self, rendered: &Rendered) -> Option<Vec<u8>> {
        let is_png = |path: &PathBuf| matches!(PictureFormat::of(path), Ok(PictureFormat::Png));
        let curve = settings::curve(self.args);
        // As the published pictures of the standard scenes were made.
        let encoding = if self.args.spd { Encoding::Linear } else { Encoding::Srgb };
        let tone_map = ToneMap { curve, exposure: self.args.exposure, encoding };
        self.args.output.iter().any(is_png).then(|| tone_map.bytes(&rendered.picture))
    }
}

/// The file of a frame: its number stands for a run of `#` in the name, or before the ending.
fn numbered(path: &Path, frame: Option<u32>) -> PathBuf {
    let Some(frame) = frame else { return path.to_owned() };
    let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
    let name = match name.find('#') {
        Some(at) => {
            let width = name[at..].bytes().take_while(|&byte| byte == b'#').count();
            format!("{}{frame:0width$}{}", &name[..at], &name[at + width..])
        }
        None => match name.rsplit_once('.') {
            Some((stem, ending)) => format!("{stem}.{frame:04}.{ending}"),
            None => format!("{name}.{frame:04}"),
        },
    };
    path.with_file_name(name)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn frames_get_files_of_their_own() {
        let check = |path, expected| {
            assert_eq!(numbered(Path::new(path), Some(7)), PathBuf::from(expected));
        };
        check("a/film.png", "a/film.0007.png");
        check("a.b/film", "a.b/film.0007");
        check("film_##.exr", "film_07.exr");
        check("#.exr", "7.exr");
        assert_eq!(numbered(Path::new("a.png"), None), PathBuf::from("a.png"));
    }
}
