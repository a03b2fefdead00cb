//! Random shapes of every kind, and points worth aiming at on each.

mod makers;

use glam::Vec3A;
use nestray_core::aabb::Aabb;
use nestray_core::ray::{Ray, RayKind};
use nestray_shapes::any::AnyShape;
use nestray_shapes::parallelogram::Parallelogram;
use nestray_shapes::plane::Plane;
use nestray_shapes::shape::{Shape, Sides, Single};

use crate::numbers::Numbers;

use self::makers::*;

/// Makes a shape about as large as the ball with this centre and radius.
type Maker = fn(&mut Numbers, Vec3A, f32) -> AnyShape;

/// Surfaces of solids: what solids are made of.
const CLOSED: &[Maker] = &[sphere, block, torus, ellipsoid];
const OPEN: &[Maker] =
    &[cone, cylinder, disk, parallelogram, polygon, star, patch, saddle, bezier, hills];

/// A bounded shape of any kind in the unit cube; every other on round numbers, where faces
/// meet faces.
#[must_use]
pub fn bounded(numbers: &mut Numbers) -> AnyShape {
    let maker = numbers.below(CLOSED.len() + OPEN.len());
    make(CLOSED.iter().chain(OPEN).nth(maker).expect("in range"), numbers)
}

/// A shape with an inside.
#[must_use]
pub fn closed(numbers: &mut Numbers) -> AnyShape {
    make(numbers.pick(CLOSED), numbers)
}

/// A plane without end.
#[must_use]
pub fn plane(numbers: &mut Numbers) -> AnyShape {
    Plane { point: numbers.point(), normal: axis(numbers) }.into()
}

/// A shape without end, thin or not.
#[must_use]
pub fn endless(numbers: &mut Numbers) -> AnyShape {
    if numbers.once_in(2) {
        return plane(numbers);
    }
    let mut squares = [1.0; 3];
    squares[numbers.below(3)] = *numbers.pick(&[0.0, 0.0, -2.0]);
    let size = numbers.between(0.02, 0.2);
    quadric(numbers.point(), squares, size * size, Aabb::ENDLESS)
}

/// `count` bounded shapes as primitives of one geometry, at least one of every kind if there
/// are that many.
#[must_use]
pub fn mixed(numbers: &mut Numbers, count: usize, geometry: u32) -> Vec<Single<AnyShape>> {
    let makers = || CLOSED.iter().chain(OPEN).cycle();
    (0..)
        .zip(makers().take(count))
        .map(|(primitive, maker)| {
            let sides = *numbers.pick(&[Sides::Both, Sides::Both, Sides::Front, Sides::Back]);
            Single { geometry, primitive, sides, shape: make(maker, numbers) }
        })
        .collect()
}

/// Which kind a shape is. A new kind of shape stops here: give it a maker, and it is part of
/// all tests across crates.
#[must_use]
pub fn kind(shape: &AnyShape) -> usize {
    match shape {
        AnyShape::Sphere(_) => 0,
        AnyShape::Cone(_) => 1,
        AnyShape::Cylinder(_) => 2,
        AnyShape::Plane(_) => 3,
        AnyShape::Disk(_) => 4,
        AnyShape::Parallelogram(_) => 5,
        AnyShape::Block(_) => 6,
        AnyShape::Polygon(_) => 7,
        AnyShape::Patch(_) => 8,
        AnyShape::Torus(_) => 9,
        AnyShape::Quadric(_) => 10,
        AnyShape::Bezier(_) => 11,
        AnyShape::HeightField(_) => 12,
    }
}

/// How many kinds there are.
pub const KINDS: usize = 13;

/// Corners, rims and points of a surface, and of the box around it.
#[must_use]
pub fn aims(shape: &AnyShape, numbers: &mut Numbers) -> Vec<Vec3A> {
    let bounds = shape.bounds();
    let mut aims = own_corners(shape);
    if bounds.is_empty() || !bounds.is_bounded() {
        return aims;
    }
    aims.extend((0..8).map(|i| bounds.corner(i)).chain([bounds.center()]));
    // Where a round shape touches its box, or nearly.
    for axis in 0..3 {
        for end in [bounds.min, bounds.max] {
            let mut touch = bounds.center();
            touch[axis] = end[axis];
            aims.push(touch);
        }
    }
    for _ in 0..6 {
        let inside = bounds.min + bounds.size() * numbers.point();
        let ray = Ray::new(inside, numbers.direction(), RayKind::Camera);
        shape.crossings(&ray, |crossing| aims.push(ray.at(crossing.t)));
    }
    aims
}

/// The points a shape was made from.
fn own_corners(shape: &AnyShape) -> Vec<Vec3A> {
    let all = |points: &[[f32; 3]]| points.iter().map(|&p| Vec3A::from_array(p)).collect();
    match shape {
        AnyShape::Cone(cone) => vec![cone.base, cone.apex],
        AnyShape::Cylinder(cylinder) => vec![cylinder.base, cylinder.top],
        AnyShape::Disk(disk) => {
            let out = disk.normal.normalize().any_orthonormal_vector() * disk.radius;
            vec![disk.center, disk.center + out, disk.center - out]
        }
        AnyShape::Parallelogram(Parallelogram { corner, u, v }) => {
            vec![*corner, *corner + *u, *corner + *v, *corner + *u + *v, *corner + *u * 0.5]
        }
        AnyShape::Plane(plane) => {
            let across = plane.normal.normalize().any_orthonormal_vector();
            vec![plane.point, plane.point + across, plane.point - across * 0.3]
        }
        AnyShape::Polygon(polygon) => all(polygon.vertices()),
        AnyShape::Patch(patch) => all(patch.polygon().vertices()),
        AnyShape::Bezier(patch) => {
            [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 1.0], [0.5, 0.0], [0.5, 0.5]]
                .map(|uv| patch.at(uv))
                .to_vec()
        }
        AnyShape::HeightField(field) => {
            let [width, depth] = field.counts();
            let ends = [[0, 0], [width - 1, 0], [width / 2, depth / 2], [width - 1, depth - 1]];
            ends.map(|[x, z]| field.sample(x, z)).to_vec()
        }
        _ => Vec::new(),
    }
}

fn make(maker: &Maker, numbers: &mut Numbers) -> AnyShape {
    if numbers.once_in(2) {
        let center = (numbers.point() * 8.0).round() / 8.0;
        return maker(numbers, center, 0.125);
    }
    let (center, size) = (numbers.point(), numbers.between(0.02, 0.2));
    maker(numbers, center, size)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_kind_of_shape_takes_part() {
        let mut numbers = Numbers::new(1);
        let mut seen = [false; KINDS];
        let all = mixed(&mut numbers, CLOSED.len() + OPEN.len(), 0);
        for shape in all.iter().map(|single| &single.shape).chain([&plane(&mut numbers)]) {
            seen[kind(shape)] = true;
            assert!(!aims(shape, &mut Numbers::new(2)).is_empty(), "{shape:?}");
        }
        assert_eq!(seen, [true; KINDS], "kinds without a maker");
    }
}
