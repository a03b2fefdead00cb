use glam::{Affine3A, Quat, Vec3};

use super::outline::Outline;
use super::*;
use crate::directions::{SPHERE_DENSITY, on_sphere};
use crate::sampler::{Sampler, Set};

/// Outlines of every kind.
fn outlines() -> Vec<(&'static str, Outline)> {
    let turned = Affine3A::from_scale_rotation_translation(
        Vec3::new(1.0, 2.0, -0.5),
        Quat::from_xyzw(0.1, 0.5, -0.3, 0.7).normalize(),
        Vec3::new(0.2, -0.1, 0.3),
    );
    let sides = [Vec3A::new(1.0, 0.2, 0.0), Vec3A::new(-0.3, 1.0, 0.4)];
    let disk = Outline::disk(Vec3A::ZERO, Vec3A::new(1.0, 1.0, 2.0), 0.8, &turned);
    vec![
        ("triangle", Outline::Triangle { corner: Vec3A::ZERO, sides, mirrored: false }),
        ("parallelogram", Outline::parallelogram(Vec3A::ZERO, sides, &turned)),
        ("ellipse", disk.expect("it has a normal")),
        ("sphere", Outline::sphere(Vec3A::ZERO, 0.7, &Affine3A::IDENTITY)),
        ("ellipsoid", Outline::sphere(Vec3A::ZERO, 0.7, &turned)),
    ]
}

#[test]
fn places_on_lights_are_as_dense_as_they_say() {
    // The mean of 1 / density over picked places is the solid angle, and so is the share of
    // all directions that meet the outline; here both are compared through a smooth weight.
    for (name, outline) in outlines() {
        for at in [Vec3A::new(0.3, 0.4, 3.0), Vec3A::new(-2.0, 1.5, 1.0)] {
            let weight = |dir: Vec3A| f64::from(1.0 + dir.x + 0.5 * dir.y);
            let samples = 1 << 14;
            let mut picked = 0.0;
            for i in 0..samples {
                let [a, b, ..] = Sampler::new(4, i, 1).four(Set::Eye);
                let Some(place) = outline.sample(at, [a, b]) else { continue };
                let again = outline.density(at, place.position, place.normal);
                assert!(
                    (again - place.density).abs() < 2e-3 * again,
                    "{name}: {again} {}",
                    place.density
                );
                // Only the near side of what is round can be seen.
                let round = matches!(outline, Outline::Sphere { .. } | Outline::Ellipsoid(_));
                if !round || place.normal.dot(at - place.position) > 0.0 {
                    let dir = (place.position - at).normalize();
                    picked += weight(dir) / f64::from(place.density) / f64::from(samples);
                }
            }
            let tries = 1 << 20;
            let mut met = 0.0;
            for i in 0..tries {
                let [a, b, ..] = Sampler::new(5, i, 1).four(Set::Eye);
                let dir = on_sphere([a, b]);
                if meets(&outline, at, dir) {
                    met += weight(dir) / f64::from(SPHERE_DENSITY) / f64::from(tries);
                }
            }
            assert!((picked - met).abs() < 0.015 * met, "{name} from {at}: {picked} {met}");
        }
    }
}

/// Whether a ray meets an outline; written for reading.
fn meets(outline: &Outline, at: Vec3A, dir: Vec3A) -> bool {
    let flat = |corner: Vec3A, [a, b]: [Vec3A; 2]| {
        let normal = a.cross(b);
        let t = (corner - at).dot(normal) / dir.dot(normal);
        let p = at + dir * t - corner;
        let square = normal.length_squared();
        (t > 0.0).then(|| [p.cross(b).dot(normal) / square, a.cross(p).dot(normal) / square])
    };
    match *outline {
        Outline::Triangle { corner, sides, .. } => {
            flat(corner, sides).is_some_and(|[u, v]| u >= 0.0 && v >= 0.0 && u + v <= 1.0)
        }
        Outline::Parallelogram { corner, sides, .. } => flat(corner, sides)
            .is_some_and(|[u, v]| (0.0..=1.0).contains(&u) && (0.0..=1.0).contains(&v)),
        Outline::Ellipse { center, axes, .. } => {
            flat(center, axes).is_some_and(|[u, v]| u * u + v * v <= 1.0)
        }
        Outline::Sphere { center, radius } => {
            let way = center - at;
            (way - dir * way.dot(dir)).length() <= radius && way.dot(dir) > 0.0
        }
        Outline::Ellipsoid(to) => {
            let from = to.inverse();
            let (at, dir) = (from.transform_point3a(at), from.transform_vector3a(dir).normalize());
            meets(&Outline::Sphere { center: Vec3A::ZERO, radius: 1.0 }, at, dir)
        }
    }
}
