//! The octree of [Glassner 84]: cells cut into eight, by three planes at once.
//!
//! A cell is cut by its three planes one after the other, so that a ray meets the eighths in
//! exact order. Planes are in the middle, or where they cost least [Whang 95].
//!
//! Space `O(n)` (at most 8 entries a child), build `O(n · depth)`, a ray visits the cells on its
//! way.

mod planes;

use nestray_core::family::Family;
use nestray_core::technique::{Leaves, OutOfRange, Technique, in_range};
use serde::{Deserialize, Serialize};

use crate::cells::{Cell, Cells, Children, Plane, Rule};

/// The technique: an octree.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Octree {
    /// Cells with more children are cut, 1 to 8 in the literature; 0 is 8 for packed triangles
    /// and 2 for all else.
    pub max_leaf: usize,
    /// Most times space is cut into eighths, 5 to 8 in the literature; 0 chooses by the number
    /// of children.
    pub max_depth: u32,
    /// Where planes are.
    pub places: Places,
}

/// Where the planes of an octree are.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Places {
    /// In the middle of a cell.
    #[default]
    Middle,
    /// Where they cost least, between the middle of the cell and that of its children.
    ByCost,
}

impl Technique for Octree {
    const NAME: &'static str = "octree";
    const EFFORT: f64 = 2.0;
    type Index = Cells;

    fn build(&self, family: &dyn Family, leaves: &mut Leaves) -> Cells {
        let children = Children::new(family);
        let max_depth = match self.max_depth {
            // Twice as many cells along an axis, four times as many on a surface.
            0 => (5 + (usize::BITS - children.boxes.len().leading_zeros()) / 2).min(MOST),
            depth => depth,
        };
        let max_leaf = children.most_in_leaf(self.max_leaf, 2);
        let rule = Self { max_leaf, max_depth, ..*self };
        Cells::new(&rule, &children, leaves)
    }

    fn neighbours(&self) -> Vec<Self> {
        let from = if self.max_leaf > 0 { self.max_leaf } else { 4 };
        let other = match self.places {
            Places::Middle => Places::ByCost,
            Places::ByCost => Places::Middle,
        };
        [from / 2, from * 2]
            .map(|max_leaf| Self { max_leaf, ..*self })
            .into_iter()
            .filter(|params| params.max_leaf > 0 && params.check().is_ok())
            .chain([Self { places: other, ..*self }])
            .collect()
    }

    fn check(&self) -> Result<(), OutOfRange> {
        in_range((0..=64).contains(&self.max_leaf), "max_leaf", "0 (chosen), or 1 to 64")?;
        in_range((0..=MOST).contains(&self.max_depth), "max_depth", "0 (chosen), or 1 to 21")
    }
}

/// Most times space is cut into eighths: a tree of cells has room for 64 planes.
const MOST: u32 = 21;

/// How a cell is being cut into eighths.
#[derive(Clone, Copy, Debug, Default)]
pub struct Progress {
    /// How often space was, around it.
    eighths: u32,
    /// Planes still to come.
    planes: [Option<f32>; 3],
}

impl Rule for Octree {
    type Memory = Progress;

    fn cut(&self, cell: &Cell<'_>, mut progress: Progress) -> Option<(Plane, Progress)> {
        if progress.planes == [None; 3] {
            if cell.inside.len() <= self.max_leaf || progress.eighths >= self.max_depth {
                return None;
            }
            let eighths = progress.eighths + 1;
            progress = Progress { eighths, planes: planes::planes(self.places, cell)? };
        }
        let axis = progress.planes.iter().position(Option::is_some)?;
        let at = progress.planes[axis].take()?;
        Some((Plane { axis, at }, progress))
    }
}
