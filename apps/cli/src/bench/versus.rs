//! `nestray bench --vs`: our plans and other libraries on the same rays, in turns.

mod ours;
mod report;
mod rounds;
mod tessellate;
mod triangles;

use std::path::Path;

use nestray::io::load::LoadOptions;
use nestray::plan::error::nearest;
use nestray::render::watch::Watch as _;
use nestray_peers::core::keep_to_one_core;
use nestray_peers::peer::{Missing, Peer};
use nestray_peers::world::World;
use nestray_peers::{NAMES, builds_on_all, open};

use self::ours::Ours;
use self::report::Report;
use self::rounds::Contender;
use super::sets;
use crate::args::{BenchArgs, Talk};
use crate::errors::Failure;
use crate::progress::Progress;
use crate::{input, output, stop};

/// Rays of each kind: a picture of 800 × 608 pixels. Fewer are less coherent.
const RAYS: usize = 486_400;

pub(super) fn run(args: &BenchArgs, talk: &Talk) -> Result<(), Failure> {
    check(args)?;
    let progress = Progress::new(talk);
    let mut scene = input::scene(&args.scene, &LoadOptions::default(), &progress)?;
    let refused = |reason| Failure::usage(format!("{}: {reason}", args.scene));
    if let Some(done) = tessellate::tessellate(&mut scene).map_err(refused)? {
        progress.note(&done);
    }
    let world = triangles::world(&mut scene).map_err(refused)?;
    let plans: Vec<&str> = match &*args.plans {
        [] => vec!["bvh"],
        plans => plans.iter().map(String::as_str).collect(),
    };
    let ours = plans.iter().map(|plan| Ours::new(plan, &scene)).collect::<Result<Vec<_>, _>>()?;
    let mut missing = Vec::new();
    // First of all: nothing is to be timed on one thread while others wait for more to build.
    let theirs = args.vs.iter().flat_map(|name| builds_on_all(name, &world));
    let on_all = ours.iter().map(Ours::build_on_all).chain(theirs).collect();
    keep_to_one_core();
    let peers = peers(&args.vs, &world, &mut missing)?;
    missing.iter().for_each(|missing| progress.note(&missing.to_string()));
    let all = ours.iter().map(|ours| ours as &dyn Peer);
    let all: Vec<&dyn Peer> = all.chain(peers.iter().map(|peer| &**peer)).collect();
    let contenders: Vec<Contender<'_>> = all
        .iter()
        .flat_map(|&peer| peer.ways().iter().map(move |&way| Contender { peer, way }))
        .collect();
    let mut report = Report::new(&args.scene, &world, args.seed, (&contenders, &missing), &on_all);
    let sets = sets::sets(&scene, ours[0].world(), args.rays.unwrap_or(RAYS), args.seed)?;
    let watching = progress.watch("bench");
    for (i, set) in (0..).zip(&sets) {
        watching.advanced(i, sets.len() as u64, 0);
        report.add(set, rounds::run(&contenders, set, args.rounds)?);
    }
    drop(watching);
    for path in &args.output {
        let text = if is_json(path) { report.json() } else { report.text() };
        output::write(path, text.as_bytes())?;
    }
    output::say(&if args.json { report.json() } else { report.text() })
}

fn is_json(path: &Path) -> bool {
    path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("json"))
}

/// Whether everything that was asked for is there to be asked for.
fn check(args: &BenchArgs) -> Result<(), Failure> {
    for name in &args.vs {
        if !NAMES.contains(&&**name) {
            let failure = Failure::usage(format!("--vs: no library is known as {name:?}"));
            return Err(match nearest(name, NAMES.iter().copied()) {
                Some(near) => failure.hint(format!("did you mean \"{near}\"?")),
                None => failure.hint(NAMES.join(", ")),
            });
        }
    }
    args.output.iter().try_for_each(|path| output::check(path))
}

/// The libraries with the scene in them; those that cannot take part are added to `missing`.
fn peers(
    names: &[String],
    world: &World,
    missing: &mut Vec<Missing>,
) -> Result<Vec<Box<dyn Peer>>, Failure> {
    let mut peers = Vec::new();
    for name in names {
        stop::check()?;
        for peer in open(name, world) {
            match peer {
                Ok(peer) => peers.push(peer),
                Err(reason) if missing.contains(&reason) => {}
                Err(reason) => missing.push(reason),
            }
        }
    }
    Ok(peers)
}
