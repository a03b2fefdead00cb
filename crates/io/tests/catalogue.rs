//! Real files, which have as many triangles and shapes as others found in them.

use std::collections::{BTreeMap, HashMap};
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Instant;

use nestray_io::load::{LoadOptions, Loaded, Source, load, read};
use nestray_io::nff::write::write_nff;
use nestray_scene::geometry::Content;
use nestray_scene::scene::Scene;
use nestray_shapes::shape::Shape;

/// The folder of real scenes, if it is there.
fn folder() -> Option<PathBuf> {
    let named = std::env::var_os("NESTRAY_SCENES").map(PathBuf::from);
    let usual = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/scenes");
    let folder = named.unwrap_or(usual);
    if folder.is_dir() {
        return Some(folder);
    }
    eprintln!("skipped: there is no folder {}", folder.display());
    None
}

fn loaded(path: &Path) -> Loaded {
    let start = Instant::now();
    let options = LoadOptions { complete: false, ..LoadOptions::default() };
    let loaded = load(path, &options).unwrap_or_else(|error| panic!("{error}"));
    eprintln!(
        "{:8.1} ms {:9} primitives {}",
        start.elapsed().as_secs_f64() * 1e3,
        loaded.scene.primitives(),
        path.display()
    );
    for warning in loaded.warnings.iter().take(2) {
        eprintln!("  {warning}");
    }
    loaded
}

/// Whether every edge has one face on each side, corners in the same place taken as one.
fn is_closed(scene: &Scene) -> bool {
    let mut places = HashMap::new();
    let mut edges: HashMap<(usize, usize), [u32; 2]> = HashMap::new();
    for geometry in &scene.geometries {
        let Content::Mesh(mesh) = &geometry.content else { return false };
        for face in mesh.faces() {
            let corners = face.map(|vertex| {
                let next = places.len();
                let bits = mesh.positions()[vertex as usize].map(f32::to_bits);
                *places.entry(bits).or_insert(next)
            });
            for i in 0..3 {
                let (a, b) = (corners[i], corners[(i + 1) % 3]);
                if a != b {
                    edges.entry((a.min(b), a.max(b))).or_default()[usize::from(a < b)] += 1;
                }
            }
        }
    }
    edges.values().all(|&sides| sides == [1, 1])
}

/// Vertices of all meshes.
fn vertices(scene: &Scene) -> usize {
    let of = |content: &Content| match content {
        Content::Mesh(mesh) => mesh.positions().len(),
        Content::Shapes(_) | Content::Solids(_) => 0,
    };
    scene.geometries.iter().map(|geometry| of(&geometry.content)).sum()
}

fn count_files(folder: &Path, extension: &str) -> Vec<PathBuf> {
    let mut found = Vec::new();
    let mut folders = vec![folder.to_owned()];
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(&folder).expect("a folder") {
            let path = entry.expect("an entry").path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|e| e == extension) {
                found.push(path);
            }
        }
    }
    found.sort();
    found
}

#[test]
fn meshes_have_their_triangles_and_are_closed_or_not() {
    let Some(folder) = folder() else { return };
    // Of STL the catalogue counts corners; those in the same place are one vertex here.
    let expected = [
        ("suzanne.obj", 507, 968, false),
        ("teapot.obj", 3644, 6320, false),
        ("cow.obj", 2903, 5804, true),
        ("spot.obj", 3225, 5856, true),
        ("fandisk.obj", 6475, 12_946, true),
        ("homer.obj", 6002, 12_000, true),
        ("stanford-bunny.ply", 35_947, 69_451, false),
        ("low_poly_bunny.obj", 350, 696, true),
        ("CornellBox-Original-Merged.obj", 64, 32, false),
        ("cornell_box.obj", 72, 36, false),
        ("gears.stl", 9723, 19_426, true),
        ("teapot.stl", 480, 894, false),
        ("cow.off", 2762, 5520, false),
    ];
    for (name, vertices, triangles, closed) in expected {
        let scene = loaded(&folder.join("meshes").join(name)).scene;
        assert_eq!(scene.primitives(), triangles, "{name}");
        assert_eq!(is_closed(&scene), closed, "{name}");
        assert_eq!(self::vertices(&scene), vertices, "{name}");
        assert!(scene.bounds().is_bounded() && !scene.bounds().is_empty(), "{name}");
    }
}

#[test]
fn dragons_of_text_are_unpacked() {
    let Some(folder) = folder() else { return };
    let expected = [
        ("_res4", 5205, 11_102),
        ("_res3", 22_998, 47_794),
        ("_res2", 100_250, 202_520),
        ("", 437_645, 871_414),
    ];
    for (name, vertices, triangles) in expected {
        let scene = loaded(&folder.join(format!("large/dragon_vrip{name}.ply.gz"))).scene;
        assert_eq!(scene.primitives(), triangles, "{name}");
        let Content::Mesh(mesh) = &scene.geometries[0].content else { panic!("it is a mesh") };
        assert_eq!(mesh.positions().len(), vertices, "{name}");
    }
}

/// How many primitives of each kind there are, and how many fills, lights and views.
fn census(scene: &Scene) -> BTreeMap<&str, usize> {
    let mut counts = BTreeMap::new();
    for geometry in &scene.geometries {
        let Content::Shapes(shapes) = &geometry.content else { panic!("it holds shapes") };
        for shape in shapes.iter() {
            *counts.entry(shape.kind()).or_default() += 1;
        }
    }
    counts.insert("f", scene.materials.len());
    counts.insert("l", scene.lights.len());
    counts.insert("v", scene.cameras.len());
    counts
}

#[test]
fn standard_scenes_have_their_primitives() {
    let Some(folder) = folder() else { return };
    // Fills, lights, spheres, cones and cylinders, polygons, patches.
    let expected: [(&str, [usize; 6]); 17] = [
        ("balls", [2, 3, 7381, 0, 1, 0]),
        ("balls-2", [2, 3, 91, 0, 1, 0]),
        ("balls-5", [2, 3, 66_430, 0, 1, 0]),
        ("gears", [65, 5, 0, 0, 9345, 0]),
        ("gears-2", [9, 5, 0, 0, 1169, 0]),
        ("mount", [2, 1, 4, 0, 8192, 0]),
        ("rings", [841, 3, 4200, 4200, 1, 0]),
        ("rings-3", [85, 3, 420, 420, 1, 0]),
        ("teapot", [3, 2, 0, 0, 36, 2256]),
        ("tetra", [1, 1, 0, 0, 4096, 0]),
        ("tetra-3", [1, 1, 0, 0, 64, 0]),
        ("tree", [2, 7, 4095, 4095, 1, 0]),
        ("tree-6", [2, 7, 127, 127, 1, 0]),
        ("jacks", [1, 1, 438, 219, 0, 0]),
        ("lattice-6", [1225, 6, 343, 882, 0, 0]),
        ("shells", [1, 1, 5761, 0, 0, 0]),
        ("sombrero", [1, 1, 0, 0, 1922, 0]),
    ];
    for (name, [fills, lights, spheres, cones, polygons, patches]) in expected {
        let Loaded { scene, warnings } = loaded(&folder.join(format!("nff/{name}.nff")));
        let counts = census(&scene);
        let of = |kind: &str| counts.get(kind).copied().unwrap_or(0);
        assert_eq!((of("v"), of("f"), of("l")), (1, fills, lights), "{name}");
        assert_eq!(of("sphere"), spheres, "{name}");
        assert_eq!(of("cone") + of("cylinder"), cones, "{name}");
        assert_eq!((of("polygon"), of("patch")), (polygons, patches), "{name}");
        assert!(warnings.is_empty(), "{name}: {warnings:?}");
    }
}

/// The words of a file, fills without their index of refraction, of which files say 0 and we
/// say 1 for what is opaque.
fn words(text: &str) -> Vec<String> {
    let mut all = Vec::new();
    for line in text.lines() {
        let count = if line.starts_with("f ") { 8 } else { usize::MAX };
        all.extend(line.split_whitespace().take(count).map(String::from));
    }
    all
}

#[test]
fn standard_scenes_are_written_as_they_were() {
    let Some(folder) = folder() else { return };
    for path in count_files(&folder.join("nff"), "nff") {
        let text = std::fs::read_to_string(&path).expect("it is text");
        let mut out = Vec::new();
        write_nff(&loaded(&path).scene, &mut out).expect("it can be held");
        let out = String::from_utf8(out).expect("it is text");
        let (ours, theirs) = (words(&out), words(&text));
        // Normals were made unit ones, which may change their last digit.
        let near = |a: &str, b: &str| match (a.parse::<f32>(), b.parse::<f32>()) {
            (Ok(a), Ok(b)) => (a - b).abs() <= 1.5e-6,
            _ => false,
        };
        let first = ours.iter().zip(&theirs).position(|(a, b)| a != b && !near(a, b));
        assert_eq!((ours.len(), first), (theirs.len(), None), "{}", path.display());
    }
}

#[test]
fn meshes_of_other_programs_scenes_are_read() {
    let Some(folder) = folder() else { return };
    let mut counts = Vec::new();
    for (part, extension) in [
        ("interiors/living-room", "ply"),
        ("interiors/staircase2", "ply"),
        ("mitsuba/cbox", "obj"),
        ("pbrt/veach-mis", "ply"),
    ] {
        let files = count_files(&folder.join(part), extension);
        let (mut triangles, mut points) = (0, 0);
        for path in &files {
            let scene = loaded(path).scene;
            (triangles, points) = (triangles + scene.primitives(), points + vertices(&scene));
        }
        counts.push((part, files.len(), points, triangles));
    }
    eprintln!("{counts:?}");
    assert_eq!(counts[0], ("interiors/living-room", 65, 119_519, 143_163));
    assert_eq!(counts[1], ("interiors/staircase2", 19, 21_250, 30_911));
    // 31 faces, some of four corners; of 78 vertices eight are in no face, and some others are
    // several, with a normal each.
    assert_eq!(counts[2], ("mitsuba/cbox", 8, 76, 38));
    assert_eq!(counts[3], ("pbrt/veach-mis", 5, 24, 12));
}

#[test]
fn the_hundreds_of_files_of_sponza_are_read() {
    let Some(folder) = folder() else { return };
    let unpacked = tempfile::tempdir().expect("a folder");
    let done = Command::new("tar")
        .arg("xJf")
        .arg(folder.join("large/sponza.tar.xz"))
        .arg("-C")
        .arg(unpacked.path())
        .status();
    if !done.is_ok_and(|status| status.success()) {
        eprintln!("skipped: there is no `tar` that can unpack it");
        return;
    }
    let files = count_files(unpacked.path(), "obj");
    let start = Instant::now();
    let (mut triangles, mut polygons) = (0, 0);
    for path in &files {
        let options = LoadOptions { complete: false, ..LoadOptions::default() };
        let bytes = std::fs::read(path).expect("it can be read");
        let source = Source { path: path.clone(), options };
        let scene = read(&bytes, &source).unwrap_or_else(|error| panic!("{error}")).scene;
        triangles += scene.primitives();
        let text = String::from_utf8_lossy(&bytes);
        let corners = |line: &str| line.split_whitespace().count() as u64 - 1;
        let faces = text.lines().filter(|line| line.starts_with("f "));
        polygons += faces.map(|line| corners(line) - 2).sum::<u64>();
    }
    eprintln!("{} files, {triangles} triangles in {:?}", files.len(), start.elapsed());
    assert_eq!((files.len(), triangles), (384, 263_167));
    assert_eq!(triangles, polygons);
}
