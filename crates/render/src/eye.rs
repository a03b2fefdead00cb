//! Rays from the eye.

use glam::Vec3A;
use nestray_core::ray::{Ray, RayKind};
use nestray_scene::camera::View;
use nestray_scene::group::Motion;
use nestray_scene::scene::Scene;

use crate::directions::in_disk;
use crate::filter::{Filter, Places};
use crate::options::Options;
use crate::sampler::{Sampler, Set};

/// The camera, made ready for one picture.
pub(crate) struct Eye {
    view: View,
    resolution: [u32; 2],
    /// None for the corners of pixels.
    places: Option<Places>,
    lens: bool,
    moving: bool,
    seed: u64,
    first: u32,
}

/// The beginning of a path.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Start {
    pub(crate) ray: Ray,
    pub(crate) sampler: Sampler,
    /// What it counts for in its pixel.
    pub(crate) weight: f32,
}

impl Eye {
    pub(crate) fn new(scene: &Scene, options: &Options) -> Self {
        let camera = &scene.cameras[options.camera];
        let [width, height] = options.resolution;
        let places = (options.filter != Filter::Corners).then(|| Places::new(options.filter));
        let moves = |group: &nestray_scene::group::Group| {
            group.places.iter().any(|place| matches!(place.motion, Motion::Keys(_)))
        };
        Self {
            view: camera.view(width as f32 / height as f32),
            resolution: options.resolution,
            places,
            lens: camera.aperture > 0.0,
            moving: scene.groups.iter().any(moves),
            seed: options.seed,
            first: options.first_sample,
        }
    }

    /// The numbers of a sample of a pixel, or of a corner: the one above and left of the pixel.
    pub(crate) fn sampler(&self, [column, row]: [u32; 2], sample: u32) -> Sampler {
        // One more a row than pixels, for the last corner.
        let pixel = row.wrapping_mul(self.resolution[0] + 1).wrapping_add(column);
        Sampler::new(pixel, self.first + sample, self.seed)
    }

    /// The ray of a sample, given the numbers of its [`Set::Eye`].
    pub(crate) fn start(
        &self,
        [column, row]: [u32; 2],
        sampler: Sampler,
        [u, v, lens_u, lens_v]: [f32; 4],
    ) -> Start {
        let [width, height] = self.resolution;
        let (at, weight) = match &self.places {
            None => ([0.0, 0.0], 1.0),
            Some(places) => {
                let ((x, a), (y, b)) = (places.pick(u), places.pick(v));
                ([x + 0.5, y + 0.5], a * b)
            }
        };
        let x = (column as f32 + at[0]) / width as f32 * 2.0 - 1.0;
        let y = 1.0 - (row as f32 + at[1]) / height as f32 * 2.0;
        let lens = if self.lens { in_disk([lens_u, lens_v]) } else { [0.0; 2] };
        let (origin, dir) = self.view.ray(x, y, lens);
        let ray = Ray::new(origin, dir, RayKind::Camera);
        let ray = if self.moving { ray.at_time(sampler.four(Set::Time)[0]) } else { ray };
        Start { ray, sampler, weight }
    }
}

/// What one path saw.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Seen {
    /// Radiance.
    pub(crate) color: Vec3A,
    /// Of the first surface: its reflectance.
    pub(crate) albedo: Vec3A,
    /// Of the first surface: its normal, towards the eye.
    pub(crate) normal: Vec3A,
    /// Of the first surface: its distance, infinite if there is none.
    pub(crate) depth: f32,
    /// Of the first surface: its geometry, −1 if there is none.
    pub(crate) geometry: f32,
    /// What the ray from the eye cost, if that was counted.
    pub(crate) cost: f32,
}

impl Seen {
    pub(crate) const NOTHING: Self = Self {
        color: Vec3A::ZERO,
        albedo: Vec3A::ZERO,
        normal: Vec3A::ZERO,
        depth: f32::INFINITY,
        geometry: -1.0,
        cost: 0.0,
    };
}
