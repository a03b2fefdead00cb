//! Random numbers that depend on nothing but a seed and how many were asked for.

use glam::DVec3;

/// Numbers in a fixed order, each mixed from a counter [Steele 14].
#[derive(Clone, Copy, Debug)]
pub(super) struct Random(u64);

impl Random {
    /// The numbers of a seed.
    pub(super) fn new(seed: u64) -> Self {
        Self(mix(seed))
    }

    /// 64 random bits.
    pub(super) fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        mix(self.0)
    }

    /// A number in `[0, 1)`.
    pub(super) fn unit(&mut self) -> f64 {
        (self.bits() >> 11) as f64 / (1u64 << 53) as f64
    }

    /// A number in `[from, to)`.
    pub(super) fn between(&mut self, from: f64, to: f64) -> f64 {
        from + (to - from) * self.unit()
    }

    /// A point of the cube `[−1, 1]³`.
    pub(super) fn in_cube(&mut self) -> DVec3 {
        let [x, y, z] = std::array::from_fn(|_| self.between(-1.0, 1.0));
        DVec3::new(x, y, z)
    }

    /// A direction, all alike.
    pub(super) fn direction(&mut self) -> DVec3 {
        loop {
            let v = self.in_cube();
            let square = v.length_squared();
            if square > 1e-6 && square <= 1.0 {
                return v / square.sqrt();
            }
        }
    }
}

/// Stirs 64 bits so that each depends on all.
pub(super) fn mix(x: u64) -> u64 {
    let x = (x ^ (x >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let x = (x ^ (x >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    x ^ (x >> 31)
}
