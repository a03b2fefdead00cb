//! Scenes against the output of Haines' programs, number by number.

use std::path::PathBuf;

use glam::Vec3A;
use nestray_shapes::any::AnyShape;

use crate::camera::Projection;
use crate::geometry::Content;
use crate::light::{Background, LightKind};
use crate::procedural::generate;
use crate::scene::Scene;

/// A thing in a file: what it is, and its numbers.
type Item = (&'static str, Vec<f64>);

#[test]
fn every_scene_of_haines_is_as_his_program_wrote_it() {
    let files = [
        ("balls", "balls", 4),
        ("balls-2", "balls", 2),
        ("balls-5", "balls", 5),
        ("gears", "gears", 4),
        ("gears-2", "gears", 2),
        ("jacks", "jacks", 3),
        ("lattice-6", "lattice", 6),
        ("mount", "mount", 6),
        ("rings", "rings", 7),
        ("rings-3", "rings", 3),
        ("shells", "shells", 5),
        ("sombrero", "sombrero", 1),
        ("teapot", "teapot", 6),
        ("tetra", "tetra", 6),
        ("tetra-3", "tetra", 3),
        ("tree", "tree", 11),
        ("tree-6", "tree", 6),
    ];
    let folder = folder();
    if !folder.is_dir() {
        eprintln!("skipped: no scenes in {}", folder.display());
        return;
    }
    let wrong: Vec<String> = files
        .into_iter()
        .filter_map(|(file, name, size)| {
            let text = std::fs::read_to_string(folder.join(format!("{file}.nff")))
                .expect("it can be read");
            let scene = generate(name, Some(size)).expect("it can be made");
            compare(&read(&text), &items(&scene)).err().map(|what| format!("{file}: {what}"))
        })
        .collect();
    assert!(wrong.is_empty(), "{wrong:#?}");
}

/// Where the files are.
fn folder() -> PathBuf {
    let beside = || PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/../../../shared/scenes"));
    std::env::var_os("NESTRAY_SCENES").map_or_else(beside, PathBuf::from).join("nff")
}

fn compare(theirs: &[Item], ours: &[Item]) -> Result<(), String> {
    for (i, (theirs, ours)) in theirs.iter().zip(ours).enumerate() {
        let same = theirs.0 == ours.0 && theirs.1.len() == ours.1.len() && {
            // Six digits are printed, and ours are single.
            let largest = theirs.1.iter().fold(0.0f64, |all, x| all.max(x.abs()));
            let slack = |x: f64| 6e-6 * x.abs() + 2e-7 * largest;
            theirs.1.iter().zip(&ours.1).all(|(a, b)| (a - b).abs() <= slack(*a))
        };
        if !same {
            return Err(format!("item {i} is {theirs:?}, not {ours:?}"));
        }
    }
    if theirs.len() == ours.len() {
        return Ok(());
    }
    Err(format!("{} items, not {}", theirs.len(), ours.len()))
}

/// The items of a file.
fn read(text: &str) -> Vec<Item> {
    let mut words = text.split_whitespace();
    let mut items = Vec::new();
    while let Some(word) = words.next() {
        let mut some = |count: usize| -> Vec<f64> {
            let numbers = words.by_ref().filter_map(|word| word.parse().ok());
            numbers.take(count).collect()
        };
        let item = match word {
            "b" => ("background", some(3)),
            "v" => ("view", some(13)),
            "l" => ("light", some(3)),
            "f" => {
                let mut fill = some(8);
                fill[7] = fill[7].max(1.0);
                ("fill", fill)
            }
            "s" => ("sphere", some(4)),
            "c" => ("cone", some(8)),
            "p" | "pp" => {
                let count = some(1)[0] as usize;
                if word == "p" { ("polygon", some(3 * count)) } else { ("patch", some(6 * count)) }
            }
            other => panic!("{other:?} is nothing that a file starts a line with"),
        };
        items.push(item);
    }
    items
}

/// The items that the file of a scene would have.
fn items(scene: &Scene) -> Vec<Item> {
    let flat = |all: &[Vec3A]| -> Vec<f64> { numbers(all.iter().flat_map(|v| v.to_array())) };
    let Background::Color(sky) = scene.background else { panic!("the sky is a colour") };
    let camera = &scene.cameras[0];
    let Projection::Perspective { degrees } = camera.projection else { panic!("it has an angle") };
    let mut view = flat(&[camera.from, camera.from + camera.forward, camera.up]);
    view.extend(numbers([degrees, camera.hither]));
    view.extend(camera.resolution.expect("it is given").map(f64::from));
    let mut items = vec![("background", numbers(sky)), ("view", view)];
    for light in &scene.lights {
        let LightKind::Point { position, fades: false } = light.kind else {
            panic!("lights are points that do not fade")
        };
        items.push(("light", flat(&[position])));
    }
    for geometry in &scene.geometries {
        let material = &scene.materials[geometry.material];
        let whitted = material.whitted.expect("it is of NFF");
        let mut fill = numbers(whitted.color);
        fill.extend(numbers([whitted.kd, whitted.ks, whitted.shine, whitted.t, material.ior]));
        items.push(("fill", fill));
        let Content::Shapes(shapes) = &geometry.content else { panic!("there is no mesh") };
        items.extend(shapes.iter().map(item));
    }
    items
}

fn item(shape: &AnyShape) -> Item {
    let disk = |v: Vec3A, r: f32| numbers([v.x, v.y, v.z, r]);
    match shape {
        AnyShape::Sphere(sphere) => ("sphere", disk(sphere.center, sphere.radius)),
        AnyShape::Cylinder(it) => {
            ("cone", [disk(it.base, it.radius), disk(it.top, it.radius)].concat())
        }
        AnyShape::Cone(it) => {
            ("cone", [disk(it.base, it.base_radius), disk(it.apex, it.apex_radius)].concat())
        }
        AnyShape::Polygon(polygon) => {
            ("polygon", numbers(polygon.vertices().iter().copied().flatten()))
        }
        AnyShape::Patch(patch) => {
            let places = patch.polygon().vertices().iter();
            let corners = places.zip(patch.normals()).flat_map(|(place, normal)| [*place, *normal]);
            ("patch", numbers(corners.flatten()))
        }
        other => panic!("{other:?} is not in any file"),
    }
}

fn numbers(all: impl IntoIterator<Item = f32>) -> Vec<f64> {
    all.into_iter().map(f64::from).collect()
}
