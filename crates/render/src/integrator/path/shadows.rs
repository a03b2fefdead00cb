//! Light of many paths that waits for its shadow rays.

use std::mem;

use glam::Vec3A;
use nestray_core::ray::{Ray, RayKind};

use crate::eye::Seen;
use crate::tracer::Tracer;

/// Light on its way to a surface.
#[derive(Clone, Copy, Debug)]
pub(super) struct Waiting {
    /// Which of the starts sees it if it arrives.
    pub(super) start: u32,
    pub(super) light: Vec3A,
}

/// Shadow rays to be cast.
#[derive(Debug, Default)]
pub(super) struct Shadows {
    waiting: Vec<Waiting>,
    /// One for each.
    rays: Vec<Ray>,
    /// What gets through them.
    passing: Vec<f32>,
    /// Room for putting them in order.
    order: Vec<(RayKind, u32)>,
    sorted: (Vec<Waiting>, Vec<Ray>),
}

impl Shadows {
    /// One more.
    pub(super) fn push(&mut self, waiting: Waiting, ray: Ray) {
        self.waiting.push(waiting);
        self.rays.push(ray);
    }

    /// Casts them, light by light, and adds what arrives.
    pub(super) fn settle(&mut self, tracer: &mut Tracer<'_>, seen: &mut [Seen]) {
        if !self.rays.is_sorted_by_key(Ray::kind) {
            self.sort();
        }
        tracer.passing(&self.rays, &mut self.passing);
        for (waiting, passing) in self.waiting.iter().zip(&self.passing) {
            seen[waiting.start as usize].color += waiting.light * *passing;
        }
        self.waiting.clear();
        self.rays.clear();
    }

    /// By light; those of one light stay as they were.
    fn sort(&mut self) {
        let Self { waiting, rays, order, sorted, .. } = self;
        order.clear();
        order.extend((0..).zip(&*rays).map(|(i, ray)| (ray.kind(), i)));
        order.sort_unstable();
        sorted.0.clear();
        sorted.0.extend(order.iter().map(|&(_, i)| waiting[i as usize]));
        sorted.1.clear();
        sorted.1.extend(order.iter().map(|&(_, i)| rays[i as usize]));
        mem::swap(waiting, &mut sorted.0);
        mem::swap(rays, &mut sorted.1);
    }
}
