//! A patch as a ray sees it: two coordinates that are zero where the ray passes.

use glam::Vec3A;
use nestray_core::ray::Ray;

/// One coordinate of a net of control points, or of a part of one.
pub(super) type Grid = [[f64; 4]; 4];

/// A grid from what each place holds. Written out: `map` over arrays is not always inlined.
#[inline(always)]
pub(super) fn grid(at: impl Fn(usize, usize) -> f64) -> Grid {
    let mut grid = [[0.0; 4]; 4];
    for (i, row) in grid.iter_mut().enumerate() {
        *row = self::row(|j| at(i, j));
    }
    grid
}

/// A row of a grid.
#[inline(always)]
pub(super) fn row(at: impl Fn(usize) -> f64) -> [f64; 4] {
    [at(0), at(1), at(2), at(3)]
}

/// A patch with the ray as its z axis: a shear, so that patches that share control points
/// see the same numbers.
pub(super) struct Net {
    pub(super) x: Grid,
    pub(super) y: Grid,
    /// Parameters of the ray.
    pub(super) t: Grid,
    /// Whether `∂x/∂u ∂y/∂v − ∂x/∂v ∂y/∂u` is positive where the ray arrives at the back.
    pub(super) along: bool,
}

/// Place, and derivatives by `u` and by `v`.
#[derive(Clone, Copy)]
pub(super) struct At {
    pub(super) x: [f64; 3],
    pub(super) y: [f64; 3],
}

impl Net {
    #[inline]
    pub(super) fn new(points: &[[Vec3A; 4]; 4], ray: &Ray) -> Self {
        let (origin, dir) = (ray.origin().to_array(), ray.dir().to_array());
        let size = dir.map(f32::abs);
        let c = if size[0] > size[1] && size[0] > size[2] {
            0
        } else {
            1 + usize::from(size[1] <= size[2])
        };
        let (a, b) = ((c + 1) % 3, (c + 2) % 3);
        let [oa, ob, oc] = [a, b, c].map(|axis| f64::from(origin[axis]));
        let inverse = 1.0 / f64::from(dir[c]);
        let [sa, sb] = [a, b].map(|axis| f64::from(dir[axis]) * inverse);
        let depth = grid(|i, j| f64::from(points[i][j][c]) - oc);
        let aside = |axis: usize, from: f64, slope: f64| {
            grid(|i, j| (f64::from(points[i][j][axis]) - from) - slope * depth[i][j])
        };
        Self {
            x: aside(a, oa, sa),
            y: aside(b, ob, sb),
            t: grid(|i, j| depth[i][j] * inverse),
            along: dir[c] > 0.0,
        }
    }

    /// Both coordinates at a place.
    #[inline]
    pub(super) fn at(&self, [u, v]: [f64; 2]) -> At {
        let (u, v) = (Weights::new(u), Weights::new(v));
        At { x: u.blend(&v, &self.x), y: u.blend(&v, &self.y) }
    }

    /// The parameter of the ray at a place.
    pub(super) fn depth(&self, [u, v]: [f64; 2]) -> f64 {
        Weights::new(u).blend(&Weights::new(v), &self.t)[0]
    }
}

/// What each of four control points counts, for the place and for the derivative.
pub(super) struct Weights {
    pub(super) value: [f64; 4],
    pub(super) slope: [f64; 4],
}

impl Weights {
    #[inline]
    pub(super) fn new(u: f64) -> Self {
        let v = 1.0 - u;
        let (uu, vv, uv) = (u * u, v * v, u * v);
        Self {
            value: [vv * v, 3.0 * (vv * u), 3.0 * (v * uu), uu * u],
            slope: [-3.0 * vv, 3.0 * (vv - 2.0 * uv), 3.0 * (2.0 * uv - uu), 3.0 * uu],
        }
    }

    /// Value and derivatives, with these weights across rows and `v` along them.
    #[inline(always)]
    fn blend(&self, v: &Self, grid: &Grid) -> [f64; 3] {
        let down = |w: &[f64; 4]| {
            row(|j| {
                (w[0] * grid[0][j] + w[1] * grid[1][j]) + (w[2] * grid[2][j] + w[3] * grid[3][j])
            })
        };
        let (value, slope) = (down(&self.value), down(&self.slope));
        [dot(&value, &v.value), dot(&slope, &v.value), dot(&value, &v.slope)]
    }
}

#[inline(always)]
fn dot(a: &[f64; 4], b: &[f64; 4]) -> f64 {
    (a[0] * b[0] + a[1] * b[1]) + (a[2] * b[2] + a[3] * b[3])
}

/// The lower and the upper part of a net, cut across `u` [de Casteljau 59].
#[inline]
pub(super) fn cut(grid: &Grid, u: f64) -> [Grid; 2] {
    let between = |a: &[f64; 4], b: &[f64; 4]| row(|j| a[j] + (b[j] - a[j]) * u);
    let [a, b, c, d] = grid;
    let (ab, bc, cd) = (between(a, b), between(b, c), between(c, d));
    let (abc, bcd) = (between(&ab, &bc), between(&bc, &cd));
    let middle = between(&abc, &bcd);
    [[*a, ab, abc, middle], [middle, bcd, cd, *d]]
}

/// The part of a net between two values of `u`.
#[inline]
pub(super) fn section(grid: &Grid, [from, to]: [f64; 2]) -> Grid {
    let [below, _] = cut(grid, to);
    if from > 0.0 { cut(&below, from / to)[1] } else { below }
}

/// The same net with `u` and `v` in each other's place.
#[inline]
pub(super) fn flipped(from: &Grid) -> Grid {
    grid(|i, j| from[j][i])
}
