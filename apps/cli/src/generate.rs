//! `nestray generate`.

use crate::args::{GenerateArgs, Talk};
use crate::errors::Failure;
use crate::progress::Progress;
use crate::{convert, input, output, stop};

pub(crate) fn run(args: &GenerateArgs, talk: &Talk) -> Result<(), Failure> {
    let progress = Progress::new(talk);
    convert::check(&args.output)?;
    output::check(&args.output)?;
    let scene = input::builtin(&args.name, args.size)?;
    stop::check()?;
    convert::write(&args.output, &scene, progress)
}
