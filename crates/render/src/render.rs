//! The whole of it: tiles shared out to threads, waves of rays, pixels.

use std::ops::Range;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

use nestray_core::counters::Counters;
use nestray_core::object::Object;
use nestray_core::scratch::Scratch;
use nestray_core::simd::Level;
use nestray_scene::check::SceneError;
use nestray_scene::picture::Picture;
use nestray_scene::scene::Scene;
use nestray_scene::surfaces::Surfaces;

use crate::eye::{Eye, Seen, Start};
use crate::film::{Film, Keep, TileFilm};
use crate::filter::Filter;
use crate::heat;
use crate::integrator::Integrate;
use crate::integrator::ambient_occlusion::AmbientOcclusion;
use crate::integrator::cost::Cost;
use crate::integrator::path::{Direct, Path, Room};
use crate::integrator::whitted::Whitted;
use crate::light_sampling::Lights;
use crate::options::{Integrator, Options, RenderError};
use crate::ray_counts::RayCounts;
use crate::sampler::{Sampler, Set, fours as sample};
use crate::tile::{Tile, tiles};
use crate::tracer::Tracer;
use crate::watch::{Progress, Watch};

/// What came of a render.
#[derive(Clone, Debug)]
pub struct Rendered {
    /// The picture: the main layer, then, as asked for, `cost`, `albedo`, `normal` (towards
    /// the eye), `depth` (distance from where the ray began, infinite for nothing) and
    /// `geometry` (−1 for nothing), the last two of the pixel's first sample.
    pub picture: Picture,
    /// How many rays there were.
    pub rays: RayCounts,
    /// What they did, if [`Integrator::Cost`] counted it.
    pub counters: Counters,
    /// Whether every sample was taken. Pixels without any are black.
    pub complete: bool,
}

/// Renders a frame of a scene, its nodes resolved ([`Scene::frame`]); `world` holds its
/// geometries under their numbers, and its instances under theirs.
///
/// The same scene and options give the same picture to the bit, whatever the nest, the
/// threads, the tiles, the batches and the vector instructions.
///
/// # Errors
/// If the scene does not pass [`check_names`](Scene::check_names), the options make no sense, or
/// threads cannot be started.
///
/// # Panics
/// If `world` reports hits that are not of the scene.
pub fn render(
    scene: &Scene,
    world: &dyn Object,
    options: &Options,
    watch: &dyn Watch,
) -> Result<Rendered, RenderError> {
    render_by(scene, world, options, watch, Direct::Both)
}

/// [`render`], with a say in how paths find lights.
pub(crate) fn render_by(
    scene: &Scene,
    world: &dyn Object,
    options: &Options,
    watch: &dyn Watch,
    direct: Direct,
) -> Result<Rendered, RenderError> {
    scene.check_names()?;
    options.check(scene)?;
    let surfaces = Surfaces::new(scene).map_err(SceneError::from)?;
    let cost = options.integrator == Integrator::Cost;
    let keep = Keep { layers: options.layers, cost };
    let film = Film::new(options.window(), options.filter == Filter::Corners, keep);
    let tiles = tiles(film.window(), options.shuffle);
    let pixels: u64 = tiles.iter().map(|tile| tile.pixels() as u64).sum();
    let job = Job {
        world,
        surfaces: &surfaces,
        options,
        eye: Eye::new(scene, options),
        lights: (options.integrator == Integrator::Path).then(|| Lights::new(&surfaces)),
        direct,
        progress: Progress::new(watch, pixels * u64::from(options.samples)),
        tiles,
        next: AtomicUsize::new(0),
        done: Mutex::new((film, RayCounts::default(), Counters::default())),
    };
    job.run()?;
    let complete = job.progress.is_complete();
    let (film, rays, counters) = job.done.into_inner().expect("no thread panicked");
    let mut picture = film.develop();
    if cost {
        heat::paint(&mut picture);
    }
    Ok(Rendered { picture, rays, counters, complete })
}

/// A render under way, shared by its threads.
struct Job<'a> {
    world: &'a dyn Object,
    surfaces: &'a Surfaces<'a>,
    options: &'a Options,
    eye: Eye,
    /// For paths only.
    lights: Option<Lights<'a>>,
    direct: Direct,
    progress: Progress<'a>,
    tiles: Vec<Tile>,
    /// The first tile that nobody has taken.
    next: AtomicUsize,
    done: Mutex<(Film, RayCounts, Counters)>,
}

impl Job<'_> {
    fn run(&self) -> Result<(), RenderError> {
        // Where there are no threads, one can still render.
        if self.options.threads == 1 {
            self.work();
            return Ok(());
        }
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(self.options.threads)
            .build()
            .map_err(|error| RenderError::Threads(error.to_string()))?;
        pool.broadcast(|_| self.work());
        Ok(())
    }

    /// What one thread does: takes tiles until there are none.
    fn work(&self) {
        let scratch = match (self.options.integrator, self.options.level) {
            (Integrator::Cost, _) => Scratch::counting(),
            (_, Some(level)) => Scratch::with_level(level),
            (_, None) => Scratch::new(),
        };
        let mut hand = Hand {
            tracer: Tracer::new(self.world, self.surfaces, scratch, self.options.wave),
            integrator: self.integrator(),
            making: Making::default(),
            starts: Vec::new(),
            seen: Vec::new(),
        };
        let mut film = TileFilm::default();
        while let Some(&tile) = self.tiles.get(self.next.fetch_add(1, Ordering::Relaxed)) {
            if self.progress.stopped() {
                break;
            }
            film.begin(tile);
            self.tile(&mut hand, &mut film);
            self.done.lock().expect("no thread panicked").0.put(&film);
        }
        let mut done = self.done.lock().expect("no thread panicked");
        done.1.add(&hand.tracer.counts);
        done.2.add(&hand.tracer.scratch.counters);
    }

    fn integrator(&self) -> Box<dyn Integrate + '_> {
        let max_depth = self.options.max_depth;
        match self.options.integrator {
            Integrator::Whitted(whitted) => Box::new(Whitted::new(whitted.tree, max_depth)),
            Integrator::Path => Box::new(Path {
                lights: self.lights.as_ref().expect("they were made ready"),
                max_depth,
                most: self.options.clamp.unwrap_or(f32::INFINITY),
                direct: self.direct,
                room: Room::default(),
            }),
            Integrator::AmbientOcclusion { radius } => {
                Box::new(AmbientOcclusion { radius: radius.unwrap_or(f32::INFINITY) })
            }
            Integrator::Cost => Box::new(Cost),
        }
    }

    /// Renders a tile wave by wave, pixel after pixel, all samples of each: neighbours together,
    /// so that their rays are packets.
    fn tile(&self, hand: &mut Hand<'_>, film: &mut TileFilm) {
        let Hand { tracer, integrator, making, starts, seen } = hand;
        let tile = film.tile;
        let samples = self.options.samples as usize;
        let all = tile.pixels() * samples;
        // Rays that are traced one at a time are made as many at a time as usual.
        let wave = match self.options.wave {
            1 => Options::default().wave,
            wave => wave,
        };
        let wave = integrator.starts(wave);
        tile.order(&mut making.pixels);
        let mut done = 0;
        while done < all && !self.progress.stopped() {
            let end = done.saturating_add(wave).min(all);
            self.start(making, tracer.scratch.level, (tile, done..end), starts);
            let before = tracer.counts.total().cast;
            integrator.trace(tracer, starts, seen);
            for (i, (start, seen)) in (done..).zip(starts.iter().zip(&*seen)) {
                film.add(making.pixels[i / samples] as usize, seen, start.weight);
            }
            self.progress.add((end - done) as u64, tracer.counts.total().cast - before);
            done = end;
        }
    }

    /// The rays of some samples of a tile.
    fn start(
        &self,
        Making { pixels, samplers, fours }: &mut Making,
        level: Level,
        (tile, which): (Tile, Range<usize>),
        starts: &mut Vec<Start>,
    ) {
        let samples = self.options.samples as usize;
        let pixel = |i: usize| tile.pixel(pixels[i / samples] as usize);
        samplers.clear();
        let sampler = |i: usize| self.eye.sampler(pixel(i), (i % samples) as u32);
        samplers.extend(which.clone().map(sampler));
        sample(level, Set::Eye, samplers.iter(), fours);
        starts.clear();
        let numbers = samplers.iter().zip(&*fours);
        starts.extend(
            which
                .zip(numbers)
                .map(|(i, (sampler, &four))| self.eye.start(pixel(i), *sampler, four)),
        );
    }
}

/// What rays of a tile are made from.
#[derive(Default)]
struct Making {
    /// The pixels in order.
    pixels: Vec<u32>,
    /// Those of a wave, and their numbers.
    samplers: Vec<Sampler>,
    fours: Vec<[f32; 4]>,
}

/// What a thread works with.
struct Hand<'a> {
    tracer: Tracer<'a>,
    integrator: Box<dyn Integrate + 'a>,
    making: Making,
    /// Room for a wave.
    starts: Vec<Start>,
    /// What each of them saw.
    seen: Vec<Seen>,
}

#[cfg(test)]
mod tests;
