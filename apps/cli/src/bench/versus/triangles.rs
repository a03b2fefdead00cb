//! A scene as other libraries take it: triangles, and places of triangles.

use std::collections::BTreeMap;

use nestray::glam::Affine3A;
use nestray::prelude::{Content, Geometry, Motion, Scene, Sides};
use nestray_peers::world::{Mesh, Place, World};

/// Most places that are written out.
const PLACES: usize = 4_000_000;

/// The triangles of a scene; what stands in one place stands there as it is.
///
/// Changes the scene so that its triangles are seen from both sides, as other libraries see them.
pub(super) fn world(scene: &mut Scene) -> Result<World, String> {
    for geometry in &mut scene.geometries {
        geometry.sides = Sides::Both;
    }
    scene.check_places().map_err(|error| error.to_string())?;
    let places = places(scene)?;
    let mut count = BTreeMap::<usize, usize>::new();
    for (group, _) in &places {
        *count.entry(*group).or_default() += 1;
    }
    let (mut world, mut meshes) = (World::default(), BTreeMap::new());
    for (&group, &count) in &count {
        let mesh = mesh(scene, group)?;
        if count > 1 && !mesh.faces.is_empty() {
            meshes.insert(group, world.meshes.len());
            world.meshes.push(mesh);
        } else if let Some((_, to)) = places.iter().find(|place| place.0 == group) {
            world.fixed.append(&mesh, to);
        }
    }
    let instances = places.into_iter().filter_map(|(group, world_from_mesh)| {
        Some(Place { mesh: *meshes.get(&group)?, world_from_mesh })
    });
    world.places = instances.collect();
    Ok(world)
}

/// Every group that stands somewhere, and where.
fn places(scene: &Scene) -> Result<Vec<(usize, Affine3A)>, String> {
    let (mut found, mut open) = (Vec::new(), vec![(scene.root, Affine3A::IDENTITY)]);
    while let Some((group, to)) = open.pop() {
        for place in &scene.groups[group].places {
            let within = match &place.motion {
                Motion::Still(at) => *at,
                Motion::Node(node) => scene.animation.world_from_node(*node, 0.0),
                Motion::Keys(_) => return Err("something moves while the shutter is open".into()),
            };
            open.push((place.group, to * within));
        }
        found.push((group, to));
        if found.len() + open.len() > PLACES {
            return Err(format!("more than {PLACES} instances, all levels counted"));
        }
    }
    Ok(found)
}

/// The triangles that stand in a group itself.
fn mesh(scene: &Scene, group: usize) -> Result<Mesh, String> {
    let mut mesh = Mesh::default();
    for &number in &scene.groups[group].geometries {
        let Geometry { name, content, .. } = &scene.geometries[number];
        let Content::Mesh(triangles) = content else {
            return Err(format!("other libraries take triangles only: geometry {name:?} has none"));
        };
        let faces = (0..).zip(triangles.faces());
        let usable = faces.filter(|&(face, _)| triangles.is_usable(face)).map(|(_, face)| *face);
        let own = Mesh { positions: triangles.positions().to_vec(), faces: usable.collect() };
        mesh.append(&own, &Affine3A::IDENTITY);
    }
    Ok(mesh)
}
