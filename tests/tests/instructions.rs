//! Instructions per ray, counted by valgrind and held against what was recorded: clocks of shared
//! machines tell nothing of a few in a hundred, counts are the same each time.
//!
//! `NESTRAY_RECORD=1` writes `instructions.txt` anew. Skipped where there is no valgrind, no AVX2,
//! or another compiler than the one that was recorded with.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::{env, fs, thread};

use nestray_core::hit::Hit;
use nestray_core::object::{DynObject, Object};
use nestray_core::ray::{Ray, RayKind};
use nestray_core::scratch::Scratch;
use nestray_core::simd::Level;
use nestray_plan::build::build;
use nestray_plan::single::single;
use nestray_scene::procedural::generate;
use nestray_scene::scene::Scene;
use nestray_tests::numbers::Numbers;

/// More than this many times what is recorded is a failure; less than one over it asks for a new
/// record.
const MOST: f64 = 1.03;
/// Pixels across and down: few enough for a program that is watched at each step.
const SIZE: u32 = 48;
/// Says which case to run, when this program is watched.
const CASE: &str = "NESTRAY_CASE";

/// A technique over a scene, with its size factor, and how it is asked.
#[derive(Clone, Copy)]
struct Case {
    technique: &'static str,
    scene: (&'static str, u32),
    query: &'static str,
}

const QUERIES: [&str; 7] = [
    "closest, single",
    "closest, neighbours",
    "closest, scattered",
    "any, single",
    "any, neighbours",
    "any, scattered",
    "all, single",
];

/// Triangles with vertices in common, without, and instances; shapes of other kinds.
const SCENES: [(&str, u32); 4] =
    [("terrain", 64), ("scatter", 3000), ("stadium", 100), ("balls", 2)];

/// Techniques that are asked the first and the third query.
const OTHERS: [&str; 8] =
    ["sbvh", "kd-tree", "octree", "grid", "macro-regions", "slabs", "rubin-whitted", "bsp"];

fn cases() -> Vec<Case> {
    let of = |technique, scene, queries: &[&'static str]| -> Vec<Case> {
        queries.iter().map(|query| Case { technique, scene, query }).collect()
    };
    let mut cases: Vec<Case> =
        SCENES.into_iter().flat_map(|scene| of("bvh", scene, &QUERIES)).collect();
    let few = [QUERIES[0], QUERIES[2]];
    cases.extend(OTHERS.into_iter().flat_map(|technique| of(technique, SCENES[0], &few)));
    cases
}

impl Case {
    fn name(&self) -> String {
        let (scene, size) = self.scene;
        format!("{} over {scene}@{size}: {}", self.technique, self.query)
    }
}

/// Through neighbouring pixels in tiles, or across the scene from anywhere.
fn rays(scene: &Scene, scattered: bool) -> Vec<Ray> {
    if scattered {
        let (bounds, mut numbers) = (scene.bounds(), Numbers::new(1));
        let mut point = || bounds.min + bounds.size() * numbers.point();
        let mut ray = |_| {
            let from = point();
            Ray::new(from, point() - from, RayKind::Diffuse)
        };
        return (0..SIZE * SIZE).map(&mut ray).collect();
    }
    let view = scene.cameras[0].view(1.0);
    let pixel = |i: u32| {
        let (tile, within) = (i / 64, i % 64);
        let [x, y] = [tile % (SIZE / 8) * 8 + within % 8, tile / (SIZE / 8) * 8 + within / 8];
        let (from, dir) = view.through([x, y], [SIZE, SIZE]);
        Ray::new(from, dir, RayKind::Camera)
    };
    (0..SIZE * SIZE).map(pixel).collect()
}

/// What valgrind counts: nothing but this and what it calls.
#[inline(never)]
fn what_is_counted(world: &DynObject, rays: &[Ray], query: &str, scratch: &mut Scratch) -> usize {
    let mut hits: Vec<Hit> = rays.iter().map(|ray| Hit::none(ray.t_max())).collect();
    let mut blocked = vec![false; rays.len()];
    match query {
        "closest, single" => rays.iter().zip(&mut hits).for_each(|(ray, hit)| {
            world.closest_hit(ray, hit, scratch);
        }),
        "any, single" => rays.iter().zip(&mut blocked).for_each(|(ray, blocked)| {
            *blocked = world.any_hit(ray, scratch);
        }),
        "all, single" => {
            let mut all = Vec::new();
            rays.iter().for_each(|ray| world.all_hits(ray, &mut all, scratch));
            return all.len();
        }
        query if query.starts_with("closest") => world.closest_hits(rays, &mut hits, scratch),
        _ => world.any_hits(rays, &mut blocked, scratch),
    }
    hits.iter().filter(|hit| hit.is_some()).count() + blocked.iter().filter(|is| **is).count()
}

#[cfg(target_arch = "x86_64")]
fn level() -> Option<Level> {
    Level::available().into_iter().find(|level| matches!(level, Level::Avx2(_)))
}

#[cfg(not(target_arch = "x86_64"))]
fn level() -> Option<Level> {
    None
}

/// Runs one case, if asked for; of use under valgrind only.
#[test]
fn one_case() {
    let Ok(name) = env::var(CASE) else { return };
    let case = cases().into_iter().find(|case| case.name() == name).expect("it is one of them");
    let scene = generate(case.scene.0, Some(case.scene.1)).expect("it is a scene of ours");
    let plan = single(case.technique, serde_json::Map::new(), &scene).expect("it is registered");
    let world = build(&plan, &scene).expect("it fits");
    let rays = rays(&scene, !case.query.ends_with("neighbours"));
    let mut scratch = Scratch::with_level(level().expect("asked before"));
    let hits = what_is_counted(&world, &rays, case.query, &mut scratch);
    assert!(hits > rays.len() / 50, "{hits} hits of {} rays", rays.len());
}

/// Instructions per ray of a case.
fn counted(case: &Case) -> f64 {
    let own = env::current_exe().expect("it has a name");
    let out = Command::new("valgrind")
        .args(["--tool=callgrind", "--callgrind-out-file=/dev/null"])
        .arg("--toggle-collect=*what_is_counted*")
        .arg(own)
        .args(["--exact", "one_case", "--test-threads", "1"])
        .env(CASE, case.name())
        .env("RAYON_NUM_THREADS", "1")
        .output()
        .expect("valgrind is there");
    let said = String::from_utf8_lossy(&out.stderr);
    assert!(out.status.success(), "{}: {said}", case.name());
    let collected = said.lines().find_map(|line| line.split("Collected :").nth(1));
    let count: f64 = collected.and_then(|count| count.trim().parse().ok()).unwrap_or(0.0);
    assert!(count > 0.0, "{}: nothing was counted: {said}", case.name());
    count / f64::from(SIZE * SIZE)
}

/// All cases, on two threads.
fn counted_all(cases: &[Case]) -> BTreeMap<String, f64> {
    let next = AtomicUsize::new(0);
    let work = || {
        let mut counts = Vec::new();
        while let Some(case) = cases.get(next.fetch_add(1, Ordering::Relaxed)) {
            counts.push((case.name(), counted(case)));
        }
        counts
    };
    thread::scope(|scope| {
        let both = [scope.spawn(work), scope.spawn(work)];
        both.into_iter().flat_map(|one| one.join().expect("it counts")).collect()
    })
}

fn compiler() -> String {
    let rustc = env::var_os("RUSTC").unwrap_or_else(|| "rustc".into());
    let said = Command::new(rustc).arg("--version").output();
    said.map_or_else(|_| "none".into(), |out| String::from_utf8_lossy(&out.stdout).trim().into())
}

fn record() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/instructions.txt")
}

/// Why nothing can be counted here, if so.
fn hindrance(recorded_with: &str, compiler: &str) -> Option<String> {
    let watches = Command::new("valgrind").arg("--version").output();
    if !watches.is_ok_and(|out| out.status.success()) {
        return Some("there is no valgrind".into());
    }
    if level().is_none() {
        return Some("this machine has no AVX2".into());
    }
    if cfg!(debug_assertions) {
        return Some("this build checks what releases do not".into());
    }
    let differs = recorded_with != compiler && env::var_os("NESTRAY_RECORD").is_none();
    differs.then(|| format!("recorded with {recorded_with}, this is {compiler}"))
}

#[test]
fn no_loop_takes_more_instructions_than_it_did() {
    let text = fs::read_to_string(record()).unwrap_or_default();
    let (recorded_with, lines) = text.split_once('\n').unwrap_or(("nothing", ""));
    let compiler = compiler();
    if let Some(why) = hindrance(recorded_with, &compiler) {
        eprintln!("skipped: {why}");
        return;
    }
    let counts = counted_all(&cases());
    if env::var_os("NESTRAY_RECORD").is_some() {
        let mut text = format!("{compiler}\n");
        counts.iter().for_each(|(name, count)| {
            let _ = writeln!(text, "{count:9.1}  {name}");
        });
        fs::write(record(), text).expect("it can be written");
        return;
    }
    let before: BTreeMap<&str, f64> = lines
        .lines()
        .filter_map(|line| line.trim().split_once("  "))
        .filter_map(|(count, name)| Some((name, count.parse().ok()?)))
        .collect();
    let mut wrong = String::new();
    for (name, count) in &counts {
        let was = before.get(name.as_str()).copied().unwrap_or(0.0);
        if *count > was * MOST {
            let _ = writeln!(wrong, "{name}: {count:.1}, was {was:.1}");
        } else if count * MOST < was {
            eprintln!("{name}: {count:.1}, was {was:.1}: NESTRAY_RECORD=1 keeps it so");
        }
    }
    assert!(wrong.is_empty(), "more instructions per ray than recorded:\n{wrong}");
}
