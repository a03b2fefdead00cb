//! How an acceleration technique is written.

mod index;
mod step;

use std::fmt::Debug;

use serde::Serialize;
use serde::de::DeserializeOwned;

use crate::aim::Aims;
use crate::family::Family;

pub use self::index::{Asks, Every, Expected, Index, Lead, Led, Query, Repeats, Visit, Walk};
pub use self::step::{Leaf, Leaves, Step};

/// An acceleration technique with its settings, as written in a plan: a way of putting
/// children in order.
///
/// What it makes of them is an [`Index`], which leads rays to them. Several techniques make
/// the same kind of index, as several builders of hierarchies do; so loops over it are compiled
/// once for all of them.
///
/// `Default` is what the literature recommends. A missing setting takes its default; an unknown
/// one is refused by `Deserialize`, one out of range by [`check`](Self::check).
pub trait Technique:
    Clone + Debug + Default + PartialEq + Send + Sync + Serialize + DeserializeOwned + 'static
{
    /// The word used for it in plans and on the command line.
    const NAME: &'static str;

    /// How many times as long as the usual hierarchy of boxes it takes to build and try, roughly: for
    /// whoever has to know before it was tried.
    const EFFORT: f64 = 5.0;

    /// What it makes of children.
    type Index: Index;

    /// In how many leaves a child stands at most, on average.
    const COPIES: usize = Self::Index::COPIES;

    /// Puts a family in order. Every child must be pushed into a leaf, unless the index
    /// [`LISTS`](Index::LISTS).
    fn build(&self, family: &dyn Family, leaves: &mut Leaves) -> Self::Index;

    /// Settings one step away, for the annealer to try.
    fn neighbours(&self) -> Vec<Self>;

    /// The name of a setting out of range, and the range.
    ///
    /// # Errors
    /// If there is one.
    fn check(&self) -> Result<(), OutOfRange>;

    /// The same technique for a scene with these lights and eyes, where its settings leave them
    /// open.
    #[must_use]
    fn aimed(self, _aims: &Aims) -> Self {
        self
    }

    /// Why it cannot serve in this place of a plan, if it cannot.
    #[must_use]
    fn objection(&self, _place: &Place) -> Option<String> {
        None
    }
}

/// Where in a plan a technique stands.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Place {
    /// How many instances are above it: not 0 means that its space is not the world's.
    pub instances: usize,
    /// Whether something in it moves during the shutter.
    pub moving: bool,
}

/// A setting that is out of range.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct OutOfRange {
    /// Its name.
    pub setting: &'static str,
    /// What it may be, in words: `1 to 64`.
    pub range: &'static str,
}

/// Says that `setting` must be in `range`, unless it is.
///
/// # Errors
/// If it is not.
pub fn in_range(is: bool, setting: &'static str, range: &'static str) -> Result<(), OutOfRange> {
    if is { Ok(()) } else { Err(OutOfRange { setting, range }) }
}
