//! What differs between two plans.

use std::fmt::Write as _;
use std::path::PathBuf;

use nestray::plan::check::check_form;
use nestray::plan::plan::Plan;
use nestray::plan::plan::diff::differences;
use serde_json::{Value, json};

use super::Report;
use crate::errors::Failure;
use crate::input;

/// Of two plan files.
pub(super) fn report(first: &PathBuf, second: &PathBuf) -> Result<Report, Failure> {
    let read = |path: &PathBuf| -> Result<Plan, Failure> {
        let plan = input::read_plan(path)?;
        check_form(&plan).map_err(|error| input::plan_failure(&error, Some(path)))?;
        Ok(plan)
    };
    let plans = [read(first)?, read(second)?];
    let all = differences(&plans[0], &plans[1]);
    let mut text = String::new();
    let _ = writeln!(text, "first     {}  {}", plans[0].hash(), first.display());
    let _ = writeln!(text, "second    {}  {}", plans[1].hash(), second.display());
    if all.is_empty() {
        let _ = writeln!(text, "they are the same");
    }
    for one in &all {
        let _ = writeln!(text, "{}", one.path);
        let _ = writeln!(text, "  first   {}", shown(one.first.as_ref()));
        let _ = writeln!(text, "  second  {}", shown(one.second.as_ref()));
    }
    let hashes = plans.map(|plan| plan.hash());
    Ok(Report { text, json: json!({ "hashes": hashes, "differences": all }) })
}

/// In a line that can be read.
fn shown(value: Option<&Value>) -> String {
    /// More letters than that are cut off.
    const MOST: usize = 160;
    let Some(value) = value else { return "–".into() };
    let text = value.to_string();
    match text.char_indices().nth(MOST) {
        Some((end, _)) => format!("{}…", &text[..end]),
        None => text,
    }
}
