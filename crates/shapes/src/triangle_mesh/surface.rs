//! What a triangle looks like at a hit.

use glam::{DVec3, Vec2, Vec3A, Vec4};
use nestray_core::surface::Surface;

use super::Triangles;

impl Triangles {
    /// The surface of a triangle at barycentric coordinates: the weights of its second and
    /// third corner.
    ///
    /// The shading normal comes from the vertex normals, turned to the side of the true
    /// one; texture coordinates default to the barycentric ones.
    ///
    /// # Panics
    /// If there is no such triangle.
    #[must_use]
    pub fn surface(&self, triangle: u32, [u, v]: [f32; 2]) -> Surface {
        let face = self.faces[triangle as usize];
        let [a, b, c] = self.corners(triangle).map(|corner| Vec3A::from_array(corner).as_dvec3());
        let (v1, v2) = (f64::from(u), f64::from(v));
        let weights = [(1.0 - v1 - v2) as f32, u, v];
        let position = (a + (b - a) * v1 + (c - a) * v2).as_vec3a();
        let normal = (b - a).cross(c - a).try_normalize().unwrap_or(DVec3::Z).as_vec3a();
        let uv = match self.uvs.is_empty() {
            true => [u, v],
            false => blend(weights, face.map(|i| Vec2::from(self.uvs[i as usize]))).to_array(),
        };
        // As far as a neighbour in the same plane may seem off by its own arithmetic.
        let farthest = [a, b, c].iter().fold(DVec3::ZERO, |far, p| far.max(p.abs()));
        let (tangent, mirrored) = self.tangent(face, [a, b, c]);
        Surface {
            error: farthest.as_vec3a() * (4.0 * f32::EPSILON),
            shading: self.shading(face, weights, normal),
            tangent,
            mirrored,
            uv,
            ..Surface::new(position, normal)
        }
    }

    /// Reads a little of all that [`surface`](Self::surface) and [`color`](Self::color) will
    /// read, so that it is near when they do; the sum of it, which means nothing.
    ///
    /// # Panics
    /// If there is no such triangle.
    #[inline]
    #[must_use]
    pub fn touch(&self, triangle: u32) -> f32 {
        let face = self.faces[triangle as usize].map(|vertex| vertex as usize);
        let first = |vertex: usize| {
            let normal = self.normals.get(vertex).map_or(0.0, |normal| normal[0]);
            let uv = self.uvs.get(vertex).map_or(0.0, |uv| uv[0]);
            let color = self.colors.get(vertex).map_or(0.0, |color| color[0]);
            self.positions[vertex][0] + normal + uv + color
        };
        first(face[0]) + first(face[1]) + first(face[2])
    }

    /// The colour of a triangle at barycentric coordinates, if it has one.
    #[must_use]
    pub fn color(&self, triangle: u32, [u, v]: [f32; 2]) -> Option<[f32; 4]> {
        if self.colors.is_empty() {
            return None;
        }
        let corners = self.faces[triangle as usize].map(|i| Vec4::from(self.colors[i as usize]));
        Some(blend([1.0 - u - v, u, v], corners).to_array())
    }

    fn shading(&self, face: [u32; 3], weights: [f32; 3], normal: Vec3A) -> Vec3A {
        if self.normals.is_empty() {
            return normal;
        }
        let corners = face.map(|i| Vec3A::from_array(self.normals[i as usize]));
        let smooth = blend(weights, corners).normalize_or(normal);
        if smooth.dot(normal) < 0.0 { -smooth } else { smooth }
    }

    /// Along which way the first texture coordinate grows, and whether a picture is seen in a
    /// mirror.
    fn tangent(&self, face: [u32; 3], [a, b, c]: [DVec3; 3]) -> (Vec3A, bool) {
        if self.uvs.is_empty() {
            return ((b - a).normalize_or_zero().as_vec3a(), true);
        }
        let [p, q, r] = face.map(|i| Vec2::from(self.uvs[i as usize]).as_dvec2());
        let (q, r) = (q - p, r - p);
        let turned = (b - a) * r.y - (c - a) * q.y;
        let mirrored = q.perp_dot(r) > 0.0;
        let side = if mirrored { 1.0 } else { -1.0 };
        ((turned * side).normalize_or_zero().as_vec3a(), mirrored)
    }
}

fn blend<T>([a, b, c]: [f32; 3], [x, y, z]: [T; 3]) -> T
where
    T: std::ops::Mul<f32, Output = T> + std::ops::Add<Output = T>,
{
    x * a + y * b + z * c
}
