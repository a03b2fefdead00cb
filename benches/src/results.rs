//! What `nestray bench --vs` measured on one scene.

use std::fs;
use std::path::Path;

use serde_json::Value;

/// Ways to ask, as in the measurements.
pub(crate) const SINGLE: &str = "single";
pub(crate) const BATCH: &str = "batch";

/// Plans of ours: what is built for rays that matter, and what is built fast.
pub(crate) const QUALITY: &str = "sbvh";
pub(crate) const FAST: &str = "bvh";

/// Names of Embree's settings, as in the measurements.
pub(crate) const HIGH: &str = "Embree HIGH";
pub(crate) const MEDIUM: &str = "Embree MEDIUM";
pub(crate) const ROBUST: &str = "Embree HIGH ROBUST";

/// Sets of rays, as in the measurements.
pub(crate) const SETS: [&str; 6] = ["primary", "bounce", "chords", "shadow", "ao", "long"];

/// Measurements on one scene.
pub(crate) struct Results {
    pub(crate) scene: String,
    value: Value,
}

/// A contender: who, and in which way.
pub(crate) struct Row<'a> {
    pub(crate) peer: &'a str,
    pub(crate) way: &'a str,
    pub(crate) version: &'a str,
    pub(crate) build_seconds: f64,
    /// By the clock; not a number if it does not do that.
    pub(crate) build_seconds_on_all: f64,
    pub(crate) bytes: f64,
}

impl Results {
    pub(crate) fn read(scene: &str, path: &Path) -> Result<Self, String> {
        let wrong = |error: &dyn std::fmt::Display| format!("{}: {error}", path.display());
        let text = fs::read_to_string(path).map_err(|error| wrong(&error))?;
        let value = serde_json::from_str(&text).map_err(|error| wrong(&error))?;
        Ok(Self { scene: scene.into(), value })
    }

    /// Writes into measurements what was measured.
    pub(crate) fn sign(path: &Path, commit: &str) -> Result<(), String> {
        let wrong = |error: &dyn std::fmt::Display| format!("{}: {error}", path.display());
        let text = fs::read_to_string(path).map_err(|error| wrong(&error))?;
        let mut value: Value = serde_json::from_str(&text).map_err(|error| wrong(&error))?;
        value["commit"] = commit.into();
        fs::write(path, format!("{value:#}\n")).map_err(|error| wrong(&error))
    }

    /// What was measured; nothing if nobody knows.
    pub(crate) fn commit(&self) -> &str {
        self.value["commit"].as_str().unwrap_or_default()
    }

    fn list(&self, name: &str) -> &[Value] {
        self.value[name].as_array().map_or(&[], Vec::as_slice)
    }

    /// Everybody who took part; ours first.
    pub(crate) fn rows(&self) -> impl Iterator<Item = Row<'_>> {
        self.list("contenders").iter().map(|one| Row {
            peer: one["peer"].as_str().unwrap_or_default(),
            way: one["way"].as_str().unwrap_or_default(),
            version: one["version"].as_str().unwrap_or_default(),
            build_seconds: one["build_seconds"].as_f64().unwrap_or(f64::NAN),
            build_seconds_on_all: one["build_seconds_on_all_threads"].as_f64().unwrap_or(f64::NAN),
            bytes: one["bytes"].as_f64().unwrap_or(f64::NAN),
        })
    }

    /// The first plan.
    pub(crate) fn ours(&self) -> &str {
        self.rows().next().map_or("", |row| row.peer)
    }

    pub(crate) fn row(&self, peer: &str) -> Option<Row<'_>> {
        self.rows().find(|row| row.peer == peer)
    }

    fn taken(&self, row: usize, set: &str) -> Option<&Value> {
        let set = self.list("sets").iter().find(|one| one["name"] == set)?;
        set["of"].get(row)
    }

    /// Millions of rays per second of the contenders that are right.
    pub(crate) fn rates(
        &self,
        set: &str,
        is_right: impl Fn(&Row<'_>) -> bool,
    ) -> impl Iterator<Item = f64> {
        let rows = self.rows().enumerate().filter(move |(_, row)| is_right(row));
        rows.filter_map(move |(i, _)| self.taken(i, set)?["mrays_per_second"].as_f64())
    }

    pub(crate) fn rate(&self, peer: &str, way: &str, set: &str) -> Option<f64> {
        self.rates(set, |row| row.peer == peer && row.way == way).next()
    }

    /// Of its ways the fastest.
    pub(crate) fn best(&self, peer: &str, set: &str) -> Option<f64> {
        self.rates(set, |row| row.peer == peer).reduce(f64::max)
    }

    /// Answers of a contender that are not those of ours, over all sets, and how many it gave.
    pub(crate) fn differing(&self, peer: &str, way: &str) -> (u64, u64) {
        let row = self.rows().position(|row| row.peer == peer && row.way == way);
        let all = SETS.iter().filter_map(|set| self.taken(row?, set));
        let number = |one: &Value, name: &str| one[name].as_u64().unwrap_or(0);
        all.fold((0, 0), |(differ, of), one| {
            let more = number(one, "other_hits") + number(one, "other_distances");
            (differ + more, of + number(one, "rays"))
        })
    }

    /// Triangles, every instance counted or not.
    pub(crate) fn triangles(&self, is_stored: bool) -> f64 {
        let name = if is_stored { "triangles_stored" } else { "triangles" };
        self.value[name].as_f64().unwrap_or(f64::NAN)
    }

    /// Who did not take part, and why.
    pub(crate) fn missing(&self) -> impl Iterator<Item = (&str, &str)> {
        self.list("missing").iter().map(|one| {
            (one["peer"].as_str().unwrap_or_default(), one["reason"].as_str().unwrap_or_default())
        })
    }
}

/// The geometric mean, and the smallest with its name; none of nothing.
pub(crate) fn mean_and_worst<'a>(of: &[(f64, &'a str)]) -> Option<(f64, f64, &'a str)> {
    let &(worst, name) = of.iter().min_by(|a, b| a.0.total_cmp(&b.0))?;
    let logs: f64 = of.iter().map(|(ratio, _)| ratio.ln()).sum();
    Some(((logs / of.len() as f64).exp(), worst, name))
}
