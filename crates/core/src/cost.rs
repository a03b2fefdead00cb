//! Expected cost of a ray, after [Arvo 90, Appendix A].

use std::collections::BTreeMap;
use std::sync::LazyLock;

use crate::ray::RayKind;

/// What one ray, or one structure, costs.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Cost {
    /// Time of a ray that meets the bounds and hits, in nanoseconds.
    pub hit_nanos: f64,
    /// Time of a ray that meets the bounds and hits nothing, in nanoseconds.
    pub miss_nanos: f64,
    /// Share of the rays that meet the bounds and hit, in `[0, 1]`.
    pub hit_rate: f64,
    /// Memory, in bytes.
    pub bytes: u64,
}

impl Cost {
    /// A primitive that takes as long on a hit as on a miss.
    #[must_use]
    pub const fn primitive(nanos: f64, hit_rate: f64, bytes: u64) -> Self {
        Self { hit_nanos: nanos, miss_nanos: nanos, hit_rate, bytes }
    }

    /// Time of a ray that meets the bounds, in nanoseconds.
    #[must_use]
    pub fn nanos(&self) -> f64 {
        self.hit_rate * self.hit_nanos + (1.0 - self.hit_rate) * self.miss_nanos
    }

    /// The same with `nanos` more for every ray and `bytes` more memory.
    #[must_use]
    pub fn plus(self, nanos: f64, bytes: u64) -> Self {
        Self {
            hit_nanos: self.hit_nanos + nanos,
            miss_nanos: self.miss_nanos + nanos,
            bytes: self.bytes + bytes,
            ..self
        }
    }
}

/// Prices, in nanoseconds, and what rays are asked about.
#[derive(Clone, Debug, PartialEq)]
pub struct CostModel {
    /// What a ray costs whatever it meets.
    pub ray: f64,
    /// What each step and each test costs more every time that a structure doubles beyond
    /// [`NEAR`](Self::NEAR).
    pub far: f64,
    /// Entering an aggregate.
    pub call: f64,
    /// Moving a ray into an instance.
    pub transform: f64,
    /// Testing one primitive, by [`Object::kind`](crate::object::Object::kind).
    pub primitive: BTreeMap<String, f64>,
    /// One step of each technique, by name.
    pub step: BTreeMap<String, f64>,
    /// The kind of ray under study; none for a mix.
    pub kind: Option<RayKind>,
}

impl CostModel {
    /// Bytes that are near the processor however they are used.
    pub const NEAR: u64 = 1 << 18;

    /// What each step and each test costs more in a structure of so many bytes.
    #[must_use]
    pub fn distance(&self, bytes: u64) -> f64 {
        self.far * Self::doublings(bytes)
    }

    /// How often memory doubles from [`NEAR`](Self::NEAR) to so many bytes.
    #[must_use]
    pub fn doublings(bytes: u64) -> f64 {
        (bytes.max(Self::NEAR) as f64 / Self::NEAR as f64).log2()
    }

    /// The default prices, made once: builders ask for the weight of every child.
    #[must_use]
    pub fn usual() -> &'static Self {
        static USUAL: LazyLock<CostModel> = LazyLock::new(CostModel::default);
        &USUAL
    }

    /// Price of one step of `technique`; one never measured costs what a call does.
    #[must_use]
    pub fn step(&self, technique: &str) -> f64 {
        self.step.get(technique).copied().unwrap_or(self.call)
    }

    /// Price of testing one primitive; one never measured costs what a call does.
    #[must_use]
    pub fn primitive(&self, kind: &str) -> f64 {
        self.primitive.get(kind).copied().unwrap_or(self.call)
    }
}

impl Default for CostModel {
    /// Rough prices of a present-day processor, those of shapes rounded from one measurement on a
    /// busy machine: ratios matter, and calibration replaces them.
    fn default() -> Self {
        let named = |prices: &[(&str, f64)]| {
            prices.iter().map(|&(name, nanos)| (name.to_owned(), nanos)).collect()
        };
        Self {
            ray: 0.0,
            far: 0.0,
            call: 15.0,
            transform: 20.0,
            primitive: named(&[
                ("bezier", 700.0),
                ("block", 25.0),
                ("cone", 45.0),
                ("cylinder", 45.0),
                ("disk", 20.0),
                ("height-field", 300.0),
                ("parallelogram", 55.0),
                ("patch", 45.0),
                ("polygon", 55.0),
                ("quadric", 50.0),
                ("sphere", 18.0),
                ("torus", 160.0),
                ("triangle", 3.0),
            ]),
            step: named(&[
                ("adaptive-grid", 5.0),
                ("bvh", 10.0),
                ("goldsmith-salmon", 10.0),
                ("grid", 4.0),
                ("list", 0.0),
                ("macro-regions", 5.0),
                ("motion-bvh", 14.0),
                ("nested-grid", 5.0),
                ("ploc", 10.0),
                ("reinsertion", 10.0),
                ("rubin-whitted", 12.0),
                ("sbvh", 10.0),
                ("slabs", 14.0),
                ("spacetime", 12.0),
            ]),
            kind: None,
        }
    }
}
