//! Building a binary tree from the top, children cut where that pays.

use nestray_core::aabb::Aabb;
use nestray_core::family::Family;

use super::Sbvh;
use super::cut::Cut;
use super::early::cut_large;
use super::plane::best_cut;
use crate::bvh::split::{best_plane, partition};
use crate::wide_tree::{Binary, Contents, Pair, in_halves};

/// Splits all children again and again, from `halves_from` levels down in halves and uncut.
pub(super) fn split<'a>(
    params: &Sbvh,
    family: &dyn Family,
    of: &'a Contents,
    halves_from: usize,
) -> Binary<'a> {
    let count = of.boxes.len();
    let bounds = of.boxes.iter().fold(Aabb::EMPTY, |all, b| all.join(*b));
    let mut growing = Growing {
        params,
        parts: Parts {
            family,
            of: Contents {
                boxes: of.boxes.clone(),
                weights: of.weights.clone(),
                together: of.together,
            },
            children: (0..count as u32).collect(),
            reach: bounds.reach(),
        },
        halves_from,
        least_overlap: params.overlap * bounds.surface_area(),
        order: Vec::with_capacity(count),
        pairs: Vec::with_capacity(2 * count),
    };
    let room = f64::from(params.copies) * count as f64;
    let early = (1.0 + f64::from(params.early) * (f64::from(params.copies) - 1.0)) * count as f64;
    cut_large(&mut growing.parts, &bounds, early as usize);
    let parts = growing.parts.of.boxes.len() as u32;
    growing.grow((0..parts).collect(), 0, room);
    Binary { of, order: growing.order, pairs: growing.pairs }
}

/// The parts that children were cut into; at first, each whole.
pub(super) struct Parts<'a> {
    pub(super) family: &'a dyn Family,
    /// A box around each part, and what testing it costs: that of the whole child.
    pub(super) of: Contents,
    /// Which child each is of.
    pub(super) children: Vec<u32>,
    /// The largest coordinate of all boxes.
    pub(super) reach: f32,
}

impl Parts<'_> {
    /// A box around some parts.
    pub(super) fn around(&self, parts: &[u32]) -> Aabb {
        parts.iter().fold(Aabb::EMPTY, |all, &part| all.join(self.of.boxes[part as usize]))
    }

    /// Cuts a part in two; returns the second.
    pub(super) fn divide(&mut self, part: u32, pieces: [Aabb; 2]) -> u32 {
        let other = self.of.boxes.len() as u32;
        self.of.boxes[part as usize] = pieces[0];
        self.of.boxes.push(pieces[1]);
        self.of.weights.push(self.of.weights[part as usize]);
        self.children.push(self.children[part as usize]);
        other
    }

    /// What testing some parts costs.
    pub(super) fn weight(&self, parts: &[u32]) -> f32 {
        parts.iter().map(|&part| self.of.weights[part as usize]).sum()
    }

    /// A box around what of a part is in a cell inside its box; empty if nothing is. A hit is
    /// never outside the joint boxes of what a part is cut into, up to rounding.
    pub(super) fn inside(&self, part: u32, cell: &Aabb) -> Aabb {
        let bounds = self.of.boxes[part as usize];
        let inside = self.family.clipped(self.children[part as usize], cell).meet(bounds);
        if inside.is_empty() { Aabb::EMPTY } else { inside }
    }
}

/// Overlaps with a smaller part of the surface around both sides are left alone, too.
const PART: f32 = 0.1;

struct Growing<'a> {
    params: &'a Sbvh,
    parts: Parts<'a>,
    halves_from: usize,
    /// Overlaps with less surface are left alone.
    least_overlap: f32,
    order: Vec<u32>,
    pairs: Vec<Pair>,
}

impl Growing<'_> {
    /// Appends the subtree of `inside`, cut into no more than `room` parts; says where it begins.
    fn grow(&mut self, inside: Vec<u32>, depth: usize, room: f64) -> u32 {
        let me = self.pairs.len();
        let (bounds, first) = (self.parts.around(&inside), self.order.len() as u32);
        self.pairs.push(Pair { bounds, first, count: 1, left: 0, right: 0 });
        if let [part] = inside[..] {
            self.order.push(self.parts.children[part as usize]);
            return me as u32;
        }
        let [left, right] = self.halves(inside, &bounds, depth, room);
        let share = room / (left.len() + right.len()) as f64;
        let rooms = [left.len() as f64 * share, right.len() as f64 * share];
        self.pairs[me].left = self.grow(left, depth + 1, rooms[0]);
        self.pairs[me].right = self.grow(right, depth + 1, rooms[1]);
        self.pairs[me].count = self.order.len() as u32 - first;
        me as u32
    }

    /// Puts two parts or more in two sets.
    fn halves(
        &mut self,
        mut inside: Vec<u32>,
        bounds: &Aabb,
        depth: usize,
        room: f64,
    ) -> [Vec<u32>; 2] {
        let by_area = depth < self.halves_from;
        let of = &self.parts.of;
        let plane = if by_area { best_plane(self.params.bins, of, &inside) } else { None };
        let middle = match &plane {
            Some(plane) => partition(&mut inside, |part| plane.is_left(of.center(part))),
            None => in_halves(of, &mut inside),
        };
        if by_area && room >= inside.len() as f64 + 1.0 && inside.len() > of.together as usize {
            let sides = [&inside[..middle], &inside[middle..]];
            let boxes = sides.map(|side| self.parts.around(side));
            let cost = match &plane {
                Some(plane) => plane.cost,
                None => {
                    let cost = |i: usize| boxes[i].surface_area() * self.parts.weight(sides[i]);
                    cost(0) + cost(1)
                }
            };
            let least = self.least_overlap.max(PART * bounds.surface_area());
            if boxes[0].meet(boxes[1]).surface_area() > least
                && let Some(halves) = self.cut(&inside, bounds, cost, room)
            {
                return halves;
            }
        }
        let right = inside.split_off(middle);
        [inside, right]
    }

    /// Cuts parts by a plane, if that costs less than `cost` and there is room.
    fn cut(
        &mut self,
        inside: &[u32],
        bounds: &Aabb,
        cost: f32,
        room: f64,
    ) -> Option<[Vec<u32>; 2]> {
        let plane = best_cut(&self.parts, inside, bounds, cost)?;
        let cut = Cut::new(&self.parts, inside, plane);
        let makes_progress = !cut.counts().contains(&0);
        let fits = cut.counts().iter().sum::<usize>() as f64 <= room;
        (makes_progress && fits && cut.cost() < cost).then(|| cut.made(&mut self.parts))
    }
}
