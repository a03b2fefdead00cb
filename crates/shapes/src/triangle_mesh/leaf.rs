//! Testing a leaf, or one triangle, with one ray.

use nestray_core::hit::Hit;
use nestray_core::simd::{SCALAR, Scalar, Simd, prefetch};
use nestray_core::technique::Leaf;

use super::kernel::Soup;
use super::layout::{Block, Layout};
use super::shear::Probe;
use super::{Mesh, test};

impl<L: Layout> Mesh<L> {
    /// See [`Children::closest_in_leaf`](nestray_core::children::Children::closest_in_leaf).
    #[inline(always)]
    pub(super) fn closest_of<S: Simd>(
        &self,
        simd: S,
        mut leaf: Leaf,
        probe: &Probe,
        hit: &mut Hit,
    ) -> bool {
        let mut found = false;
        loop {
            let block = L::load(simd, &self.blocks, leaf, &probe.shear);
            // Asked for only where something is hit, and last.
            prefetch::<1>(self.numbers.as_ptr().wrapping_add(block.first as usize).cast());
            let number = |lane: usize| self.numbers[block.first as usize + lane];
            if let Some(hits) = test::hits::<S, L>(simd, probe, &block, hit.t, number) {
                // Numbers ascend in a block, so the first lane wins a tie.
                let (lane, t, uv) = hits.nearest(simd);
                found |= self.offer(hit, t, uv, number(lane));
            }
            let Some(next) = block.next else { return found };
            leaf = next;
        }
    }

    /// See [`Children::any_in_leaf`](nestray_core::children::Children::any_in_leaf).
    #[inline(always)]
    pub(super) fn any_of<S: Simd>(
        &self,
        simd: S,
        mut leaf: Leaf,
        probe: &Probe,
        t_max: f32,
    ) -> bool {
        loop {
            let block = L::load(simd, &self.blocks, leaf, &probe.shear);
            let number = |lane: usize| self.numbers[block.first as usize + lane];
            if test::hits::<S, L>(simd, probe, &block, t_max, number).is_some() {
                return true;
            }
            let Some(next) = block.next else { return false };
            leaf = next;
        }
    }

    /// See [`Children::all_in_leaf`](nestray_core::children::Children::all_in_leaf).
    #[inline(always)]
    pub(super) fn all_of<S: Simd>(
        &self,
        simd: S,
        mut leaf: Leaf,
        probe: &Probe,
        t_max: f32,
        out: &mut Vec<Hit>,
    ) {
        loop {
            let block = L::load(simd, &self.blocks, leaf, &probe.shear);
            let number = |lane: usize| self.numbers[block.first as usize + lane];
            if let Some(hits) = test::hits::<S, L>(simd, probe, &block, t_max, number) {
                for lane in (0..8).filter(|lane| hits.mask >> lane & 1 == 1) {
                    let (t, uv) = hits.lane(simd, lane);
                    let mut hit = Hit::none(t_max);
                    if self.offer(&mut hit, t, uv, number(lane)) {
                        out.push(hit);
                    }
                }
            }
            let Some(next) = block.next else { return };
            leaf = next;
        }
    }

    /// One triangle in the first lane, by the same arithmetic.
    pub(super) fn alone(&self, number: u32, probe: &Probe, limit: f32) -> Option<(f32, [f32; 2])> {
        let (triangles, primitive) = self.bodies.find(number);
        if number == probe.skip || !triangles.is_usable(primitive) {
            return None;
        }
        let corners = triangles.corners(primitive);
        let lane = |corner: usize, axis: usize| SCALAR.splat(corners[corner][axis]);
        let shear = &probe.shear;
        let corners = [0, 1, 2].map(|c| {
            let axis = |i: usize| lane(c, shear.axis(i));
            shear.apply(SCALAR, axis(0), axis(1), axis(2))
        });
        let block = Block { corners, shared: None, lanes: 1, first: 0, next: None };
        let hits = test::hits::<Scalar, Soup>(SCALAR, probe, &block, limit, |_| number)?;
        Some(hits.lane(SCALAR, 0))
    }
}
