//! Where a picture is taken from.

use glam::Vec3A;

use crate::animation::Animation;

/// A camera. Looks from `from` along `forward`; `up` need not be at right angles to it.
#[derive(Clone, Debug)]
pub struct Camera {
    /// What it is called; may be empty.
    pub name: String,
    /// The eye.
    pub from: Vec3A,
    /// Where it looks, any length but zero.
    pub forward: Vec3A,
    /// Roughly up in the picture.
    pub up: Vec3A,
    /// How the world is projected.
    pub projection: Projection,
    /// Rays start this far along `forward`.
    pub hither: f32,
    /// Pixels across and down, if the file says so.
    pub resolution: Option<[u32; 2]>,
    /// Radius of the lens; 0 for a pinhole.
    pub aperture: f32,
    /// Distance along `forward` that is in focus.
    pub focus: f32,
    /// The node of the animation it hangs on; then it is relative to that.
    pub node: Option<usize>,
}

/// How the world is projected.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Projection {
    /// Lines meet in the eye.
    Perspective {
        /// Angle from the bottom of the picture to the top, in degrees, below 180.
        degrees: f32,
    },
    /// Lines are parallel.
    Orthographic {
        /// Height of the picture in the world.
        height: f32,
    },
}

impl Default for Camera {
    /// From +z towards the origin.
    fn default() -> Self {
        Self {
            name: String::new(),
            from: Vec3A::new(0.0, 0.0, 5.0),
            forward: Vec3A::NEG_Z,
            up: Vec3A::Y,
            projection: Projection::Perspective { degrees: 45.0 },
            hither: 0.0,
            resolution: None,
            aperture: 0.0,
            focus: 1.0,
            node: None,
        }
    }
}

/// A camera made ready for one picture.
#[derive(Clone, Copy, Debug)]
pub struct View {
    from: Vec3A,
    forward: Vec3A,
    /// From the middle of the picture to its right edge, at distance 1.
    right: Vec3A,
    /// From the middle of the picture to its top edge, at distance 1.
    up: Vec3A,
    /// Unit vectors across and up the lens, times its radius.
    lens: [Vec3A; 2],
    focus: f32,
    hither: f32,
    parallel: bool,
}

impl Camera {
    /// A camera at `from` that looks at `at`.
    #[must_use]
    pub fn looking(from: Vec3A, at: Vec3A, up: Vec3A, degrees: f32) -> Self {
        let projection = Projection::Perspective { degrees };
        Self { from, forward: at - from, up, projection, ..Self::default() }
    }

    /// Moves with its node, if it hangs on one.
    pub fn follow(&mut self, animation: &Animation, time: f32) {
        let Some(node) = self.node.take() else { return };
        let place = animation.world_from_node(node, time);
        self.from = place.transform_point3a(self.from);
        self.forward = place.transform_vector3a(self.forward);
        self.up = place.transform_vector3a(self.up);
    }

    /// Ready for a picture so many times as wide as high.
    #[must_use]
    pub fn view(&self, aspect: f32) -> View {
        let forward = self.forward.normalize_or(Vec3A::NEG_Z);
        let right = forward.cross(self.up).normalize_or(forward.any_orthonormal_vector());
        let up = right.cross(forward);
        let (half, parallel) = match self.projection {
            Projection::Perspective { degrees } => (libm::tanf(degrees.to_radians() / 2.0), false),
            Projection::Orthographic { height } => (height / 2.0, true),
        };
        View {
            from: self.from,
            forward,
            right: right * (half * aspect),
            up: up * half,
            lens: [right * self.aperture, up * self.aperture],
            focus: self.focus,
            hither: self.hither,
            parallel,
        }
    }
}

impl View {
    /// Origin and direction of the ray through the middle of a pixel, counted from the top left,
    /// of a picture so many pixels wide and high; through the middle of the lens.
    #[must_use]
    pub fn through(&self, [x, y]: [u32; 2], [width, height]: [u32; 2]) -> (Vec3A, Vec3A) {
        let across = (x as f32 + 0.5) / width as f32 * 2.0 - 1.0;
        let up = 1.0 - (y as f32 + 0.5) / height as f32 * 2.0;
        self.ray(across, up, [0.0; 2])
    }

    /// Origin and direction of the ray through a point of the picture: `x` from −1 (left) to 1,
    /// `y` from −1 (bottom) to 1, through a point of the lens, a disk of radius 1. The
    /// direction of a pinhole's rays has length 1 along the view.
    #[must_use]
    pub fn ray(&self, x: f32, y: f32, lens: [f32; 2]) -> (Vec3A, Vec3A) {
        let across = self.right * x + self.up * y;
        if self.parallel {
            return (self.from + across + self.forward * self.hither, self.forward);
        }
        let dir = self.forward + across;
        let shift = self.lens[0] * lens[0] + self.lens[1] * lens[1];
        let dir = dir - shift / self.focus;
        (self.from + shift + dir * self.hither, dir)
    }
}
