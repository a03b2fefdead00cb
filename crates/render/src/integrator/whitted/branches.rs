//! Rays of many trees.

use glam::Vec3A;
use nestray_core::ray::Ray;

/// A ray of a tree.
#[derive(Clone, Copy, Debug)]
pub(super) struct Branch {
    /// Which of the starts.
    pub(super) start: u32,
    /// What it counts for.
    pub(super) share: Vec3A,
}

/// Many of them, and their rays.
#[derive(Debug, Default)]
pub(super) struct Branches {
    pub(super) branches: Vec<Branch>,
    pub(super) rays: Vec<Ray>,
}

/// Light that waits for its shadow rays.
#[derive(Debug, Default)]
pub(super) struct Shadows {
    /// What each adds to what its start sees.
    pub(super) waiting: Vec<Branch>,
    pub(super) rays: Vec<Ray>,
    /// What gets through them.
    pub(super) passing: Vec<f32>,
}

impl Branches {
    pub(super) fn push(&mut self, branch: Branch, ray: Ray) {
        self.branches.push(branch);
        self.rays.push(ray);
    }

    pub(super) fn clear(&mut self) {
        self.branches.clear();
        self.rays.clear();
    }
}
