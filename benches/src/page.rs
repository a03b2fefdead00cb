//! The page about speed.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use crate::pictures::{self, Picture};
use crate::results::{BATCH, HIGH, Results, SETS};
use crate::{growth, machine, reach};

/// What the page says before any figure.
const HEAD: &str = "# Performance

Our own hierarchies of boxes against other libraries: the same rays, in the same process, in turns. `sbvh` is built for rays
that matter, as Embree's HIGH is, and is what ratios are of; `bvh` is built fast, as its MEDIUM is. Both have their usual
settings. Written by `cargo xtask bench`; nothing on this page is put in by hand.

Every turn shoots a whole set of rays on one thread, and what counts is the processor time of that thread, so that other
work on the machine weighs less; rates are medians of the turns. Rays come as records of 32 bytes and answers go out as
records of 16 (or one byte): what each library needs to make its own of them is part of its time, ours included. Where a
library is so slow that a turn would take seconds, it shoots fewer of the rays, in blocks of 1024 neighbours. Embree and our own
code choose their vector instructions when they run; tinybvh and the libraries in Rust are compiled for the very machine.
Embree flushes denormal numbers to zero while it is called, as its manual advises, and is told which rays are coherent.

";

/// What the sets of rays are.
const RAYS: &str = "## Rays

| set | query | what |
|---|---|---|
| primary | closest | from the eye, jittered, 800 × 608 pixels in tiles of 16 × 16 in Morton order |
| bounce | closest | from what those hit, by Lambert's law, without end |
| chords | closest | uniform random lines through the box around the scene |
| shadow | any | from what the primary rays hit to a light at a point, in the same order |
| ao | any | from what the primary rays hit, by Lambert's law, a twentieth of the scene's diagonal long |
| long | any | the bounce rays again |

Shapes other than triangles are shot at as triangles by all. Memory is what queries need, nodes and leaves; meshes as they
were handed over are not counted, for nobody. Embree's trees are built for its flags HIGH, MEDIUM, and HIGH with ROBUST.
Rays that leave a surface start a fifty-thousandth of the scene's diagonal above it, chords a hundredth before the box: what
lies right at the start is hit by some libraries and not by others. Builds are timed on one thread, by its processor time, and
on all threads by the clock. An answer differs from ours if one hits and the other does not, or if distances differ by more
than a thousandth and a millionth of the diagonal.

";

pub(crate) fn page(
    all: &[Results],
    rendered: &[Picture],
    grown: &[Results],
    options: &[String],
) -> String {
    let mut text = String::from(HEAD);
    text.push_str("| | |\n|---|---|\n");
    for [name, fact] in machine::describe() {
        let _ = writeln!(text, "| {name} | {fact} |");
    }
    let _ = writeln!(text, "| commit | {} |", commits(all.iter().chain(grown)));
    let mut libraries: Vec<String> = all.iter().flat_map(|one| one.rows()).map(library).collect();
    libraries.sort();
    libraries.dedup();
    let _ = writeln!(text, "| libraries | {} |", libraries.join("; "));
    let extra = if options.is_empty() { String::new() } else { format!(" {}", options.join(" ")) };
    let _ = writeln!(
        text,
        "| repeat with | `cargo xtask peers && cargo xtask bench`; one scene: `nestray bench \
         builtin:terrain --plans sbvh,bvh --vs embree,tinybvh,obvhs,parry3d,bvh{extra}` |\n"
    );
    text.push_str(RAYS);
    text.push_str("## What was to be reached, and what is\n\n");
    text.push_str("Geometric means over the scenes, and the worst of them. Bold: reached.\n\n");
    text.push_str(&reach::table(all));
    text.push_str(
        "\n## Ratios, scene by scene\n\nOurs in batches over the better of Embree HIGH's ",
    );
    text.push_str("calls (one ray, or packets of 16).\n\n");
    text.push_str(&ratios(all));
    if !rendered.is_empty() {
        text.push_str(&pictures::section(rendered));
    }
    if !grown.is_empty() {
        text.push_str(&growth::section(grown));
    }
    text.push_str("\n## Rates\n\nMillions of rays per second; the fastest of each set in bold.\n");
    all.iter().for_each(|one| text.push_str(&rates(one)));
    text
}

/// What was measured, and which scenes are from another commit.
fn commits<'a>(all: impl Iterator<Item = &'a Results>) -> String {
    let now = machine::commit();
    let mut others: BTreeMap<&str, Vec<&str>> = BTreeMap::new();
    for one in all.filter(|one| one.commit() != now) {
        others.entry(one.commit()).or_default().push(&one.scene);
    }
    let other = |(commit, scenes): (&str, Vec<&str>)| match commit {
        "" => format!("{} of one unknown", scenes.join(", ")),
        commit => format!("{} of {commit}", scenes.join(", ")),
    };
    let parts = std::iter::once(now.clone()).chain(others.into_iter().map(other));
    parts.collect::<Vec<_>>().join("; ")
}

/// The first word of a name, and a version.
fn library(row: crate::results::Row<'_>) -> String {
    let ours = row.version.contains(',');
    let name = if ours { "nestray" } else { row.peer.split(' ').next().unwrap_or_default() };
    format!("{name} {}", row.version)
}

fn head(text: &mut String, first: &str) {
    let _ = writeln!(text, "| {first} | {} |", SETS.join(" | "));
    let _ = writeln!(text, "|---{}|", "|---".repeat(SETS.len()));
}

fn ratios(all: &[Results]) -> String {
    let mut text = String::new();
    head(&mut text, "scene");
    for one in all {
        let cell = |set: &&str| {
            let ratio = || Some(one.rate(one.ours(), BATCH, set)? / one.best(HIGH, set)?);
            ratio().map_or("–".into(), |ratio| format!("{ratio:.2}"))
        };
        let cells: Vec<String> = SETS.iter().map(cell).collect();
        let _ = writeln!(text, "| {} | {} |", one.scene, cells.join(" | "));
    }
    text
}

/// Everything about one scene.
fn rates(one: &Results) -> String {
    let (stored, shown) = (one.triangles(true), one.triangles(false));
    let mut text = format!("\n### {}: {shown} triangles", one.scene);
    if stored < shown {
        let _ = write!(text, ", {stored} stored");
    }
    text.push_str("\n\n| library, way | build s | on all | Mtri/s | B/tri | ");
    let _ = writeln!(text, "{} | differ |", SETS.join(" | "));
    let _ = writeln!(text, "|---{}|", "|---".repeat(SETS.len() + 5));
    let most = SETS.map(|set| one.rates(set, |_| true).fold(0.0, f64::max));
    for row in one.rows() {
        let cell = |(set, most): (&&str, &f64)| match one.rate(row.peer, row.way, set) {
            Some(rate) if rate >= *most => format!("**{rate:.2}**"),
            Some(rate) => format!("{rate:.2}"),
            None => "–".into(),
        };
        let cells: Vec<String> = SETS.iter().zip(&most).map(cell).collect();
        let (differ, of) = one.differing(row.peer, row.way);
        let on_all = match row.build_seconds_on_all {
            seconds if seconds.is_nan() => "–".into(),
            seconds => format!("{seconds:.3}"),
        };
        let percent = 100.0 * differ as f64 / of.max(1) as f64;
        let _ = writeln!(
            text,
            "| {}, {} | {:.3} | {on_all} | {:.2} | {:.1} | {} | {differ} ({percent:.4} %) |",
            row.peer,
            row.way,
            row.build_seconds,
            stored / row.build_seconds / 1e6,
            row.bytes / stored,
            cells.join(" | "),
        );
    }
    for (peer, reason) in one.missing() {
        let _ = writeln!(text, "\n{peer} did not take part: {reason}");
    }
    text
}
