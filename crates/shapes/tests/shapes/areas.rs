//! The area of the convex hull is four times the mean shadow [Arvo 90, Theorem 2].

use glam::Vec3A;
use nestray_core::ray::{Ray, RayKind};
use nestray_shapes::any::AnyShape;
use nestray_shapes::disk::Disk;
use nestray_shapes::polygon::Polygon;
use nestray_shapes::shape::Shape;

use crate::hits::crossings;
use crate::numbers::Numbers;
use crate::samples::{Form, near};

/// What a line must meet to meet the hull: the shape, and the ends of an open one.
fn hull(shape: &AnyShape) -> Vec<AnyShape> {
    let mut parts = vec![shape.clone()];
    let mut end = |center: Vec3A, normal: Vec3A, radius: f32| {
        if radius > 0.0 {
            parts.push(Disk { center, normal, radius }.into());
        }
    };
    match shape {
        AnyShape::Cone(c) => {
            end(c.base, c.apex - c.base, c.base_radius);
            end(c.apex, c.apex - c.base, c.apex_radius);
        }
        AnyShape::Cylinder(c) => {
            end(c.base, c.top - c.base, c.radius);
            end(c.top, c.top - c.base, c.radius);
        }
        _ => {}
    }
    parts
}

#[test]
fn the_hull_area_is_what_random_lines_say() {
    let mut checked = 0;
    for seed in 0..6 {
        for sample in near(seed) {
            if sample.form == Form::Other {
                continue;
            }
            let parts = hull(&sample.shape);
            let mut numbers = Numbers(seed ^ 0xa7ea);
            // Lines that meet a ball around it: a direction, and a point of its shadow.
            let (lines, radius) = (40_000, 2.2 * sample.size);
            let mut met = 0;
            for _ in 0..lines {
                let dir = numbers.unit();
                let [x, y] = [numbers.unit(), numbers.unit()];
                let (x, y) = (dir.cross(x).normalize(), dir.cross(y));
                let y = (y - x * x.dot(y)).normalize();
                let (a, b) = loop {
                    let (a, b) = (numbers.between(-1.0, 1.0), numbers.between(-1.0, 1.0));
                    if a * a + b * b <= 1.0 {
                        break (a, b);
                    }
                };
                let from = sample.center + (x * a + y * b) * radius;
                let ray = Ray::new(from.as_vec3a(), dir.as_vec3a(), RayKind::Camera);
                met += usize::from(parts.iter().any(|part| !crossings(part, &ray).is_empty()));
            }
            let expected = f64::from(sample.shape.hull_area())
                / (4.0 * std::f64::consts::PI * radius * radius);
            let found = f64::from(met as u32) / f64::from(lines);
            let sigma = (expected * (1.0 - expected) / f64::from(lines)).sqrt();
            // Four, for one in 16,000 of these says nothing.
            assert!(
                (found - expected).abs() < 4.0 * sigma,
                "seed {seed} {sample:?}: {found}, not {expected} ± {sigma}"
            );
            checked += 1;
        }
    }
    assert!(checked >= 48, "only {checked} shapes were convex");
}

#[test]
fn a_concave_polygon_has_the_hull_of_its_corners() {
    let ell = [[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [1.0, 1.0], [1.0, 2.0], [0.0, 2.0]];
    let polygon = Polygon::new(ell.map(|[x, y]| [3.0, x, y]).to_vec());
    assert!((polygon.hull_area() - 7.0).abs() < 1e-5, "{}", polygon.hull_area());
    assert_eq!(polygon.normal(), Vec3A::X);
}
