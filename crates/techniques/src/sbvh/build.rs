//! Building a binary tree from the top, children cut where that pays.

use nestray_core::aabb::Aabb;
use nestray_core::dispatch;
use nestray_core::family::Family;
use nestray_core::simd::{Level, Simd};

use super::Sbvh;
use super::cut::Cut;
use super::early::cut_large;
use super::plane::best_cut;
use crate::bvh::build::parts;
use crate::bvh::few;
use crate::bvh::part::{Around, Part, in_halves};
use crate::bvh::plane::{Cutting, SHARED, partition};
use crate::wide_tree::{Binary, Contents, Pair};

/// Splits all children again and again, from `halves_from` levels down in halves and uncut.
pub(super) fn split<'a>(
    params: &Sbvh,
    family: &dyn Family,
    of: &'a Contents,
    halves_from: usize,
) -> Binary<'a> {
    let count = of.boxes.len();
    let bounds = of.boxes.iter().fold(Aabb::EMPTY, |all, b| all.join(*b));
    let knife = Knife { family, reach: bounds.reach() };
    let room = f64::from(params.copies) * count as f64;
    let early = (1.0 + f64::from(params.early) * (f64::from(params.copies) - 1.0)) * count as f64;
    let mut parts = parts(of).to_vec();
    cut_large(&knife, &mut parts, &bounds, of.together as usize, early as usize);
    let growing = Growing {
        knife,
        together: of.together as usize,
        // Whoever moves pieces moves each of its own.
        few: if params.passes > 0 { 1 } else { few(params.max_leaf, of.together) },
        cutting: Cutting { bins: params.bins, is_even: of.is_even() },
        halves_from,
        least_overlap: params.overlap * bounds.surface_area(),
    };
    let mut grown = Grown::default();
    growing.all(parts, 0, room, &mut grown);
    Binary { of, order: grown.order, pairs: grown.pairs }
}

/// What children are cut with.
pub(super) struct Knife<'a> {
    family: &'a dyn Family,
    /// The largest coordinate of all boxes.
    pub(super) reach: f32,
}

impl Knife<'_> {
    /// A box around what of a part is in a cell inside its box; empty if nothing is. A hit is
    /// never outside the joint boxes of what a part is cut into, up to rounding.
    pub(super) fn inside(&self, part: &Part, cell: &Aabb) -> Aabb {
        let inside = self.family.clipped(part.number(), cell).meet(part.around().bounds());
        if inside.is_empty() { Aabb::EMPTY } else { inside }
    }
}

/// Overlaps with a smaller part of the surface around both sides are left alone, too.
const PART: f32 = 0.1;

struct Growing<'a> {
    knife: Knife<'a>,
    together: usize,
    /// So many are not split.
    few: usize,
    cutting: Cutting,
    halves_from: usize,
    /// Overlaps with less surface are left alone.
    least_overlap: f32,
}

/// A tree so far.
#[derive(Default)]
struct Grown {
    order: Vec<u32>,
    pairs: Vec<Pair>,
}

impl Grown {
    fn append(&mut self, other: Self) -> u32 {
        let (me, first) = (self.pairs.len() as u32, self.order.len() as u32);
        let moved = |pair: Pair| Pair { first: pair.first + first, ..pair.moved(me) };
        self.pairs.extend(other.pairs.into_iter().map(moved));
        self.order.extend(other.order);
        me
    }
}

/// What is yet to be split: the last parts of those that wait.
struct Open {
    count: usize,
    depth: usize,
    /// How many parts it may be cut into.
    room: f64,
    /// The node it is the left side of; a right side comes right after what it is in.
    above: Option<u32>,
}

impl Open {
    /// The two sides of it, that have so many parts.
    fn sides(&self, counts: [usize; 2], above: u32) -> [Self; 2] {
        let share = self.room / (counts[0] + counts[1]) as f64;
        let depth = self.depth + 1;
        let side = |count: usize, above| Self { count, depth, room: count as f64 * share, above };
        [side(counts[0], Some(above)), side(counts[1], None)]
    }
}

impl Growing<'_> {
    /// Appends the subtree of `inside`, cut into no more than `room` parts, by all cores. It is
    /// the same for any number of them.
    fn all(&self, mut inside: Vec<Part>, depth: usize, room: f64, out: &mut Grown) {
        let open = Open { count: inside.len(), depth, room, above: None };
        if inside.len() <= SHARED {
            dispatch!(Level::best(), simd => self.below(simd, inside, open, out));
            return;
        }
        let me = out.pairs.len() as u32;
        let first = out.order.len() as u32;
        let bounds = Around::all(&inside).bounds();
        out.pairs.push(Pair { bounds, first, count: 0, left: 0, right: me + 1 });
        let counts = dispatch!(Level::best(), simd => self.halves(simd, &mut inside, &open));
        let right = inside.split_off(counts[0]);
        let [a, b] = open.sides(counts, me);
        let mut apart = Grown::default();
        rayon::join(
            || self.all(right, depth + 1, b.room, out),
            || self.all(inside, depth + 1, a.room, &mut apart),
        );
        let left = out.append(apart);
        out.pairs[me as usize].left = left;
        out.pairs[me as usize].count = out.order.len() as u32 - first;
    }

    /// The same by one core, without calling itself: vector instructions would be lost.
    #[inline(always)]
    fn below<S: Simd>(&self, simd: S, mut parts: Vec<Part>, whole: Open, out: &mut Grown) {
        let begin = out.pairs.len();
        let mut waiting = vec![whole];
        while let Some(open) = waiting.pop() {
            let me = out.pairs.len() as u32;
            if let Some(above) = open.above {
                out.pairs[above as usize].left = me;
            }
            let from = parts.len() - open.count;
            let (bounds, first) = (Around::all(&parts[from..]).bounds(), out.order.len() as u32);
            let is_leaf = open.count <= self.few;
            let right = if is_leaf { 0 } else { me + 1 };
            out.pairs.push(Pair { bounds, first, count: open.count as u32, left: 0, right });
            if is_leaf {
                out.order.extend(parts.drain(from..).map(|part| part.number()));
                continue;
            }
            let mut inside = parts.split_off(from);
            let counts = self.halves(simd, &mut inside, &open);
            parts.append(&mut inside);
            waiting.extend(open.sides(counts, me));
        }
        for me in (begin..out.pairs.len()).rev() {
            let Pair { left, right, .. } = out.pairs[me];
            if left != 0 {
                let count = |side: u32| out.pairs[side as usize].count;
                out.pairs[me].count = count(left) + count(right);
            }
        }
    }

    /// Puts two parts or more in two sets, one behind the other; returns how large they are.
    #[inline(always)]
    fn halves<S: Simd>(&self, simd: S, inside: &mut Vec<Part>, open: &Open) -> [usize; 2] {
        let by_area = open.depth < self.halves_from;
        let plane = if by_area { self.cutting.best_plane(simd, inside) } else { None };
        let middle = match &plane {
            Some(plane) => partition(inside, plane),
            None => in_halves(inside),
        };
        if by_area && open.room >= inside.len() as f64 + 1.0 && inside.len() > self.together {
            let sides = match &plane {
                Some(plane) => plane.sides,
                None => [Around::all(&inside[..middle]), Around::all(&inside[middle..])],
            };
            if let Some(halves) = self.cut(inside, middle, sides, open.room) {
                let counts = halves.each_ref().map(Vec::len);
                inside.clear();
                inside.extend(halves.into_iter().flatten());
                return counts;
            }
        }
        [middle, inside.len() - middle]
    }

    /// Cuts parts by a plane, if that costs less than to leave them on two sides and there is room.
    fn cut(
        &self,
        inside: &[Part],
        middle: usize,
        sides: [Around; 2],
        room: f64,
    ) -> Option<[Vec<Part>; 2]> {
        let [a, b] = sides.map(|side| side.bounds());
        let bounds = a.join(b);
        let least = self.least_overlap.max(PART * bounds.surface_area());
        if a.meet(b).surface_area() <= least {
            return None;
        }
        let weight = |parts: &[Part]| parts.iter().map(Part::weight).sum::<f32>();
        let cost = a.surface_area() * weight(&inside[..middle])
            + b.surface_area() * weight(&inside[middle..]);
        let plane = best_cut(&self.knife, inside, &bounds, cost)?;
        let cut = Cut::new(&self.knife, inside, plane);
        let makes_progress = !cut.counts().contains(&0);
        let fits = cut.counts().iter().sum::<usize>() as f64 <= room;
        (makes_progress && fits && cut.cost() < cost).then(|| cut.made())
    }
}
