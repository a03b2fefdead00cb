//! Cells as plain as those of old programs: every cell is there, empty or not, a child is listed in
//! each that its box touches, and nothing is weighed but where planes are, if that is asked for.
//! They say what is counted where ours differ.

use glam::DVec3;

/// The box of a child.
#[derive(Clone, Copy, Debug)]
pub struct Part {
    /// Its lowest corner.
    pub min: DVec3,
    /// Its highest corner.
    pub max: DVec3,
}

/// A ray, and what becomes of it.
#[derive(Clone, Debug)]
pub struct Shot {
    /// Where it begins.
    pub origin: DVec3,
    /// Where it goes.
    pub dir: DVec3,
    /// Where it ends: at what it hits, or at the light.
    pub end: f64,
    /// If it goes to a light, the children in its way.
    pub blockers: Vec<u32>,
}

/// All children, and all rays.
#[derive(Debug)]
pub struct Plain {
    parts: Vec<Part>,
    shots: Vec<Shot>,
    /// What is cut.
    whole: Part,
}

/// What is done in plain cells, for a ray on average.
#[derive(Clone, Copy, Debug, Default)]
pub struct Visits {
    /// Tests of children.
    pub tests: f64,
    /// Cells, those included that are cut further.
    pub cells: f64,
    /// Cells, if each that is not cut is looked for from the root.
    pub located: f64,
}

/// Where cells are cut.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Places {
    /// In the middle.
    Middle,
    /// Where tests cost least, of a few places from the middle of the cell to that of the children.
    ByCost,
}

/// Places tried for each plane.
const PLACES: usize = 10;

/// A cell.
#[derive(Debug)]
enum Cell {
    /// With these children.
    Whole(Vec<u32>),
    /// In eighths by planes through this point.
    Eighths(DVec3, Box<[Self; 8]>),
}

impl Plain {
    /// These children and rays, in the box of the children.
    #[must_use]
    pub fn new(parts: Vec<Part>, shots: Vec<Shot>) -> Self {
        let none = Part { min: DVec3::INFINITY, max: DVec3::NEG_INFINITY };
        let whole = parts.iter().fold(none, |all, part| Part {
            min: all.min.min(part.min),
            max: all.max.max(part.max),
        });
        Self { parts, shots, whole }
    }

    /// The same in a cube around that box.
    #[must_use]
    pub fn in_a_cube(self) -> Self {
        let Part { min, max } = self.whole;
        let (middle, half) = ((min + max) * 0.5, (max - min).max_element() * 0.5);
        Self { whole: Part { min: middle - half, max: middle + half }, ..self }
    }

    /// What rays do in an octree whose cells with more than one child are cut in two along all axes,
    /// at most `depth` times.
    #[must_use]
    pub fn octree(&self, depth: u32, places: Places) -> Visits {
        let all = (0..self.parts.len() as u32).collect();
        let root = self.eighths(self.whole, all, depth, places);
        let mut sum = Visits::default();
        for shot in &self.shots {
            if let Some(span) = self.whole.cut(shot) {
                root.meet(shot, span, 1, &mut sum);
            }
        }
        let each = |sum: f64| sum / self.shots.len() as f64;
        Visits { tests: each(sum.tests), cells: each(sum.cells), located: each(sum.located) }
    }

    fn eighths(&self, cell: Part, inside: Vec<u32>, depth: u32, places: Places) -> Cell {
        if inside.len() <= 1 || depth == 0 {
            return Cell::Whole(inside);
        }
        let mut middle = (cell.min + cell.max) * 0.5;
        if places == Places::ByCost {
            middle = DVec3::from_array([0, 1, 2].map(|axis| self.cheapest(&cell, &inside, axis)));
        }
        let eighth = |number: usize| {
            let mut part = cell;
            for axis in 0..3 {
                let end = if number >> axis & 1 == 1 { &mut part.min } else { &mut part.max };
                end[axis] = middle[axis];
            }
            let touches = |&child: &u32| self.parts[child as usize].touches(&part);
            let inside = inside.iter().copied().filter(touches).collect();
            self.eighths(part, inside, depth - 1, places)
        };
        Cell::Eighths(middle, Box::new([0, 1, 2, 3, 4, 5, 6, 7].map(eighth)))
    }

    /// Where a plane across an axis makes tests of the children cheapest for a random line.
    fn cheapest(&self, cell: &Part, inside: &[u32], axis: usize) -> f64 {
        let ends = inside.iter().map(|&child| {
            let part = &self.parts[child as usize];
            [part.min[axis], part.max[axis]]
        });
        let ends: Vec<[f64; 2]> = ends.collect();
        let [low, high] = [cell.min[axis], cell.max[axis]];
        let mut centers: Vec<f64> =
            ends.iter().map(|[min, max]| (min.max(low) + max.min(high)) * 0.5).collect();
        let half = centers.len() / 2;
        let (_, &mut median, _) = centers.select_nth_unstable_by(half, f64::total_cmp);
        let size = cell.max - cell.min;
        let (b, c) = (size[(axis + 1) % 3], size[(axis + 2) % 3]);
        let area = |length: f64| length * (b + c) + b * c;
        let cost = |at: f64| {
            let below = ends.iter().filter(|[min, _]| *min < at).count() as f64;
            let above = ends.iter().filter(|[_, max]| *max > at).count() as f64;
            below * area(at - low) + above * area(high - at)
        };
        let middle = (low + high) * 0.5;
        (0..PLACES)
            .map(|place| middle + (median - middle) * (place as f64 / (PLACES - 1) as f64))
            .filter(|&at| low < at && at < high)
            .map(|at| (at, cost(at)))
            .min_by(|a, b| a.1.total_cmp(&b.1))
            .map_or(middle, |(at, _)| at)
    }
}

impl Part {
    /// Whether a child is in a cell: also if it begins where the cell ends, but if it ends where
    /// the cell begins only if it is flat.
    fn touches(&self, cell: &Self) -> bool {
        (0..3).all(|axis| {
            let begins = self.min[axis] >= cell.min[axis] || self.max[axis] > cell.min[axis];
            begins && self.min[axis] <= cell.max[axis]
        })
    }

    /// Where a ray is inside.
    fn cut(&self, shot: &Shot) -> Option<[f64; 2]> {
        let (mut from, mut to) = (0.0_f64, shot.end);
        for axis in 0..3 {
            // Without a way along the axis one of them is infinite, or both are NaN, which changes
            // nothing.
            let low = (self.min[axis] - shot.origin[axis]) / shot.dir[axis];
            let high = (self.max[axis] - shot.origin[axis]) / shot.dir[axis];
            from = from.max(low.min(high));
            to = to.min(low.max(high));
        }
        (from <= to).then_some([from, to])
    }
}

impl Cell {
    /// Sends a ray through, from here to there; says whether that was all of its way.
    fn meet(&self, shot: &Shot, [from, to]: [f64; 2], depth: u32, sum: &mut Visits) -> bool {
        sum.cells += 1.0;
        match self {
            Self::Whole(inside) => {
                sum.located += f64::from(depth);
                let blocker = inside.iter().position(|child| shot.blockers.contains(child));
                sum.tests += blocker.map_or(inside.len(), |at| at + 1) as f64;
                blocker.is_some() || shot.end <= to
            }
            Self::Eighths(middle, eighths) => {
                let (mut eighth, mut crossings) = (0, Vec::with_capacity(3));
                for axis in 0..3 {
                    let crossing = (middle[axis] - shot.origin[axis]) / shot.dir[axis];
                    let is_above = if shot.dir[axis] > 0.0 {
                        crossing <= from
                    } else if shot.dir[axis] < 0.0 {
                        crossing > from
                    } else {
                        shot.origin[axis] >= middle[axis]
                    };
                    eighth |= usize::from(is_above) << axis;
                    if crossing > from && crossing < to {
                        crossings.push((crossing, axis));
                    }
                }
                crossings.sort_by(|a, b| a.0.total_cmp(&b.0));
                let mut at = from;
                for (crossing, axis) in crossings {
                    if eighths[eighth].meet(shot, [at, crossing], depth + 1, sum) {
                        return true;
                    }
                    eighth ^= 1 << axis;
                    at = crossing;
                }
                eighths[eighth].meet(shot, [at, to], depth + 1, sum)
            }
        }
    }
}
