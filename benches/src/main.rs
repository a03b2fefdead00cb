//! `cargo xtask bench`: lets the program shoot rays at ten scenes in turn with other libraries, and
//! writes `docs/performance.md`.
//!
//! `nestray-benches [--scenes FOLDER] [--results FOLDER] [--docs FOLDER] [--only NAME,…]
//! [--growth] [--pictures] [--search] [--keep] [-- OPTIONS…]`: the folder of shared scenes, where
//! measurements are put and where the page; only some scenes; how things grow with the size of a scene,
//! too, and what batches bring to pictures; or instead what searches for plans find, for
//! `docs/searches.md`; measurements that are there already are kept; what `nestray bench` is told
//! besides, as `--rounds 9`. Without `--docs` no page is written, only measurements.

mod growth;
mod machine;
mod page;
mod pictures;
mod plot;
mod reach;
mod results;
mod scenes;
mod search;

use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};
use std::{env, fs};

use self::results::Results;
use self::scenes::Scene;

/// What the command line asks for.
struct Args {
    scenes: PathBuf,
    results: PathBuf,
    docs: Option<PathBuf>,
    only: Vec<String>,
    growth: bool,
    pictures: bool,
    search: bool,
    keep: bool,
    /// For `nestray bench`.
    options: Vec<String>,
}

fn main() -> ExitCode {
    match args().and_then(|args| run(&args)) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("{error}");
            ExitCode::FAILURE
        }
    }
}

fn args() -> Result<Args, String> {
    let mut args = Args {
        scenes: env::var_os("NESTRAY_SCENES").map_or("../shared/scenes".into(), PathBuf::from),
        results: beside().join("bench"),
        docs: None,
        only: Vec::new(),
        growth: false,
        pictures: false,
        search: false,
        keep: false,
        options: Vec::new(),
    };
    let mut words = env::args().skip(1);
    while let Some(word) = words.next() {
        let mut next = || words.next().ok_or(format!("{word} what?"));
        match word.as_str() {
            "--scenes" => args.scenes = next()?.into(),
            "--results" => args.results = next()?.into(),
            "--docs" => args.docs = Some(next()?.into()),
            "--only" => args.only = next()?.split(',').map(Into::into).collect(),
            "--growth" => args.growth = true,
            "--pictures" => args.pictures = true,
            "--search" => args.search = true,
            "--keep" => args.keep = true,
            "--" => args.options = words.by_ref().collect(),
            _ => return Err(format!("{word} is no option: see the head of benches/src/main.rs")),
        }
    }
    Ok(args)
}

/// The folder of builds, in which this program is.
fn beside() -> PathBuf {
    let own = env::current_exe().unwrap_or_default();
    own.parent().and_then(Path::parent).map_or_else(|| "target".into(), Path::to_owned)
}

fn program() -> PathBuf {
    beside().join("release/nestray").with_extension(env::consts::EXE_EXTENSION)
}

fn run(args: &Args) -> Result<(), String> {
    fs::create_dir_all(&args.results).map_err(|error| error.to_string())?;
    if args.search {
        let folders = (&*args.scenes, &*args.results);
        let asked = |name: &str| asked(args, name);
        return search::run(&program(), folders, args.docs.as_deref(), &asked, args.keep);
    }
    let (mut all, mut rendered) = (Vec::new(), Vec::new());
    for scene in scenes::ALL.iter().filter(|scene| asked(args, scene.name)) {
        match scene.prepare(&args.scenes, &args.results.join("scenes")) {
            Ok(named) => {
                all.push(measure(args, scene, &named)?);
                if args.pictures && pictures::SCENES.contains(&scene.name) {
                    let of = (scene.name, &*named);
                    rendered.extend(pictures::measure(&program(), of, &args.results, args.keep)?);
                }
            }
            Err(missing) => eprintln!("{} is left out: {missing}", scene.name),
        }
    }
    let mut grown = Vec::new();
    if args.growth {
        for scene in growth::ALL {
            match scene.prepare(&args.scenes, &args.results.join("scenes")) {
                Ok(named) => grown.push(measure(args, scene, &named)?),
                Err(missing) => eprintln!("{} is left out: {missing}", scene.name),
            }
        }
    }
    if let Some(docs) = &args.docs {
        let picture = growth::plot(&grown);
        let page = page::page(&all, &rendered, &grown, &args.options);
        let write = |name: &str, text: &str| {
            let path = docs.join(name);
            fs::write(&path, text).map_err(|error| format!("{}: {error}", path.display()))
        };
        if !grown.is_empty() {
            write("pictures/growth.svg", &picture)?;
        }
        write("performance.md", &page)?;
    }
    Ok(())
}

fn asked(args: &Args, name: &str) -> bool {
    args.only.is_empty() || args.only.iter().any(|only| only == name)
}

/// Lets the program bench a scene.
fn measure(args: &Args, scene: &Scene, named: &str) -> Result<Results, String> {
    eprintln!("\n> {}", scene.name);
    let output = args.results.join(format!("{}.json", scene.name));
    if args.keep && output.is_file() {
        return Results::read(scene.name, &output);
    }
    let mut command = Command::new(program());
    command.args(["bench", named, "--plans", scene.plans, "--vs", scene.peers, "--quiet", "-o"]);
    command.arg(&output);
    let done = command.args(&args.options).status();
    match done {
        Ok(status) if status.success() => {
            Results::sign(&output, &machine::commit())?;
            Results::read(scene.name, &output)
        }
        Ok(status) => Err(format!("{}: {status}", scene.name)),
        Err(error) => Err(format!("nestray cannot be started: {error}")),
    }
}
