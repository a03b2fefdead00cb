//! Tighter bounds around parts.

use std::sync::Arc;

use nestray_core::cost::CostModel;
use nestray_core::fence::{Fenced, Planes};
use nestray_core::object::DynObject;
use rayon::prelude::*;

use super::order::Part;
use crate::plan::Bounds;

/// The same parts, each behind a fence where there can be one.
pub(super) fn around(by: Bounds, parts: Vec<Part>) -> Vec<Part> {
    // One thread each; in order, and so always the same.
    parts.into_par_iter().map(|part| fenced(by, part)).collect()
}

fn fenced(bounds: Bounds, part: Part) -> Part {
    let object = match &part {
        Part::Mesh(_) => return part,
        Part::Shape(single) => {
            let single = single.clone();
            single.shape.into_object(single.geometry, single.primitive, single.sides)
        }
        Part::Object(object) => Arc::clone(object),
        Part::Placed(placed) => Arc::clone(&placed.instance) as DynObject,
    };
    let by = |planes: Option<Planes>| {
        Some(Arc::new(Fenced::new(Arc::clone(&object), planes?)) as DynObject)
    };
    let found = match bounds {
        Bounds::Cheapest => Fenced::if_it_pays(&object, CostModel::usual()),
        Bounds::TurnedBox => by(Planes::turned_box(&*object)),
        Bounds::ThirteenSlabs => by(Planes::slabs(&*object)),
    };
    found.map_or(part, Part::Object)
}

#[cfg(test)]
mod tests {
    use serde_json::Map;

    use crate::build::tests::{answers, scene};
    use crate::plan::{Bounds, Fence, Node};
    use crate::single::single;

    #[test]
    fn fences_change_no_answer() {
        let scene = scene();
        let plan = |by: Option<Bounds>| {
            let mut plan = single("bvh", Map::new(), &scene).expect("known");
            for node in plan.shared.values_mut().chain([&mut plan.root]) {
                let Node::Nest(nest) = node else { panic!("it is a nest") };
                for child in &mut nest.children {
                    let around = child.clone();
                    *child = match by {
                        Some(by) => Node::Fence(Box::new(Fence { by, around })),
                        None => around,
                    };
                }
            }
            plan
        };
        let without = answers(&scene, &plan(None));
        for by in [Bounds::Cheapest, Bounds::TurnedBox, Bounds::ThirteenSlabs] {
            assert_eq!(answers(&scene, &plan(Some(by))), without, "{by:?}");
        }
    }
}
