//! The boxes of a nest over a picture of its scene, coloured by technique.

use std::collections::BTreeMap;

use base64::Engine as _;
use base64::prelude::BASE64_STANDARD;
use nestray::core::aabb::Aabb;
use nestray::io::png;
use nestray::prelude::{Object, Scene, Vec3A};
use nestray::render::options::{Integrator, Options, WhittedOptions};
use nestray::render::render::render;
use nestray::render::tone_map::{Curve, ToneMap};
use nestray::render::watch::Unwatched;
use nestray::scene::camera::{Camera, Projection};

use super::chart::Drawing;
use super::icicle::color;
use crate::errors::Failure;

/// Pixels.
const SIZE: [u32; 2] = [480, 360];
/// Most boxes that are drawn, the largest first, and how deep it is looked for them.
const MOST: usize = 300;
const DEEPEST: usize = 6;
/// Edges are drawn from this far before the eye on, over the size of all.
const NEAR: f32 = 1e-3;

/// What is to be seen.
pub(super) const ABOUT: &str = "Boxes of techniques over a picture, the largest; instances by the \
    technique inside them; how many there are of each.";

/// A picture, and what stands where.
pub(in crate::optimize) struct Boxes {
    /// A PNG file.
    picture: Vec<u8>,
    camera: Camera,
    /// What is in each box: a technique.
    boxes: Vec<(String, Aabb)>,
}

impl Boxes {
    /// From the first camera; none if there is no camera.
    pub(in crate::optimize) fn new(
        scene: &Scene,
        world: &dyn Object,
    ) -> Result<Option<Self>, Failure> {
        let frame = scene.frame(0.0, 0.0);
        let Some(camera) = frame.cameras.first() else { return Ok(None) };
        let options = Options {
            resolution: SIZE,
            samples: 1,
            integrator: Integrator::Whitted(WhittedOptions::default()),
            layers: false,
            ..Options::default()
        };
        let painted = render(&frame, world, &options, &Unwatched)?.picture;
        let shown = ToneMap { curve: Curve::Aces, ..ToneMap::default() }.bytes(&painted);
        let mut picture = Vec::new();
        png::write(&mut picture, [painted.width, painted.height], &shown)
            .map_err(|error| Failure::new(Failure::FAILED, error))?;
        let mut boxes = Vec::new();
        gather(world, 0, &mut boxes);
        boxes.sort_by(|a, b| size(&b.1).total_cmp(&size(&a.1)));
        boxes.truncate(MOST);
        Ok(Some(Self { picture, camera: camera.clone(), boxes }))
    }

    /// The drawing.
    pub(super) fn draw(&self) -> String {
        let [width, height] = SIZE.map(f64::from);
        let mut drawing = Drawing::new(width, height + 20.0);
        let picture = BASE64_STANDARD.encode(&self.picture);
        drawing.shape(
            &format!(
                "image width=\"{width}\" height=\"{height}\" href=\"data:image/png;base64,{picture}\""
            ),
            "the scene",
        );
        let eye = Eye::new(&self.camera, NEAR * self.boxes.first().map_or(1.0, |(_, b)| size(b)));
        let mut counts = BTreeMap::<&str, usize>::new();
        // The smallest last, on top.
        for (technique, bounds) in &self.boxes {
            *counts.entry(technique).or_default() += 1;
            for [from, to] in edges(bounds) {
                if let Some([from, to]) = eye.seen(from, to) {
                    drawing.curve(&[from, to], color(technique), 1.0, 0.7);
                }
            }
        }
        let mut left = 4.0;
        for (technique, count) in counts {
            let label = format!("{technique} ({count})");
            drawing.words([left, height + 15.0], "start", color(technique), &label);
            left += 7.0 * label.len() as f64 + 10.0;
        }
        drawing.done()
    }
}

fn size(bounds: &Aabb) -> f32 {
    bounds.size().length()
}

/// The boxes of all aggregates that can be drawn. What is inside an instance stands in a space of its
/// own: its box is that of the instance.
fn gather(object: &dyn Object, level: usize, boxes: &mut Vec<(String, Aabb)>) {
    if object.own().is_some() && object.bounds().is_bounded() && !object.bounds().is_empty() {
        boxes.push((object.kind().to_owned(), object.bounds()));
    }
    if level == DEEPEST {
        return;
    }
    if object.kind() == "instance" {
        if let Some(technique) = technique_in(object, level) {
            boxes.push((technique, object.bounds()));
        }
        return;
    }
    object.visit_children(&mut |child| gather(child, level + 1, boxes));
}

/// The technique of the first aggregate within an object.
fn technique_in(object: &dyn Object, level: usize) -> Option<String> {
    let mut found = None;
    object.visit_children(&mut |child| {
        if found.is_none() {
            found = match child.own() {
                Some(_) => Some(child.kind().to_owned()),
                None if level < DEEPEST => technique_in(child, level + 1),
                None => None,
            };
        }
    });
    found
}

/// The twelve edges of a box.
fn edges(bounds: &Aabb) -> impl Iterator<Item = [Vec3A; 2]> + '_ {
    let along = |axis: u32| {
        let corners = (0..8u32).filter(move |corner| corner >> axis & 1 == 0);
        corners.map(move |corner| [corner, corner | 1 << axis])
    };
    (0..3).flat_map(along).map(|ends| ends.map(|corner| bounds.corner(corner)))
}

/// Where points are in the picture.
struct Eye {
    from: Vec3A,
    /// Unit vectors to the right, up and ahead; the first two over half of what the picture shows at
    /// distance 1, or everywhere if it is parallel.
    axes: [Vec3A; 3],
    is_parallel: bool,
    near: f32,
}

impl Eye {
    fn new(camera: &Camera, near: f32) -> Self {
        let ahead = camera.forward.normalize_or(Vec3A::NEG_Z);
        let right = ahead.cross(camera.up).normalize_or(ahead.any_orthonormal_vector());
        let up = right.cross(ahead);
        let (half, is_parallel) = match camera.projection {
            Projection::Perspective { degrees } => (libm::tanf(degrees.to_radians() / 2.0), false),
            Projection::Orthographic { height } => (height / 2.0, true),
        };
        let aspect = SIZE[0] as f32 / SIZE[1] as f32;
        let axes = [right / (half * aspect), up / half, ahead];
        Self { from: camera.from, axes, is_parallel, near }
    }

    /// The part of a line before the eye, in pixels.
    fn seen(&self, from: Vec3A, to: Vec3A) -> Option<[[f64; 2]; 2]> {
        let [mut a, mut b] = [from, to].map(|point| {
            let off = point - self.from;
            Vec3A::new(off.dot(self.axes[0]), off.dot(self.axes[1]), off.dot(self.axes[2]))
        });
        if !self.is_parallel {
            if a.z < self.near && b.z < self.near {
                return None;
            }
            let cut = |behind: Vec3A, before: Vec3A| {
                behind + (before - behind) * ((self.near - behind.z) / (before.z - behind.z))
            };
            (a, b) = match (a.z < self.near, b.z < self.near) {
                (true, _) => (cut(a, b), b),
                (_, true) => (a, cut(b, a)),
                _ => (a, b),
            };
        }
        // Far beyond the frame nothing can be seen, and numbers grow long.
        let most = 1e5;
        let place = |p: Vec3A| {
            let depth = if self.is_parallel { 1.0 } else { p.z };
            let [x, y] = [p.x / depth, p.y / depth].map(|x| f64::from(x).clamp(-most, most));
            [(x + 1.0) / 2.0 * f64::from(SIZE[0]), (1.0 - y) / 2.0 * f64::from(SIZE[1])]
        };
        Some([place(a), place(b)])
    }
}

#[cfg(test)]
mod tests {
    use nestray::plan::build::build;
    use nestray::plan::single::single;
    use nestray::scene::procedural::generate;

    use super::*;

    #[test]
    fn a_point_is_where_the_ray_through_it_is() {
        let (from, at) = (Vec3A::new(1.0, -5.0, 2.0), Vec3A::new(0.5, 0.0, 0.3));
        let camera = Camera::looking(from, at, Vec3A::Z, 50.0);
        let eye = Eye::new(&camera, 1e-3);
        let view = camera.view(SIZE[0] as f32 / SIZE[1] as f32);
        for pixel in [[0, 0], [479, 10], [240, 359]] {
            let (origin, dir) = view.through(pixel, SIZE);
            let [place, _] = eye.seen(origin + dir * 3.0, origin + dir * 9.0).expect("before it");
            for axis in 0..2 {
                let expected = f64::from(pixel[axis]) + 0.5;
                assert!((place[axis] - expected).abs() < 0.01, "{place:?} {pixel:?}");
            }
        }
        let behind = from - (at - from);
        assert!(eye.seen(behind, behind + Vec3A::Z).is_none());
        assert!(eye.seen(behind, at).is_some());
    }

    #[test]
    fn every_aggregate_has_a_box_and_instances_are_told_by_what_is_in_them() {
        let scene = generate("demo", Some(1)).expect("there is one").frame(0.0, 0.0);
        let plan = single("grid", Default::default(), &scene).expect("it is sound");
        let world = build(&plan, &scene).expect("it is sound");
        let boxes = Boxes::new(&scene, &*world).expect("it is drawn").expect("there is a camera");
        assert!(boxes.boxes.len() > 100 && boxes.boxes.iter().all(|(name, _)| name == "grid"));
        let drawn = boxes.draw();
        assert!(
            drawn.contains("data:image/png;base64,iVBOR") && drawn.contains("grid ("),
            "{drawn:.300}"
        );
        assert!(drawn.matches("<polyline").count() > 1000);
    }
}
