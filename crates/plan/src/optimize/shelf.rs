//! Worlds that were built already, for when they are timed.

use std::collections::BTreeMap;

use nestray_core::object::DynObject;

use crate::plan::Plan;

/// Bytes of all worlds that are kept.
const ROOM: u64 = 1 << 30;

/// Worlds that stay as they are, whatever rays come.
#[derive(Default)]
pub(super) struct Shelf {
    /// By the hash of their plans; each with the seconds it took to build.
    worlds: BTreeMap<String, (DynObject, f64)>,
    bytes: u64,
}

impl Shelf {
    /// Keeps a world, if there is room.
    pub(super) fn keep(&mut self, plan: &Plan, world: DynObject, seconds: f64, bytes: u64) {
        if self.bytes.saturating_add(bytes) <= ROOM {
            self.bytes += bytes;
            self.worlds.insert(plan.hash(), (world, seconds));
        }
    }

    /// Whether the world of a plan is there.
    pub(super) fn holds(&self, plan: &Plan) -> bool {
        self.worlds.contains_key(&plan.hash())
    }

    /// The world of a plan, and the seconds it took to build.
    pub(super) fn take(&mut self, plan: &Plan) -> Option<(DynObject, f64)> {
        self.worlds.remove(&plan.hash())
    }
}

#[cfg(test)]
mod tests {
    use nestray_scene::procedural::generate;

    use super::*;
    use crate::build::build;
    use crate::single::single;

    #[test]
    fn worlds_are_kept_as_long_as_there_is_room() {
        let scene = generate("balls", Some(1)).expect("there is one");
        let made = |technique: &str| {
            let plan = single(technique, Default::default(), &scene).expect("it is sound");
            let world = build(&plan, &scene).expect("it is sound");
            (plan, world)
        };
        let (one, other) = (made("bvh"), made("grid"));
        let mut shelf = Shelf::default();
        shelf.keep(&one.0, one.1, 2.5, ROOM - 10);
        shelf.keep(&other.0, other.1, 1.5, 11);
        assert!(shelf.holds(&one.0) && !shelf.holds(&other.0), "the second is too large");
        assert!(shelf.take(&other.0).is_none());
        assert_eq!(shelf.take(&one.0).map(|(_, seconds)| seconds), Some(2.5));
        assert!(!shelf.holds(&one.0), "it was taken");
    }
}
