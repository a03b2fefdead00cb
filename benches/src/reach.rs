//! How far ahead of others we are, by category.

use std::fmt::Write as _;

use crate::results::{
    BATCH, FAST, HIGH, MEDIUM, QUALITY, ROBUST, Results, Row, SETS, SINGLE, mean_and_worst,
};

/// Scenes with instances have a category of their own.
const INSTANCED: [&str; 2] = ["forest", "sponza-in-terrain"];

/// Ratios of one scene that count in a category.
type Ratios = fn(&Results) -> Vec<f64>;

/// A line of the table: what is compared, what the mean and the worst should be, which scenes
/// count, and their ratios.
struct Category {
    name: &'static str,
    goal: [f64; 2],
    instanced: bool,
    ratios: Ratios,
}

const fn category(name: &'static str, goal: [f64; 2], ratios: Ratios) -> Category {
    Category { name, goal, instanced: false, ratios }
}

/// Ours in batches over the better call of Embree HIGH.
fn batch(of: &Results, sets: &[&str]) -> Vec<f64> {
    over(of, BATCH, sets, |set| of.best(HIGH, set))
}

fn over(of: &Results, way: &str, sets: &[&str], theirs: impl Fn(&str) -> Option<f64>) -> Vec<f64> {
    let ratio = |set: &&str| Some(of.rate(of.ours(), way, set)? / theirs(set)?);
    sets.iter().filter_map(ratio).collect()
}

fn build(of: &Results, ours: &str, embree: &str) -> Vec<f64> {
    let seconds = |peer: &str| of.row(peer).map(|row| row.build_seconds);
    let ratio = || Some(seconds(embree)? / seconds(ours)?);
    ratio().into_iter().collect()
}

#[rustfmt::skip]
const CATEGORIES: &[Category] = &[
    category("closest hit, coherent batch, over the better call of Embree HIGH", [2.0, 1.2],
        |of| batch(of, &["primary"])),
    category("closest hit, scattered batch: bounce", [2.2, 1.5], |of| batch(of, &["bounce"])),
    category("closest hit, scattered batch: random chords", [2.5, 1.5], |of| batch(of, &["chords"])),
    category("closest hit, one ray per call, over `rtcIntersect1`", [1.35, 1.05],
        |of| over(of, SINGLE, &SETS[..3], |set| of.rate(HIGH, SINGLE, set))),
    category("any hit, batch: shadow", [2.2, 1.3], |of| batch(of, &["shadow"])),
    category("any hit, batch: ambient occlusion", [2.5, 1.3], |of| batch(of, &["ao"])),
    category("any hit, batch: long", [2.5, 1.3], |of| batch(of, &["long"])),
    category("batch over the better call of Embree ROBUST, watertight as ours", [2.6, 1.3],
        |of| over(of, BATCH, &SETS, |set| of.best(ROBUST, set))),
    category("one ray per call over Embree ROBUST, the same", [1.7, 1.3],
        |of| over(of, SINGLE, &SETS, |set| of.rate(ROBUST, SINGLE, set))),
    category("build of `bvh`, one thread, over Embree MEDIUM", [2.0, 1.2],
        |of| build(of, FAST, MEDIUM)),
    category("build of `bvh`, all threads by the clock over one thread", [1.9, 1.2], |of| {
        let on_all = |row: Row<'_>| row.build_seconds / row.build_seconds_on_all;
        of.row(FAST).map(on_all).into_iter().collect()
    }),
    category("build of `sbvh`, one thread, over Embree HIGH", [1.5, 1.0],
        |of| build(of, QUALITY, HIGH)),
    category("bytes: Embree HIGH over `sbvh`", [1.0, 1.0], |of| {
        let ratio = || Some(of.row(HIGH)?.bytes / of.row(QUALITY)?.bytes);
        ratio().into_iter().collect()
    }),
    Category { name: "instances: batch over the better call of Embree HIGH, all rays",
        goal: [1.5, 1.1], instanced: true, ratios: |of| batch(of, &SETS) },
    category("batch over every other library, its best way, all rays", [2.0, 1.2], |of| {
        let ours = [FAST, QUALITY];
        let other = |set: &str| {
            of.rates(set, |row| !ours.contains(&row.peer) && !row.peer.starts_with("Embree"))
                .reduce(f64::max)
        };
        over(of, BATCH, &SETS, other)
    }),
];

/// All categories: what was to be reached and what is.
pub(crate) fn table(all: &[Results]) -> String {
    let mut text: String =
        "| category | to reach: mean (worst) | mean | worst |\n|---|---|---|---|\n".into();
    for Category { name, goal: [mean, worst], instanced, ratios } in CATEGORIES {
        let of = all.iter().filter(|one| INSTANCED.contains(&&*one.scene) == *instanced);
        let ratios: Vec<(f64, &str)> = of
            .flat_map(|one| ratios(one).into_iter().map(|ratio| (ratio, one.scene.as_str())))
            .collect();
        let is = mean_and_worst(&ratios).map_or("– | –".into(), |(is, least, scene)| {
            let mark = |is: f64, goal: f64| {
                if is >= goal { format!("**{is:.2}**") } else { format!("{is:.2}") }
            };
            format!("{} | {} ({scene})", mark(is, *mean), mark(least, *worst))
        });
        let _ = writeln!(text, "| {name} | {mean:.2} ({worst:.2}) | {is} |");
    }
    text
}
