//! How many rays there were.

use nestray_core::ray::RayKind;

/// Rays of one kind.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Count {
    /// How many were cast.
    pub cast: u64,
    /// How many hit something; of shadow rays, how many were blocked.
    pub hit: u64,
}

/// Rays by what they were cast for. One that goes on behind a surface it passes through
/// counts again.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct RayCounts {
    /// From the eye.
    pub camera: Count,
    /// Towards lights.
    pub shadow: Count,
    /// Mirrored.
    pub reflect: Count,
    /// Refracted.
    pub refract: Count,
    /// Scattered.
    pub diffuse: Count,
}

impl RayCounts {
    /// All rays together.
    #[must_use]
    pub fn total(&self) -> Count {
        self.each().into_iter().fold(Count::default(), |all, (_, count)| all.plus(count))
    }

    /// Mirrored and refracted rays together, what reports on Whitted's model call secondary.
    #[must_use]
    pub fn secondary(&self) -> Count {
        self.reflect.plus(self.refract)
    }

    /// Every kind with its name.
    #[must_use]
    pub fn each(&self) -> [(&'static str, Count); 5] {
        [
            ("camera", self.camera),
            ("shadow", self.shadow),
            ("reflect", self.reflect),
            ("refract", self.refract),
            ("diffuse", self.diffuse),
        ]
    }

    /// Adds what others counted.
    pub fn add(&mut self, other: &Self) {
        self.camera = self.camera.plus(other.camera);
        self.shadow = self.shadow.plus(other.shadow);
        self.reflect = self.reflect.plus(other.reflect);
        self.refract = self.refract.plus(other.refract);
        self.diffuse = self.diffuse.plus(other.diffuse);
    }

    /// Counts a ray.
    pub(crate) fn one(&mut self, kind: RayKind, hit: bool) {
        let count = match kind {
            RayKind::Camera => &mut self.camera,
            RayKind::Shadow { .. } => &mut self.shadow,
            RayKind::Reflect => &mut self.reflect,
            RayKind::Refract => &mut self.refract,
            RayKind::Diffuse | RayKind::Custom(_) => &mut self.diffuse,
        };
        *count = count.plus(Count { cast: 1, hit: u64::from(hit) });
    }
}

impl Count {
    fn plus(self, other: Self) -> Self {
        Self { cast: self.cast + other.cast, hit: self.hit + other.hit }
    }
}
