//! Rays from far away, whose rounding is wider than what cells are padded by.

use nestray_core::technique::Step;

use super::{ALONE, Cursor, GridIndex, SWEEP};

impl GridIndex {
    /// Begins for a ray from so far away that the pad does not cover its rounding: shows the
    /// neighbours of every cell too, or all cells there are if even that may not be enough.
    #[cold]
    pub(super) fn start_far(&self, mut cursor: Cursor, slack: f32) -> (Cursor, Step) {
        if slack * 4.0 > self.cell_size.min_element() {
            cursor.around = SWEEP;
            cursor.cell = [0; 3];
        } else {
            cursor.around = 0;
        }
        match self.wide {
            Some(leaf) => (Cursor { before: true, ..cursor }, Step::leaf(leaf)),
            None => (cursor, Step::onward(self.odd_slot(&cursor))),
        }
    }

    /// Goes to the first cell, or to the next neighbour of a cell, or to the next of all;
    /// none if all neighbours were shown.
    #[cold]
    pub(super) fn resume_odd(&self, cursor: &mut Cursor) -> Option<Step> {
        if cursor.before {
            cursor.before = false;
        } else if cursor.around == SWEEP {
            cursor.cell[0] += 1;
            if cursor.cell[0] as usize == self.words.len() {
                return Some(Step::DONE);
            }
        } else {
            cursor.around += 1;
            if cursor.around == ALONE {
                cursor.around = 0;
                return None;
            }
        }
        Some(Step::onward(self.odd_slot(cursor)))
    }

    fn odd_slot(&self, cursor: &Cursor) -> u32 {
        match cursor.around {
            SWEEP => cursor.cell[0],
            ALONE => self.slot(cursor.cell),
            _ => self.slot(self.neighbour(cursor)),
        }
    }

    /// The neighbour to show next, clamped to the grid: some come twice.
    fn neighbour(&self, cursor: &Cursor) -> [u32; 3] {
        // From the middle of the 27 on: the cell itself comes first.
        let which = (cursor.around + 13) % 27;
        let offsets = [which % 3, which / 3 % 3, which / 9];
        [0, 1, 2].map(|axis| {
            let at = (cursor.cell[axis] + u32::from(offsets[axis])).saturating_sub(1);
            at.min(self.cells[axis] - 1)
        })
    }
}
