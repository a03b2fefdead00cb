//! A triangle and a beam of rays.

use glam::DVec3;
use nestray_core::aabb::Aabb;
use nestray_core::beam::{Beam, Facing};

use crate::polygon::place;
use crate::rounding::slack;
use crate::shadow::{self, Images};

/// The corners of a triangle.
type Corners = [[f32; 3]; 3];

/// At which distances along the main axis rays of `beam` may meet a triangle with these
/// `bounds`; none if none can. Unlike its box, a slanting triangle leaves most beams alone.
pub(super) fn meets(corners: &Corners, bounds: &Aabb, beam: &Beam) -> Option<[f32; 2]> {
    let range = beam.meets(bounds)?;
    if beam.origin.is_bounded() && passes(corners, beam, f64::from(range[0])) {
        return None;
    }
    Some(range)
}

/// Whether all rays of a beam that have come as far as `from` pass a triangle by. A plane is
/// looked for that has the triangle on one side and the rays on the other: through the middle of
/// where they start, and either along a side of the beam or along an edge of the triangle.
fn passes(corners: &Corners, beam: &Beam, from: f64) -> bool {
    let axes = [beam.axis % 3, (beam.axis + 1) % 3, (beam.axis + 2) % 3];
    let along = if beam.backward { -1.0 } else { 1.0 };
    let to_beam = |v: DVec3| DVec3::new(v[axes[0]] * along, v[axes[1]], v[axes[2]]);
    let (min, max) = (beam.origin.min.as_dvec3(), beam.origin.max.as_dvec3());
    let middle = to_beam((min + max) * 0.5);
    let half = to_beam((max - min) * 0.5).abs() + slack(beam.origin.reach());
    let corners = corners.map(|corner| to_beam(place(corner)) - middle);
    let (u, v) = (beam.u.map(f64::from), beam.v.map(f64::from));
    let beside = |normal: DVec3| {
        let room = normal.abs().dot(half);
        corners.iter().all(|corner| normal.dot(*corner) > room)
    };
    if beside(DVec3::new(-u[1], 1.0, 0.0))
        || beside(DVec3::new(u[0], -1.0, 0.0))
        || beside(DVec3::new(-v[1], 0.0, 1.0))
        || beside(DVec3::new(v[0], 0.0, -1.0))
    {
        return true;
    }
    (0..3).any(|edge| {
        let [a, b, c] = [corners[edge], corners[(edge + 1) % 3], corners[(edge + 2) % 3]];
        let normal = a.cross(b);
        let normal = if normal.dot(c) < 0.0 { -normal } else { normal };
        let nearest = [(0, 0), (0, 1), (1, 0), (1, 1)]
            .map(|(i, j)| normal.dot(DVec3::new(1.0, u[i], v[j])))
            .into_iter()
            .fold(f64::NEG_INFINITY, f64::max);
        nearest < 0.0 && from * nearest + normal.abs().dot(half) < 0.0
    })
}

/// The unit normal of a triangle; none if it has no area.
fn normal(corners: &Corners) -> Option<DVec3> {
    let [a, b, c] = corners.map(place);
    (b - a).cross(c - a).try_normalize()
}

/// Which side a triangle shows to all rays of `beam`.
pub(super) fn facing(corners: &Corners, beam: &Beam) -> Facing {
    normal(corners).map_or(Facing::Mixed, |normal| shadow::facing(normal, beam))
}

/// The distance along the main axis beyond which no ray of `beam` passes a triangle; none if
/// some may.
pub(super) fn blocks(corners: &Corners, beam: &Beam) -> Option<f32> {
    let normal = normal(corners)?;
    let corners = corners.map(place);
    let images = Images::new(beam, corners[0], normal)?;
    let within = (0..3).all(|i| {
        let Some(inward) = normal.cross(corners[(i + 1) % 3] - corners[i]).try_normalize() else {
            return false;
        };
        let room = |p: DVec3| slack(p.abs().max_element() as f32) * 4.0;
        images.points.iter().all(|&p| inward.dot(p - corners[i]) >= room(p))
    });
    if within { shadow::beyond(images.farthest) } else { None }
}

#[cfg(test)]
mod tests {
    use glam::Vec3A;
    use nestray_core::beam::Beam;
    use rand::{RngExt, SeedableRng};
    use rand_pcg::Pcg64Mcg;

    use super::*;

    struct Numbers(Pcg64Mcg);

    impl Numbers {
        fn between(&mut self, low: f32, high: f32) -> f32 {
            low + (high - low) * self.0.random::<f32>()
        }

        fn point(&mut self, size: f32) -> [f32; 3] {
            [0; 3].map(|_| self.between(-size, size))
        }

        fn beam(&mut self, case: usize) -> Beam {
            let min = Vec3A::from_array(self.point(1.0));
            let wide = if case.is_multiple_of(2) { 0.0 } else { self.between(0.0, 0.3) };
            let slopes = |low: f32, width: f32| [low, (low + width).min(1.0)];
            let width = self.between(0.001, 0.4);
            Beam {
                origin: Aabb { min, max: min + wide },
                axis: case / 2 % 3,
                backward: case.is_multiple_of(3),
                u: slopes(self.between(-1.0, 0.9), width),
                v: slopes(self.between(-1.0, 0.9), width),
                farthest: f32::INFINITY,
            }
        }

        /// A ray of a beam.
        fn ray(&mut self, beam: &Beam) -> (DVec3, DVec3) {
            let size = beam.origin.size();
            let origin =
                beam.origin.min + size * Vec3A::from_array([0; 3].map(|_| self.between(0.0, 1.0)));
            let mut dir = DVec3::ZERO;
            dir[beam.axis] = if beam.backward { -1.0 } else { 1.0 };
            dir[(beam.axis + 1) % 3] = f64::from(self.between(beam.u[0], beam.u[1]));
            dir[(beam.axis + 2) % 3] = f64::from(self.between(beam.v[0], beam.v[1]));
            (origin.as_dvec3(), dir)
        }
    }

    /// Where a ray meets a triangle, by the volumes that it spans with the edges.
    fn distance(corners: &Corners, (origin, dir): (DVec3, DVec3)) -> Option<f64> {
        let [a, b, c] = corners.map(|corner| place(corner) - origin);
        let volumes = [dir.dot(a.cross(b)), dir.dot(b.cross(c)), dir.dot(c.cross(a))];
        let inside = volumes.iter().all(|&v| v > 0.0) || volumes.iter().all(|&v| v < 0.0);
        let normal = (b - a).cross(c - a);
        let s = a.dot(normal) / dir.dot(normal);
        (inside && s >= 0.0).then_some(s)
    }

    #[test]
    fn no_ray_of_a_beam_meets_a_triangle_it_is_said_to_pass_and_most_slanting_ones_are() {
        let mut numbers = Numbers(Pcg64Mcg::seed_from_u64(21));
        let (mut by_box, mut by_triangle) = (0, 0);
        for case in 0..20_000 {
            let beam = numbers.beam(case);
            let at = numbers.point(4.0);
            let corners = [0; 3].map(|_| {
                let off = numbers.point(1.5);
                [0, 1, 2].map(|axis| at[axis] + off[axis])
            });
            let bounds = corners.iter().fold(Aabb::EMPTY, |all, &c| all.with(Vec3A::from_array(c)));
            let answer = meets(&corners, &bounds, &beam);
            by_box += usize::from(beam.meets(&bounds).is_some());
            by_triangle += usize::from(answer.is_some());
            let blocked = blocks(&corners, &beam);
            for _ in 0..30 {
                let hit = distance(&corners, numbers.ray(&beam));
                if let Some(s) = hit {
                    let [first, last] = answer.expect("a ray meets it");
                    assert!(f64::from(first) <= s && s <= f64::from(last), "seed 21, case {case}");
                }
                if let Some(last) = blocked {
                    let s = hit.expect("every ray is blocked");
                    assert!(s <= f64::from(last), "seed 21, case {case}");
                }
            }
        }
        assert!(by_triangle * 3 < by_box * 2, "{by_triangle} of {by_box}");
    }

    #[test]
    fn a_large_triangle_blocks_a_narrow_beam() {
        let corners = [[-10.0, -10.0, 5.0], [10.0, -10.0, 5.0], [0.0, 20.0, 6.0]];
        let mut beam = Beam {
            origin: Aabb { min: Vec3A::splat(-0.1), max: Vec3A::splat(0.1) },
            axis: 2,
            backward: false,
            u: [-0.1, 0.1],
            v: [0.0, 0.1],
            farthest: f32::INFINITY,
        };
        let last = blocks(&corners, &beam).expect("no ray gets past");
        assert!((5.0..6.5).contains(&last), "{last}");
        beam.backward = true;
        assert_eq!(blocks(&corners, &beam), None, "it is behind");
        beam.backward = false;
        beam.u = [-0.1, 5.0];
        assert_eq!(blocks(&corners, &beam), None, "some rays get past");
    }
}
