//! The plane of least expected cost through a cell.

use crate::cells::{Cell, Plane};

use super::KdTree;

/// Cells with more children are cut at one of a few equally spaced planes.
const EXACT: usize = 64;
/// Parts of a cell between such planes, along one axis.
const BINS: usize = 32;

/// A search for the best plane.
pub(super) struct Sweep<'a> {
    params: &'a KdTree,
    cell: &'a Cell<'a>,
    all: Side,
    best: Option<(Plane, f64)>,
}

/// The children on one side of a plane.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Side {
    count: usize,
    weight: f64,
}

impl Side {
    fn add(&mut self, weight: f64) {
        self.count += 1;
        self.weight += weight;
    }

    fn plus(self, other: Self) -> Self {
        Self { count: self.count + other.count, weight: self.weight + other.weight }
    }
}

impl<'a> Sweep<'a> {
    pub(super) fn new(params: &'a KdTree, cell: &'a Cell<'a>) -> Self {
        let mut all = Side::default();
        for &child in cell.inside {
            all.add(f64::from(cell.children.weights[child as usize]));
        }
        Self { params, cell, all, best: None }
    }

    /// The plane of least expected cost, and that cost.
    pub(super) fn best(mut self) -> Option<(Plane, f64)> {
        for axis in 0..3 {
            if self.cell.inside.len() <= EXACT {
                self.try_all(axis);
            } else {
                self.try_some(axis);
            }
        }
        self.best
    }

    /// Tries the planes where a child begins or ends: the best is one of them.
    fn try_all(&mut self, axis: usize) {
        let cell = self.cell;
        let parts = || {
            cell.inside.iter().map(|&child| {
                (cell.part(child, axis), f64::from(cell.children.weights[child as usize]))
            })
        };
        let mut begins: Vec<(f32, f64)> = parts().map(|([low, _], w)| (low, w)).collect();
        let mut ends: Vec<(f32, f64)> = parts().map(|([_, high], w)| (high, w)).collect();
        begins.sort_unstable_by(|a, b| a.0.total_cmp(&b.0));
        ends.sort_unstable_by(|a, b| a.0.total_cmp(&b.0));
        let (mut begun, mut ended) = (Side::default(), Side::default());
        let (mut next_begin, mut next_end) = (begins.iter().peekable(), ends.iter().peekable());
        while let Some(&&(end, _)) = next_end.peek() {
            let at = next_begin.peek().map_or(end, |&&(begin, _)| begin.min(end));
            while let Some((_, weight)) = next_end.next_if(|(end, _)| *end <= at) {
                ended.add(*weight);
            }
            self.offer(Plane { axis, at }, begun, ended);
            while let Some((_, weight)) = next_begin.next_if(|(begin, _)| *begin <= at) {
                begun.add(*weight);
            }
        }
    }

    /// Tries equally spaced planes.
    fn try_some(&mut self, axis: usize) {
        let [low, high] = self.cell.extent(axis);
        let scale = BINS as f32 / (high - low);
        let bin = |x: f32| (((x - low) * scale) as usize).min(BINS - 1);
        let (mut begins, mut ends) = ([Side::default(); BINS], [Side::default(); BINS]);
        for &child in self.cell.inside {
            let [begin, end] = self.cell.part(child, axis);
            let weight = f64::from(self.cell.children.weights[child as usize]);
            begins[bin(begin)].add(weight);
            ends[bin(end)].add(weight);
        }
        let (mut begun, mut ended) = (Side::default(), Side::default());
        for plane in 1..BINS {
            begun = begun.plus(begins[plane - 1]);
            ended = ended.plus(ends[plane - 1]);
            let at = low + (high - low) * (plane as f32 / BINS as f32);
            self.offer(Plane { axis, at }, begun, ended);
        }
    }

    /// Weighs a plane that children `begun` before, and that `ended` before or at it.
    fn offer(&mut self, plane: Plane, begun: Side, ended: Side) {
        let [low, high] = self.cell.extent(plane.axis);
        if !(low < plane.at && plane.at < high) {
            return;
        }
        let above = Side {
            count: self.all.count - ended.count,
            weight: (self.all.weight - ended.weight).max(0.0),
        };
        // What is flat and in the plane counts as below.
        let below = if begun.count > ended.count { begun } else { ended };
        let cost = self.cost(plane, below, above);
        if self.best.is_none_or(|(_, least)| cost < least) {
            self.best = Some((plane, cost));
        }
    }

    /// What a random ray through the cell costs if it is cut there and no further.
    fn cost(&self, plane: Plane, below: Side, above: Side) -> f64 {
        let Plane { axis, at } = plane;
        let size = self.cell.bounds.size().as_dvec3();
        let (b, c) = (size[(axis + 1) % 3], size[(axis + 2) % 3]);
        let (low, high) = (f64::from(self.cell.bounds.min[axis]), f64::from(at));
        let area = |length: f64| length * (b + c) + b * c;
        let whole = area(size[axis]).max(f64::MIN_POSITIVE);
        let share = [area(high - low) / whole, area(low + size[axis] - high) / whole];
        let price = |side: Side| self.cell.children.price(side.count, side.weight);
        let mut tests = share[0] * price(below) + share[1] * price(above);
        if !self.cell.children.are_packed() {
            // A ray that crosses the plane tests what is across it once only.
            let across = (below.weight + above.weight - self.all.weight).max(0.0);
            tests -= b * c / whole * across;
        }
        if below.count == 0 || above.count == 0 {
            tests *= 1.0 - f64::from(self.params.empty_bonus);
        }
        f64::from(self.params.step_cost) + tests
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cells::tests::children;

    #[test]
    fn the_plane_is_the_best_of_all_where_a_child_begins_or_ends() {
        for seed in 0..50 {
            let children = children(seed, 2 + seed as usize);
            let inside: Vec<u32> = (0..children.boxes.len() as u32).collect();
            let cell =
                Cell { bounds: children.bounds, depth: 0, inside: &inside, children: &children };
            let params = KdTree::default();
            let sweep = Sweep::new(&params, &cell);
            let mut least = f64::INFINITY;
            for axis in 0..3 {
                for at in inside.iter().flat_map(|&child| cell.part(child, axis)) {
                    let side = |is_in: &dyn Fn([f32; 2]) -> bool| {
                        let mut side = Side::default();
                        for &child in inside.iter().filter(|&&child| is_in(cell.part(child, axis)))
                        {
                            side.add(f64::from(children.weights[child as usize]));
                        }
                        side
                    };
                    let below = side(&|[low, _]| low < at);
                    let above = side(&|[_, high]| high > at);
                    let [low, high] = cell.extent(axis);
                    if low < at && at < high {
                        least = least.min(sweep.cost(Plane { axis, at }, below, above));
                    }
                }
            }
            let (_, cost) = sweep.best().expect("boxes can be told apart");
            assert!((cost - least).abs() <= 1e-9 * least, "seed {seed}: {cost}, not {least}");
        }
    }
}
