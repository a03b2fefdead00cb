//! Cutting cells of space and time.

use nestray_core::aabb::{Aabb, Clip};

use super::Spacetime;
use crate::motion_bvh::split::split;
use crate::timed_tree::{Growing, Linear, Manner, Open, Reference};

/// Cells with more children in them are cut in half, with no other planes tried.
const LARGE: usize = 32;
/// What a cut costs by itself, in nanoseconds: a part of a visit of a node of eight.
const CUT: f64 = 4.0;

/// Cuts a cell in two where it costs least, with no more than `most_around` around any. In a
/// cell that is best left whole, what moves is put together as in a hierarchy of moving boxes;
/// gives back what does not.
pub(super) fn cut(
    params: &Spacetime,
    growing: &mut Growing<'_>,
    open: Open,
    most_around: usize,
) -> Result<[Open; 2], Open> {
    let mut whole = match open.manner {
        Manner::Children => open,
        Manner::Cells => match cells(params, growing, open, most_around) {
            Err(whole) if whole.moves() || whole.depth + 1 >= most_around => whole,
            halves => return halves,
        },
    };
    if whole.manner == Manner::Cells {
        whole.manner = Manner::Children;
        let cell = whole.cell;
        whole.inside.iter_mut().for_each(|one| one.bounds = one.bounds.cut_to(&cell));
    }
    split(&params.moving(), growing, whole, most_around)
}

/// Cuts a cell in two where it costs least; gives it back if it is best left whole.
fn cells(
    params: &Spacetime,
    growing: &mut Growing<'_>,
    mut open: Open,
    most_around: usize,
) -> Result<[Open; 2], Open> {
    if open.depth + 1 >= most_around {
        return Err(open);
    }
    let bounds = open.bounds();
    // What is around the children is empty.
    open.cell = open.cell.meet(bounds.within);
    let whole = bounds.mean_area();
    let most = whole * (growing.weight(&open.inside) - CUT);
    let best = if open.inside.len() == 1 {
        None
    } else {
        let planes = if open.inside.len() > LARGE { 1 } else { params.planes };
        let planes = candidates(&open.cell, planes);
        let priced = planes.map(|plane| (plane.price(growing, &open), plane));
        priced.reduce(|best, plane| if plane.0 < best.0 { plane } else { best })
    };
    let least = best.as_ref().map_or(most, |best| best.0.min(most));
    if let Some(halves) = in_time(params, growing, &mut open, least) {
        return Ok(halves);
    }
    match best.filter(|best| best.0 < most) {
        Some((_, plane)) => plane.cut(open),
        None => Err(open),
    }
}

/// The two halves of the time, if that is so much cheaper than `cost`.
fn in_time(
    params: &Spacetime,
    growing: &mut Growing<'_>,
    open: &mut Open,
    cost: f64,
) -> Option<[Open; 2]> {
    let long = f64::from(open.time[1] - open.time[0]) * f64::from(1u32 << params.halvings) > 1.0;
    let fits = 2.0 * open.inside.len() as f64 <= open.room;
    if !(long && fits && open.moves()) {
        return None;
    }
    let halves = growing.in_time(open);
    let price = |half: &Open| half.bounds().mean_area() * growing.weight(&half.inside) * 0.5;
    let price = f64::from(params.bias) * halves.iter().map(price).sum::<f64>();
    let none_empty = halves.iter().all(|half| !half.inside.is_empty());
    (price < cost && none_empty).then_some(halves)
}

/// A plane across an axis.
#[derive(Clone, Copy)]
struct Plane {
    axis: usize,
    at: f32,
}

/// Planes equally spaced in a cell, along each axis where it is not as narrow as rounding.
fn candidates(cell: &Aabb, planes: usize) -> impl Iterator<Item = Plane> {
    let (cell, least) = (*cell, 16.0 * Clip::SLACK * cell.reach());
    (0..3).filter(move |&axis| cell.size()[axis] > least).flat_map(move |axis| {
        (1..=planes).map(move |i| {
            let share = i as f32 / (planes + 1) as f32;
            Plane { axis, at: cell.min[axis] + (cell.max[axis] - cell.min[axis]) * share }
        })
    })
}

impl Plane {
    /// The parts of a cell below and above.
    fn halves(self, cell: &Aabb) -> [Aabb; 2] {
        let (mut below, mut above) = (*cell, *cell);
        below.max[self.axis] = self.at;
        above.min[self.axis] = self.at;
        [below, above]
    }

    /// Whether a child is in the part below and in the one above. One that ends exactly at the
    /// plane is on its own side only: box tests reach beyond the plane.
    fn sides(self, one: &Reference, halves: &[Aabb; 2]) -> [bool; 2] {
        let hull = one.bounds.within;
        let [below, above] = [hull.min[self.axis] < self.at, hull.max[self.axis] > self.at];
        if one.bounds.is_still() {
            return [below || !above, above];
        }
        let above = above && one.bounds.passes(&halves[1]);
        let below = below && one.bounds.passes(&halves[0]);
        // Flat in the plane, or lost to rounding.
        [below || !above, above]
    }

    /// What the children cost on both sides.
    fn price(self, growing: &Growing<'_>, open: &Open) -> f64 {
        let halves = self.halves(&open.cell);
        let (mut moving, mut weights, mut entries) = ([Linear::EMPTY; 2], [0.0; 2], 0.0);
        let mut still = [Aabb::EMPTY; 2];
        for one in &open.inside {
            let weight = f64::from(growing.of.weights[one.child as usize]);
            let (sides, stays) = (self.sides(one, &halves), one.bounds.is_still());
            for side in (0..2).filter(|&side| sides[side]) {
                weights[side] += weight;
                entries += 1.0;
                if stays {
                    still[side] = still[side].join(one.bounds.within);
                } else {
                    moving[side] = moving[side].join(one.bounds.cut_to(&halves[side]));
                }
            }
        }
        let price = |side: usize| match weights[side] {
            0.0 => 0.0,
            weight => {
                let still = Linear::still(still[side].meet(halves[side]));
                moving[side].join(still).mean_area() * weight
            }
        };
        // What moves through both sides takes room that a cut in time may need.
        let moving = if open.moves() { entries / open.inside.len() as f64 } else { 1.0 };
        (price(0) + price(1)) * moving
    }

    /// What is below and above, unless it is too much, or the same.
    fn cut(self, open: Open) -> Result<[Open; 2], Open> {
        let halves = self.halves(&open.cell);
        let on = |side: usize| -> Vec<Reference> {
            let inside = open.inside.iter().copied();
            inside.filter(|one| self.sides(one, &halves)[side]).collect()
        };
        let [below, above] = [on(0), on(1)];
        let entries = (below.len() + above.len()) as f64;
        let same = below.len().max(above.len()) == open.inside.len();
        if entries > open.room || same && below.len().min(above.len()) == 0 {
            return Err(open);
        }
        let share = below.len() as f64 / entries;
        let below = Open { cell: halves[0], ..open.part_of(below, share) };
        let above = Open { cell: halves[1], ..open.part_of(above, 1.0 - share) };
        Ok([below, above])
    }
}
