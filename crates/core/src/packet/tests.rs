//! What packets promise.

use super::*;
use crate::aabb::Clip;
use crate::ray::RayKind;
use crate::simd::SCALAR;

fn fan(middle: Vec3A, apart: f32, count: usize) -> Vec<Ray> {
    let from = Vec3A::new(0.5, -3.0, 0.25);
    (0..count)
        .map(|i| {
            let off = Vec3A::new((i % 5) as f32, (i % 7) as f32, (i % 3) as f32) * apart;
            Ray::new(from + off * 0.1, middle + off, RayKind::Camera)
        })
        .collect()
}

fn taken(rays: &[Ray]) -> Option<Packet> {
    let mut packet = Packet::EMPTY;
    let is_one = Packet::may_be(rays) && packet.take(SCALAR, rays, |_| f32::INFINITY);
    is_one.then_some(packet)
}

#[test]
fn neighbours_are_a_packet_and_others_are_not() {
    for middle in [Vec3A::new(0.1, 1.0, -0.2), Vec3A::NEG_X, Vec3A::new(0.0, 0.0, 3.0)] {
        for count in [4, 7, RAYS] {
            let packet = taken(&fan(middle, 1e-3, count)).expect("they are neighbours");
            assert_eq!(packet.beam.axis, longest(middle.to_array()));
            assert_eq!(packet.beam.backward, middle[packet.beam.axis] < 0.0);
            let wanted = GROUPS.iter().map(|&from| packet.wanted(SCALAR, from).count_ones());
            assert_eq!(wanted.sum::<u32>() as usize, count);
        }
        assert!(taken(&fan(middle, 0.3, RAYS)).is_none(), "they spread");
        assert!(taken(&fan(middle, 1e-3, 3)).is_none(), "they are few");
    }
    let aslant = Vec3A::new(1.0, 1.0, 0.0);
    assert!(taken(&fan(aslant, 1e-3, RAYS)).is_none(), "no axis is the fastest of all");
    let mut rays = fan(Vec3A::Y, 1e-3, RAYS);
    rays[5] = rays[5].between(f32::NAN, 1.0);
    assert!(taken(&rays).is_none(), "one is none");
}

#[test]
fn a_packet_meets_the_boxes_that_its_rays_meet() {
    let reach = 4.0;
    let (mut met, mut missed) = (0, 0);
    for middle in [Vec3A::new(0.1, 1.0, -0.2), Vec3A::new(-1e-12, 1.0, 0.0)] {
        let rays = fan(middle, 2e-3, RAYS);
        let mut packet = taken(&rays).expect("they are neighbours");
        packet.face(SCALAR, reach, Clip::SLACK);
        let pencil = Pencil::new(&packet.beam, reach);
        for i in 0..2000u16 {
            let at = |step: u16| f32::from(i * step % 997) / 997.0;
            let way = at(17) * 4.0;
            let from = Vec3A::new(0.5, -3.0, 0.25) + middle * way;
            let min = from + (Vec3A::new(at(31), at(23), at(11)) - 0.5) * 0.1;
            let max = min + Vec3A::new(at(7), at(5), at(3)) * 0.05;
            let mut rows = [[0.0; 8]; 6];
            for axis in 0..3 {
                (rows[2 * axis][3], rows[2 * axis + 1][3]) = (min[axis], max[axis]);
            }
            let mask = packet.meet(SCALAR, &rows, 3);
            let one = |ray: &Ray| {
                let clip = Clip::new(ray, reach);
                clip.cut(&Aabb { min, max }, f32::INFINITY).is_some()
            };
            let expected = (0..RAYS).fold(0, |mask, i| mask | u32::from(one(&rays[i])) << i);
            assert_eq!(mask, expected, "box {i}");
            let (lanes, _) = pencil.meets(SCALAR, &rows);
            assert!(mask == 0 || lanes >> 3 & 1 == 1, "box {i}: the beam holds every ray");
            (met, missed) = (met + u32::from(mask != 0), missed + u32::from(mask == 0));
        }
    }
    assert!(met > 100 && missed > 1000, "{met} met, {missed} missed");
}
