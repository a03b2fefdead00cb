//! The scenes, and how they are put together from files.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use serde_json::{Value, json};

/// All libraries.
const PEERS: &str = "embree,tinybvh,obvhs,parry3d,bvh";

/// All but one that takes more than six minutes to build a tree over long thin triangles.
const PATIENT_PEERS: &str = "embree,tinybvh,parry3d,bvh";

/// A scene by what makes it.
#[derive(Debug)]
pub(crate) struct Scene {
    pub(crate) name: &'static str,
    pub(crate) peers: &'static str,
    /// Plans of ours, the one that ratios are of first.
    pub(crate) plans: &'static str,
    from: From,
}

#[derive(Debug)]
enum From {
    /// A scene of the program.
    Builtin(&'static str),
    /// A file of the shared folder, as it is.
    File(&'static str),
    /// A file of the shared folder on a floor: what is hit below it, how far it reaches, and the
    /// middle of what stands there.
    OnFloor(&'static str, f32, f32, [f32; 3]),
    Sponza,
    /// So many of them along a side of a terrain.
    SponzaInTerrain(u32),
}

const fn scene(name: &'static str, from: From) -> Scene {
    Scene { name, peers: PEERS, plans: "sbvh,bvh", from }
}

/// A scene that is measured with Embree alone, of the program.
pub(crate) const fn builtin(name: &'static str, builtin: &'static str) -> Scene {
    Scene { name, peers: "embree", plans: "bvh", from: From::Builtin(builtin) }
}

/// The same, of a file.
pub(crate) const fn file(name: &'static str, file: &'static str) -> Scene {
    Scene { name, peers: "embree", plans: "bvh", from: From::File(file) }
}

/// The ten scenes, and one more with instances.
#[rustfmt::skip]
pub(crate) const ALL: &[Scene] = &[
    scene("bunny", From::OnFloor("meshes/stanford-bunny.ply", 0.033, 0.5, [-0.017, 0.11, -0.001])),
    scene("dragon", From::OnFloor("large/dragon_vrip.ply.gz", 0.0528, 0.6, [-0.006, 0.12, -0.005])),
    scene("sponza", From::Sponza),
    scene("terrain", From::Builtin("builtin:terrain")),
    scene("stadium", From::Builtin("builtin:stadium")),
    Scene { peers: PATIENT_PEERS, ..scene("needles", From::Builtin("builtin:needles")) },
    scene("truss", From::Builtin("builtin:truss")),
    scene("scatter", From::Builtin("builtin:scatter")),
    scene("tree", From::Builtin("builtin:tree")),
    scene("forest", From::Builtin("builtin:forest")),
    scene("sponza-in-terrain", From::SponzaInTerrain(4)),
];

impl Scene {
    /// What to call it on the command line; puts files together in `folder` where there is need.
    pub(crate) fn prepare(&self, shared: &Path, folder: &Path) -> Result<String, String> {
        if let From::Builtin(name) = self.from {
            return Ok(name.into());
        }
        fs::create_dir_all(folder).map_err(|error| error.to_string())?;
        let scene = match self.from {
            From::Builtin(name) => return Ok(name.into()),
            From::File(file) => return Ok(found(&shared.join(file))?.display().to_string()),
            From::OnFloor(file, height, reach, middle) => {
                let file = copied(&shared.join(file), folder)?;
                on_floor(&file, height, reach, middle)
            }
            From::Sponza => inside(&sponza(shared, folder)?),
            From::SponzaInTerrain(side) => {
                let hall =
                    json!({ "nestray_scene": 1, "groups": [{ "file": sponza(shared, folder)? }] });
                write(&folder.join("hall.json"), &hall)?;
                in_terrain(side)
            }
        };
        let path = folder.join(format!("{}.json", self.name));
        write(&path, &scene)?;
        Ok(path.display().to_string())
    }
}

fn write(path: &Path, scene: &Value) -> Result<(), String> {
    fs::write(path, format!("{scene}\n")).map_err(|error| format!("{}: {error}", path.display()))
}

fn found(path: &Path) -> Result<&Path, String> {
    if path.is_file() { Ok(path) } else { Err(format!("{} is not there", path.display())) }
}

/// Files that a scene names lie beside it.
fn copied(path: &Path, folder: &Path) -> Result<String, String> {
    let name = found(path)?.file_name().and_then(|name| name.to_str()).unwrap_or_default();
    fs::copy(path, folder.join(name)).map_err(|error| format!("{}: {error}", path.display()))?;
    Ok(name.into())
}

fn floor(height: f32, reach: f32, [x, _, z]: [f32; 3]) -> Value {
    let corner = |u: f32, v: f32| json!([x + u * reach, height, z + v * reach]);
    let positions = [corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)];
    json!({ "name": "floor", "mesh": { "positions": positions, "faces": [[0, 2, 1], [0, 3, 2]] } })
}

/// Seen from before it and above, with a lamp over the left shoulder.
fn on_floor(file: &str, height: f32, reach: f32, middle: [f32; 3]) -> Value {
    let [x, y, z] = middle;
    let camera = json!({ "from": [x + 0.12, y + 0.1, z + 0.3], "at": middle,
        "projection": { "perspective": { "degrees": 38.0 } } });
    let lamp = json!({ "color": [1.0, 1.0, 1.0],
        "kind": { "point": { "position": [x - 0.25, y + 0.5, z + 0.3] } } });
    json!({ "nestray_scene": 1, "cameras": [camera], "lights": [lamp],
        "geometries": [{ "name": "model", "file": file }, floor(height, reach, middle)] })
}

/// Meshes of the hall as one file, the name of which it returns: faces of each count from its own
/// first vertex.
fn sponza(shared: &Path, folder: &Path) -> Result<String, String> {
    /// What it is called.
    const NAME: &str = "sponza-meshes.obj";
    let archive = shared.join("large/sponza.tar.xz");
    let done = Command::new("tar").arg("xJf").arg(found(&archive)?).arg("-C").arg(folder).status();
    if !done.is_ok_and(|status| status.success()) {
        return Err(format!("{} cannot be unpacked", archive.display()));
    }
    let models = folder.join("sponza/models");
    let entries = models.read_dir().map_err(|error| format!("{}: {error}", models.display()))?;
    let mut paths: Vec<PathBuf> = entries.filter_map(|entry| Some(entry.ok()?.path())).collect();
    paths.retain(|path| path.extension().is_some_and(|extension| extension == "obj"));
    paths.sort();
    let (mut all, mut before) = (String::new(), 0);
    for path in paths {
        let text = fs::read_to_string(&path).map_err(|error| error.to_string())?;
        before += append(&mut all, &text, before);
    }
    fs::write(folder.join(NAME), all).map_err(|error| error.to_string())?;
    fs::remove_dir_all(folder.join("sponza")).map_err(|error| error.to_string())?;
    Ok(NAME.into())
}

/// Places and faces only, behind `before` other places; returns how many places there were.
fn append(all: &mut String, text: &str, before: usize) -> usize {
    let mut count = 0;
    for line in text.lines() {
        let mut words = line.split_whitespace();
        match words.next() {
            Some("v") => {
                all.push_str(line);
                count += 1;
            }
            Some("f") => {
                all.push('f');
                for corner in words {
                    let number = corner.split('/').next().and_then(|word| word.parse().ok());
                    let number: usize = number.unwrap_or(1);
                    all.push_str(&format!(" {}", number + before));
                }
            }
            _ => continue,
        }
        all.push('\n');
    }
    count
}

/// From the end of the hall, with a lamp in its middle.
fn inside(file: &str) -> Value {
    let camera = json!({ "from": [-118.0, 18.0, -4.0], "forward": [1.0, 0.12, 0.0],
        "up": [0.0, 1.0, 0.0], "projection": { "perspective": { "degrees": 62.0 } } });
    let lamp = json!({ "color": [1.0, 1.0, 1.0],
        "kind": { "point": { "position": [-20.0, 60.0, -4.0] } } });
    json!({ "nestray_scene": 1, "cameras": [camera], "lights": [lamp], "groups": [{ "file": file }] })
}

/// Halls at equal distances on hills, turned, seen from a corner above.
fn in_terrain(side: u32) -> Value {
    /// From one hall to the next, and cells of the hills between them.
    const APART: f32 = 450.0;
    const CELLS: u32 = 64;
    let hall = |i: u32| {
        let (x, z) = ((i % side) as f32 * APART, (i / side) as f32 * APART);
        let turn = json!({ "axis": [0.0, 1.0, 0.0], "degrees": 37.0 * i as f32 });
        let place = json!({ "rotate": turn, "translate": [x, hills(x, z), z] });
        json!({ "group": 1, "motion": { "still": place } })
    };
    let count = (side + 1) * CELLS;
    let vertex = |i: u32| {
        let along = |i: u32| (i as f32 / CELLS as f32 - 1.0) * APART;
        let (x, z) = (along(i % (count + 1)), along(i / (count + 1)));
        [x, hills(x, z) - 1.0, z]
    };
    let positions: Vec<[f32; 3]> = (0..(count + 1) * (count + 1)).map(vertex).collect();
    let cell = |i: u32| {
        let first = i / count * (count + 1) + i % count;
        let below = first + count + 1;
        [[first, below, first + 1], [first + 1, below, below + 1]]
    };
    let faces: Vec<[u32; 3]> = (0..count * count).flat_map(cell).collect();
    let camera = json!({ "from": [-0.6 * APART, 260.0, -0.6 * APART], "up": [0.0, 1.0, 0.0],
        "at": [APART, 0.0, APART], "projection": { "perspective": { "degrees": 50.0 } } });
    json!({ "nestray_scene": 1, "cameras": [camera],
        "geometries": [{ "name": "hills", "mesh": { "positions": positions, "faces": faces } }],
        "groups": [
            { "geometries": [0], "places": (0..side * side).map(hall).collect::<Vec<_>>() },
            { "file": "hall.json" }] })
}

/// Height of the hills: two waves of parabolas.
fn hills(x: f32, z: f32) -> f32 {
    let wave = |x: f32| {
        let part = x - x.floor();
        let up = 4.0 * (part % 0.5) * (0.5 - part % 0.5);
        if part < 0.5 { up } else { -up }
    };
    60.0 * wave(x / 900.0 + 0.2) + 45.0 * wave(z / 700.0) + 6.0 * wave(x / 90.0) * wave(z / 70.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn meshes_of_many_files_become_one() {
        let mut all = String::new();
        let text = "o a\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 1\ns off\nf 1//1 2//1 3//1\n";
        assert_eq!(append(&mut all, text, 0), 3);
        assert_eq!(append(&mut all, text, 3), 3);
        assert_eq!(all.matches("v ").count(), 6);
        assert!(all.ends_with("f 4 5 6\n") && all.contains("f 1 2 3\n"), "{all}");
    }

    #[test]
    fn hills_go_up_and_down_without_steps() {
        let mut last = hills(0.0, 10.0);
        let mut signs = [false; 2];
        for i in 1..2000 {
            let here = hills(i as f32, 10.0);
            assert!((here - last).abs() < 1.0);
            signs[usize::from(here > last)] = true;
            last = here;
        }
        assert_eq!(signs, [true; 2]);
    }
}
