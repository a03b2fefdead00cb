//! What the rays of a beam may meet.

use nestray_core::beam::Beam;
use nestray_core::family::Family;
use nestray_core::ray::Source;

use super::cut::{Forest, Part};

/// Parts of a tree that a beam meets, by where they begin.
#[derive(Debug)]
pub(crate) struct List {
    lines: Box<[Line]>,
    /// What hides everything behind it from every ray of the beam, if anything does.
    shade: Option<Shade>,
}

/// Eight parts: one line of the cache.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
pub(crate) struct Line {
    /// What each is: the word of a [`Step`](nestray_core::technique::Step).
    pub(crate) words: [u32; 8],
    /// Where along the main axis it begins; NaN if there is nothing.
    pub(crate) begin: [f32; 8],
}

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
struct Shade {
    child: u32,
    /// No ray meets it nearer than that.
    near: f32,
    /// Nor farther.
    far: f32,
}

impl List {
    /// Most lines: what a [`Trail`](nestray_core::trail::Trail) has room for beside a tree.
    pub(crate) const LINES: usize = 2;
    /// Most parts.
    pub(crate) const ROOM: usize = 8 * Self::LINES;

    /// Of these parts, at most [`ROOM`](Self::ROOM) of them. Places on the main axis may be off
    /// by `slack`.
    pub(super) fn new(
        forest: &Forest,
        family: &dyn Family,
        beam: &Beam,
        (key, slack): (Key, f32),
        mut parts: Vec<Part>,
    ) -> Self {
        parts.sort_by(|a, b| a.begin.total_cmp(&b.begin).then(a.name.cmp(&b.name)));
        let shade = shade(forest, family, beam, &parts).map(|shade| Shade {
            near: shade.near - slack,
            far: shade.far + slack,
            ..shade
        });
        if let Some(Shade { far, .. }) = shade {
            parts.retain(|part| part.begin <= far + slack);
        }
        if let Key::Coordinate { axis, backward } = key {
            for part in &mut parts {
                part.begin = forest.coordinate(part.name, axis, backward) - slack;
            }
            parts.sort_by(|a, b| a.begin.total_cmp(&b.begin).then(a.name.cmp(&b.name)));
        }
        let lines = parts.chunks(8).map(|parts| {
            let mut line = Line { words: [0; 8], begin: [f32::NAN; 8] };
            for (lane, part) in parts.iter().enumerate() {
                (line.words[lane], line.begin[lane]) = (forest.word(part.name), part.begin);
            }
            line
        });
        Self { lines: lines.collect(), shade }
    }

    #[inline(always)]
    pub(super) fn lines(&self) -> &[Line] {
        &self.lines
    }

    /// Whether the list will do for a ray over `[from, to]` of the main axis. What is hidden was
    /// left out, so either the ray does not come to it or it meets what hides it: then `nearest`
    /// says whether that is nearer to the ray than what was left out.
    #[inline(always)]
    pub(crate) fn serves(
        &self,
        [from, to]: [f32; 2],
        nearest: bool,
        family: &dyn Family,
        source: &Source,
    ) -> bool {
        match &self.shade {
            // What the ray leaves hides nothing from it.
            Some(shade) if to > shade.far => {
                nearest && from <= shade.near && !family.holds(shade.child, source)
            }
            _ => true,
        }
    }

    pub(crate) fn bytes(&self) -> usize {
        size_of_val::<[Line]>(&self.lines)
    }
}

/// The child that hides most.
fn shade(forest: &Forest, family: &dyn Family, beam: &Beam, parts: &[Part]) -> Option<Shade> {
    let mut best: Option<Shade> = None;
    for part in parts {
        if best.is_some_and(|best| part.begin > best.far) {
            break;
        }
        for &child in forest.children(part.name) {
            let Some(far) = family.blocks(child, beam) else { continue };
            if best.is_none_or(|best| far < best.far)
                && let Some([near, _]) = family.meets(child, beam)
            {
                best = Some(Shade { child, near, far });
            }
        }
    }
    best
}
