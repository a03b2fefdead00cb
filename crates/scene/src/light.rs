//! Lights without a surface, and what lies behind everything.

use glam::Vec3A;

use crate::animation::Animation;

/// A light without a surface.
#[derive(Clone, Debug)]
pub struct Light {
    /// What it is called; may be empty.
    pub name: String,
    /// Colour and strength, per channel, linear: radiant intensity of points and spots,
    /// irradiance of directional ones.
    pub color: [f32; 3],
    /// What kind it is, and where.
    pub kind: LightKind,
    /// The node of the animation it hangs on; then places and directions are relative to it.
    pub node: Option<usize>,
}

/// Kinds of light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LightKind {
    /// Shines alike in all directions.
    Point {
        /// Where.
        position: Vec3A,
        /// Whether it gets weaker with the square of the distance; the lights of NFF do not.
        fades: bool,
    },
    /// Comes from infinitely far away.
    Directional {
        /// Where the light goes, of length one.
        direction: Vec3A,
    },
    /// A point that shines in a cone.
    Spot {
        /// Where.
        position: Vec3A,
        /// Where the light goes, of length one.
        direction: Vec3A,
        /// Cosine of the angle up to which it is at its brightest.
        cos_inner: f32,
        /// Cosine of the angle from which on it is dark.
        cos_outer: f32,
    },
}

/// What rays see that hit nothing.
#[derive(Clone, Debug, PartialEq)]
pub enum Background {
    /// The same radiance everywhere.
    Color([f32; 3]),
    /// From below (first) to above, evenly by height.
    Gradient([[f32; 3]; 2], Vec3A),
    /// A picture of all directions, longitude by latitude, the middle towards −z and the
    /// top towards +y, turned by `radians` about y, times `scale`.
    Environment {
        /// The texture.
        texture: usize,
        /// How far it is turned.
        radians: f32,
        /// What radiance is multiplied by.
        scale: f32,
    },
}

impl Default for Background {
    fn default() -> Self {
        Self::Color([0.0; 3])
    }
}

impl Light {
    /// A point light that gets weaker with the square of the distance.
    #[must_use]
    pub fn point(position: Vec3A, color: [f32; 3]) -> Self {
        let kind = LightKind::Point { position, fades: true };
        Self { name: String::new(), color, kind, node: None }
    }

    /// Moves with its node, if it hangs on one: places become those of the world.
    pub fn follow(&mut self, animation: &Animation, time: f32) {
        let Some(node) = self.node.take() else { return };
        let place = animation.world_from_node(node, time);
        let moved = |p: Vec3A| place.transform_point3a(p);
        let turned = |d: Vec3A| place.transform_vector3a(d).normalize_or(d);
        match &mut self.kind {
            LightKind::Point { position, .. } => *position = moved(*position),
            LightKind::Directional { direction } => *direction = turned(*direction),
            LightKind::Spot { position, direction, .. } => {
                (*position, *direction) = (moved(*position), turned(*direction));
            }
        }
    }
}
