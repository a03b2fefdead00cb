//! Polygons cut into triangles by clipping ears [Meisters 75].

use glam::{DVec3, Vec3};

/// Cuts polygons; keeps its working memory.
#[derive(Debug)]
pub(crate) struct Cutter {
    /// Corners seen flat, counter-clockwise.
    flat: Vec<[f64; 2]>,
    previous: Vec<usize>,
    next: Vec<usize>,
    /// Corners that may lie in an ear of others, first to last.
    inward: Vec<usize>,
    /// Comparisons that may still be made, so that no file takes for ever.
    budget: u64,
    /// Polygons whose budget ran out; they are fans as far as they were left.
    given_up: usize,
}

impl Default for Cutter {
    fn default() -> Self {
        /// A few seconds.
        const BUDGET: u64 = 1 << 30;
        Self {
            flat: Vec::new(),
            previous: Vec::new(),
            next: Vec::new(),
            inward: Vec::new(),
            budget: BUDGET,
            given_up: 0,
        }
    }
}

impl Cutter {
    /// Adds triangles that fill a polygon, two fewer than it has corners, which keep its
    /// corners and its direction. A polygon that is none (crosses itself, has no area) is
    /// cut somehow.
    pub(crate) fn cut(&mut self, corners: &[[f32; 3]], mut triangle: impl FnMut([usize; 3])) {
        let n = corners.len();
        if n < 3 {
            return;
        }
        if n == 3 {
            return triangle([0, 1, 2]);
        }
        if !self.flatten(corners) || self.is_convex() {
            return (1..n - 1).for_each(|i| triangle([0, i, i + 1]));
        }
        self.clip(triangle);
    }

    /// How many polygons were too intricate to be cut well.
    pub(crate) fn given_up(&self) -> usize {
        self.given_up
    }

    /// Looks at the polygon along the axis its normal is nearest to; false if it has
    /// none.
    fn flatten(&mut self, corners: &[[f32; 3]]) -> bool {
        let [first, ..] = corners else { return false };
        let first = Vec3::from_array(*first).as_dvec3();
        let at = |i: usize| Vec3::from_array(corners[i]).as_dvec3() - first;
        let n = corners.len();
        let normal: DVec3 = (0..n).map(|i| at(i).cross(at((i + 1) % n))).sum();
        let axis = normal.abs().max_position();
        if !(normal[axis].abs() > 0.0 && normal[axis].is_finite()) {
            return false;
        }
        let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
        let (u, v) = if normal[axis] > 0.0 { (u, v) } else { (v, u) };
        self.flat.clear();
        self.flat.extend((0..n).map(|i| [at(i)[u], at(i)[v]]));
        true
    }

    /// Whether it turns left at every corner, and only once around.
    fn is_convex(&self) -> bool {
        let n = self.flat.len();
        let mut turns = 0;
        for i in 0..n {
            let [a, b, c] = [i, (i + 1) % n, (i + 2) % n];
            if self.area(a, b, c) <= 0.0 {
                return false;
            }
            let right = |a: usize, b: usize| self.flat[b][0] > self.flat[a][0];
            turns += usize::from(right(a, b) != right(b, c));
        }
        turns <= 2
    }

    fn clip(&mut self, mut triangle: impl FnMut([usize; 3])) {
        let n = self.flat.len();
        self.previous.clear();
        self.previous.extend((0..n).map(|i| (i + n - 1) % n));
        self.next.clear();
        self.next.extend((0..n).map(|i| (i + 1) % n));
        self.inward.clear();
        let inward = (0..n).filter(|&i| self.area((i + n - 1) % n, i, (i + 1) % n) <= 0.0);
        let inward: Vec<usize> = inward.collect();
        self.inward.extend(inward);
        // How bad an ear may be, since none has been found for a whole round.
        let mut lenience = 0;
        let (mut at, mut left, mut tried) = (0, n, 0);
        while left > 3 {
            if lenience < 2 && self.budget == 0 {
                lenience = 2;
                self.given_up += 1;
            }
            let (before, after) = (self.previous[at], self.next[at]);
            if lenience >= 2 || self.is_ear(at, lenience > 0) {
                triangle([before, at, after]);
                self.next[before] = after;
                self.previous[after] = before;
                // Marks it as gone.
                self.next[at] = usize::MAX;
                left -= 1;
                tried = 0;
                if self.budget > 0 {
                    lenience = 0;
                }
                // Not the very next: slivers would fan out.
                at = self.next[after];
            } else {
                at = after;
                tried += 1;
                if tried > left {
                    lenience += 1;
                    tried = 0;
                }
            }
        }
        triangle([self.previous[at], at, self.next[at]]);
    }

    /// Whether a corner can be cut off: it points outwards, or straight on if `flat` will do,
    /// and no other corner is in the way.
    fn is_ear(&mut self, corner: usize, flat: bool) -> bool {
        let [a, b, c] = [self.previous[corner], corner, self.next[corner]];
        let area = self.area(a, b, c);
        if area < 0.0 || (area == 0.0 && !flat) {
            return false;
        }
        if self.inward.len() > 64 {
            let next = &self.next;
            let gone = self.inward.iter().filter(|&&i| next[i] == usize::MAX).count();
            if gone * 2 > self.inward.len() {
                self.inward.retain(|&i| next[i] != usize::MAX);
            }
        }
        self.budget = self.budget.saturating_sub(1 + self.inward.len() as u64);
        let [p, q, r] = [self.flat[a], self.flat[b], self.flat[c]];
        !self.inward.iter().any(|&i| {
            let s = self.flat[i];
            self.next[i] != usize::MAX
                && s != p
                && s != q
                && s != r
                && self.area(a, b, i) >= 0.0
                && self.area(b, c, i) >= 0.0
                && self.area(c, a, i) >= 0.0
        })
    }

    /// Twice the area of a triangle; negative if it turns right.
    fn area(&self, a: usize, b: usize, c: usize) -> f64 {
        let [a, b, c] = [a, b, c].map(|i| self.flat[i]);
        (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn area(corners: &[[f32; 3]]) -> DVec3 {
        let at = |i: usize| Vec3::from_array(corners[i % corners.len()]).as_dvec3();
        (0..corners.len()).map(|i| at(i).cross(at(i + 1))).sum()
    }

    /// Cut, with the sum of the absolute areas, which is that of the polygon if no
    /// triangles lie over one another.
    fn check(corners: &[[f32; 3]]) -> (usize, f64) {
        let (mut count, mut sum) = (0, 0.0);
        let whole = area(corners).normalize();
        Cutter::default().cut(corners, |triangle| {
            let part = area(&triangle.map(|i| corners[i]));
            assert!(part.dot(whole) >= -1e-9, "{triangle:?} looks the other way");
            count += 1;
            sum += part.length();
        });
        (count, sum)
    }

    #[test]
    fn a_concave_polygon_is_filled_and_no_more() {
        // A comb: fans of it would cover the gaps between its teeth.
        let mut comb = vec![[0.0, 0.0, 2.0], [100.0, 0.0, 2.0]];
        for tooth in (0..50).rev() {
            let x = 2.0 * tooth as f32;
            comb.extend([[x + 2.0, 1.0, 2.0], [x + 1.0, 5.0, 2.0]]);
        }
        comb.push([0.0, 1.0, 2.0]);
        for turned in [[0, 1, 2], [1, 2, 0], [2, 0, 1], [1, 0, 2]] {
            let comb: Vec<[f32; 3]> = comb.iter().map(|c| turned.map(|k| c[k])).collect();
            for start in [0, 1, 7, 50] {
                let mut comb = comb.clone();
                comb.rotate_left(start);
                let (count, sum) = check(&comb);
                assert_eq!(count, comb.len() - 2);
                assert!((sum - area(&comb).length()).abs() < 1e-6, "{sum}");
            }
        }
    }

    #[test]
    fn a_dart_is_cut_at_its_dent() {
        let dart = [[0.0, 0.0, 0.0], [2.0, 1.0, 0.0], [0.0, 2.0, 0.0], [1.0, 1.0, 0.0]];
        for start in 0..4 {
            let mut dart = dart;
            dart.rotate_left(start);
            assert_eq!(check(&dart), (2, 2.0));
        }
    }

    #[test]
    fn corners_in_a_line_are_kept() {
        let square = [
            [0.0, 0.0, 0.0],
            [1.0, 0.0, 0.0],
            [2.0, 0.0, 0.0],
            [2.0, 2.0, 0.0],
            [1.0, 2.0, 0.0],
            [0.0, 2.0, 0.0],
        ];
        assert_eq!(check(&square), (4, 8.0));
    }

    #[test]
    fn garbage_is_cut_somehow() {
        let mut cutter = Cutter::default();
        let mut seed = 1u32;
        for round in 0..2000 {
            let n = 3 + round % 40;
            let corners: Vec<[f32; 3]> = (0..n)
                .map(|_| {
                    [0; 3].map(|_| {
                        seed = seed.wrapping_mul(747_796_405).wrapping_add(2_891_336_453);
                        let small = (seed >> 28) as f32;
                        if round % 3 == 0 { f32::from_bits(seed) } else { small }
                    })
                })
                .collect();
            let mut count = 0;
            cutter.cut(&corners, |triangle| {
                assert!(triangle.iter().all(|&i| i < n));
                count += 1;
            });
            assert_eq!(count, n - 2);
        }
    }

    #[test]
    fn an_intricate_polygon_does_not_take_for_ever() {
        let zigzag = |i: u32| [(i * 7919 % 10007) as f32, (i * 104_729 % 10009) as f32, 0.0];
        let corners: Vec<[f32; 3]> = (0..100_000).map(zigzag).collect();
        let mut cutter = Cutter { budget: 1 << 24, ..Cutter::default() };
        let mut count = 0;
        cutter.cut(&corners, |_| count += 1);
        assert_eq!((count, cutter.given_up()), (corners.len() - 2, 1));
    }
}
