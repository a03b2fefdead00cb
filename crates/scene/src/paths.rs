//! Which instances a hit went through, from the one number that says so.

use std::fmt;

use nestray_core::hit::InstancePath;

use crate::scene::Scene;

/// Numbers every place of the hierarchy of groups, written out in full, as
/// [`InstancePath`] describes.
#[derive(Clone, Debug)]
pub struct Paths {
    root: usize,
    /// For each group the numbers of its places, relative to it.
    numbers: Vec<Vec<u32>>,
    /// For each group the groups of its places.
    groups: Vec<Vec<usize>>,
}

/// Why a hierarchy of groups cannot be numbered.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PathsError {
    /// A group stands in itself.
    Cycle {
        /// Which group.
        group: usize,
    },
    /// There are more than 2³² − 1 places, every instance counted.
    TooMany,
    /// Instances stand in one another more than [`Paths::DEEPEST`] deep.
    TooDeep,
}

impl fmt::Display for PathsError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Cycle { group } => write!(f, "group {group} stands in itself"),
            Self::TooMany => write!(f, "more than 4294967295 instances, all levels counted"),
            Self::TooDeep => write!(f, "instances nested more than {} deep", Paths::DEEPEST),
        }
    }
}

impl std::error::Error for PathsError {}

impl Paths {
    /// Deepest nesting of instances; each level takes room on the stack of a traversal.
    pub const DEEPEST: usize = 64;

    /// Numbers the places of a scene.
    ///
    /// # Errors
    /// If a group stands in itself, or there are too many places or levels.
    pub fn new(scene: &Scene) -> Result<Self, PathsError> {
        let groups: Vec<Vec<usize>> = scene
            .groups
            .iter()
            .map(|group| group.places.iter().map(|place| place.group).collect())
            .collect();
        let mut count = Count {
            groups: &groups,
            numbers: vec![Vec::new(); groups.len()],
            paths: vec![State::Unknown; groups.len()],
        };
        for group in 0..groups.len() {
            count.group(group, 0)?;
        }
        let numbers = count.numbers;
        Ok(Self { root: scene.root, numbers, groups })
    }

    /// The numbers of the places of a group, relative to it: what an
    /// [`Instance`](nestray_core::instance::Instance) of each is given.
    #[must_use]
    pub fn numbers(&self, group: usize) -> &[u32] {
        &self.numbers[group]
    }

    /// The places a hit went through, outermost first, each as a group and which of its
    /// places; empty if none.
    #[must_use]
    pub fn places(&self, path: InstancePath) -> Vec<(usize, usize)> {
        let mut places = Vec::new();
        let (mut group, mut rest) = (self.root, path.number());
        while let Some(step) = self.step(group, rest) {
            places.push((group, step.place));
            (group, rest) = (step.group, step.rest);
        }
        places
    }

    /// The group that no place leads to.
    pub(crate) fn root(&self) -> usize {
        self.root
    }

    /// The first place of a path that begins in a group; none if it is the empty one.
    pub(crate) fn step(&self, group: usize, path: u32) -> Option<Step> {
        if path == 0 {
            return None;
        }
        let numbers = &self.numbers[group];
        let place = numbers.partition_point(|&number| number <= path).checked_sub(1)?;
        Some(Step { place, group: self.groups[group][place], rest: path - numbers[place] })
    }
}

/// A step of a path.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Step {
    /// Which place of the group.
    pub(crate) place: usize,
    /// The group that stands there.
    pub(crate) group: usize,
    /// The path from there on.
    pub(crate) rest: u32,
}

#[derive(Clone, Copy)]
enum State {
    Unknown,
    Open,
    Known { paths: u32, depth: usize },
}

struct Count<'a> {
    groups: &'a [Vec<usize>],
    numbers: Vec<Vec<u32>>,
    paths: Vec<State>,
}

impl Count<'_> {
    /// How many paths there are in a group, the empty one too, and how deep they go.
    fn group(&mut self, group: usize, above: usize) -> Result<(u32, usize), PathsError> {
        match self.paths[group] {
            State::Known { paths, depth } => return Ok((paths, depth)),
            State::Open => return Err(PathsError::Cycle { group }),
            State::Unknown => {}
        }
        if above > Paths::DEEPEST {
            return Err(PathsError::TooDeep);
        }
        self.paths[group] = State::Open;
        let (mut paths, mut depth) = (1u32, 0);
        let mut numbers = Vec::with_capacity(self.groups[group].len());
        let all = self.groups;
        for &inner in &all[group] {
            numbers.push(paths);
            let (more, below) = self.group(inner, above + 1)?;
            paths = paths.checked_add(more).ok_or(PathsError::TooMany)?;
            depth = depth.max(below + 1);
        }
        if depth > Paths::DEEPEST {
            return Err(PathsError::TooDeep);
        }
        self.numbers[group] = numbers;
        self.paths[group] = State::Known { paths, depth };
        Ok((paths, depth))
    }
}
