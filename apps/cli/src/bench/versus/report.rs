//! What is said of libraries that shot the same rays.

use std::collections::HashMap;
use std::fmt::Write as _;
use std::time::Duration;

use nestray::plan::describe::bytes;
use nestray_peers::peer::{Missing, Way};
use nestray_peers::world::World;
use serde_json::{Value, json};

use super::rounds::{Contender, Taken};
use crate::bench::sets::RaySet;

/// What is known of a contender before it shoots.
struct Row {
    peer: String,
    version: String,
    way: Way,
    build_seconds: f64,
    build_seconds_on_all: Option<f64>,
    bytes: u64,
}

/// What came of one set.
struct Column {
    name: &'static str,
    any: bool,
    /// In the set; not all may have been shot.
    rays: usize,
    taken: Vec<Taken>,
}

/// Everything that was measured.
pub(super) struct Report {
    scene: String,
    seed: u64,
    stored: u64,
    shown: u64,
    rows: Vec<Row>,
    columns: Vec<Column>,
    missing: Vec<Missing>,
}

impl Report {
    pub(super) fn new(
        scene: &str,
        world: &World,
        seed: u64,
        (contenders, missing): (&[Contender<'_>], &[Missing]),
        on_all: &HashMap<String, Duration>,
    ) -> Self {
        let row = |one: &Contender<'_>| Row {
            peer: one.peer.name(),
            version: one.peer.version(),
            way: one.way,
            build_seconds: one.peer.build_time().as_secs_f64(),
            build_seconds_on_all: on_all.get(&one.peer.name()).map(Duration::as_secs_f64),
            bytes: one.peer.bytes(),
        };
        Self {
            scene: scene.into(),
            seed,
            stored: world.stored(),
            shown: world.shown(),
            rows: contenders.iter().map(row).collect(),
            columns: Vec::new(),
            missing: missing.to_vec(),
        }
    }

    pub(super) fn add(&mut self, set: &RaySet, taken: Vec<Taken>) {
        self.columns.push(Column { name: set.name, any: set.any, rays: set.rays.len(), taken });
    }

    /// Tables for a terminal.
    pub(super) fn text(&self) -> String {
        let mut text = String::new();
        let Self { scene, seed, stored, shown, .. } = self;
        let _ =
            writeln!(text, "{scene}: {shown} triangles, {stored} stored; one thread, seed {seed}");
        for missing in &self.missing {
            let _ = writeln!(text, "{missing}");
        }
        text.push_str(&self.libraries());
        let rate = |taken: &Taken, _: &Column| format!("{:.2}", taken.rate);
        self.table(&mut text, "millions of rays per second", &rate);
        if self.best(EMBREE).next().is_some() {
            let ratio = |taken: &Taken, column: &Column| {
                let best = self.best(EMBREE).map(|i| column.taken[i].rate);
                format!("{:.2}", taken.rate / best.fold(f64::MIN_POSITIVE, f64::max))
            };
            self.table(&mut text, "over the better call of Embree HIGH", &ratio);
        }
        let differ = |taken: &Taken, _: &Column| {
            let Taken { other_hits, other_distances, .. } = taken;
            format!("{other_hits}+{other_distances}")
        };
        self.table(&mut text, "answers unlike the first's: hit or miss + where", &differ);
        let shot = |taken: &Taken, _: &Column| taken.rays.to_string();
        self.table(&mut text, "rays of each turn", &shot);
        text
    }

    /// Who takes part: builds and memory.
    fn libraries(&self) -> String {
        let mut text = format!(
            "\n{:<22} {:>9} {:>9} {:>8} {:>10} {:>8}  version\n",
            "library", "build s", "on all", "Mtri/s", "memory", "B/tri"
        );
        let mut last = "";
        for row in &self.rows {
            if last == row.peer {
                continue;
            }
            last = &row.peer;
            let Row { peer, build_seconds: build, version, .. } = row;
            let on_all = row.build_seconds_on_all.map_or("-".into(), |time| format!("{time:.3}"));
            let (rate, per) = (self.triangle_rate(row), self.bytes_each(row));
            let size = bytes(row.bytes);
            let _ = writeln!(
                text,
                "{peer:<22} {build:>9.3} {on_all:>9} {rate:>8.2} {size:>10} {per:>8.1}  {version}"
            );
        }
        text
    }

    /// Rows of contenders, columns of sets.
    fn table(&self, text: &mut String, title: &str, cell: &dyn Fn(&Taken, &Column) -> String) {
        let _ = write!(text, "\n{title}\n{:<36}", "");
        self.columns.iter().for_each(|column| {
            let _ = write!(text, " {:>9}", column.name);
        });
        let _ = writeln!(text);
        for (i, row) in self.rows.iter().enumerate() {
            let _ = write!(text, "{:<36}", format!("{}, {}", row.peer, row.way.name()));
            for column in &self.columns {
                let _ = write!(text, " {:>9}", cell(&column.taken[i], column));
            }
            let _ = writeln!(text);
        }
    }

    /// Contenders of a name.
    fn best(&self, peer: &'static str) -> impl Iterator<Item = usize> {
        let named = self.rows.iter().enumerate().filter(move |(_, row)| row.peer == peer);
        named.map(|(i, _)| i)
    }

    fn triangle_rate(&self, row: &Row) -> f64 {
        self.stored as f64 / row.build_seconds.max(1e-9) / 1e6
    }

    fn bytes_each(&self, row: &Row) -> f64 {
        row.bytes as f64 / self.stored.max(1) as f64
    }

    /// Everything.
    pub(super) fn json(&self) -> String {
        let contender = |row: &Row| {
            json!({ "peer": row.peer, "version": row.version, "way": row.way.name(),
                "build_seconds": row.build_seconds,
                "build_seconds_on_all_threads": row.build_seconds_on_all, "bytes": row.bytes })
        };
        let taken = |taken: &Taken| {
            json!({ "rays": taken.rays, "mrays_per_second": taken.rate, "turns": taken.rates,
                "other_hits": taken.other_hits, "other_distances": taken.other_distances })
        };
        let set = |column: &Column| {
            json!({ "name": column.name, "rays": column.rays,
                "query": if column.any { "any" } else { "closest" },
                "of": column.taken.iter().map(taken).collect::<Vec<Value>>() })
        };
        let missing = |missing: &Missing| json!({ "peer": missing.peer, "reason": missing.reason });
        let all = json!({
            "scene": self.scene, "seed": self.seed,
            "triangles": self.shown, "triangles_stored": self.stored,
            "contenders": self.rows.iter().map(contender).collect::<Vec<Value>>(),
            "missing": self.missing.iter().map(missing).collect::<Vec<Value>>(),
            "sets": self.columns.iter().map(set).collect::<Vec<Value>>(),
        });
        format!("{all:#}\n")
    }
}

/// The contender that all are held against.
const EMBREE: &str = "Embree HIGH";
