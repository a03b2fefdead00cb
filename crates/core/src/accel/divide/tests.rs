use glam::Vec3A;

use super::{Division, divide};
use crate::aabb::Aabb;
use crate::cost::{Cost, CostModel};
use crate::family::Family;
use crate::hit::Hit;
use crate::object::Object;
use crate::ray::Ray;
use crate::scratch::Scratch;
use crate::surface::Surface;
use crate::technique::Leaves;

/// A box that is never hit.
struct Hollow(Aabb);

impl Object for Hollow {
    fn kind(&self) -> &'static str {
        "hollow"
    }
    fn bounds(&self) -> Aabb {
        self.0
    }
    fn closest_hit(&self, _ray: &Ray, _hit: &mut Hit, _scratch: &mut Scratch) -> bool {
        false
    }
    fn all_hits(&self, _ray: &Ray, _hits: &mut Vec<Hit>, _scratch: &mut Scratch) {}
    fn surface(&self, _ray: &Ray, _hit: &Hit) -> Option<Surface> {
        None
    }
    fn cost(&self, _model: &CostModel) -> Cost {
        Cost::primitive(10.0, 0.0, 0)
    }
}

/// A cube from `x` on.
fn cube(x: f32, size: f32) -> Hollow {
    let min = Vec3A::new(x, 0.0, 0.0);
    Hollow(Aabb { min, max: min + size })
}

fn endless() -> Hollow {
    Hollow(Aabb { min: Vec3A::NEG_INFINITY, max: Vec3A::INFINITY })
}

/// What becomes of leaves that are as said.
fn divided(children: Vec<Hollow>, leaves: &[&[u32]]) -> Division {
    divide(children, 64, &|_, out| {
        for leaf in leaves {
            out.push(leaf);
        }
    })
}

#[test]
fn a_child_of_several_leaves_goes_where_it_fits_best() {
    let children = || vec![cube(0.0, 1.0), cube(1.0, 1.0), cube(1.1, 1.0), cube(3.0, 1.0)];
    let division = divided(children(), &[&[0, 1, 2], &[1, 2, 3]]);
    assert_eq!(division.groups, [vec![0, 1, 2], vec![3]]);
    // Whatever the order of leaves, and however often they list it.
    let division = divided(children(), &[&[3, 2, 2, 1], &[2, 1, 0]]);
    assert_eq!(division.groups, [vec![3], vec![0, 1, 2]]);
    assert!(division.outside.is_empty());
}

#[test]
fn what_is_too_large_for_every_leaf_is_kept_apart() {
    let children = vec![cube(0.0, 1.0), cube(9.0, 1.0), cube(0.0, 10.0)];
    let division = divided(children, &[&[0, 2], &[1, 2], &[]]);
    assert_eq!(division.groups, [vec![0], vec![1], vec![2]]);
    // Where nothing else is, it is as good as anything.
    let division = divided(vec![cube(0.0, 10.0), cube(1.0, 10.0)], &[&[0, 1], &[1, 0]]);
    assert_eq!(division.groups, [vec![0, 1]]);
}

#[test]
fn children_without_a_box_are_outside_and_the_rest_keep_their_numbers() {
    let never = Hollow(Aabb::EMPTY);
    let children = vec![endless(), cube(0.0, 1.0), never, cube(2.0, 1.0)];
    // The technique sees two children.
    let division = divided(children, &[&[1], &[0]]);
    assert_eq!(division, Division { groups: vec![vec![3], vec![1]], outside: vec![0, 2] });
    let division = divide(vec![endless()], 64, &|_, _| panic!("there is nothing to put in order"));
    assert_eq!(division, Division { groups: Vec::new(), outside: vec![0] });
}

#[test]
fn what_no_leaf_lists_is_outside() {
    let division = divided(vec![cube(0.0, 1.0), cube(2.0, 1.0)], &[&[1]]);
    assert_eq!(division, Division { groups: vec![vec![1]], outside: vec![0] });
}

#[test]
fn a_full_leaf_costs_as_much_as_four_children() {
    let children: Vec<Hollow> = (0..9).map(|i| cube(i as f32, 1.0)).collect();
    let weights = |family: &dyn Family| (family.together(), family.weight(3));
    let seen = std::cell::Cell::new((0, 0.0));
    let watch = |family: &dyn Family, _: &mut Leaves| seen.set(weights(family));
    let _ = divide(children, 64, &watch);
    let (together, weight) = seen.get();
    assert_eq!((together, weight * 64.0), (64, 40.0));
}
