//! How a ray gets into a grid, out of it again, and across a region.

use nestray_core::aabb::Clip;
use nestray_core::ray::Ray;
use nestray_core::technique::Step;

use super::frame::Frame;
use super::{Cursor, Grids};

impl Grids {
    /// Where a ray enters a grid and leaves it again; none if it does not enter it within `limit`.
    #[inline(always)]
    pub(super) fn span(&self, clip: &Clip, grid: u32, limit: f32) -> Option<(f32, f32)> {
        let span = clip.cut(&self.frames[grid as usize].bounds, f32::INFINITY);
        span.filter(|&(enter, _)| enter <= limit)
    }

    /// Places a ray in a grid that it is inside of from `enter` to `leave`.
    #[inline(always)]
    pub(super) fn place(
        &self,
        ray: &Ray,
        cursor: &mut Cursor,
        grid: u32,
        (enter, leave): (f32, f32),
    ) -> Step {
        let frame = &self.frames[grid as usize];
        cursor.grid = grid;
        cursor.exit = leave;
        cursor.far = self.is_far(ray, frame);
        if cursor.far {
            return self.start_far(ray, cursor, enter);
        }
        cursor.cell = frame.cell_of(ray.at(enter));
        self.aim(ray, cursor, frame);
        Step::onward(frame.slot(cursor.cell))
    }

    /// Whether rounding may take a ray farther aside than boxes are widened.
    #[inline(always)]
    pub(super) fn is_far(&self, ray: &Ray, frame: &Frame) -> bool {
        2.0 * Clip::SLACK * ray.origin().abs().max_element() > frame.least_pad
    }

    /// Works out where a ray leaves its cell.
    #[inline(always)]
    pub(super) fn aim(&self, ray: &Ray, cursor: &mut Cursor, frame: &Frame) {
        cursor.crossing[0] = frame.crossing(ray, cursor.forward, cursor.cell[0], 0);
        cursor.crossing[1] = frame.crossing(ray, cursor.forward, cursor.cell[1], 1);
        cursor.crossing[2] = frame.crossing(ray, cursor.forward, cursor.cell[2], 2);
    }

    /// Goes back to the cell around the grid that the ray leaves; false if there is none.
    #[inline(always)]
    pub(super) fn climb(&self, ray: &Ray, cursor: &mut Cursor) -> bool {
        let Some(outer) = self.frames[cursor.grid as usize].outer else { return false };
        let frame = &self.frames[outer.grid as usize];
        cursor.grid = outer.grid;
        cursor.cell = [outer.cell[0].into(), outer.cell[1].into(), outer.cell[2].into()];
        cursor.far = self.is_far(ray, frame);
        let clip = Clip::new(ray, self.reach);
        if let Some((_, leave)) = clip.cut(&frame.bounds, f32::INFINITY) {
            cursor.exit = leave;
        }
        if cursor.far {
            cursor.axis = frame.far_axis(ray);
        } else {
            self.aim(ray, cursor, frame);
        }
        true
    }

    /// Crosses a region: to its last cell on the way, from where the next step leaves it.
    #[inline(always)]
    pub(super) fn cross(&self, ray: &Ray, cursor: &mut Cursor, region: u32) {
        let frame = &self.frames[cursor.grid as usize];
        let region = &self.regions[region as usize];
        let (low, high) = (region.low(), region.high());
        let mut last = [0; 3];
        let mut leave = f32::INFINITY;
        for axis in 0..3 {
            let up = cursor.forward >> axis & 1 == 1;
            last[axis] = if up { high[axis] } else { low[axis] };
            leave = leave.min(frame.crossing(ray, cursor.forward, last[axis], axis));
        }
        let cell = frame.cell_of(ray.at(leave));
        for axis in 0..3 {
            // Never back, whatever rounding says, and never outside.
            let (at, now) = (cell[axis], cursor.cell[axis]);
            let up = cursor.forward >> axis & 1 == 1;
            let crossing = frame.crossing(ray, cursor.forward, last[axis], axis);
            let on_way = if up { at.max(now).min(last[axis]) } else { at.min(now).max(last[axis]) };
            cursor.cell[axis] = if crossing <= leave { last[axis] } else { on_way };
        }
        self.aim(ray, cursor, frame);
    }
}
