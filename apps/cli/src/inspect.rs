//! `nestray inspect`.

mod diff;
mod explain;
mod list;
pub(crate) mod pilot;
mod plan;
mod ray;
mod scene;

use std::path::Path;

use nestray::io::load::{LoadOptions, bytes_of};
use nestray::io::native;

use crate::args::{InspectArgs, Talk};
use crate::cache::Cache;
use crate::errors::Failure;
use crate::progress::Progress;
use crate::{input, output};

pub(crate) fn run(args: &InspectArgs, talk: &Talk) -> Result<(), Failure> {
    if let Some([first, second]) = args.diff.as_deref() {
        return said(&diff::report(first, second)?, args);
    }
    let report = match (&args.list, &args.scene) {
        (Some(list), _) => list::report(*list),
        (None, Some(name)) if is_plan(name) => plan::report(Path::new(name), args)?,
        (None, Some(name)) => {
            let choice = input::choose(args.plan.as_deref().unwrap_or("auto"))?;
            let progress = Progress::new(talk);
            let scene = input::scene(name, &LoadOptions::default(), &progress)?;
            match &args.explain {
                Some(path) => {
                    explain::report(&scene, &choice, path, &Cache::open(true, progress).prices())?
                }
                None => scene::report(&scene, &choice, args)?,
            }
        }
        (None, None) => return Err(Failure::usage("a scene, a plan or --list is expected")),
    };
    said(&report, args)
}

fn said(report: &Report, args: &InspectArgs) -> Result<(), Failure> {
    if args.json { output::say(&format!("{:#}\n", report.json)) } else { output::say(&report.text) }
}

/// What is said, for people and for programs.
struct Report {
    text: String,
    json: serde_json::Value,
}

/// Whether a file is a plan: JSON that is not a scene of ours and has the parts of a plan.
fn is_plan(name: &str) -> bool {
    /// So much of a file is looked at.
    const HEAD: usize = 1 << 16;
    let path = Path::new(name);
    if !path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("json")) {
        return false;
    }
    let options = LoadOptions::default();
    let Ok(bytes) = bytes_of(path, &options) else { return false };
    let head = String::from_utf8_lossy(&bytes[..bytes.len().min(HEAD)]);
    !native::begins(&bytes) && (head.contains("\"root\"") || head.contains("\"shared\""))
}
