//! What was published: counts of V. Havran's renderer GOLEM in 1999, as kept with Haines' standard
//! procedural databases.

use super::PerRay;

/// What was printed for one scene.
#[derive(Clone, Copy, Debug)]
pub struct Printed {
    /// The scene, and its size factor.
    pub scene: &'static str,
    /// See `scene`.
    pub size: u32,
    /// Rays from the eye that hit; of [`EYE`].
    pub eye_hit: u32,
    /// Rays to lights, and how many were blocked.
    pub shadow: [u32; 2],
    /// Reflected and refracted rays, and how many of them hit.
    pub secondary: [u32; 2],
    /// Uniform grids of one and of ten cells a child.
    pub grid: [PerRay; 2],
    /// Recursive grids, two and three deep.
    pub nested: [PerRay; 2],
    /// Octree of halves, located from the root for each cell; tests are for each ray that hits.
    pub octree_located: PerRay,
    /// The same, recursive.
    pub octree: PerRay,
    /// Octree of planes where they cost least, recursive; tests are for each ray that hits.
    pub octree_by_cost: PerRay,
    /// How often space was cut for `octree`: printed for balls, lattice and tree, for the others
    /// what fits best.
    pub depth: u32,
    /// The same for `octree_by_cost`: what fits best.
    pub depth_by_cost: u32,
}

/// Rays from the eye.
pub const EYE: u32 = 513 * 513;

impl Printed {
    /// All rays.
    #[must_use]
    pub fn rays(&self) -> u32 {
        EYE + self.shadow[0] + self.secondary[0]
    }

    /// Which part of them hit something.
    #[must_use]
    pub fn hitting(&self) -> f64 {
        f64::from(self.eye_hit + self.shadow[1] + self.secondary[1]) / f64::from(self.rays())
    }
}

const fn per_ray(tests: f64, steps: f64) -> PerRay {
    PerRay { tests, steps }
}

/// Tests for each ray that hits, by the octree located from the root, cut four, five, six and
/// seven times.
pub const BY_DEPTH: [(&str, [f64; 4]); 3] = [
    ("balls", [1787.0, 578.0, 210.0, 95.0]),
    ("lattice", [28.6, 13.8, 11.1, 10.8]),
    ("tree", [8066.0, 4201.0, 2098.0, 741.0]),
];

/// All scenes we can make; his ninth, fluid, was never given away.
pub const PRINTED: [Printed; 8] = [
    Printed {
        scene: "balls",
        size: 4,
        eye_hit: 263_169,
        shadow: [959_244, 285_178],
        secondary: [179_884, 134_368],
        grid: [per_ray(358.66, 5.69), per_ray(72.54, 12.4)],
        nested: [per_ray(25.67, 14.29), per_ray(16.94, 16.87)],
        octree_located: per_ray(94.75, 167.0),
        octree: per_ray(89.93, 50.67),
        octree_by_cost: per_ray(26.38, 16.64),
        depth: 7,
        depth_by_cost: 5,
    },
    Printed {
        scene: "gears",
        size: 4,
        eye_hit: 245_332,
        shadow: [2_088_012, 1_057_557],
        secondary: [494_338, 365_338],
        grid: [per_ray(39.76, 6.84), per_ray(22.82, 13.83)],
        nested: [per_ray(27.18, 11.42), per_ray(27.72, 14.27)],
        octree_located: per_ray(71.38, 46.49),
        octree: per_ray(69.62, 18.71),
        octree_by_cost: per_ray(65.44, 11.7),
        depth: 7,
        depth_by_cost: 6,
    },
    Printed {
        scene: "lattice",
        size: 12,
        eye_hit: 261_170,
        shadow: [1_180_774, 943_159],
        secondary: [243_210, 178_786],
        grid: [per_ray(20.67, 5.09), per_ray(9.26, 10.56)],
        nested: [per_ray(34.87, 6.4), per_ray(34.87, 6.4)],
        octree_located: per_ray(13.8, 47.88),
        octree: per_ray(12.32, 17.68),
        octree_by_cost: per_ray(8.99, 17.62),
        depth: 5,
        depth_by_cost: 5,
    },
    Printed {
        scene: "mount",
        size: 6,
        eye_hit: 173_685,
        shadow: [361_037, 74_555],
        secondary: [710_436, 472_351],
        grid: [per_ray(19.01, 8.85), per_ray(13.17, 18.43)],
        nested: [per_ray(15.97, 11.45), per_ray(15.51, 12.42)],
        octree_located: per_ray(23.72, 30.89),
        octree: per_ray(22.61, 13.37),
        octree_by_cost: per_ray(16.56, 12.72),
        depth: 5,
        depth_by_cost: 5,
    },
    Printed {
        scene: "rings",
        size: 7,
        eye_hit: 263_169,
        shadow: [1_077_336, 510_719],
        secondary: [312_879, 175_688],
        grid: [per_ray(45.29, 11.78), per_ray(23.36, 24.51)],
        nested: [per_ray(30.88, 18.25), per_ray(30.46, 18.51)],
        octree_located: per_ray(35.12, 81.9),
        octree: per_ray(34.87, 28.59),
        octree_by_cost: per_ray(31.81, 18.65),
        depth: 6,
        depth_by_cost: 5,
    },
    Printed {
        scene: "teapot",
        size: 12,
        eye_hit: 161_546,
        shadow: [406_340, 34_757],
        secondary: [226_235, 67_688],
        grid: [per_ray(33.65, 14.98), per_ray(15.13, 32.5)],
        nested: [per_ray(18.16, 18.75), per_ray(17.53, 19.67)],
        octree_located: per_ray(45.63, 64.67),
        octree: per_ray(44.21, 23.31),
        octree_by_cost: per_ray(47.91, 19.16),
        depth: 6,
        depth_by_cost: 5,
    },
    Printed {
        scene: "tetra",
        size: 6,
        eye_hit: 49_950,
        shadow: [46_262, 5_538],
        secondary: [0, 0],
        grid: [per_ray(20.64, 7.43), per_ray(10.01, 15.97)],
        nested: [per_ray(21.32, 12.29), per_ray(21.49, 12.34)],
        octree_located: per_ray(63.58, 32.08),
        octree: per_ray(61.11, 12.7),
        octree_by_cost: per_ray(24.08, 13.85),
        depth: 5,
        depth_by_cost: 7,
    },
    Printed {
        scene: "tree",
        size: 11,
        eye_hit: 169_907,
        shadow: [1_110_323, 47_506],
        secondary: [0, 0],
        grid: [per_ray(727.62, 7.6), per_ray(246.08, 15.45)],
        nested: [per_ray(19.86, 13.65), per_ray(12.03, 14.62)],
        octree_located: per_ray(741.3, 219.3),
        octree: per_ray(738.0, 65.9),
        octree_by_cost: per_ray(23.79, 18.46),
        depth: 7,
        depth_by_cost: 7,
    },
];
