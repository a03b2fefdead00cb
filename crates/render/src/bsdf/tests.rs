use super::*;
use crate::directions::{SPHERE_DENSITY, cosine_weighted, on_sphere};
use crate::sampler::{Sampler, Set};

fn look(base: f32, metallic: f32, roughness: f32, transmission: f32, ior: f32) -> Look {
    Look {
        base: Vec3A::splat(base),
        metallic,
        roughness,
        emission: Vec3A::ZERO,
        transmission,
        ior,
        normal: Vec3A::Z,
        tint: Vec3A::ONE,
        material: 0,
    }
}

/// What it looks like, and whether it is seen from its front.
type Side = (Look, bool);

/// Surfaces of every kind, by name.
fn surfaces() -> Vec<(&'static str, Side)> {
    let of = |look: Look| (look, true);
    let back = |look: Look| (look, false);
    vec![
        ("chalk", of(look(1.0, 0.0, 1.0, 0.0, 1.0))),
        ("plaster", of(look(1.0, 0.0, 1.0, 0.0, 1.5))),
        ("plastic", of(look(1.0, 0.0, 0.2, 0.0, 1.5))),
        ("varnish", of(look(1.0, 0.0, 0.0, 0.0, 1.5))),
        ("mirror", of(look(1.0, 1.0, 0.0, 0.0, 1.5))),
        ("polished metal", of(look(1.0, 1.0, 0.1, 0.0, 1.5))),
        ("brushed metal", of(look(1.0, 1.0, 0.5, 0.0, 1.5))),
        ("cast metal", of(look(1.0, 1.0, 1.0, 0.0, 1.5))),
        ("half metal", of(look(1.0, 0.5, 0.4, 0.0, 1.5))),
        ("glass", of(look(1.0, 0.0, 0.0, 1.0, 1.5))),
        ("glass from inside", back(look(1.0, 0.0, 0.0, 1.0, 1.5))),
        ("frosted glass", of(look(1.0, 0.0, 0.4, 1.0, 1.5))),
        ("frosted glass from inside", back(look(1.0, 0.0, 0.4, 1.0, 1.5))),
    ]
}

fn bsdf((look, front): &Side, v: Vec3A) -> Bsdf {
    Bsdf::new(look, *front, 0.5, v)
}

/// Surfaces of which most light does not go, or nearly, one way only.
fn blurred() -> Vec<(&'static str, Side)> {
    let sharp = |(name, side): &(&str, Side)| {
        bsdf(side, Vec3A::Z).is_sharp() || *name == "varnish" || *name == "polished metal"
    };
    surfaces().into_iter().filter(|surface| !sharp(surface)).collect()
}

fn views() -> [Vec3A; 3] {
    [0.95, 0.5, 0.15].map(|z: f32| Vec3A::new((1.0 - z * z).sqrt(), 0.0, z))
}

/// The mean of `value` over samples.
fn mean(samples: u32, mut value: impl FnMut([f32; 4]) -> f64) -> f64 {
    let all = (0..samples).map(|i| value(Sampler::new(0, i, 9).four(Set::Eye)));
    all.sum::<f64>() / f64::from(samples)
}

#[test]
fn white_surfaces_give_back_all_light() {
    for (name, side) in surfaces() {
        // What rough glass loses comes back by a coarser table.
        let slack = if name.starts_with("frosted") { 0.03 } else { 0.005 };
        for v in views() {
            let bsdf = bsdf(&side, v);
            let albedo = mean(1 << 14, |[a, b, c, _]| {
                bsdf.sample([a, b, c]).map_or(0.0, |s| f64::from(s.weight.x))
            });
            assert!((albedo - 1.0).abs() < slack, "{name} from {}: {albedo}", v.z);
        }
    }
}

#[test]
fn sampled_and_evaluated_light_agree() {
    for (name, side) in blurred() {
        for v in views() {
            let bsdf = bsdf(&side, v);
            let sampled = mean(1 << 14, |[a, b, c, _]| {
                bsdf.sample([a, b, c]).map_or(0.0, |s| f64::from(s.weight.x))
            });
            let evaluated = mean(1 << 16, |[a, b, ..]| {
                f64::from(bsdf.evaluate(on_sphere([a, b])).0.x / SPHERE_DENSITY)
            });
            assert!(
                (sampled - evaluated).abs() < 0.02 * sampled,
                "{name} from {}: {sampled} {evaluated}",
                v.z
            );
        }
    }
}

/// Which of 8 × 16 cells of the sphere, equal in size, a direction is in.
fn cell(dir: Vec3A) -> usize {
    let around = libm::atan2f(dir.y, dir.x) / std::f32::consts::TAU + 0.5;
    let (row, column) = ((dir.z + 1.0) * 4.0, around * 16.0);
    (row as usize).min(7) * 16 + (column as usize).min(15)
}

#[test]
fn directions_come_as_often_as_their_density_says() {
    for (name, side) in blurred() {
        for v in views() {
            let bsdf = bsdf(&side, v);
            let (mut found, mut expected) = ([0.0f64; 128], [0.0f64; 128]);
            let samples = 1 << 15;
            for i in 0..samples {
                let [a, b, c, _] = Sampler::new(1, i, 2).four(Set::Eye);
                if let Some(scatter) = bsdf.sample([a, b, c]) {
                    found[cell(scatter.dir)] += 1.0;
                    let (_, density) = bsdf.evaluate(scatter.dir);
                    let error = (density - scatter.density).abs();
                    assert!(error <= 1e-3 * density, "{name}: {density} {}", scatter.density);
                }
            }
            let tries = 1 << 18;
            for i in 0..tries {
                let [a, b, ..] = Sampler::new(2, i, 3).four(Set::Eye);
                let dir = on_sphere([a, b]);
                expected[cell(dir)] += f64::from(bsdf.evaluate(dir).1 / SPHERE_DENSITY)
                    / f64::from(tries)
                    * f64::from(samples);
            }
            for (i, (found, expected)) in found.iter().zip(expected).enumerate() {
                let slack = 5.0 * expected.sqrt() + 0.03 * expected + 3.0;
                assert!(
                    (found - expected).abs() < slack,
                    "{name} from {}, cell {i}: {found} {expected}",
                    v.z
                );
            }
        }
    }
}

#[test]
fn opaque_surfaces_scatter_alike_both_ways_without_gain() {
    // Only the ground is exactly so; see the head of `layered`.
    let chalk = (look(0.8, 0.0, 1.0, 0.0, 1.0), true);
    let [a, b, _] = views();
    let [there, back] = [(a, b), (b, a)].map(|(v, l)| bsdf(&chalk, v).evaluate(l).0 / l.z);
    assert!((there - back).length() < 1e-6, "{there} {back}");
    assert!((there.x - 0.8 / std::f32::consts::PI).abs() < 1e-6);
}

#[test]
fn no_direction_carries_much_more_than_the_others() {
    for roughness in [0.3, 0.6, 1.0] {
        let metal = (look(1.0, 1.0, roughness, 0.0, 1.5), true);
        let mut most = 0.0f32;
        for i in 0..200_000u32 {
            let [a, b, c, d] = Sampler::new(i, 0, 7).four(Set::Eye);
            let v = cosine_weighted([a, d]);
            if let Some(scatter) = bsdf(&metal, v).sample([b, c, d]) {
                most = most.max(scatter.weight.max_element());
            }
        }
        assert!(most < 2.0, "roughness {roughness}: {most}");
    }
}
