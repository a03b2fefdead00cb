//! `cargo xtask bench`: other libraries over ten scenes.

use std::env::consts::EXE_SUFFIX;
use std::process::Command;

use crate::peers::{root, run, target};

/// Writes `docs/performance.md`, or does what `nestray-benches` is told.
pub(crate) fn bench(args: &[String]) -> Result<(), String> {
    let build = ["build", "--release", "-p", "nestray-cli", "-p", "nestray-benches"];
    run(Command::new(env!("CARGO")).args(build).current_dir(root()))?;
    let program = target().join(format!("release/nestray-benches{EXE_SUFFIX}"));
    let mut command = Command::new(program);
    command.current_dir(root());
    run(if args.is_empty() {
        command.args(["--docs", "docs", "--growth", "--pictures"])
    } else {
        command.args(args)
    })
}
