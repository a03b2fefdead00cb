//! Rays from far away, whose rounding is wider than what boxes are widened by.
//!
//! They go through a grid slice by slice, across the axis along which they cross most cells; in
//! each slice they are shown the block of cells that they may pass, however rounded. Where they
//! are follows from the cell alone, as for all rays.

use nestray_core::aabb::Clip;
use nestray_core::ray::Ray;
use nestray_core::technique::Step;

use super::block::Block;
use super::frame::Frame;
use super::{Cursor, Grids};

/// A ray in a grid: from where to where, and how far aside it may be.
struct Passage {
    enter: f32,
    leave: f32,
    aside: f32,
}

impl Grids {
    /// Begins for a ray that is inside of its grid from `enter` on.
    #[cold]
    pub(super) fn start_far(&self, ray: &Ray, cursor: &mut Cursor, enter: f32) -> Step {
        let frame = &self.frames[cursor.grid as usize];
        cursor.axis = frame.far_axis(ray);
        let passage = self.passage(ray, frame, enter);
        cursor.cell[usize::from(cursor.axis)] = passage.ends(ray, frame, cursor)[0];
        let (_, block) = passage.slice(ray, frame, cursor);
        cursor.cell = block.low();
        Step::onward(frame.slot(cursor.cell))
    }

    /// Goes to the next cell of the slice, or to the next slice; none if that was the last, or
    /// the next begins beyond the limit.
    #[cold]
    pub(super) fn resume_far(&self, ray: &Ray, cursor: &mut Cursor, limit: f32) -> Option<Step> {
        let frame = &self.frames[cursor.grid as usize];
        let clip = Clip::new(ray, self.reach);
        let (enter, _) = clip.cut(&frame.bounds, f32::INFINITY)?;
        let passage = self.passage(ray, frame, enter);
        let along = usize::from(cursor.axis);
        let (low, high) = {
            let (_, block) = passage.slice(ray, frame, cursor);
            (block.low(), block.high())
        };
        for axis in [(along + 1) % 3, (along + 2) % 3] {
            if cursor.cell[axis] < high[axis] {
                cursor.cell[axis] += 1;
                return Some(Step::onward(frame.slot(cursor.cell)));
            }
            cursor.cell[axis] = low[axis];
        }
        if cursor.cell[along] == passage.ends(ray, frame, cursor)[1] {
            return None;
        }
        let up = cursor.forward >> along & 1 == 1;
        cursor.cell[along] = if up { cursor.cell[along] + 1 } else { cursor.cell[along] - 1 };
        let (begin, block) = passage.slice(ray, frame, cursor);
        cursor.cell = block.low();
        (begin <= limit).then(|| Step::onward(frame.slot(cursor.cell)))
    }

    fn passage(&self, ray: &Ray, frame: &Frame, enter: f32) -> Passage {
        let clip = Clip::new(ray, self.reach);
        let leave = clip.cut(&frame.bounds, f32::INFINITY).map_or(enter, |(_, leave)| leave);
        let most = ray.origin().abs().max_element().max(self.reach);
        Passage { enter, leave: leave.max(enter), aside: 2.0 * Clip::SLACK * most }
    }
}

impl Passage {
    /// The first and the last slice.
    fn ends(&self, ray: &Ray, frame: &Frame, cursor: &Cursor) -> [u32; 2] {
        let along = usize::from(cursor.axis);
        let aside = if cursor.forward >> along & 1 == 1 { self.aside } else { -self.aside };
        let cell = |t: f32, aside: f32| frame.cell_of(ray.at(t) + aside)[along];
        [cell(self.enter, -aside), cell(self.leave, aside)]
    }

    /// The cells of the slice that the ray stands in, and where that begins.
    fn slice(&self, ray: &Ray, frame: &Frame, cursor: &Cursor) -> (f32, Block) {
        let along = usize::from(cursor.axis);
        let at = cursor.cell[along];
        let inverse = ray.inverse_dir()[along];
        let wall = |number: u32, aside: f32| {
            (frame.wall(number, along) + aside - ray.origin()[along]) * inverse
        };
        // What is outside the grid counts to the outermost slices.
        let low = if at == 0 { f32::NEG_INFINITY } else { wall(at, -self.aside) };
        let low = if at == 0 && inverse < 0.0 { f32::INFINITY } else { low };
        let is_last = at + 1 == frame.cells[along];
        let high = if is_last { f32::INFINITY } else { wall(at + 1, self.aside) };
        let high = if is_last && inverse < 0.0 { f32::NEG_INFINITY } else { high };
        let begin = low.min(high).max(self.enter);
        let end = low.max(high).min(self.leave).max(begin);
        let (a, b) = (ray.at(begin), ray.at(end));
        let mut first = frame.cell_of(a.min(b) - self.aside);
        let mut last = frame.cell_of(a.max(b) + self.aside);
        (first[along], last[along]) = (at, at);
        (begin, Block::new(first, last))
    }
}
