//! What a material looks like at one point: textures, vertex colours and normal maps applied.

use glam::Vec3A;
use nestray_scene::material::{AlphaMode, Material};
use nestray_scene::scene::Scene;
use nestray_scene::surfaces::Point;

/// A material at a point.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Look {
    /// Reflectance.
    pub(crate) base: Vec3A,
    pub(crate) metallic: f32,
    pub(crate) roughness: f32,
    pub(crate) emission: Vec3A,
    pub(crate) transmission: f32,
    pub(crate) ior: f32,
    /// Unit normal to shade with, on the front.
    pub(crate) normal: Vec3A,
    /// What vertex colours and texture multiply colours by.
    pub(crate) tint: Vec3A,
    /// Which material it is.
    pub(crate) material: usize,
}

impl Look {
    pub(crate) fn at(scene: &Scene, point: &Point) -> Self {
        let material = &scene.materials[point.material];
        let [r, g, b, _] = color(scene, material, point);
        let tint = Vec3A::new(r, g, b);
        let uv = point.surface.uv;
        let (mut metallic, mut roughness) = (material.metallic, material.roughness);
        if let Some(texture) = material.metallic_roughness_texture {
            let [_, rough, metal, _] = scene.textures[texture].sample(uv);
            (metallic, roughness) = (metallic * metal, roughness * rough);
        }
        Self {
            base: (Vec3A::from(material.base_color) * tint).clamp(Vec3A::ZERO, Vec3A::ONE),
            metallic: unit(metallic),
            roughness: unit(roughness),
            emission: emission(scene, material, uv),
            transmission: unit(material.transmission),
            ior: if material.ior > 0.0 { material.ior } else { 1.0 },
            normal: normal(scene, material, point),
            tint,
            material: point.material,
        }
    }
}

/// How much of a surface is there, from 0 to 1.
pub(crate) fn opacity(scene: &Scene, point: &Point) -> f32 {
    let material = &scene.materials[point.material];
    if material.alpha_mode == AlphaMode::Opaque {
        return 1.0;
    }
    let alpha = material.alpha * color(scene, material, point)[3];
    match material.alpha_mode {
        AlphaMode::Opaque => 1.0,
        AlphaMode::Mask(least) => f32::from(u8::from(alpha >= least)),
        AlphaMode::Blend => unit(alpha),
    }
}

/// The radiance a material gives off.
pub(crate) fn emission(scene: &Scene, material: &Material, uv: [f32; 2]) -> Vec3A {
    let emission = Vec3A::from(material.emission);
    match material.emission_texture {
        Some(texture) if material.glows() => {
            let [r, g, b, _] = scene.textures[texture].sample(uv);
            emission * Vec3A::new(r, g, b)
        }
        _ => emission,
    }
}

/// Vertex colour times texture.
fn color(scene: &Scene, material: &Material, point: &Point) -> [f32; 4] {
    let mut color = point.color;
    if let Some(texture) = material.base_texture {
        let sampled = scene.textures[texture].sample(point.surface.uv);
        for (c, s) in color.iter_mut().zip(sampled) {
            *c *= s;
        }
    }
    color
}

/// The shading normal, bent by the normal map.
fn normal(scene: &Scene, material: &Material, point: &Point) -> Vec3A {
    let surface = &point.surface;
    let smooth = surface.shading;
    let Some(texture) = material.normal_texture else { return smooth };
    let along = surface.tangent - smooth * surface.tangent.dot(smooth);
    let along = along.normalize_or_zero();
    if along == Vec3A::ZERO {
        return smooth;
    }
    // Texture coordinates count rows downwards; green points up.
    let up = if surface.mirrored { along.cross(smooth) } else { smooth.cross(along) };
    let [r, g, b, _] = scene.textures[texture].sample(surface.uv);
    let (x, y) = ((2.0 * r - 1.0) * material.normal_scale, (2.0 * g - 1.0) * material.normal_scale);
    (along * x + up * y + smooth * (2.0 * b - 1.0)).normalize_or(smooth)
}

/// Within 0 and 1; 0 if it is no number.
fn unit(x: f32) -> f32 {
    if x > 0.0 { x.min(1.0) } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use nestray_core::surface::Surface;
    use nestray_scene::texture::{Image, Pixels, Texture};
    use nestray_shapes::triangle_mesh::Triangles;

    use super::*;

    /// The shading normal of a square that faces +z, under a map that leans to the upper
    /// edge of its picture; `left` and `right` are the first coordinates of its sides.
    fn leaning(left: f32, right: f32) -> Vec3A {
        let corners = vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
        let square = Triangles::new(corners, vec![[0, 1, 2], [0, 2, 3]]).expect("sound");
        let uvs = vec![[left, 1.0], [right, 1.0], [right, 0.0], [left, 0.0]];
        let square = square.with_uvs(uvs).expect("one each");
        let up = Pixels::Linear(vec![[128, 230, 200, 255]]);
        let mut scene = Scene::new();
        scene.textures.push(Texture::new("", Arc::new(Image { width: 1, height: 1, pixels: up })));
        let material = Material { normal_texture: Some(0), ..Material::default() };
        let surface: Surface = square.surface(1, [0.3, 0.3]);
        let point = Point { surface, material: 0, color: [1.0; 4] };
        normal(&scene, &material, &point)
    }

    #[test]
    fn a_bump_stays_a_bump_where_the_picture_is_mirrored() {
        for (left, right) in [(0.0, 1.0), (1.0, 0.0)] {
            let found = leaning(left, right);
            assert!(found.y > 0.5 && found.x.abs() < 0.01 && found.z > 0.5, "{found}");
        }
    }
}
