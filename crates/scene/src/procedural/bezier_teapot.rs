//! The teapot as its 32 patches, hit exactly, on the board of [Haines 87].

use super::newell::newell_teapot;
use super::teapot::board;
use crate::scene::Scene;

/// Patches of the teapot and squares of the board.
pub(super) fn count(size: u32) -> u64 {
    u64::from(size).pow(2) + 32
}

pub(super) fn build(size: u32) -> Scene {
    let mut scene = board(size);
    for patch in newell_teapot() {
        scene.shape(patch);
    }
    scene.finish()
}
