//! What rays see that hit nothing.

use std::f32::consts::{FRAC_1_PI, PI, TAU};

use glam::Vec3A;
use nestray_scene::light::Background;
use nestray_scene::scene::Scene;
use nestray_scene::texture::Image;

/// The radiance from a unit direction.
pub(crate) fn radiance(scene: &Scene, dir: Vec3A) -> Vec3A {
    match &scene.background {
        Background::Color(color) => Vec3A::from(*color),
        Background::Gradient([below, above], up) => {
            let height = (0.5 + 0.5 * dir.dot(up.normalize_or_zero())).clamp(0.0, 1.0);
            Vec3A::from(*below) * (1.0 - height) + Vec3A::from(*above) * height
        }
        Background::Environment { texture, radians, scale } => {
            let image = &scene.textures[*texture].image;
            image_at(image, place_of(dir, *radians)) * *scale
        }
    }
}

/// Where in a picture of all directions a unit direction is: across and down, in `[0, 1]`.
pub(crate) fn place_of(dir: Vec3A, radians: f32) -> [f32; 2] {
    let around = (libm::atan2f(dir.x, -dir.z) + radians) / TAU + 0.5;
    [around - around.floor(), libm::acosf(dir.y.clamp(-1.0, 1.0)) * FRAC_1_PI]
}

/// The unit direction at a place of a picture of all directions, and the sine of its angle
/// from the top.
pub(crate) fn direction_of([u, v]: [f32; 2], radians: f32) -> (Vec3A, f32) {
    let (sine, cosine) = libm::sincosf((u - 0.5) * TAU - radians);
    let (fall, height) = libm::sincosf(v * PI);
    (Vec3A::new(sine * fall, height, -cosine * fall), fall)
}

/// Neighbours blended; goes on around the sides, not over the poles.
fn image_at(image: &Image, [u, v]: [f32; 2]) -> Vec3A {
    let (width, height) = (image.width, image.height);
    let (x, y) = (u * width as f32 - 0.5, v * height as f32 - 0.5);
    let (left, top) = (x.floor(), y.floor());
    let (a, b) = (x - left, y - top);
    let pixel = |x: f32, y: f32| {
        let column = (x as i64).rem_euclid(width as i64) as usize;
        let row = (y as i64).clamp(0, height as i64 - 1) as usize;
        let [r, g, b, _] = image.pixel(column, row);
        Vec3A::new(r, g, b)
    };
    let upper = pixel(left, top) * (1.0 - a) + pixel(left + 1.0, top) * a;
    let lower = pixel(left, top + 1.0) * (1.0 - a) + pixel(left + 1.0, top + 1.0) * a;
    upper * (1.0 - b) + lower * b
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_and_directions_are_each_others_inverse() {
        for (u, v) in [(0.5, 0.5), (0.1, 0.3), (0.99, 0.9), (0.75, 0.5)] {
            for radians in [0.0, 1.0, -4.0] {
                let (dir, fall) = direction_of([u, v], radians);
                let [x, y] = place_of(dir, radians);
                assert!((x - u).abs() < 1e-5 && (y - v).abs() < 1e-5, "{u} {v}: {x} {y}");
                assert!((fall - libm::sinf(PI * v)).abs() < 1e-6);
            }
        }
        let (turned, _) = direction_of([0.5, 0.5], PI / 2.0);
        assert!((turned - Vec3A::NEG_X).length() < 1e-6, "counter-clockwise from above");
        assert!((direction_of([0.5, 0.5], 0.0).0 - Vec3A::NEG_Z).length() < 1e-6, "the middle");
        assert!((direction_of([0.3, 0.0], 0.0).0 - Vec3A::Y).length() < 1e-6, "the top");
    }
}
