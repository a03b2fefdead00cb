//! What holds of all trees of boxes that move; and things that move.

mod counts;
mod degenerate;
mod family;

use std::sync::Arc;

use glam::{Affine3A, Quat, Vec3, Vec3A};
use nestray_core::aabb::Aabb;
use nestray_core::accel::Accel;
use nestray_core::hit::Hit;
use nestray_core::instance::Instance;
use nestray_core::moving::{Keys, Moving};
use nestray_core::object::{DynObject, Object};
use nestray_core::ray::{Ray, RayKind};
use nestray_core::scratch::Scratch;
use nestray_core::technique::{Index, Leaves, Technique};
use nestray_shapes::any::AnyShape;
use nestray_shapes::block::Block;
use nestray_shapes::shape::Single;
use nestray_shapes::sphere::Sphere;

pub(crate) use self::counts::expected_and_counted;
pub(crate) use self::family::Objects;
use super::{Part, TimedTree};
use crate::counted::Numbers;
use crate::list::List;
use crate::motion_bvh::MotionBvh;
use crate::spacetime::Spacetime;

/// How things move.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Way {
    /// Not at all.
    Still,
    /// Straight ahead, by so many times their size.
    Straight(f32),
    /// Once around an axis beside them, through so many keys.
    Around(u32),
    /// Through three places, turned and scaled, of which the outer two are within the shutter.
    Keyed,
}

const WAYS: [Way; 5] =
    [Way::Still, Way::Straight(3.0), Way::Straight(30.0), Way::Around(12), Way::Keyed];

/// Shapes about 0.2 wide in a cube of 10, moving.
pub(crate) fn movers(way: Way, count: u32, seed: u64) -> Vec<DynObject> {
    let mut numbers = Numbers::new(seed);
    let mut one = |number: u32| -> DynObject {
        let shape = match number % 2 {
            0 => AnyShape::from(Sphere { center: Vec3A::ZERO, radius: 0.1 }),
            _ => AnyShape::from(Block::between(Vec3A::splat(-0.2), Vec3A::splat(0.1))),
        };
        let shape: DynObject = Arc::new(Single { primitive: number, ..Single::new(0, shape) });
        let at = Affine3A::from_translation(Vec3::from(numbers.point() * 10.0));
        match keys(way, &mut numbers, at) {
            keys if keys.len() == 1 => Arc::new(Instance::new(number + 1, shape, keys[0].1)),
            keys => {
                let keys = Keys::new(keys).expect("they ascend");
                Arc::new(Moving::new(number + 1, shape, keys))
            }
        }
    };
    (0..count).map(&mut one).collect()
}

fn keys(way: Way, numbers: &mut Numbers, at: Affine3A) -> Vec<(f32, Affine3A)> {
    let moved = |by: Vec3A| Affine3A::from_translation(by.into()) * at;
    let mut turned = || {
        let turn = Quat::from_axis_angle(numbers.direction().into(), 6.0 * numbers.next());
        Affine3A::from_rotation_translation(turn, numbers.direction().into())
    };
    match way {
        Way::Still => vec![(0.0, at * turned())],
        Way::Straight(sizes) => {
            let by = numbers.direction() * 0.2 * sizes;
            vec![(0.0, at), (1.0, moved(by))]
        }
        Way::Around(count) => {
            let beside = Affine3A::from_translation(Vec3::X * 1.5);
            let turn = |part: f32| at * Affine3A::from_rotation_z(part * 6.3) * beside;
            (0..=count).map(|i| i as f32 / count as f32).map(|part| (part, turn(part))).collect()
        }
        Way::Keyed => vec![(-0.3, at), (0.4, at * turned()), (0.9, at * turned())],
    }
}

/// A ray from anywhere to anywhere, at any time: now and then at the ends of halves.
fn ray(numbers: &mut Numbers) -> Ray {
    let (from, to) = (numbers.point() * 14.0 - 2.0, numbers.point() * 10.0);
    let time = match (numbers.next() * 4.0) as u32 {
        0 => (numbers.next() * 16.0).floor() / 16.0,
        1 => ((numbers.next() * 16.0).floor() / 16.0).next_down(),
        _ => numbers.next(),
    };
    Ray::new(from, to - from, RayKind::Camera).at_time(time)
}

fn agrees_with_the_list<T: Technique<Index = TimedTree>>(technique: &T) {
    for (seed, way) in (0..).zip(WAYS) {
        let mut children = movers(way, 150, seed);
        children.extend(movers(Way::Still, 20, seed + 9));
        let list = Accel::new(List::default(), children.clone());
        let inside: DynObject = Arc::new(Accel::new(technique.clone(), children));
        let keys = keys(Way::Keyed, &mut Numbers::new(seed), Affine3A::IDENTITY);
        let keys = Keys::new(keys).expect("they ascend");
        let twice = |object: DynObject| -> Vec<DynObject> {
            let place = Affine3A::from_translation(Vec3::splat(2.0));
            let moving = Moving::new(500, Arc::clone(&object), keys.clone());
            vec![Arc::new(moving), Arc::new(Instance::new(1, object, place))]
        };
        let lists: DynObject = Arc::new(Accel::new(List::default(), twice(Arc::new(list))));
        let nests = Accel::new(technique.clone(), twice(inside));
        let (mut numbers, mut scratch) = (Numbers::new(seed + 50), Scratch::new());
        let mut found = 0;
        for i in 0..1000 {
            let ray = ray(&mut numbers);
            let mut hits = [Hit::none(ray.t_max()); 2];
            lists.closest_hit(&ray, &mut hits[0], &mut scratch);
            found += u32::from(nests.closest_hit(&ray, &mut hits[1], &mut scratch));
            assert_eq!(hits[0], hits[1], "{} {way:?} ray {i}", T::NAME);
            let any = nests.any_hit(&ray, &mut scratch);
            assert_eq!(any, hits[0].is_some(), "{} {way:?} ray {i}", T::NAME);
            let mut all = [Vec::new(), Vec::new()];
            lists.all_hits(&ray, &mut all[0], &mut scratch);
            nests.all_hits(&ray, &mut all[1], &mut scratch);
            all.iter_mut().for_each(|hits| hits.sort_by(|a, b| a.t.total_cmp(&b.t)));
            assert_eq!(all[0].len(), all[1].len(), "{} {way:?} ray {i}", T::NAME);
            assert!(all[0].iter().zip(&all[1]).all(|(a, b)| a.t == b.t));
        }
        assert!(found > 60, "{way:?}: {found} hits");
    }
}

#[test]
fn answers_are_those_of_the_list_at_any_time() {
    agrees_with_the_list(&MotionBvh::default());
    agrees_with_the_list(&MotionBvh { halvings: 8, bias: 1.0, ..MotionBvh::default() });
    agrees_with_the_list(&Spacetime::default());
    agrees_with_the_list(&Spacetime { halvings: 8, bias: 1.0, ..Spacetime::default() });
}

/// Boxes of objects, and the tree over them.
pub(crate) fn tree<T: Technique<Index = TimedTree>>(
    technique: &T,
    family: &Objects,
) -> (TimedTree, Leaves) {
    let mut leaves = Leaves::default();
    let tree = technique.build(family, &mut leaves);
    (tree, leaves)
}

/// Every way down to `child` at a time: the box that is left of all boxes on it.
fn ways_down(tree: &TimedTree, leaves: &Leaves, child: u32, time: f32) -> Vec<Aabb> {
    let nodes: Vec<Vec<Part>> = tree.nodes().collect();
    let (mut open, mut found) = (vec![(0u32, Aabb::ENDLESS)], Vec::new());
    while let Some((node, around)) = open.pop() {
        for part in &nodes[node as usize] {
            let [from, until] = part.time;
            if !(from <= time && (time < until || until == 1.0)) {
                continue;
            }
            let left = around.meet(part.bounds.at((time - from) / (until - from)));
            if part.step.is_onward() {
                open.push((part.step.word(), left));
            } else if leaves.of(part.step.as_leaf().0 as usize).contains(&child) {
                found.push(left);
            }
        }
    }
    found
}

#[test]
fn every_point_of_a_child_is_in_boxes_down_to_it_at_any_time() {
    let mut numbers = Numbers::new(3);
    for (seed, way) in (0..).zip(WAYS) {
        let family = Objects(movers(way, 60, seed));
        let motion = tree(&MotionBvh { max_leaf: 1, ..MotionBvh::default() }, &family);
        let cells = tree(&Spacetime { max_leaf: 1, ..Spacetime::default() }, &family);
        for child in 0..60 {
            for time in [0.0, 0.5, 1.0, numbers.next(), numbers.next(), numbers.next()] {
                let inside = family.0[child as usize].bounds_during([time; 2]);
                let once = ways_down(&motion.0, &motion.1, child, time);
                assert_eq!(once.len(), 1, "motion-bvh {way:?}: one way at a time");
                assert!(once[0].contains(&inside), "motion-bvh {way:?}: child {child} at {time}");
                let ways = ways_down(&cells.0, &cells.1, child, time);
                for i in 0..20 {
                    let within = inside.min + numbers.point() * inside.size();
                    let point = if i < 8 { inside.corner(i) } else { within };
                    let point = Aabb { min: point, max: point };
                    let held = ways.iter().any(|way| way.contains(&point));
                    assert!(held, "spacetime {way:?}: child {child} at {time}");
                }
            }
        }
    }
}

#[test]
fn a_child_is_shown_at_its_time_only() {
    let family = Objects(movers(Way::Around(12), 40, 1));
    let (tree, _) = tree(&MotionBvh { halvings: 4, ..MotionBvh::default() }, &family);
    let mut cut = 0;
    for part in tree.nodes().flatten() {
        let [from, until] = part.time;
        cut += u32::from(until - from < 1.0);
        assert!((0.0..until).contains(&from) && until <= 1.0);
        assert!((until - from) * 16.0 >= 1.0, "halved too often: {from} to {until}");
        assert!(!part.step.is_done());
    }
    assert!(cut > 40, "time was split {cut} times");
    assert!(tree.bytes() > 0);
}
