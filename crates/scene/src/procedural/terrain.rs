//! Mountains as one mesh: heights from layers of smooth noise [Musgrave 89].

use glam::DVec3;
use nestray_shapes::triangle_mesh::Triangles;

use super::look::{camera, matte, outdoors};
use super::mesh::Mesh;
use super::random::mix;
use crate::geometry::Geometry;
use crate::scene::Scene;

/// Triangles.
pub(super) fn count(size: u32) -> u64 {
    2 * u64::from(size).pow(2)
}

pub(super) fn build(size: u32) -> Scene {
    let mut scene = outdoors();
    let ground = scene.add_material(matte("ground", [1.0; 3]));
    scene.add(Geometry::mesh("mountains", ground, mountains(size)));
    let from = DVec3::new(-0.9, -1.55, 0.62);
    scene.cameras.push(camera("whole", from, DVec3::new(0.0, 0.0, 0.1), 40.0));
    scene
}

fn mountains(size: u32) -> Triangles {
    let step = 2.0 / f64::from(size);
    // One row and column more on every side, for the slopes.
    let row = size as usize + 3;
    let place = |i: usize| step * (i as f64 - 1.0) - 1.0;
    let heights: Vec<f64> =
        (0..row * row).map(|i| height(place(i % row), place(i / row))).collect();
    let mut mesh = Mesh::default();
    mesh.corners(size, |j, i| {
        let at = (j as usize + 1) * row + i as usize + 1;
        let slope = |apart: usize| (heights[at + apart] - heights[at - apart]) / (2.0 * step);
        let normal = DVec3::new(-slope(1), -slope(row), 1.0).normalize();
        let (x, y) = (place(i as usize + 1), place(j as usize + 1));
        (DVec3::new(x, y, heights[at]), normal)
    });
    mesh.cells(size, 0);
    mesh.color_by(color);
    mesh.finish()
}

/// Meadows, rock where it is steep, snow on top; by place and normal.
fn color(place: DVec3, normal: DVec3) -> [f64; 3] {
    let (height, up) = (place.z, normal.z);
    let blend = |a: [f64; 3], b: [f64; 3], part: f64| {
        let part = part.clamp(0.0, 1.0);
        [0, 1, 2].map(|i| a[i] + (b[i] - a[i]) * part)
    };
    let meadow = blend([0.13, 0.2, 0.06], [0.3, 0.28, 0.14], height * 7.0);
    let snow = blend(meadow, [0.85, 0.87, 0.9], (height - 0.15) * 20.0);
    blend([0.28, 0.24, 0.21], snow, (up - 0.62) * 6.0)
}

/// Ridges at several scales, each smaller one only where the larger are high.
fn height(x: f64, y: f64) -> f64 {
    let (mut sum, mut size, mut often, mut weight) = (0.0, 0.17, 1.4, 1.0);
    for layer in 0..9 {
        let ridge = 1.0 - noise(x * often, y * often, layer).abs();
        let ridge = ridge * ridge * weight;
        sum += ridge * size;
        weight = (ridge * 1.5).min(1.0);
        size *= 0.5;
        often *= 2.03;
    }
    sum - 0.12
}

/// A smooth function between about −1 and 1 with features of size 1: random slopes at
/// whole places, blended [Perlin 85].
fn noise(x: f64, y: f64, seed: u64) -> f64 {
    let (left, low) = (x.floor(), y.floor());
    let (u, v) = (x - left, y - low);
    let corner = |i: u32, j: u32| {
        let (cell_x, cell_y) =
            ((left as i64 + i64::from(i)) as u64, (low as i64 + i64::from(j)) as u64);
        let bits = mix(cell_x ^ mix(cell_y ^ mix(seed + 11)));
        let part = |bits: u64| f64::from(bits as u32 & 0xffff) / 32768.0 - 1.0;
        part(bits) * (u - f64::from(i)) + part(bits >> 20) * (v - f64::from(j))
    };
    let ease = |x: f64| x * x * x * (x * (x * 6.0 - 15.0) + 10.0);
    let blend = |a: f64, b: f64, part: f64| a + (b - a) * part;
    let (a, b) = (ease(u), ease(v));
    1.6 * blend(blend(corner(0, 0), corner(1, 0), a), blend(corner(0, 1), corner(1, 1), a), b)
}
