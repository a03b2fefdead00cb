//! Hybrids: a technique whose leaves are put in order by another, to any depth.
//!
//! An octree with hierarchies of boxes in its cells [Scherson 87], grids in the cells of a grid
//! [Snyder 87], a hierarchy whose lower levels are built when a ray comes: all are a technique, and
//! a [`Filling`] for its leaves.

use std::sync::Arc;

use nestray_core::lazy::Lazy;
use nestray_core::object::DynObject;
use rayon::prelude::*;
use serde_json::Value;

use crate::{Entry, Members, SettingsError, find};

/// What the leaves of a technique are put in order by.
#[derive(Clone, Debug)]
pub struct Filling {
    /// The technique.
    pub entry: &'static Entry,
    /// Its settings.
    pub params: Value,
    /// Smaller leaves are left to the technique above, as they are.
    pub more_than: usize,
    /// How many children the technique above may take to be as cheap as a few.
    pub per_leaf: u32,
    /// Whether each leaf is put in order when the first ray comes to it.
    pub is_lazy: bool,
    /// What the leaves of this technique are put in order by, if not by itself.
    pub leaves: Option<Box<Self>>,
}

/// An aggregate by one technique, with its leaves put in order by `leaves`.
///
/// The technique is asked what it would put in its leaves. Each child is given to one leaf, the
/// one it fits best, so that none is tested twice. What is in a leaf of more than
/// [`more_than`](Filling::more_than) children becomes an aggregate by the other technique; then
/// the technique orders these aggregates, and whatever is in none. So it makes the whole aggregate
/// alone where all leaves are small, and the other alone where all children are in one.
///
/// # Errors
/// If settings of any of them are wrong.
pub fn build(
    entry: &Entry,
    params: &Value,
    leaves: Option<&Filling>,
    members: Members,
) -> Result<DynObject, SettingsError> {
    with_parts(entry, params, leaves, members).map(|(object, _)| object)
}

/// The same, and the objects that it orders; none if it is made of triangles or single shapes.
///
/// # Errors
/// If settings of any of them are wrong.
pub fn with_parts(
    entry: &Entry,
    params: &Value,
    leaves: Option<&Filling>,
    members: Members,
) -> Result<(DynObject, Vec<DynObject>), SettingsError> {
    let alone = |members: Members| {
        let parts = match &members {
            Members::Objects(objects) => objects.clone(),
            _ => Vec::new(),
        };
        Ok(((entry.build)(params, members)?, parts))
    };
    let Some(leaves) = leaves else { return alone(members) };
    leaves.check()?;
    if members.count() <= leaves.more_than {
        return alone(members);
    }
    let division = (entry.divide)(params, &members, leaves.per_leaf)?;
    let (large, small): (Vec<_>, Vec<_>) =
        division.groups.into_iter().partition(|group| group.len() > leaves.more_than);
    match (&large[..], &small[..]) {
        ([], _) => return alone(members),
        ([_], []) => return Ok((leaves.fill(members)?, Vec::new())),
        _ => {}
    }
    // One thread each; in order, and so always the same.
    let filled = large.par_iter().map(|group| leaves.fill(members.part(group)));
    let mut objects = filled.collect::<Result<Vec<DynObject>, _>>()?;
    for group in small.iter().chain([&division.outside]) {
        objects.extend(apart(members.part(group))?);
    }
    alone(Members::Objects(objects))
}

/// Children that are in no aggregate of the other technique; triangles are packed together.
fn apart(members: Members) -> Result<Vec<DynObject>, SettingsError> {
    match members.shared() {
        Members::Objects(objects) => Ok(objects),
        Members::Triangles(mesh) if mesh.count() == 0 => Ok(Vec::new()),
        packed => {
            let list = find("list").expect("it is the first of all techniques");
            Ok(vec![(list.build)(&Value::Null, packed)?])
        }
    }
}

impl Filling {
    /// A technique with its defaults.
    #[must_use]
    pub fn new(entry: &'static Entry) -> Self {
        Self {
            entry,
            params: Value::Null,
            more_than: Self::MORE_THAN as usize,
            per_leaf: Self::PER_LEAF,
            is_lazy: false,
            leaves: None,
        }
    }

    /// What [`more_than`](Self::more_than) usually is.
    pub const MORE_THAN: u32 = 16;
    /// What [`per_leaf`](Self::per_leaf) usually is.
    pub const PER_LEAF: u32 = 64;

    /// Whether all settings are sound.
    fn check(&self) -> Result<(), SettingsError> {
        let mut open = Some(self);
        while let Some(filling) = open {
            (filling.entry.neighbours)(&filling.params)?;
            open = filling.leaves.as_deref();
        }
        Ok(())
    }

    /// An aggregate over what is in a leaf.
    fn fill(&self, members: Members) -> Result<DynObject, SettingsError> {
        if !self.is_lazy {
            return build(self.entry, &self.params, self.leaves.as_deref(), members);
        }
        let members = members.shared();
        let stand_in = members.one_by_one();
        let filling = Self { is_lazy: false, ..self.clone() };
        Ok(Arc::new(Lazy::new(stand_in, move || {
            filling.fill(members.clone()).expect("the settings have been checked")
        })))
    }
}
