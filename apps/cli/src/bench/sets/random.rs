//! Random numbers that are the same on every machine.

use nestray::prelude::Vec3A;

/// A sequence of them.
pub(super) struct Random(u64);

impl Random {
    pub(super) fn new(seed: u64) -> Self {
        Self(seed)
    }

    /// As `SplitMix64` does [Steele 14].
    fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// From 0 to below 1.
    pub(super) fn part(&mut self) -> f32 {
        (self.bits() >> 40) as f32 / (1_u64 << 24) as f32
    }

    /// A direction, each as likely as any other.
    pub(super) fn on_sphere(&mut self) -> Vec3A {
        // A point of the cube, until it lies in the ball: sines differ from machine to machine.
        loop {
            let at = Vec3A::new(self.part(), self.part(), self.part()) * 2.0 - 1.0;
            let length = at.length();
            if (1e-3..=1.0).contains(&length) {
                return at / length;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn directions_are_unit_vectors_to_all_sides() {
        let mut random = Random::new(7);
        let mut octants = [0_u32; 8];
        for _ in 0..4000 {
            let dir = random.on_sphere();
            assert!((dir.length() - 1.0).abs() < 1e-6);
            octants[(dir.cmpgt(Vec3A::ZERO)).bitmask() as usize] += 1;
        }
        assert!(octants.iter().all(|&count| (400..600).contains(&count)), "{octants:?}");
    }
}
