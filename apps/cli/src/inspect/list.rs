//! What there is to choose from.

use std::fmt::Write as _;

use nestray::plan::presets::PRESETS;
use nestray::registry::TECHNIQUES;
use nestray::scene::procedural::SCENES;
use serde_json::{Value, json};

use super::Report;
use crate::args::ListName;

/// Single shapes, and meshes.
const SHAPES: &[(&str, &str)] = &[
    ("sphere", "a ball"),
    ("cone", "a cone or the part of one between two circles"),
    ("cylinder", "a tube without ends"),
    ("plane", "without end"),
    ("disk", "a flat circle"),
    ("parallelogram", "flat, four corners"),
    ("block", "a box along the axes"),
    ("polygon", "flat, any number of corners"),
    ("patch", "a triangle with normals of its own"),
    ("torus", "a ring"),
    ("quadric", "any surface of degree two, cut by a box"),
    ("bezier", "a bicubic patch"),
    ("height-field", "a grid of heights"),
    ("csg", "a solid made of two: union, intersection, difference"),
    ("triangle", "of a mesh, tested eight at a time"),
];

pub(super) fn report(list: ListName) -> Report {
    match list {
        ListName::Techniques => techniques(),
        ListName::Presets => presets(),
        ListName::Scenes => scenes(),
        ListName::Shapes => shapes(),
    }
}

fn techniques() -> Report {
    let (mut text, mut list) = (String::new(), Vec::new());
    for entry in TECHNIQUES {
        let defaults = (entry.defaults)();
        let settings: Vec<String> = defaults
            .as_object()
            .map(|all| all.iter().map(|(name, value)| format!("{name} = {value}")).collect())
            .unwrap_or_default();
        line(&mut text, entry.name, entry.about);
        for setting in settings {
            line(&mut text, "", &format!("  {setting}"));
        }
        list.push(json!({ "name": entry.name, "about": entry.about, "defaults": defaults }));
    }
    Report { text, json: list.into() }
}

fn presets() -> Report {
    let (mut text, mut list) = (String::new(), Vec::new());
    for preset in PRESETS {
        let mut nest = json!(preset.nest());
        if let Some(nest) = nest.as_object_mut() {
            nest.remove("children");
        }
        line(&mut text, preset.name, preset.about);
        line(&mut text, "", &format!("  {nest}"));
        list.push(json!({ "name": preset.name, "about": preset.about, "nest": nest }));
    }
    Report { text, json: list.into() }
}

fn scenes() -> Report {
    let (mut text, mut list) = (String::new(), Vec::new());
    for entry in SCENES {
        let (low, high) = (*entry.sizes.start(), *entry.sizes.end());
        line(&mut text, entry.name, entry.about);
        let size = format!("  size {} ({low} to {high}): {}", entry.default, entry.unit);
        line(&mut text, "", &size);
        list.push(json!({ "name": entry.name, "about": entry.about, "unit": entry.unit,
            "default": entry.default, "sizes": [low, high],
            "primitives": (entry.primitives)(entry.default) }));
    }
    Report { text, json: list.into() }
}

fn shapes() -> Report {
    let (mut text, mut list) = (String::new(), Vec::new());
    for &(name, about) in SHAPES {
        line(&mut text, name, about);
        list.push(json!({ "name": name, "about": about }));
    }
    Report { text, json: Value::from(list) }
}

fn line(text: &mut String, name: &str, about: &str) {
    let _ = writeln!(text, "{name:<20} {about}");
}

#[cfg(test)]
mod tests {
    use nestray::prelude::{Content, Shape as _};
    use nestray::scene::procedural::generate;

    use super::*;

    #[test]
    fn every_shape_of_the_mixed_scene_is_in_the_list() {
        let scene = generate("mixed", Some(1)).expect("it can be made");
        let mut kinds = 0;
        for geometry in &scene.geometries {
            let Content::Shapes(shapes) = &geometry.content else { continue };
            for shape in shapes.iter() {
                assert!(SHAPES.iter().any(|&(name, _)| name == shape.kind()), "{}", shape.kind());
                kinds += 1;
            }
        }
        assert!(kinds > 8, "{kinds} shapes");
    }
}
