//! Finding everything that glows, through all instances.

use glam::{Affine3A, Vec3A};
use nestray_scene::geometry::{Content, Geometry};
use nestray_scene::group::Motion;
use nestray_scene::scene::Scene;
use nestray_scene::surfaces::Surfaces;

use super::emitter::{Emitter, Standing, place};
use super::luminance;

/// More than these are found by scattered rays only: each takes memory.
const MOST: usize = 1 << 22;

/// All emitters by name, where they stand, and how much light each gives.
pub(crate) fn emitters(surfaces: &Surfaces<'_>) -> (Vec<Emitter>, Vec<Standing>, Vec<f32>) {
    let scene = surfaces.scene();
    let glows = glowing_groups(scene);
    let mut search = Search { surfaces, glows, standing: Vec::new(), emitters: Vec::new() };
    search.group(scene.root, 0, &mut Vec::new());
    let Search { standing, mut emitters, .. } = search;
    emitters.sort_unstable_by_key(Emitter::name);
    let powers = emitters.iter().map(|emitter| power(scene, &standing, emitter)).collect();
    (emitters, standing, powers)
}

/// Whether a geometry has primitives to pick places on.
fn glows(scene: &Scene, geometry: &Geometry) -> bool {
    let material = &scene.materials[geometry.material];
    let textured = material.emission_texture.is_some() || material.base_texture.is_some();
    match &geometry.content {
        Content::Mesh(_) => material.glows(),
        // Coordinates on other shapes are known only where a ray meets them.
        Content::Shapes(_) => material.glows() && !textured,
        // No place on what is left of a solid can be picked without looking for it: scattered
        // rays find its light.
        Content::Solids(_) => false,
    }
}

/// Which groups hold something that glows, at any depth.
fn glowing_groups(scene: &Scene) -> Vec<bool> {
    fn visit(scene: &Scene, group: usize, known: &mut [Option<bool>]) -> bool {
        if let Some(known) = known[group] {
            return known;
        }
        let parts = &scene.groups[group];
        let mut found = parts.geometries.iter().any(|&g| glows(scene, &scene.geometries[g]));
        for place in &parts.places {
            found |= visit(scene, place.group, known);
        }
        known[group] = Some(found);
        found
    }
    let mut known = vec![None; scene.groups.len()];
    (0..scene.groups.len()).map(|group| visit(scene, group, &mut known)).collect()
}

struct Search<'a, 's> {
    surfaces: &'a Surfaces<'s>,
    glows: Vec<bool>,
    standing: Vec<Standing>,
    emitters: Vec<Emitter>,
}

impl<'s> Search<'_, 's> {
    fn group(&mut self, group: usize, path: u32, motions: &mut Vec<&'s Motion>) {
        if !self.glows[group] || self.emitters.len() >= MOST {
            return;
        }
        let scene = self.surfaces.scene();
        let parts = &scene.groups[group];
        let standing = self.standing.len() as u32;
        self.standing.push(standing_of(motions));
        for &geometry in &parts.geometries {
            if !glows(scene, &scene.geometries[geometry]) {
                continue;
            }
            let count = scene.geometries[geometry].primitives();
            let room = (MOST - self.emitters.len()).min(count as usize) as u32;
            let geometry = geometry as u32;
            self.emitters.extend((0..room).map(|primitive| Emitter {
                geometry,
                primitive,
                path,
                standing,
            }));
        }
        let numbers = self.surfaces.paths().numbers(group);
        for (place, number) in parts.places.iter().zip(numbers) {
            motions.push(&place.motion);
            self.group(place.group, path + number, motions);
            motions.pop();
        }
    }
}

fn standing_of(motions: &[&Motion]) -> Standing {
    if motions.iter().any(|motion| matches!(motion, Motion::Keys(_))) {
        return Standing::Moving(motions.iter().map(|&motion| motion.clone()).collect());
    }
    let all = |all: Affine3A, motion: &&Motion| all * place(motion, 0.0);
    Standing::Still(motions.iter().fold(Affine3A::IDENTITY, all))
}

/// About how much light it gives: never nothing where a texture may hide some.
fn power(scene: &Scene, standing: &[Standing], emitter: &Emitter) -> f32 {
    let to = standing[emitter.standing as usize].at(0.5);
    let Some(outline) = emitter.outline(scene, &to) else { return 0.0 };
    let geometry = &scene.geometries[emitter.geometry as usize];
    let material = &scene.materials[geometry.material];
    let least = 0.05 * luminance(Vec3A::from(material.emission));
    let places = [[1.0 / 3.0, 1.0 / 3.0], [0.6, 0.2], [0.2, 0.6], [0.2, 0.2]];
    let bright: f32 = places.map(|uv| luminance(emitter.emission(scene, uv))).iter().sum();
    outline.area() * (0.25 * bright).max(least)
}
