//! Scenes and plans, from wherever the command line says.

use std::io::Read as _;
use std::path::{Path, PathBuf};

use nestray::io::load::{LoadOptions, Loaded, Source, bytes_of, load, read};
use nestray::plan::error::{PlanError, nearest};
use nestray::plan::plan::Plan;
use nestray::plan::presets;
use nestray::plan::single::single;
use nestray::scene::procedural;
use nestray::scene::scene::Scene;

use crate::errors::Failure;
use crate::progress::Progress;

/// Most bytes of a plan.
const PLAN_BYTES: u64 = 1 << 28;

/// A scene; says what was odd about it.
pub(crate) fn scene(
    name: &str,
    options: &LoadOptions,
    progress: &Progress,
) -> Result<Scene, Failure> {
    /// More warnings than anybody reads.
    const MOST: usize = 20;
    let loaded = loaded(name, options)?;
    for warning in loaded.warnings.iter().take(MOST) {
        progress.note(&format!("warning: {warning}"));
    }
    if let Some(more) = loaded.warnings.len().checked_sub(MOST + 1) {
        progress.note(&format!("warning: and {} more", more + 1));
    }
    Ok(loaded.scene)
}

fn loaded(name: &str, options: &LoadOptions) -> Result<Loaded, Failure> {
    if let Some(name) = name.strip_prefix("builtin:") {
        let (name, size) = match name.split_once('@') {
            Some((name, size)) => {
                let wrong = |_| Failure::usage(format!("builtin:{name}: size {size:?} is none"));
                (name, Some(size.parse().map_err(wrong)?))
            }
            None => (name, None),
        };
        return Ok(Loaded { scene: builtin(name, size)?, warnings: Vec::new() });
    }
    if name == "-" {
        let source = Source { path: "-".into(), options: *options };
        let mut bytes = Vec::new();
        let input = std::io::stdin().take(options.max_bytes.saturating_add(1));
        std::io::BufReader::new(input)
            .read_to_end(&mut bytes)
            .map_err(|error| source.spot().error(error.to_string()))?;
        if bytes.len() as u64 > options.max_bytes {
            let message = format!("has more than {} bytes", options.max_bytes);
            return Err(source.spot().error(message).into());
        }
        return Ok(read(&bytes, &source)?);
    }
    Ok(load(Path::new(name), options)?)
}

/// A scene made by program.
pub(crate) fn builtin(name: &str, size: Option<u32>) -> Result<Scene, Failure> {
    procedural::generate(name, size)
        .map_err(|error| Failure::usage(error).hint("nestray inspect --list scenes"))
}

/// What `--plan` asks for.
#[derive(Debug)]
pub(crate) enum Choice {
    /// One technique or preset over everything, or `auto`.
    Technique(String),
    /// A plan and its file.
    File(Box<Plan>, PathBuf),
}

/// Reads what `--plan` says; a word that is no file is a technique or a preset.
pub(crate) fn choose(text: &str) -> Result<Choice, Failure> {
    if text == "auto" || presets::names().any(|name| name == text) {
        return Ok(Choice::Technique(text.into()));
    }
    let path = Path::new(text);
    let is_file = path.exists() || path.extension().is_some() || text.contains(['/', '\\']);
    if !is_file {
        let near = nearest(text, presets::names().chain(["auto"]));
        let failure = Failure::usage(format!("--plan: no technique, preset or file {text:?}"));
        return Err(match near {
            Some(near) => failure.hint(format!("did you mean \"{near}\"?")),
            None => failure.hint("nestray inspect --list techniques, or --list presets"),
        });
    }
    let plan = read_plan(path)?;
    Ok(Choice::File(Box::new(plan), path.into()))
}

/// A plan file.
pub(crate) fn read_plan(path: &Path) -> Result<Plan, Failure> {
    let options = LoadOptions { max_bytes: PLAN_BYTES, ..LoadOptions::default() };
    let text = String::from_utf8(bytes_of(path, &options)?);
    let text = text.map_err(|error| {
        let at = error.utf8_error().valid_up_to();
        let message = format!("{}: is no text: byte {at} is not UTF-8", path.display());
        Failure::new(Failure::UNREADABLE, message)
    })?;
    Plan::from_json(&text).map_err(|error| plan_failure(&error, Some(path)))
}

/// What is wrong with a plan, and with which.
pub(crate) fn plan_failure(error: &PlanError, path: Option<&Path>) -> Failure {
    match (error, path) {
        (PlanError::Syntax { .. }, Some(path)) => {
            Failure::new(Failure::UNREADABLE, format!("{}:{error}", path.display()))
        }
        (PlanError::At { .. }, Some(path)) => {
            Failure::new(Failure::UNREADABLE, format!("{}: {error}", path.display()))
        }
        (PlanError::Scene(_), _) => Failure::new(Failure::UNREADABLE, error),
        (_, None) => Failure::usage(format!("--plan: {error}")),
    }
}

impl Choice {
    /// Whether it is left to the program.
    pub(crate) fn is_auto(&self) -> bool {
        matches!(self, Self::Technique(name) if name == "auto")
    }

    /// The plan for a scene.
    pub(crate) fn plan(&self, scene: &Scene) -> Result<Plan, Failure> {
        match self {
            Self::Technique(name) => {
                single(name, Default::default(), scene).map_err(|e| self.failure(&e))
            }
            Self::File(plan, _) => Ok((**plan).clone()),
        }
    }

    /// What is wrong with it.
    pub(crate) fn failure(&self, error: &PlanError) -> Failure {
        match self {
            Self::Technique(_) => plan_failure(error, None),
            Self::File(_, path) => plan_failure(error, Some(path)),
        }
    }
}

/// As many threads as asked for; 0 is all.
pub(crate) fn pool(threads: usize) -> Result<rayon::ThreadPool, Failure> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
    pool.map_err(|error| Failure::new(Failure::FAILED, format!("--threads: {error}")))
}
