//! The nestray program: scenes in, pictures and answers out.

mod args;
mod bench;
mod cache;
mod calibrate;
mod convert;
mod demo;
mod errors;
mod generate;
mod input;
mod inspect;
mod optimize;
mod output;
mod progress;
mod query;
mod render;
mod stats;
mod stop;

use std::process::ExitCode;

use crate::args::Verb;
use crate::errors::Failure;

fn main() -> ExitCode {
    let done = args::parse().and_then(|args| {
        stop::listen()?;
        run(&args)
    });
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            failure.report();
            ExitCode::from(failure.code)
        }
    }
}

fn run(args: &args::Args) -> Result<(), Failure> {
    let talk = &args.talk;
    match &args.verb {
        Verb::Demo(demo) => demo::run(demo, talk),
        Verb::Render(render) => render::run(render, talk),
        Verb::Query(query) => query::run(query, talk),
        Verb::Generate(generate) => generate::run(generate, talk),
        Verb::Convert(convert) => convert::run(convert, talk),
        Verb::Inspect(inspect) => inspect::run(inspect, talk),
        Verb::Bench(bench) => bench::run(bench, talk),
        Verb::Optimize(optimize) => optimize::run(optimize, talk),
        Verb::Calibrate(calibrate) => calibrate::run(calibrate, talk),
    }
}
