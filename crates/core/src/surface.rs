//! What a hit looks like: asked once, after the search.

use glam::{Affine3A, Vec3A};

/// A point of a surface, in the space of whoever was asked.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Surface {
    /// The point, as near to the true surface as `f32` allows; not just `ray.at(t)`.
    pub position: Vec3A,
    /// How far [`position`](Self::position) may be off the surface, per axis, not negative.
    pub error: Vec3A,
    /// Unit normal of the true surface, on its front: outwards for closed shapes,
    /// counter-clockwise for polygons. Not turned towards the ray.
    pub normal: Vec3A,
    /// Unit normal to shade with, where the shape has another (a mesh with vertex normals).
    pub shading: Vec3A,
    /// Unit direction along which `uv[0]` grows, for normal maps; zero if unknown.
    pub tangent: Vec3A,
    /// Whether a picture on it is seen in a mirror from the front: `uv[1]`, which runs down a
    /// picture, then grows along `normal × tangent`, else against it.
    pub mirrored: bool,
    /// Texture coordinates.
    pub uv: [f32; 2],
}

impl Surface {
    /// A point without texture coordinates whose shading normal is the true one; `error` is
    /// that of one rounding of `position`.
    #[must_use]
    pub fn new(position: Vec3A, normal: Vec3A) -> Self {
        Self {
            position,
            error: position.abs() * f32::EPSILON,
            normal,
            shading: normal,
            tangent: Vec3A::ZERO,
            mirrored: false,
            uv: [0.0; 2],
        }
    }

    /// The same point seen from another space. Singular transforms keep the normals.
    #[must_use]
    pub fn transformed(&self, to_from: &Affine3A) -> Self {
        let m = to_from.matrix3;
        let absolute =
            |v: Vec3A| m.x_axis.abs() * v.x + m.y_axis.abs() * v.y + m.z_axis.abs() * v.z;
        // Normals go by the inverse transpose, up to a factor: the cofactors, which do not
        // need the matrix to be regular. A mirror image turns them inside out.
        let mirror = 1f32.copysign(m.determinant());
        let cofactor = |n: Vec3A| {
            let moved = m.y_axis.cross(m.z_axis) * n.x
                + m.z_axis.cross(m.x_axis) * n.y
                + m.x_axis.cross(m.y_axis) * n.z;
            unit_or(moved * mirror, n)
        };
        Self {
            position: to_from.transform_point3a(self.position),
            // The old error moved, and three products and sums of rounding.
            error: absolute(self.error)
                + (absolute(self.position.abs()) + to_from.translation.abs())
                    * (3.0 * f32::EPSILON),
            normal: cofactor(self.normal),
            shading: cofactor(self.shading),
            tangent: unit_or(m * self.tangent, Vec3A::ZERO),
            mirrored: self.mirrored != (mirror < 0.0),
            uv: self.uv,
        }
    }

    /// Where a ray in direction `dir` should start so that it cannot meet the surface again
    /// where it leaves it: moved along the normal by the error, to the side `dir` points to
    /// [Pharr 23, §6.8.6].
    #[must_use]
    pub fn leave(&self, dir: Vec3A) -> Vec3A {
        let distance = self.normal.abs().dot(self.error);
        let side = if dir.dot(self.normal) < 0.0 { -1.0 } else { 1.0 };
        let moved = self.position + self.normal * (distance * side);
        // Round away from the surface, so that a small step is not lost.
        let away = |axis: usize| match self.normal[axis] * side {
            n if n > 0.0 => moved[axis].next_up(),
            n if n < 0.0 => moved[axis].next_down(),
            _ => moved[axis],
        };
        Vec3A::new(away(0), away(1), away(2))
    }
}

/// `v` of length one, or `otherwise` if it has no direction. Scaled first: squares of small
/// numbers vanish.
fn unit_or(v: Vec3A, otherwise: Vec3A) -> Vec3A {
    let longest = v.abs().max_element();
    if longest > 0.0 && longest.is_finite() { (v / longest).normalize() } else { otherwise }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_mirror_image_keeps_normals_outside() {
        // The right side of a unit cube, mirrored, is its left side.
        let surface = Surface::new(Vec3A::X, Vec3A::X);
        let mirrored = surface.transformed(&Affine3A::from_scale(glam::Vec3::new(-2.0, 1.0, 1.0)));
        assert_eq!(mirrored.normal, Vec3A::NEG_X);
        assert_eq!(mirrored.position.x, -2.0);
        assert!(mirrored.mirrored, "pictures on it, too, are seen in a mirror");
        assert!(!surface.transformed(&Affine3A::from_rotation_y(1.0)).mirrored);
    }

    #[test]
    fn a_ray_leaves_on_the_side_it_goes_to() {
        let surface = Surface::new(Vec3A::new(3.0, 4.0, 5.0), Vec3A::Z);
        assert!(surface.leave(Vec3A::new(1.0, 0.0, 0.1)).z > 5.0);
        assert!(surface.leave(Vec3A::new(1.0, 0.0, -0.1)).z < 5.0);
    }
}
