//! Nodes that move over the frames of a film.

use glam::{Affine3A, Quat, Vec3};
use nestray_core::moving::Keys;

use crate::group::Motion;
use crate::scene::Scene;

/// A hierarchy of moving nodes.
#[derive(Clone, Debug, Default)]
pub struct Animation {
    /// Each node after its parent.
    pub nodes: Vec<Node>,
}

/// A part of the hierarchy.
#[derive(Clone, Debug)]
pub struct Node {
    /// The node it hangs on, which comes before it.
    pub parent: Option<usize>,
    /// Where it rests, relative to the parent.
    pub rest: Pose,
    /// How it moves instead, if it does.
    pub translation: Track<Vec3>,
    /// See [`translation`](Self::translation).
    pub rotation: Track<Quat>,
    /// See [`translation`](Self::translation).
    pub scale: Track<Vec3>,
}

/// Where a node is: a whole matrix, or parts that can be animated apart.
#[derive(Clone, Copy, Debug)]
pub enum Pose {
    /// A matrix.
    Matrix(Affine3A),
    /// Scaled, then rotated, then moved.
    Parts {
        /// Where to.
        translation: Vec3,
        /// A unit quaternion.
        rotation: Quat,
        /// How much, along each axis.
        scale: Vec3,
    },
}

/// How one number changes over time, in seconds. Before the first key it is the first
/// value, after the last the last; without keys it does not change.
#[derive(Clone, Debug)]
pub struct Track<T> {
    /// Times ascend.
    pub keys: Vec<(f32, T)>,
    /// Between keys.
    pub way: Way,
}

/// How a track goes from key to key.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Way {
    /// It jumps at each key.
    Step,
    /// At even speed; rotations along the shortest arc.
    #[default]
    Linear,
    /// By cubic splines; keys then hold in-tangent, value and out-tangent in turn, all
    /// with the same time.
    Cubic,
}

impl<T> Default for Track<T> {
    fn default() -> Self {
        Self { keys: Vec::new(), way: Way::default() }
    }
}

/// A value that tracks can go between.
pub trait Blend: Copy {
    /// The value `part` of the way from `a` to `b`.
    fn blend(a: Self, b: Self, part: f32) -> Self;
    /// `Σ weight · value`, made valid again.
    fn sum(terms: [(f32, Self); 4]) -> Self;
}

impl Blend for Vec3 {
    fn blend(a: Self, b: Self, part: f32) -> Self {
        a.lerp(b, part)
    }
    fn sum(terms: [(f32, Self); 4]) -> Self {
        terms.iter().fold(Self::ZERO, |sum, (weight, value)| sum + *value * *weight)
    }
}

impl Blend for Quat {
    /// Along the shortest arc; by the pinned sine, so that every machine agrees.
    fn blend(a: Self, b: Self, part: f32) -> Self {
        let cosine = a.dot(b).clamp(-1.0, 1.0);
        let b = if cosine < 0.0 { -b } else { b };
        let angle = libm::acosf(cosine.abs());
        if angle < 1e-4 {
            return (a * (1.0 - part) + b * part).normalize();
        }
        let weight = |part: f32| libm::sinf(part * angle) / libm::sinf(angle);
        (a * weight(1.0 - part) + b * weight(part)).normalize()
    }
    fn sum(terms: [(f32, Self); 4]) -> Self {
        let sum = terms.iter().fold(Self::from_xyzw(0.0, 0.0, 0.0, 0.0), |sum, (weight, value)| {
            sum + *value * *weight
        });
        if sum.length_squared() > 0.0 { sum.normalize() } else { Self::IDENTITY }
    }
}

impl<T: Blend> Track<T> {
    /// The value at a time in seconds; none if there are no keys.
    #[must_use]
    pub fn at(&self, time: f32) -> Option<T> {
        let stride = if self.way == Way::Cubic { 3 } else { 1 };
        let middle = stride / 2;
        let count = self.keys.len() / stride;
        let key = |i: usize| self.keys[i * stride + middle];
        if count == 0 {
            return None;
        }
        let next = (0..count).position(|i| key(i).0 > time).unwrap_or(count);
        if next == 0 || next == count {
            return Some(key(next.saturating_sub(1)).1);
        }
        let ((from, a), (to, b)) = (key(next - 1), key(next));
        let part = (time - from) / (to - from);
        Some(match self.way {
            Way::Step => a,
            Way::Linear => T::blend(a, b, part),
            Way::Cubic => {
                let (out, into) = (self.keys[next * 3 - 1].1, self.keys[next * 3].1);
                let (s, s2, s3, span) = (part, part * part, part * part * part, to - from);
                T::sum([
                    (2.0 * s3 - 3.0 * s2 + 1.0, a),
                    (span * (s3 - 2.0 * s2 + s), out),
                    (3.0 * s2 - 2.0 * s3, b),
                    (span * (s3 - s2), into),
                ])
            }
        })
    }
}

impl Animation {
    /// When the last key is, in seconds; 0 if nothing moves.
    #[must_use]
    pub fn duration(&self) -> f32 {
        self.nodes
            .iter()
            .flat_map(|node| {
                let last = |time: Option<f32>| time.unwrap_or(0.0);
                [
                    last(node.translation.keys.last().map(|key| key.0)),
                    last(node.rotation.keys.last().map(|key| key.0)),
                    last(node.scale.keys.last().map(|key| key.0)),
                ]
            })
            .fold(0.0, f32::max)
    }

    /// Where a node is at a time in seconds.
    #[must_use]
    pub fn world_from_node(&self, node: usize, time: f32) -> Affine3A {
        let mut place = Affine3A::IDENTITY;
        let mut at = Some(node);
        while let Some(node) = at {
            place = self.nodes[node].local(time) * place;
            at = self.nodes[node].parent;
        }
        place
    }

    /// Whether a node, or one it hangs on, moves at all.
    #[must_use]
    pub fn moves(&self, node: usize) -> bool {
        let moves = |node: &Node| {
            !(node.translation.keys.is_empty()
                && node.rotation.keys.is_empty()
                && node.scale.keys.is_empty())
        };
        std::iter::successors(Some(node), |&n| self.nodes[n].parent).any(|n| moves(&self.nodes[n]))
    }
}

impl Node {
    fn local(&self, time: f32) -> Affine3A {
        match self.rest {
            Pose::Matrix(matrix) => matrix,
            Pose::Parts { translation, rotation, scale } => {
                Affine3A::from_scale_rotation_translation(
                    self.scale.at(time).unwrap_or(scale),
                    self.rotation.at(time).unwrap_or(rotation),
                    self.translation.at(time).unwrap_or(translation),
                )
            }
        }
    }
}

impl Scene {
    /// The scene as one frame sees it: nodes fixed at `time`, in seconds, or moving while the
    /// shutter is open for `shutter` seconds from then on. Geometry is shared, not copied.
    #[must_use]
    pub fn frame(&self, time: f32, shutter: f32) -> Self {
        /// Moments a moving node is looked at; it goes straight in between.
        const MOMENTS: usize = 9;
        let mut frame = self.clone();
        let resolve = |motion: &mut Motion| {
            let Motion::Node(node) = *motion else { return };
            let at = |time: f32| self.animation.world_from_node(node, time);
            *motion = Motion::Still(at(time));
            if shutter > 0.0 && self.animation.moves(node) {
                let keys = (0..MOMENTS).map(|i| {
                    let part = i as f32 / (MOMENTS - 1) as f32;
                    (part, at(time + part * shutter))
                });
                *motion = Motion::Keys(Keys::new(keys.collect()).expect("times ascend"));
            }
        };
        for place in frame.groups.iter_mut().flat_map(|group| &mut group.places) {
            resolve(&mut place.motion);
        }
        for camera in &mut frame.cameras {
            camera.follow(&self.animation, time);
        }
        for light in &mut frame.lights {
            light.follow(&self.animation, time);
        }
        frame
    }
}
