//! Pairs of parallel planes around an object.

use glam::{Mat3A, Vec3A};

use crate::aabb::{Aabb, Clip};
use crate::object::Object;
use crate::ray::{Ray, RayKind};

/// What lies between several pairs of parallel planes.
#[derive(Clone, Debug, PartialEq)]
pub struct Planes {
    shape: Shape,
    /// Largest coordinate of what is between, which rounding errors are relative to.
    reach: f32,
}

#[derive(Clone, Debug, PartialEq)]
enum Shape {
    /// Three pairs, across directions that are the rows of a matrix.
    Turned { axes: Mat3A, low: Vec3A, high: Vec3A },
    /// Any number of pairs.
    Slabs(Box<[Pair]>),
}

/// All points with `direction · point` in `[low, high]`.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Pair {
    direction: Vec3A,
    low: f32,
    high: f32,
}

/// How far planes are moved outwards, relative to the largest coordinate: three coordinates add
/// up, each with the slack of a box test, and so does what rounding does to `direction · dir`
/// along the whole way of the ray.
const SLACK: f32 = 64.0 * f32::EPSILON;

/// Price of testing a turned box, in nanoseconds.
const TURNED: f64 = 15.0;
/// Price of testing one of many pairs.
const PAIR: f64 = 5.0;

/// Directions looked at to turn a box.
const LOOKS: u32 = 128;

impl Planes {
    /// The box around `object` of least surface that was found, turned anyhow. None if it has
    /// no bounds.
    #[must_use]
    pub fn turned_box(object: &dyn Object) -> Option<Self> {
        if !is_bounded(object) {
            return None;
        }
        let width = |direction: Vec3A| {
            let [low, high] = object.along(direction);
            high - low
        };
        // Rods have a direction in which they are long, plates one in which they are short.
        let long = climb(&|direction| width(direction));
        let short = climb(&|direction| -width(direction));
        let around = [long, short].map(|first| {
            let (u, v) = first.any_orthonormal_pair();
            let turn = |step: u32| {
                // From no turn to a quarter, without an angle.
                let t = step as f32 / 32.0;
                let (cos, sin) = ((1.0 - t * t) / (1.0 + t * t), 2.0 * t / (1.0 + t * t));
                Mat3A::from_cols(first, u * cos + v * sin, v * cos - u * sin)
            };
            (0..32).map(turn).collect::<Vec<_>>()
        });
        let area = |axes: &Mat3A| {
            let [a, b, c] = [axes.x_axis, axes.y_axis, axes.z_axis].map(width);
            a * b + b * c + c * a
        };
        let all = std::iter::once(Mat3A::IDENTITY).chain(around.into_iter().flatten());
        let best = all.min_by(|a, b| area(a).total_cmp(&area(b)))?;
        let pairs = pairs(object, &[best.x_axis, best.y_axis, best.z_axis])?;
        let end = |end: fn(&Pair) -> f32| Vec3A::from_array([0, 1, 2].map(|i| end(&pairs[i])));
        let (low, high) = (end(|pair| pair.low), end(|pair| pair.high));
        let shape = Shape::Turned { axes: best.transpose(), low, high };
        Some(Self { shape, reach: object.bounds().reach() })
    }

    /// Thirteen slabs around `object`: across the axes, the diagonals of a cube and those of its
    /// faces [Kay 86]. None if it has no bounds.
    #[must_use]
    pub fn slabs(object: &dyn Object) -> Option<Self> {
        let mut directions = Vec::with_capacity(13);
        for x in [-1.0, 0.0, 1.0] {
            for y in [-1.0, 0.0, 1.0] {
                directions.extend([-1.0, 0.0, 1.0].map(|z| Vec3A::new(x, y, z)));
            }
        }
        // Each comes with its opposite; the middle one is none.
        directions.truncate(13);
        if !is_bounded(object) {
            return None;
        }
        let shape = Shape::Slabs(pairs(object, &directions)?);
        Some(Self { shape, reach: object.bounds().reach() })
    }

    /// Whether a ray may meet what is between, up to `limit`.
    #[inline]
    #[must_use]
    pub fn admit(&self, ray: &Ray, limit: f32) -> bool {
        let slack = ray.origin().abs().max_element().max(self.reach) * SLACK;
        // Slower than this is all rounding. The slack has room for what the change moves.
        let least = ray.dir().abs().max_element() * (4.0 * f32::EPSILON);
        match &self.shape {
            Shape::Turned { axes, low, high } => {
                let (speed, middle) = (*axes * ray.dir(), *axes * ray.origin());
                let slow = Vec3A::splat(least).copysign(speed);
                let inverse =
                    Vec3A::ONE / Vec3A::select(speed.abs().cmplt(Vec3A::splat(least)), slow, speed);
                let (a, b) =
                    ((*low - slack - middle) * inverse, (*high + slack - middle) * inverse);
                let enter = a.min(b).max_element().max(ray.t_min());
                let leave = a.max(b).min_element().min(limit);
                // What is no number tells nothing.
                enter <= leave || !(a + b).is_finite()
            }
            Shape::Slabs(pairs) => {
                let (mut enter, mut leave) = (ray.t_min(), limit);
                for pair in pairs {
                    let speed = pair.direction.dot(ray.dir());
                    let speed = if speed.abs() < least { least.copysign(speed) } else { speed };
                    let (inverse, middle) = (1.0 / speed, pair.direction.dot(ray.origin()));
                    let a = (pair.low - slack - middle) * inverse;
                    let b = (pair.high + slack - middle) * inverse;
                    // What is no number narrows nothing.
                    enter = a.min(b).max(enter);
                    leave = a.max(b).min(leave);
                }
                enter <= leave
            }
        }
    }

    /// Of uniformly random rays that meet `bounds`, how many come through; by sample.
    #[must_use]
    pub fn share(&self, bounds: &Aabb) -> f64 {
        const LINES: u32 = 512;
        let radius = 0.5 * bounds.size().length();
        let (mut met, mut through) = (0u32, 0u32);
        for line in 0..LINES {
            let [a, b, c, d] = spread(line);
            let Some(dir) = on_sphere(a, b) else { continue };
            let (u, v) = dir.any_orthonormal_pair();
            let aside = (u * (2.0 * c - 1.0) + v * (2.0 * d - 1.0)) * radius;
            let ray = Ray::new(bounds.center() + aside - dir * radius, dir, RayKind::Camera);
            if Clip::new(&ray, bounds.reach()).cut(bounds, f32::INFINITY).is_some() {
                met += 1;
                through += u32::from(self.admit(&ray, f32::INFINITY));
            }
        }
        f64::from(through) / f64::from(met.max(1))
    }

    /// What asking costs, in nanoseconds.
    #[must_use]
    pub fn price(&self) -> f64 {
        match &self.shape {
            Shape::Turned { .. } => TURNED,
            Shape::Slabs(pairs) => PAIR * pairs.len() as f64,
        }
    }

    /// Memory beside itself.
    #[must_use]
    pub fn bytes(&self) -> u64 {
        match &self.shape {
            Shape::Turned { .. } => 0,
            Shape::Slabs(pairs) => size_of_val(&**pairs) as u64,
        }
    }

    /// In a word, for reports.
    #[must_use]
    pub fn settings(&self) -> String {
        match &self.shape {
            Shape::Turned { .. } => "a turned box".to_owned(),
            Shape::Slabs(pairs) => format!("{} slabs", pairs.len()),
        }
    }
}

/// How far an object reaches along each direction; none if it cannot tell.
fn pairs(object: &dyn Object, directions: &[Vec3A]) -> Option<Box<[Pair]>> {
    let pairs = directions.iter().map(|&direction| {
        let [low, high] = object.along(direction);
        Pair { direction, low, high }
    });
    let pairs: Box<[Pair]> = pairs.collect();
    pairs.iter().all(|pair| pair.low <= pair.high).then_some(pairs)
}

fn is_bounded(object: &dyn Object) -> bool {
    let bounds = object.bounds();
    !bounds.is_empty() && bounds.is_bounded()
}

/// The direction in which `height` is greatest, about.
fn climb(height: &dyn Fn(Vec3A) -> f32) -> Vec3A {
    let start = (0..LOOKS).filter_map(|look| {
        let [a, b, ..] = spread(look);
        on_sphere(a, b)
    });
    let start = start.chain([Vec3A::X, Vec3A::Y, Vec3A::Z]);
    let mut best = start.max_by(|a, b| height(*a).total_cmp(&height(*b))).unwrap_or(Vec3A::X);
    let mut angle = 0.2f32;
    while angle > 1e-4 {
        let (u, v) = best.any_orthonormal_pair();
        let near = [u, v, u + v, u - v, -u, -v, -u - v, v - u];
        let next = near.into_iter().map(|aside| (best + aside * angle).normalize());
        let next = next.max_by(|a, b| height(*a).total_cmp(&height(*b))).unwrap_or(best);
        if height(next) > height(best) {
            best = next;
        } else {
            angle *= 0.5;
        }
    }
    best
}

/// Point number `n` of a sequence that fills a cube of four dimensions evenly [Roberts 18].
fn spread(n: u32) -> [f32; 4] {
    // Powers of the root of `x⁵ = x + 1`.
    const STEPS: [f64; 4] = [0.856_674_883_8, 0.733_891_856_6, 0.628_706_721_0, 0.538_597_257_2];
    STEPS.map(|step| (0.5 + step * f64::from(n + 1)).fract() as f32)
}

/// A point of the unit sphere, as likely as any other if the numbers are; they may give none
/// [Marsaglia 72].
fn on_sphere(a: f32, b: f32) -> Option<Vec3A> {
    let (x, y) = (2.0 * a - 1.0, 2.0 * b - 1.0);
    let square = x * x + y * y;
    let root = 2.0 * (1.0 - square).max(0.0).sqrt();
    (square < 1.0).then(|| Vec3A::new(x * root, y * root, 1.0 - 2.0 * square))
}
