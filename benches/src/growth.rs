//! How time and memory grow with the size of a scene.

use std::fmt::Write as _;

use crate::plot::{Chart, Line, draw};
use crate::results::{BATCH, HIGH, MEDIUM, Results, SINGLE};
use crate::scenes::{Scene, builtin, file};

/// One scene at several resolutions, another at several sizes, smallest first; Embree alone beside.
#[rustfmt::skip]
pub(crate) const ALL: &[Scene] = &[
    file("dragon-4", "large/dragon_vrip_res4.ply.gz"),
    file("dragon-3", "large/dragon_vrip_res3.ply.gz"),
    file("dragon-2", "large/dragon_vrip_res2.ply.gz"),
    file("dragon-1", "large/dragon_vrip.ply.gz"),
    builtin("terrain-71", "builtin:terrain@71"),
    builtin("terrain-224", "builtin:terrain@224"),
    builtin("terrain-708", "builtin:terrain@708"),
    builtin("terrain-2237", "builtin:terrain@2237"),
];

/// What is drawn of each scene.
type Figure = fn(&Results) -> Option<f64>;

/// A curve: its name, its colour, and the figure.
type Curve = (&'static str, &'static str, Figure);

const OURS: &str = "#c03a2b";
const OURS_TOO: &str = "#e59a86";
const EMBREE: &str = "#1f5fa8";
const EMBREE_TOO: &str = "#86b0dc";

/// Nanoseconds for each ray.
fn nanos(rate: Option<f64>) -> Option<f64> {
    rate.map(|rate| 1e3 / rate)
}

const CHARTS: &[(&str, &[Curve])] = &[
    (
        "ns per ray, bounce",
        &[
            ("ours, batch", OURS, |of| nanos(of.rate(of.ours(), BATCH, "bounce"))),
            ("ours, single", OURS_TOO, |of| nanos(of.rate(of.ours(), SINGLE, "bounce"))),
            ("Embree HIGH, single", EMBREE, |of| nanos(of.rate(HIGH, SINGLE, "bounce"))),
            ("Embree MEDIUM, single", EMBREE_TOO, |of| nanos(of.rate(MEDIUM, SINGLE, "bounce"))),
        ],
    ),
    (
        "bytes per triangle",
        &[
            ("ours", OURS, |of| Some(of.row(of.ours())?.bytes / of.triangles(true))),
            ("Embree HIGH", EMBREE, |of| Some(of.row(HIGH)?.bytes / of.triangles(true))),
            ("Embree MEDIUM", EMBREE_TOO, |of| Some(of.row(MEDIUM)?.bytes / of.triangles(true))),
        ],
    ),
    (
        "build, ns per triangle, one thread",
        &[
            ("ours", OURS, |of| build(of, of.ours())),
            ("Embree HIGH", EMBREE, |of| build(of, HIGH)),
            ("Embree MEDIUM", EMBREE_TOO, |of| build(of, MEDIUM)),
        ],
    ),
];

fn build(of: &Results, peer: &str) -> Option<f64> {
    Some(of.row(peer)?.build_seconds * 1e9 / of.triangles(true))
}

/// A row of charts for each scene.
pub(crate) fn plot(grown: &[Results]) -> String {
    let mut charts = Vec::new();
    for scene in ["dragon", "terrain"] {
        let sizes: Vec<&Results> =
            grown.iter().filter(|one| one.scene.starts_with(scene)).collect();
        for (title, curves) in CHARTS {
            let line = |(name, color, figure): &Curve| {
                let point = |of: &&Results| Some([of.triangles(true), figure(of)?]);
                Line { name, color, points: sizes.iter().filter_map(point).collect() }
            };
            let lines = curves.iter().map(line).collect();
            charts.push(Chart { title: format!("{scene}: {title}"), lines });
        }
    }
    draw(&charts, CHARTS.len(), "triangles")
}

/// The part of the page.
pub(crate) fn section(grown: &[Results]) -> String {
    let mut text = String::from(
        "\n## Growth with the size of a scene\n\n![ns per ray, bytes and build time against the \
         number of triangles](pictures/growth.svg)\n\n| scene | triangles |",
    );
    let columns: Vec<(&str, &Curve)> = CHARTS
        .iter()
        .flat_map(|(title, curves)| curves.iter().map(move |one| (*title, one)))
        .collect();
    columns.iter().for_each(|(title, (name, ..))| {
        let _ = write!(text, " {title}: {name} |");
    });
    let _ = writeln!(text, "\n|---|---{}|", "|---".repeat(columns.len()));
    for of in grown {
        let _ = write!(text, "| {} | {} |", of.scene, of.triangles(true));
        for (_, (_, _, figure)) in &columns {
            let _ = match figure(of) {
                Some(figure) => write!(text, " {figure:.1} |"),
                None => write!(text, " – |"),
            };
        }
        text.push('\n');
    }
    text
}
