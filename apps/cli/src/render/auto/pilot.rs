//! A small picture of the same view: what a sample takes, and which rays there are.

use std::time::Instant;

use nestray::prelude::{DynObject, Scene};
use nestray::render::options::{Crop, Options};
use nestray::render::ray_counts::RayCounts;
use nestray::render::render::render;
use nestray::render::watch::Watch;

use crate::errors::Failure;
use crate::stop;

/// The part of the work of all threads that a pilot may do, and the least and most samples of one.
const PART: f64 = 1.0 / 512.0;
const LEAST: f64 = 256.0;
const MOST: f64 = 16_384.0;
/// Most samples of a pixel: neighbours matter as well.
const SAMPLES: u32 = 16;

/// A small picture, rendered by one thread.
#[derive(Debug)]
pub(super) struct Pilot {
    options: Options,
}

/// Ends with the program.
struct Interrupted;

impl Watch for Interrupted {
    fn stop(&self) -> bool {
        stop::asked()
    }
}

impl Pilot {
    /// For pictures of so many samples, of which each of several threads does a share.
    pub(super) fn new(options: &Options, samples: u64, threads: usize) -> Self {
        let part = samples as f64 * PART / threads.max(1) as f64;
        let each = options.samples.min(SAMPLES);
        let pixels = part.clamp(LEAST, MOST) / f64::from(each);
        let Crop { from, to } = options.window();
        let window = f64::from(to[0] - from[0]) * f64::from(to[1] - from[1]);
        let scale = (pixels / window).sqrt().min(1.0);
        let small = |x: u32| f64::from(x) * scale;
        let resolution = options.resolution.map(|x| (small(x).round() as u32).max(1));
        let from: [u32; 2] = [0, 1].map(|i| (small(from[i]) as u32).min(resolution[i] - 1));
        let to = [0, 1].map(|i| (small(to[i]).ceil() as u32).clamp(from[i] + 1, resolution[i]));
        let crop = Some(Crop { from, to });
        let options = options.clone();
        Self {
            options: Options {
                resolution,
                crop,
                samples: each,
                threads: 1,
                layers: false,
                ..options
            },
        }
    }

    /// Renders a few samples, so that whatever is made once is there. The picture has use for it too.
    pub(super) fn warm(&self, scene: &Scene, world: &DynObject) -> Result<(), Failure> {
        /// Pixels across and down, at most.
        const PIXELS: u32 = 8;
        let resolution = self.options.resolution.map(|x| x.min(PIXELS));
        let options = Options { resolution, crop: None, samples: 1, ..self.options.clone() };
        render(scene, world, &options, &Interrupted)?;
        Ok(())
    }

    /// What samples take with two plans, by the shorter of two turns each.
    pub(super) fn in_turns(
        &self,
        scene: &Scene,
        worlds: [&DynObject; 2],
    ) -> Result<[f64; 2], Failure> {
        let mut least = [f64::INFINITY; 2];
        for _ in 0..2 {
            for (least, world) in least.iter_mut().zip(worlds) {
                *least = least.min(self.run(scene, world)?.0);
            }
        }
        Ok(least)
    }

    /// Seconds that a sample takes, and the rays of all.
    pub(super) fn run(
        &self,
        scene: &Scene,
        world: &DynObject,
    ) -> Result<(f64, RayCounts), Failure> {
        let begun = Instant::now();
        let rays = render(scene, world, &self.options, &Interrupted)?.rays;
        Ok((begun.elapsed().as_secs_f64() / self.samples() as f64, rays))
    }

    /// How many it has.
    pub(super) fn samples(&self) -> u64 {
        let Crop { from, to } = self.options.window();
        let [width, height] = [0, 1].map(|i| u64::from(to[i] - from[i]));
        width * height * u64::from(self.options.samples)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_pilot_is_a_small_part_of_the_picture() {
        let check = |resolution, crop, samples: u32, expected: std::ops::Range<u64>| {
            let options = Options { resolution, crop, samples, ..Options::default() };
            let Crop { from, to } = options.window();
            let all = u64::from(to[0] - from[0]) * u64::from(to[1] - from[1]) * u64::from(samples);
            let pilot = Pilot::new(&options, all, 2);
            assert!(expected.contains(&pilot.samples()), "{}", pilot.samples());
            let scene = nestray::scene::procedural::generate("balls", Some(1));
            assert!(pilot.options.check(&scene.expect("there is one")).is_ok());
        };
        check([640, 480], None, 16, 4000..6000);
        check([4096, 4096], None, 1024, 16_000..17_500);
        check([640, 480], None, 1, 256..330);
        check([1, 1], None, 1, 1..2);
        check([65_536, 1], None, 4, 256..9000);
        check([640, 480], Some(Crop { from: [639, 479], to: [640, 480] }), 500, 16..17);
        check([640, 480], Some(Crop { from: [320, 0], to: [640, 480] }), 64, 8000..12_000);
    }
}
