//! Roots of a quartic, none of them lost: bracketed between its turning points, which are
//! bracketed between those of its derivative.

/// `s⁴ + square · s² + linear · s + constant`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Quartic {
    pub(super) square: f64,
    pub(super) linear: f64,
    pub(super) constant: f64,
}

impl Quartic {
    /// Value and slope.
    fn at(&self, s: f64) -> (f64, f64) {
        let cubic = (s * s + self.square) * s + self.linear;
        (cubic * s + self.constant, self.derived(s).0)
    }

    /// Value and slope of the derivative.
    fn derived(&self, s: f64) -> (f64, f64) {
        let square = s * s;
        ((4.0 * square + 2.0 * self.square) * s + self.linear, 12.0 * square + 2.0 * self.square)
    }

    /// Calls `found` with every place within `(-limit, limit)` where the sign changes, in
    /// order, and whether it becomes negative there. A zero counts as positive: what only
    /// touches is no root.
    pub(super) fn each_root(&self, limit: f64, mut found: impl FnMut(f64, bool)) {
        // Where the derivative turns.
        let bend = (-self.square / 6.0).max(0.0).sqrt().min(limit);
        let mut stations = [limit; 5];
        stations[0] = -limit;
        let mut count = 1;
        for [low, high] in [[-limit, -bend], [-bend, bend], [bend, limit]] {
            if let Some((turn, _)) = between(low, high, 1e-7, |s| self.derived(s)) {
                stations[count] = turn;
                count += 1;
            }
        }
        for pair in stations[..=count].windows(2) {
            if let Some((root, falling)) = between(pair[0], pair[1], 1e-9, |s| self.at(s)) {
                found(root, falling);
            }
        }
    }
}

/// Where a function that is monotone from `low` to `high` changes sign, if it does, and
/// whether it falls: Newton's steps, halves where they leave the bracket.
#[inline]
fn between(low: f64, high: f64, fine: f64, at: impl Fn(f64) -> (f64, f64)) -> Option<(f64, bool)> {
    let falling = at(low).0 >= 0.0;
    if low >= high || falling == (at(high).0 >= 0.0) {
        return None;
    }
    let (mut low, mut high) = (low, high);
    let mut s = (low + high) / 2.0;
    // Halving alone would end after sixty; Newton takes five.
    for _ in 0..80 {
        let (value, slope) = at(s);
        if (value >= 0.0) == falling {
            low = s;
        } else {
            high = s;
        }
        let step = s - value / slope;
        if step >= low && step <= high {
            // The error is squared in each step.
            if (step - s).abs() <= fine {
                return Some((step, falling));
            }
            s = step;
        } else {
            s = (low + high) / 2.0;
            if high - low <= 1e-15 {
                break;
            }
        }
    }
    Some((s, falling))
}
