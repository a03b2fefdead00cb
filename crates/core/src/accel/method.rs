//! A technique of which only the index it makes is known.

use std::fmt::Debug;

use crate::family::Family;
use crate::technique::{Index, Leaves, Technique};

/// A [`Technique`] that makes indices of type `I`: all an aggregate needs of it, so that
/// aggregates with the same kind of index are one type, compiled once.
pub(super) trait Method<I: Index>: Debug + Send + Sync {
    /// [`Technique::NAME`].
    fn name(&self) -> &'static str;
    /// [`Technique::build`].
    fn build(&self, family: &dyn Family, leaves: &mut Leaves) -> I;
    /// Its settings, for reports: `{ max_leaf: 8 }`.
    fn settings(&self) -> String;
}

impl<T: Technique> Method<T::Index> for T {
    fn name(&self) -> &'static str {
        T::NAME
    }

    fn build(&self, family: &dyn Family, leaves: &mut Leaves) -> T::Index {
        Technique::build(self, family, leaves)
    }

    fn settings(&self) -> String {
        let all = format!("{self:?}");
        all.trim_start_matches(|c: char| c.is_alphanumeric()).trim_start().into()
    }
}
