//! What can be wrong with a plan.

use nestray_registry::SettingsError;
use nestray_scene::check::SceneError;
use thiserror::Error;

use crate::plan::Plan;

/// Why a plan cannot be used.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum PlanError {
    /// The text is no plan.
    #[error("{line}:{column}: {message}")]
    Syntax {
        /// Counted from 1.
        line: usize,
        /// Counted from 1, in bytes.
        column: usize,
        /// What is wrong there.
        message: String,
    },
    /// The plan does not make sense, or does not fit the scene.
    #[error("{path}: {problem}")]
    At {
        /// Where in the plan: `root/nest/children/1/by_kind/shadow`.
        path: String,
        /// What is wrong there.
        problem: Problem,
    },
    /// The parts of the scene do not fit together.
    #[error("the scene: {0}")]
    Scene(#[from] SceneError),
}

/// What is wrong at some place of a plan.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum Problem {
    /// It is of a format not known.
    #[error("format {0} is not known, only {known}", known = Plan::VERSION)]
    Version(u32),
    /// It is made for another scene.
    #[error(
        "made for the scene {expected}, but this one is {found}: {geometries} geometries and \
         {primitives} primitives"
    )]
    OtherScene {
        /// The fingerprint in the plan.
        expected: String,
        /// That of the scene.
        found: String,
        /// How many the scene has.
        geometries: usize,
        /// How many the scene stores.
        primitives: u64,
    },
    /// There is no such thing.
    #[error("unknown {what} \"{name}\"{}", hint(.nearest.as_deref()))]
    Unknown {
        /// What it should be: a technique, a shared subtree, …
        what: String,
        /// What is asked for.
        name: String,
        /// What there is that is most like it.
        nearest: Option<String>,
    },
    /// The settings of a technique are wrong.
    #[error("{technique}: {error}{}", hint(.nearest.as_deref()))]
    Settings {
        /// Which technique.
        technique: &'static str,
        /// What is wrong.
        error: SettingsError,
        /// A setting that is most like an unknown one.
        nearest: Option<String>,
    },
    /// A technique cannot serve there.
    #[error("{technique} cannot serve here: {reason}")]
    Objection {
        /// Which technique.
        technique: &'static str,
        /// Why.
        reason: String,
    },
    /// A shared subtree places itself.
    #[error("shared subtrees place each other in a circle: {}", .0.join(" > "))]
    Cycle(Vec<String>),
    /// A shared subtree is placed nowhere.
    #[error("nothing places this shared subtree")]
    Unused,
    /// There are too many levels.
    #[error("more than {} levels, instances counted (the limit `Plan::DEEPEST`)", Plan::DEEPEST)]
    TooDeep,
    /// Something is held twice.
    #[error("{what} is held twice, also by {other}")]
    Twice {
        /// Which geometry or instance.
        what: String,
        /// Where else.
        other: String,
    },
    /// Something is not held.
    #[error("{what} is not held by anything{}", others(*.more))]
    Missing {
        /// Which geometry or instance.
        what: String,
        /// How many more there are.
        more: usize,
    },
    /// A case of a by-kind node holds other things than `other` does.
    #[error("holds {} than `other`, for example {what}", if *.more { "more" } else { "less" })]
    Differs {
        /// Which geometry or instance is only in one of them.
        what: String,
        /// Whether it is this one.
        more: bool,
    },
}

fn hint(nearest: Option<&str>) -> String {
    nearest.map_or_else(String::new, |name| format!(" (did you mean \"{name}\"?)"))
}

fn others(more: usize) -> String {
    match more {
        0 => String::new(),
        1 => ", nor is another".into(),
        _ => format!(", nor are {more} others"),
    }
}

impl PlanError {
    pub(crate) fn at(path: impl Into<String>, problem: Problem) -> Self {
        Self::At { path: path.into(), problem }
    }
}

impl Problem {
    /// An unknown name, with the nearest of those known.
    pub(crate) fn unknown<'a>(
        what: impl Into<String>,
        name: &str,
        known: impl IntoIterator<Item = &'a str>,
    ) -> Self {
        Self::Unknown { what: what.into(), name: name.into(), nearest: nearest(name, known) }
    }
}

/// The name most like another, if any is alike at all; of equals the first.
#[must_use]
pub fn nearest<'a>(name: &str, known: impl IntoIterator<Item = &'a str>) -> Option<String> {
    // A long name is not compared whole.
    let name: String = name.to_lowercase().chars().take(60).collect();
    // Half of the letters must agree.
    let mut best: Option<(f64, &str)> = None;
    for candidate in known {
        let alike = strsim::normalized_damerau_levenshtein(&name, &candidate.to_lowercase());
        if alike > best.map_or(0.5, |(most, _)| most) {
            best = Some((alike, candidate));
        }
    }
    best.map(|(_, name)| name.to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_nearest_name_is_a_likely_one() {
        let known = ["bvh", "grid", "light_buffer"];
        assert_eq!(nearest("bhv", known).as_deref(), Some("bvh"));
        assert_eq!(nearest("Gird", known).as_deref(), Some("grid"));
        assert_eq!(nearest("lightbuffer", known).as_deref(), Some("light_buffer"));
        assert_eq!(nearest("xyz", known), None);
        assert_eq!(nearest("", known), None);
    }
}
