//! Newell's teapot on a chessboard: in triangles as [Haines 87] cuts it, and exact.

use glam::DVec3;

use super::newell::{is_pole, nets, surface};
use super::standard::{Eye, Fill, SKY, Standard};
use crate::scene::Scene;

/// Triangles of the teapot and squares of the board.
pub(super) fn count(size: u32) -> u64 {
    let n = u64::from(size);
    64 * n * n - 8 * n + n * n
}

pub(super) fn build(size: u32) -> Scene {
    let mut scene = board(size);
    for net in nets() {
        for cell in 0..size * size {
            let (s, t) = (cell / size, cell % size);
            let corners = [(s, t), (s, t + 1), (s + 1, t + 1), (s + 1, t)];
            let at = |i: u32| f64::from(i) / f64::from(size);
            let corners = corners.map(|(s, t)| surface(&net, at(s), at(t)));
            for triangle in [[0, 1, 2], [2, 3, 0]] {
                let corners = triangle.map(|i: usize| corners[i]);
                // In the middle of the lid and of the bottom some have no area.
                if corners.iter().filter(|&&(place, _)| is_pole(place)).count() < 2 {
                    scene.patch(corners);
                }
            }
        }
    }
    scene.finish()
}

/// The board, and the fill of the teapot.
pub(super) fn board(size: u32) -> Standard {
    let eye = Eye::above([4.86, 7.2, 5.4], [0.0; 3], 1.0);
    let mut scene = Standard::new(SKY, &eye, &[[-3.1, 9.8, 12.1], [11.3, 5.1, 8.8]]);
    for (name, color, odd) in [("white", 1.0, 1), ("grey", 0.5, 0)] {
        scene.fill(name, &Fill { angle: 30.0, ..Fill::mirror([color; 3], 0.5, 0.5) });
        for cell in 0..size * size {
            let (i, j) = (cell / size, cell % size);
            if (i + j) % 2 == odd {
                let corner = |(i, j): (u32, u32)| {
                    let [x, y] = [i, j].map(|i| 4.0 * (2.0 * f64::from(i) / f64::from(size) - 1.0));
                    DVec3::new(x, y, 0.0)
                };
                scene.polygon(&[(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)].map(corner));
            }
        }
    }
    scene.fill("teapot", &Fill { angle: 37.0, ..Fill::mirror([1.0, 0.5, 0.1], 0.75, 0.25) });
    scene.two_sided();
    scene
}
