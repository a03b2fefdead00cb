//! Draws every shared scene, and puts the pictures on the contact sheets of the documentation.
//!
//! `nestray-sheet SCENES OUTPUT [NAME…]`: the folder of shared scenes, the folder for the
//! sheets, and which sheets, if not all.

mod draw;
mod letters;
mod sheet;

use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};

use nestray::prelude::*;

use self::draw::{Manner, draw, read, smaller, together};
use self::sheet::{Cell, Layout};

/// Samples of pictures in which all light is followed.
const SAMPLES: u32 = 128;
/// Pictures that are to be looked at, and those of single parts of larger scenes.
const LARGE: Layout = Layout { columns: 5, size: [256, 192] };
const SMALL: Layout = Layout { columns: 20, size: [72, 54] };
const SQUARE: Layout = Layout { columns: 8, size: [168, 168] };

/// A sheet: its name, and what draws it.
type Sheet = (&'static str, Layout, fn(&Path, &Layout) -> Result<Vec<Cell>, String>);

const SHEETS: &[Sheet] = &[
    ("nff", SQUARE, standard_scenes),
    ("meshes", LARGE, meshes),
    ("gltf", LARGE, gltf),
    ("rooms", LARGE, rooms),
    ("parts", SMALL, parts),
    ("sponza", SMALL, sponza),
];

fn main() -> ExitCode {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let [scenes, output, names @ ..] = args.as_slice() else {
        let names: Vec<&str> = SHEETS.iter().map(|(name, ..)| *name).collect();
        eprintln!("nestray-sheet SCENES OUTPUT [NAME...], each of these: {}", names.join(", "));
        return ExitCode::from(2);
    };
    let wanted = |name: &str| names.is_empty() || names.iter().any(|wanted| wanted == name);
    for (name, layout, cells) in SHEETS.iter().filter(|(name, ..)| wanted(name)) {
        let path = Path::new(output).join(format!("sheet-{name}.png"));
        let done = cells(Path::new(scenes), layout).and_then(|cells| layout.save(&cells, &path));
        if let Err(error) = done {
            eprintln!("{error}");
            return ExitCode::FAILURE;
        }
        eprintln!("{}", path.display());
    }
    ExitCode::SUCCESS
}

/// The files below a folder with one of these endings, in order of their paths.
fn files(folder: &Path, endings: &[&str]) -> Result<Vec<PathBuf>, String> {
    let (mut found, mut open) = (Vec::new(), vec![folder.to_owned()]);
    while let Some(folder) = open.pop() {
        let fail = |error: std::io::Error| format!("{}: {error}", folder.display());
        for entry in std::fs::read_dir(&folder).map_err(fail)? {
            let path = entry.map_err(fail)?.path();
            let name = path.to_string_lossy().into_owned();
            if path.is_dir() {
                open.push(path);
            } else if endings.iter().any(|ending| name.ends_with(ending)) {
                found.push(path);
            }
        }
    }
    found.sort();
    Ok(found)
}

/// Draws a file; its name is the label.
fn cell(path: &Path, manner: Manner, layout: &Layout) -> Result<Cell, String> {
    let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
    Ok(Cell { name, bytes: draw(&read(path)?, manner, layout.size) })
}

/// Each scene, and where there is one the published picture of it on its right.
fn standard_scenes(scenes: &Path, layout: &Layout) -> Result<Vec<Cell>, String> {
    let mut cells = Vec::new();
    for path in files(&scenes.join("nff"), &[".nff"])? {
        cells.push(cell(&path, Manner::Standard, layout)?);
        let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        let published = scenes.join("nff/reference").join(format!("{name}.png"));
        if published.is_file() {
            let fail = |error: image::ImageError| format!("{}: {error}", published.display());
            let picture = image::open(&published).map_err(fail)?.into_rgb8();
            let bytes = smaller(&picture, layout.size);
            cells.push(Cell { name: format!("{name}, published"), bytes });
        }
    }
    Ok(cells)
}

fn meshes(scenes: &Path, layout: &Layout) -> Result<Vec<Cell>, String> {
    let mut all = files(&scenes.join("meshes"), &[".obj", ".ply", ".stl", ".off"])?;
    all.extend(files(&scenes.join("large"), &[".ply.gz"])?);
    all.iter().map(|path| cell(path, Manner::Path(SAMPLES), layout)).collect()
}

fn gltf(scenes: &Path, layout: &Layout) -> Result<Vec<Cell>, String> {
    let all = files(&scenes.join("gltf"), &[".gltf", ".glb"])?;
    all.iter().map(|path| cell(path, Manner::Path(SAMPLES), layout)).collect()
}

/// The single meshes of scenes whose own files are not read.
fn parts(scenes: &Path, layout: &Layout) -> Result<Vec<Cell>, String> {
    let mut all = files(&scenes.join("mitsuba"), &[".obj", ".ply"])?;
    all.extend(files(&scenes.join("interiors"), &[".obj", ".ply"])?);
    all.iter().map(|path| cell(path, Manner::Plain(9), layout)).collect()
}

/// A folder of `large/sponza.tar.xz`, unpacked.
fn unpacked(scenes: &Path) -> Result<tempfile::TempDir, String> {
    let folder = tempfile::tempdir().map_err(|error| error.to_string())?;
    let archive = scenes.join("large/sponza.tar.xz");
    let done = Command::new("tar").arg("xJf").arg(archive).arg("-C").arg(folder.path()).status();
    match done {
        Ok(status) if status.success() => Ok(folder),
        Ok(status) => Err(format!("tar: {status}")),
        Err(error) => Err(format!("tar: {error}")),
    }
}

fn sponza(scenes: &Path, layout: &Layout) -> Result<Vec<Cell>, String> {
    let folder = unpacked(scenes)?;
    let all = files(folder.path(), &[".obj"])?;
    all.iter().map(|path| cell(path, Manner::Plain(9), layout)).collect()
}

/// All meshes of each scene together, from where its own file has the camera, or, of Sponza,
/// from the end of the hall.
fn rooms(scenes: &Path, layout: &Layout) -> Result<Vec<Cell>, String> {
    let folder = unpacked(scenes)?;
    let camera = |from: [f32; 3], forward: [f32; 3], degrees: f32| {
        let (from, forward) = (Vec3A::from_array(from), Vec3A::from_array(forward));
        Camera::looking(from, from + forward, Vec3A::Y, degrees)
    };
    let all = [
        (
            "cbox",
            scenes.join("mitsuba/cbox"),
            camera([278.0, 273.0, -800.0], [0.0, 0.0, 1.0], 39.3),
        ),
        (
            "living-room",
            scenes.join("interiors/living-room"),
            camera([5.105, 0.731, -2.318], [-0.962, 0.074, 0.263], 66.0),
        ),
        (
            "staircase2",
            scenes.join("interiors/staircase2"),
            camera([6.912, 1.652, 2.554], [-0.9, 0.0, -0.436], 60.0),
        ),
        ("sponza", folder.path().to_owned(), camera([-118.0, 18.0, -4.0], [1.0, 0.12, 0.0], 62.0)),
    ];
    let draw = |(name, folder, camera): (&str, PathBuf, Camera)| {
        let scene = together(&files(&folder, &[".obj", ".ply"])?, camera)?;
        Ok(Cell { name: name.into(), bytes: draw(&scene, Manner::Open(SAMPLES), layout.size) })
    };
    all.into_iter().map(draw).collect()
}
