//! What is in a scene.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use nestray::core::cost::CostModel;
use nestray::plan::build::build;
use nestray::plan::describe::describe;
use nestray::plan::fingerprint::fingerprint;
use nestray::prelude::{Content, DynObject, Scene, Shape as _};
use serde_json::{Value, json};

use super::{Report, pilot, ray};
use crate::args::InspectArgs;
use crate::errors::Failure;
use crate::input::Choice;

pub(super) fn report(
    scene: &Scene,
    choice: &Choice,
    args: &InspectArgs,
) -> Result<Report, Failure> {
    scene.check().map_err(|error| Failure::new(Failure::UNREADABLE, error))?;
    let mut report = counts(scene);
    let wants_tree = args.tree || (args.plan.is_some() && args.ray.is_none());
    if wants_tree || args.ray.is_some() {
        let scene = scene.frame(0.0, 0.0);
        let plan = choice.plan(&scene)?;
        let world = build(&plan, &scene).map_err(|error| choice.failure(&error))?;
        if wants_tree {
            tree(&scene, &world, &plan.hash(), &mut report)?;
        }
        if let Some(pixel) = args.ray {
            ray::add(pixel, args.resolution, &scene, &world, &mut report)?;
        }
    }
    Ok(report)
}

fn counts(scene: &Scene) -> Report {
    let stored: u64 = scene.geometries.iter().map(|g| u64::from(g.primitives())).sum();
    let places: usize = scene.groups.iter().map(|group| group.places.len()).sum();
    let mut kinds = BTreeMap::<&str, u64>::new();
    for geometry in &scene.geometries {
        match &geometry.content {
            Content::Mesh(mesh) => *kinds.entry("triangle").or_default() += u64::from(mesh.count()),
            Content::Solids(solids) => *kinds.entry("csg").or_default() += solids.len() as u64,
            Content::Shapes(shapes) => {
                for shape in shapes.iter() {
                    *kinds.entry(shape.kind()).or_default() += 1;
                }
            }
        }
    }
    let bounds = scene.bounds();
    let (min, max) = (bounds.min.to_array(), bounds.max.to_array());
    let mut text = String::new();
    let fingerprint = fingerprint(scene);
    let _ = writeln!(text, "fingerprint {fingerprint}");
    let _ = writeln!(text, "geometries  {}", scene.geometries.len());
    let _ = writeln!(text, "primitives  {stored} stored, {} seen", scene.primitives());
    for (kind, count) in &kinds {
        let _ = writeln!(text, "            {count} × {kind}");
    }
    let _ = writeln!(text, "groups      {}, placed {places} times", scene.groups.len());
    let _ = writeln!(text, "bounds      {min:?} to {max:?}");
    let _ = writeln!(text, "materials   {}", scene.materials.len());
    let _ = writeln!(text, "textures    {}", scene.textures.len());
    let _ = writeln!(text, "lights      {}", scene.lights.len());
    let _ = writeln!(text, "cameras     {}", scene.cameras.len());
    let duration = scene.animation.duration();
    if duration > 0.0 {
        let _ = writeln!(text, "animation   {duration} s");
    }
    let json = json!({ "fingerprint": fingerprint, "geometries": scene.geometries.len(), "primitives_stored": stored,
        "primitives": scene.primitives(), "kinds": kinds, "groups": scene.groups.len(),
        "places": places, "bounds": [min, max], "materials": scene.materials.len(),
        "textures": scene.textures.len(), "lights": scene.lights.len(),
        "cameras": scene.cameras.len(), "animation_seconds": duration });
    Report { text, json }
}

/// What the nest is made of, and what each part of it does for rays of each kind.
fn tree(scene: &Scene, world: &DynObject, hash: &str, report: &mut Report) -> Result<(), Failure> {
    let sent = pilot::send(scene, world)?;
    let part = describe(world, CostModel::usual()).counted(&sent);
    let _ = writeln!(report.text, "plan        {hash}");
    let rays: Vec<String> = sent.rays.iter().map(|(name, _, n)| format!("{n} {name}")).collect();
    let _ = writeln!(report.text, "rays sent   {}", rays.join(", "));
    report.text.push_str(&part.to_text());
    report.json["rays_sent"] = sent.rays.iter().map(|(name, _, n)| (name.clone(), *n)).collect();
    report.json["plan"] = hash.into();
    report.json["tree"] = serde_json::to_value(&part).unwrap_or(Value::Null);
    Ok(())
}
