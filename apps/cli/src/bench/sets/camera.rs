//! Rays of a picture, and the light that shadow rays go to.

use nestray::core::aabb::Aabb;
use nestray::prelude::{Ray, RayKind, Scene, Vec3A};
use nestray::scene::light::LightKind;

use super::random::Random;

/// Pixels along a side of a tile.
const TILE: u32 = 16;

/// Pixels across and down, about 4 to 3, whole tiles, at most `count`.
fn resolution(count: usize) -> [u32; 2] {
    let tiles = (count / (TILE * TILE) as usize).max(1);
    let across = ((tiles as f64 * 4.0 / 3.0).sqrt() as usize).max(1);
    [across as u32 * TILE, (tiles / across) as u32 * TILE]
}

/// Through a point of each pixel of a picture, tile after tile; within a tile neighbours stay near
/// one another: first in twos, then in fours of those, and so on.
pub(super) fn tiles(scene: &Scene, count: usize, seed: u64) -> Vec<Ray> {
    let [width, height] = resolution(count);
    let camera = scene.cameras.first().cloned().unwrap_or_default();
    let (view, mut random) = (camera.view(width as f32 / height as f32), Random::new(seed));
    let mut rays = Vec::new();
    for (row, column) in (0..height / TILE).flat_map(|y| (0..width / TILE).map(move |x| (y, x))) {
        for within in 0..TILE * TILE {
            let x = (column * TILE + every_second_bit(within)) as f32 + random.part();
            let y = (row * TILE + every_second_bit(within >> 1)) as f32 + random.part();
            let (across, up) = (x / width as f32 * 2.0 - 1.0, 1.0 - y / height as f32 * 2.0);
            let (origin, dir) = view.ray(across, up, [0.0; 2]);
            rays.push(Ray::new(origin, dir, RayKind::Camera));
        }
    }
    rays.truncate(count);
    rays
}

/// Bits 0, 2, 4 and 6, moved together.
fn every_second_bit(of: u32) -> u32 {
    (0..4).map(|i| (of >> (2 * i) & 1) << i).sum()
}

/// The first light of the scene that is at a point; if there is none, one beside the eye if that
/// is inside, else above, over the left shoulder.
pub(super) fn light(scene: &Scene, bounds: Aabb) -> Vec3A {
    let points = scene.lights.iter().filter_map(|light| match light.kind {
        LightKind::Point { position, .. } | LightKind::Spot { position, .. } => Some(position),
        LightKind::Directional { .. } => None,
    });
    if let Some(light) = points.into_iter().next() {
        return light;
    }
    let camera = scene.cameras.first().cloned().unwrap_or_default();
    let back = -camera.forward.normalize_or(Vec3A::NEG_Z);
    let right = camera.up.cross(back).normalize_or(Vec3A::X);
    let (up, size) = (back.cross(right), bounds.size().length());
    let eye = camera.from;
    let inside = eye.cmpge(bounds.min).all() && eye.cmple(bounds.max).all();
    if inside {
        return eye + (right + up) * (0.01 * size);
    }
    bounds.center() + (back * 0.75 + up - right * 0.45).normalize() * size
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tiles_fill_the_picture() {
        assert_eq!(resolution(486_400), [800, 608]);
        for count in [256, 1000, 65_536, 486_400] {
            let [width, height] = resolution(count);
            assert!((width * height) as usize <= count && width * height * 2 > count as u32);
        }
        let mut seen: Vec<_> =
            (0..256).map(|i| [every_second_bit(i), every_second_bit(i >> 1)]).collect();
        assert_eq!(seen[..4], [[0, 0], [1, 0], [0, 1], [1, 1]]);
        seen.sort_unstable();
        seen.dedup();
        assert_eq!(seen.len(), 256);
    }
}
