//! The shapes written down once more, in doubles and for reading.

use glam::{DVec2, DVec3, Vec3A};
use nestray_core::ray::Ray;
use nestray_shapes::any::AnyShape;
use nestray_shapes::shape::Shape;

/// How far a point is off the surface; none if nobody wrote it down.
pub(crate) fn off(shape: &AnyShape, point: DVec3) -> Option<f64> {
    match shape {
        AnyShape::Block(block) => {
            let (min, max) = (block.extent.min.as_dvec3(), block.extent.max.as_dvec3());
            let outside = (min - point).max(point - max);
            Some(if outside.max_element() > 0.0 {
                outside.max(DVec3::ZERO).length()
            } else {
                -outside.max_element()
            })
        }
        AnyShape::Plane(_) | AnyShape::Disk(_) => Some(inside(shape, point)?.abs()),
        AnyShape::Sphere(_)
        | AnyShape::Cone(_)
        | AnyShape::Cylinder(_)
        | AnyShape::Torus(_)
        | AnyShape::Quadric(_) => Some(inside(shape, point)?.abs()),
        AnyShape::Parallelogram(_) | AnyShape::Polygon(_) | AnyShape::Patch(_) => {
            let corners = corners(shape)?;
            let height = inside(shape, point)?;
            Some(if winding(&corners, point) { height.abs() } else { rim(&corners, point) })
        }
        #[allow(unreachable_patterns, reason = "shapes that are not written down here")]
        _ => None,
    }
}

/// A function of space that changes its sign across the surface.
fn inside(shape: &AnyShape, point: DVec3) -> Option<f64> {
    let frustum = |a: Vec3A, ra: f32, b: Vec3A, rb: f32| {
        let (a, b) = (a.as_dvec3(), b.as_dvec3());
        let axis = (b - a).normalize();
        let height = (b - a).length();
        let z = (point - a).dot(axis);
        let away = (point - a).cross(axis).length();
        let lean = DVec2::new(height, f64::from(rb) - f64::from(ra)).normalize();
        // Off the line from (0, ra) to (height, rb).
        (DVec2::new(z, away - f64::from(ra))).dot(DVec2::new(-lean.y, lean.x))
    };
    let flat = |on: DVec3, normal: DVec3| (point - on).dot(normal.normalize());
    Some(match shape {
        AnyShape::Sphere(s) => (point - s.center.as_dvec3()).length() - f64::from(s.radius),
        AnyShape::Cone(c) => frustum(c.base, c.base_radius, c.apex, c.apex_radius),
        AnyShape::Cylinder(c) => frustum(c.base, c.radius, c.top, c.radius),
        AnyShape::Block(b) => {
            let half = b.extent.size().as_dvec3() / 2.0;
            ((point - b.extent.min.as_dvec3() - half).abs() - half).max_element()
        }
        AnyShape::Torus(t) => {
            let from = point - t.center.as_dvec3();
            let height = from.dot(t.axis.as_dvec3().normalize());
            let away = (from.length_squared() - height * height).max(0.0).sqrt();
            DVec2::new(away - f64::from(t.major), height).length() - f64::from(t.minor)
        }
        AnyShape::Quadric(q) => {
            let [squares, linear] = [q.squares, q.linear].map(|x| Vec3A::from_array(x).as_dvec3());
            assert_eq!(q.products, [0.0; 3], "the samples have none");
            let value = (squares * point + linear).dot(point) + f64::from(q.constant);
            // About the distance, near the surface.
            value / (squares * point * 2.0 + linear).length()
        }
        AnyShape::Plane(p) => flat(p.point.as_dvec3(), p.normal.as_dvec3()),
        AnyShape::Disk(d) => flat(d.center.as_dvec3(), d.normal.as_dvec3()),
        AnyShape::Parallelogram(_) | AnyShape::Polygon(_) | AnyShape::Patch(_) => {
            let c = corners(shape)?;
            let normal: DVec3 =
                (1..c.len() - 1).map(|i| (c[i] - c[0]).cross(c[i + 1] - c[0])).sum();
            flat(c[0], normal)
        }
        #[allow(unreachable_patterns, reason = "shapes that are not written down here")]
        _ => return None,
    })
}

/// How far inside its edges a point of the zero set is, in lengths: negative if the shape
/// does not reach there.
fn room(shape: &AnyShape, point: DVec3) -> f64 {
    let between = |a: Vec3A, b: Vec3A| {
        let (a, b) = (a.as_dvec3(), b.as_dvec3());
        let z = (point - a).dot((b - a).normalize());
        z.min((b - a).length() - z)
    };
    match shape {
        AnyShape::Cone(c) => between(c.base, c.apex),
        AnyShape::Cylinder(c) => between(c.base, c.top),
        AnyShape::Quadric(q) if q.clip.is_bounded() => {
            let (min, max) = (q.clip.min.as_dvec3(), q.clip.max.as_dvec3());
            (point - min).min(max - point).min_element()
        }
        AnyShape::Disk(d) => f64::from(d.radius) - (point - d.center.as_dvec3()).length(),
        _ => match corners(shape) {
            Some(corners) => {
                let rim = rim(&corners, point);
                if winding(&corners, point) { rim } else { -rim }
            }
            None => f64::INFINITY,
        },
    }
}

fn corners(shape: &AnyShape) -> Option<Vec<DVec3>> {
    let polygon = match shape {
        AnyShape::Parallelogram(p) => {
            let [a, u, v] = [p.corner, p.u, p.v].map(|x| x.as_dvec3());
            return Some(vec![a, a + u, a + u + v, a + v]);
        }
        AnyShape::Polygon(polygon) => polygon,
        AnyShape::Patch(patch) => patch.polygon(),
        _ => return None,
    };
    Some(polygon.vertices().iter().map(|&v| Vec3A::from_array(v).as_dvec3()).collect())
}

/// Whether the angles at which a point in the plane sees the edges add up to a turn.
fn winding(corners: &[DVec3], point: DVec3) -> bool {
    let n = corners.len();
    let normal: DVec3 =
        (1..n - 1).map(|i| (corners[i] - corners[0]).cross(corners[i + 1] - corners[0])).sum();
    let normal = normal.normalize();
    let seen: f64 = (0..n)
        .map(|i| {
            let (a, b) = (corners[i] - point, corners[(i + 1) % n] - point);
            libm::atan2(a.cross(b).dot(normal), a.dot(b))
        })
        .sum();
    seen.abs() > std::f64::consts::PI
}

/// The distance to the nearest edge.
fn rim(corners: &[DVec3], point: DVec3) -> f64 {
    let edge = |(a, b): (DVec3, DVec3)| {
        let part = ((point - a).dot(b - a) / (b - a).length_squared()).clamp(0.0, 1.0);
        (point - a - (b - a) * part).length()
    };
    let next = corners.iter().cycle().skip(1);
    corners.iter().zip(next).map(|(&a, &b)| edge((a, b))).fold(f64::INFINITY, f64::min)
}

/// The parameters at which a line crosses the surface, found by walking along it in small
/// steps; none where it cannot tell: near an edge, or where the line all but touches.
pub(crate) fn walk(shape: &AnyShape, ray: &Ray, center: DVec3, size: f64) -> Option<Vec<f64>> {
    inside(shape, center)?;
    let (origin, dir) = (ray.origin().as_dvec3(), ray.dir().as_dvec3());
    let at = |t: f64| inside(shape, origin + dir * t).expect("it was written down");
    let middle = (center - origin).dot(dir) / dir.length_squared();
    let half = 4.0 * size / dir.length();
    let (steps, hair) = (800, 1e-3 * size);
    let t_of = |i: usize| middle - half + 2.0 * half * i as f64 / steps as f64;
    let values: Vec<f64> = (0..=steps).map(|i| at(t_of(i))).collect();
    let mut found = Vec::new();
    for i in 0..steps {
        let (a, b) = (values[i], values[i + 1]);
        if (a > 0.0) == (b > 0.0) {
            // Near the surface without crossing it, here or a step away: it may touch.
            let crosses = |i: usize| (values[i] > 0.0) != (values[(i + 1).min(steps)] > 0.0);
            let near = a.abs().min(b.abs()) < 4.0 * hair;
            if near && !crosses(i.saturating_sub(1)) && !crosses((i + 1).min(steps)) {
                return None;
            }
            continue;
        }
        let (mut low, mut high) = (t_of(i), t_of(i + 1));
        for _ in 0..60 {
            let t = (low + high) / 2.0;
            if (at(t) > 0.0) == (a > 0.0) { low = t } else { high = t }
        }
        let t = (low + high) / 2.0;
        // Two crossings within a step look like none, so demand some slope.
        let slope = (b - a).abs() / (t_of(1) - t_of(0)) / dir.length();
        let room = room(shape, origin + dir * t);
        if slope < 0.02 || room.abs() < hair {
            return None;
        }
        if room > 0.0 {
            found.push(t);
        }
    }
    // An endless shape is met beyond the walk.
    shape.bounds().is_bounded().then_some(found)
}
