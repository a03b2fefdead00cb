//! Beams: what a shape blocks, and which side it shows.

use glam::Vec3A;
use nestray_core::aabb::Aabb;
use nestray_core::beam::{Beam, Facing};
use nestray_core::ray::{Ray, RayKind};
use nestray_shapes::shape::Shape;

use crate::hits::crossings;
use crate::numbers::Numbers;
use crate::samples::{Sample, near, samples};

/// A narrow beam towards a shape.
fn towards(numbers: &mut Numbers, sample: &Sample) -> Beam {
    let dir = numbers.unit();
    let axis = dir.abs().max_position();
    let from = sample.center + numbers.cube() * (0.3 * sample.size)
        - dir * sample.size * numbers.between(1.5, 10.0);
    let half = Vec3A::splat((numbers.size(-3.0, -0.5) * sample.size) as f32);
    let spread = numbers.size(-4.0, -1.0);
    let slopes = |slope: f64| [(slope - spread) as f32, (slope + spread) as f32];
    let along = dir[axis].abs();
    Beam {
        origin: Aabb { min: from.as_vec3a() - half, max: from.as_vec3a() + half },
        axis,
        backward: dir[axis] < 0.0,
        u: slopes(dir[(axis + 1) % 3] / along),
        v: slopes(dir[(axis + 2) % 3] / along),
        farthest: f32::INFINITY,
    }
}

fn ray_of(numbers: &mut Numbers, beam: &Beam) -> Ray {
    // Often at the ends, where things go wrong.
    let mut pick = |[low, high]: [f32; 2]| match numbers.below(4) {
        0 => low,
        1 => high,
        _ => numbers.between(f64::from(low), f64::from(high)) as f32,
    };
    let mut dir = Vec3A::ZERO;
    dir[beam.axis] = if beam.backward { -1.0 } else { 1.0 };
    dir[(beam.axis + 1) % 3] = pick(beam.u);
    dir[(beam.axis + 2) % 3] = pick(beam.v);
    let origin = [0, 1, 2].map(|i| pick([beam.origin.min[i], beam.origin.max[i]]));
    Ray::new(Vec3A::from_array(origin), dir, RayKind::Shadow { light: 0 })
}

#[test]
fn what_blocks_a_beam_is_hit_by_all_its_rays() {
    let mut kinds = std::collections::BTreeMap::new();
    for seed in 0..1_500 {
        for sample in samples(seed).into_iter().chain(near(seed)) {
            let mut numbers = Numbers(seed ^ 0xb10c);
            let beam = towards(&mut numbers, &sample);
            let (blocked, facing) = (sample.shape.blocks(&beam), sample.shape.facing(&beam));
            if blocked.is_none() && facing == Facing::Mixed {
                continue;
            }
            *kinds.entry(sample.shape.kind()).or_insert(0) += usize::from(blocked.is_some());
            for _ in 0..60 {
                let ray = ray_of(&mut numbers, &beam);
                let found = crossings(&sample.shape, &ray);
                if let Some(limit) = blocked {
                    let before = found.iter().any(|hit| hit.t >= 0.0 && hit.t <= limit);
                    assert!(before, "seed {seed} {sample:?} {beam:?} {ray:?}: {limit} {found:?}");
                }
                let seen = match facing {
                    Facing::Front => found.iter().all(|hit| hit.front),
                    Facing::Back => found.iter().all(|hit| !hit.front),
                    Facing::Mixed => true,
                };
                assert!(seen, "seed {seed} {sample:?} {beam:?} {ray:?}: {facing:?} {found:?}");
            }
        }
    }
    for kind in ["sphere", "block", "plane", "disk", "parallelogram", "polygon", "patch"] {
        assert!(kinds.get(kind).is_some_and(|&n| n > 50), "{kind} hardly blocks: {kinds:?}");
    }
}

/// A ring through which all the rays go blocks nothing.
#[test]
fn a_hole_does_not_block() {
    use nestray_shapes::polygon::Polygon;
    // A star drawn in one stroke has a hole in its middle.
    let star = |i: usize| {
        let angle = std::f64::consts::TAU * (2 * i % 5) as f64 / 5.0;
        [libm::cos(angle) as f32, libm::sin(angle) as f32, 0.0]
    };
    let star = Polygon::new((0..5).map(star).collect::<Vec<_>>());
    let beam = Beam {
        origin: Aabb { min: Vec3A::new(-0.01, -0.01, 1.0), max: Vec3A::new(0.01, 0.01, 1.1) },
        axis: 2,
        backward: true,
        u: [-0.01, 0.01],
        v: [-0.01, 0.01],
        farthest: f32::INFINITY,
    };
    assert!(crossings(&star, &Ray::new(Vec3A::Z, Vec3A::NEG_Z, RayKind::Camera)).is_empty());
    assert_eq!(star.blocks(&beam), None);
}
