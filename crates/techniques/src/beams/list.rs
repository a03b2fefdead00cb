//! What the rays of a beam may meet.

use nestray_core::beam::Beam;
use nestray_core::family::Family;
use nestray_core::ray::Source;
use nestray_core::technique::Step;

use super::arena::Line;
use super::cut::{Forest, Part};

/// What parts are sorted by, and where on the main axis they are said to begin.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Key {
    /// The distance from where the rays of the beam start.
    Distance,
    /// The coordinate on this axis, with its sign changed if rays run down it: the same for
    /// every ray, wherever it starts.
    Coordinate {
        /// The axis.
        axis: usize,
        /// Whether rays run down it.
        backward: bool,
    },
}

/// A child that every ray of a beam meets.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Shade {
    pub(crate) child: u32,
    /// No ray meets it nearer than that.
    near: f32,
    /// Nor farther.
    far: f32,
}

/// One line of a list of parts of a tree that a beam meets, about by where they begin.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Parts {
    /// What each is: the word of a [`Step`](nestray_core::technique::Step). Of lists that have a
    /// shade, the first is the leaf with it.
    pub(crate) words: [u32; 8],
    /// Where along the main axis it begins; NaN if there is nothing.
    pub(crate) begin: [f32; 8],
    /// Whether the list goes on in the next line.
    pub(crate) goes_on: bool,
    /// Whether some of the list are subtrees.
    pub(crate) has_trees: bool,
    /// What hides everything behind it from every ray of the beam, if anything does.
    shade: Option<Shade>,
}

/// Parts in one line; in the other two lanes stands what hides, and whether the list goes on.
const LANES: usize = 6;
/// Instead of the number of a child.
const NOTHING: u32 = u32::MAX;

/// Most parts of a list: what a [`Trail`](nestray_core::trail::Trail) has room for beside a tree.
pub(crate) const ROOM: usize = 16;

impl Parts {
    #[inline(always)]
    pub(crate) fn read(line: &Line) -> Self {
        let line = line.words();
        let mut words: [u32; 8] = std::array::from_fn(|lane| line[lane]);
        let mut begin: [f32; 8] = std::array::from_fn(|lane| f32::from_bits(line[8 + lane]));
        let shade = Shade { child: words[LANES], near: begin[LANES], far: begin[LANES + 1] };
        let (goes_on, has_trees) = (words[LANES + 1] & 1 != 0, words[LANES + 1] & 2 != 0);
        (words[LANES], words[LANES + 1]) = (0, 0);
        (begin[LANES], begin[LANES + 1]) = (f32::NAN, f32::NAN);
        Self { words, begin, goes_on, has_trees, shade: (shade.child != NOTHING).then_some(shade) }
    }

    /// As a line that holds it.
    pub(crate) fn line(&self) -> [u32; Line::WORDS] {
        let (mut words, mut begin) = (self.words, self.begin.map(f32::to_bits));
        words[LANES] = NOTHING;
        words[LANES + 1] = u32::from(self.goes_on) | u32::from(self.has_trees) << 1;
        if let Some(shade) = self.shade {
            words[LANES] = shade.child;
            (begin[LANES], begin[LANES + 1]) = (shade.near.to_bits(), shade.far.to_bits());
        }
        std::array::from_fn(|at| if at < 8 { words[at] } else { begin[at - 8] })
    }

    /// Of a list of one leaf or of nothing, which hides nothing: the word of that leaf.
    pub(crate) fn alone(&self) -> Option<Option<u32>> {
        if self.goes_on || self.has_trees || self.shade.is_some() || !self.begin[1].is_nan() {
            return None;
        }
        Some((!self.begin[0].is_nan()).then_some(self.words[0]))
    }

    /// What the list is good for, for a ray over `[from, to]` of the main axis. What is hidden was
    /// left out, so either the ray does not come to it or it meets what hides it: then `nearest`
    /// says whether that is nearer to the ray than what was left out.
    #[inline(always)]
    pub(crate) fn serves(
        &self,
        [from, to]: [f32; 2],
        nearest: bool,
        family: &dyn Family,
        source: &Source,
    ) -> Serves {
        match &self.shade {
            Some(shade) if to > shade.far => {
                // What the ray leaves hides nothing from it.
                if nearest && from <= shade.near && !family.holds(shade.child, source) {
                    Serves::Hidden
                } else {
                    Serves::Nothing
                }
            }
            _ => Serves::All,
        }
    }
}

/// What a list is good for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Serves {
    /// The ray meets nothing that is not in it.
    All,
    /// The same, and it does meet the shade.
    Hidden,
    /// The ray may meet what was left out.
    Nothing,
}

/// The lines of the list of these parts, at most [`ROOM`] of them. Places on the main axis may be
/// off by `slack`.
pub(crate) fn lines(
    forest: &Forest,
    family: &dyn Family,
    beam: &Beam,
    (key, slack): (Key, f32),
    mut parts: Vec<Part>,
) -> Vec<Parts> {
    let sort = |parts: &mut [Part]| {
        parts.sort_by(|a, b| a.begin.total_cmp(&b.begin).then(a.name.cmp(&b.name)));
    };
    sort(&mut parts);
    let found = shade(forest, family, beam, &parts);
    let shade =
        found.map(|(_, shade)| Shade { near: shade.near - slack, far: shade.far + slack, ..shade });
    let leaf = found.map(|(part, _)| parts[part].name);
    if let Some(Shade { far, .. }) = shade {
        parts.retain(|part| part.begin <= far + slack);
    }
    if let Key::Coordinate { axis, backward } = key {
        for part in &mut parts {
            part.begin = forest.coordinate(part.name, axis, backward) - slack;
        }
        sort(&mut parts);
    }
    if let Some(at) = parts.iter().position(|part| Some(part.name) == leaf) {
        parts[..=at].rotate_right(1);
    }
    let has_trees = parts.iter().any(|part| Step::from_word(forest.word(part.name)).is_onward());
    let count = parts.len().div_ceil(LANES).max(1);
    let line = |number: usize| {
        let goes_on = number + 1 < count;
        let (words, begin) = ([0; 8], [f32::NAN; 8]);
        let mut line = Parts { words, begin, goes_on, has_trees, shade };
        for (lane, part) in parts.iter().skip(number * LANES).take(LANES).enumerate() {
            (line.words[lane], line.begin[lane]) = (forest.word(part.name), part.begin);
        }
        line
    };
    (0..count).map(line).collect()
}

/// The child that hides most, and in which part it is.
fn shade(
    forest: &Forest,
    family: &dyn Family,
    beam: &Beam,
    parts: &[Part],
) -> Option<(usize, Shade)> {
    let mut best: Option<(usize, Shade)> = None;
    for (number, part) in parts.iter().enumerate() {
        if best.is_some_and(|(_, best)| part.begin > best.far) {
            break;
        }
        for &child in forest.children(part.name) {
            let Some(far) = family.blocks(child, beam) else { continue };
            if best.is_none_or(|(_, best)| far < best.far)
                && let Some([near, _]) = family.meets(child, beam)
            {
                best = Some((number, Shade { child, near, far }));
            }
        }
    }
    best
}
