//! What does not change from one frame of a scene to the next.

use std::sync::Arc;

use nestray_scene::geometry::{Content, Geometry};
use nestray_scene::group::{Motion, Place};
use nestray_scene::scene::Scene;

/// For each group whether all that stands in it is as it was; never, if the scene is made of
/// other groups.
pub(super) fn rests(before: &Scene, scene: &Scene) -> Vec<bool> {
    let mut known = vec![None; scene.groups.len()];
    let alike = before.groups.len() == scene.groups.len()
        && before.geometries.len() == scene.geometries.len()
        && before.root == scene.root
        && before.groups.iter().zip(&scene.groups).all(|(a, b)| {
            a.geometries == b.geometries
                && a.places.len() == b.places.len()
                && a.places.iter().zip(&b.places).all(|(a, b)| a.group == b.group)
        });
    if !alike {
        return vec![false; scene.groups.len()];
    }
    (0..scene.groups.len()).map(|group| rest(before, scene, group, &mut known)).collect()
}

fn rest(before: &Scene, scene: &Scene, group: usize, known: &mut Vec<Option<bool>>) -> bool {
    if let Some(rests) = known[group] {
        return rests;
    }
    let (old, new) = (&before.groups[group], &scene.groups[group]);
    let same =
        |&geometry: &usize| is_same(&before.geometries[geometry], &scene.geometries[geometry]);
    let stays = |(old, new): (&Place, &Place)| match (&old.motion, &new.motion) {
        (Motion::Still(a), Motion::Still(b)) => a == b,
        (Motion::Keys(a), Motion::Keys(b)) => a == b,
        _ => false,
    };
    let rests = new.geometries.iter().all(same)
        && old.places.iter().zip(&new.places).all(stays)
        && new.places.iter().all(|place| rest(before, scene, place.group, known));
    known[group] = Some(rests);
    rests
}

fn is_same(a: &Geometry, b: &Geometry) -> bool {
    a.sides == b.sides
        && match (&a.content, &b.content) {
            (Content::Mesh(a), Content::Mesh(b)) => Arc::ptr_eq(a, b),
            (Content::Shapes(a), Content::Shapes(b)) => Arc::ptr_eq(a, b),
            (Content::Solids(a), Content::Solids(b)) => Arc::ptr_eq(a, b),
            _ => false,
        }
}
