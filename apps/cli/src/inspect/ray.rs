//! What one ray meets.

use std::fmt::Write as _;

use nestray::prelude::{DynObject, Hit, Object as _, Ray, RayKind, Scene, Scratch, Surfaces};
use serde_json::json;

use super::Report;
use crate::errors::Failure;
use crate::render::RESOLUTION;

/// Follows the ray through the middle of a pixel.
pub(super) fn add(
    [x, y]: [u32; 2],
    resolution: Option<[u32; 2]>,
    scene: &Scene,
    world: &DynObject,
    report: &mut Report,
) -> Result<(), Failure> {
    let ray = through([x, y], resolution, scene)?;
    let (origin, dir) = (ray.origin(), ray.dir());
    let (mut scratch, mut hit) = (Scratch::counting(), Hit::none(ray.t_max()));
    world.closest_hit(&ray, &mut hit, &mut scratch);
    let work = scratch.counters.total();
    let text = &mut report.text;
    let _ = writeln!(
        text,
        "ray         {x},{y} from {:?} along {:?}",
        origin.to_array(),
        dir.to_array()
    );
    let mut found = json!({ "pixel": [x, y], "origin": origin.to_array(),
        "direction": dir.to_array(), "steps": work.steps, "tests": work.tests, "hit": null });
    if hit.is_some() {
        let surfaces =
            Surfaces::new(scene).map_err(|error| Failure::new(Failure::UNREADABLE, error))?;
        let point = surfaces.at(&ray, &hit);
        let geometry = &scene.geometries[hit.geometry as usize];
        let name = |name: &str| if name.is_empty() { String::new() } else { format!(" {name:?}") };
        let material = scene.materials.get(point.material).map_or("", |m| m.name.as_str());
        let (position, normal) =
            (point.surface.position.to_array(), point.surface.normal.to_array());
        let _ = writeln!(text, "  hits      geometry {}{}", hit.geometry, name(&geometry.name));
        let _ = writeln!(text, "  primitive {}", hit.primitive);
        let _ = writeln!(text, "  instance  {}", hit.path.number());
        let _ = writeln!(text, "  material  {}{}", point.material, name(material));
        let _ = writeln!(text, "  distance  {}", hit.t * dir.length());
        let _ = writeln!(text, "  position  {position:?}");
        let _ = writeln!(text, "  normal    {normal:?}");
        found["hit"] = json!({ "t": hit.t, "geometry": hit.geometry, "name": geometry.name,
            "primitive": hit.primitive, "instance": hit.path.number(),
            "material": point.material, "position": position, "normal": normal });
    } else {
        let _ = writeln!(text, "  hits      nothing");
    }
    for (what, counts) in [("steps", &work.steps), ("tests", &work.tests)] {
        let list: Vec<String> = counts.iter().map(|(name, n)| format!("{n} {name}")).collect();
        let list = if list.is_empty() { "none".into() } else { list.join(", ") };
        let _ = writeln!(text, "  {what}     {list}");
    }
    report.json["ray"] = found;
    Ok(())
}

/// The ray of the first camera through the middle of a pixel.
fn through([x, y]: [u32; 2], resolution: Option<[u32; 2]>, scene: &Scene) -> Result<Ray, Failure> {
    let Some(camera) = scene.cameras.first() else {
        return Err(Failure::usage("--ray: the scene has no camera"));
    };
    let [width, height] = resolution.or(camera.resolution).unwrap_or(RESOLUTION);
    if x >= width || y >= height {
        let message = format!("--ray: {x},{y} is no pixel of {width} x {height}");
        return Err(Failure::usage(message));
    }
    let view = camera.view(width as f32 / height as f32);
    let (origin, dir) = view.through([x, y], [width, height]);
    Ok(Ray::new(origin, dir, RayKind::Camera))
}
