//! Cells of rays, each of which knows the list of its beam.
//!
//! All that is known is words in an [`Arena`]. The word of a cell says whether it was cut, and in
//! which line the words of its sixteen parts are; or in which line its list begins. The first ray
//! that comes to a cell makes what there is to know, and others that come meanwhile do without.

use std::sync::atomic::{AtomicU32, Ordering};

use nestray_core::beam::Beam;
use nestray_core::family::Family;

use super::arena::{Arena, Line};
use super::cut::{Forest, Name};
use super::list::{self, Key, Parts};
use super::path::{Cell, Path};

/// How far cells are cut.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Limits {
    /// How often a root is halved at once, up to [`FIRST`](Self::FIRST).
    pub(crate) first: u32,
    /// How often what is crowded is cut into sixteen after that.
    pub(crate) depth: u32,
    /// Cells with longer lists are crowded.
    pub(crate) most: usize,
    /// Most such cuts in a row that do not pay.
    pub(crate) idle: u32,
    /// Memory for lists, in bytes.
    pub(crate) memory: u64,
}

impl Limits {
    /// Most halves that a root is cut in at once.
    pub(crate) const FIRST: u32 = (Arena::AT_ONCE * Line::WORDS as u32).ilog2();
}

/// All cells of some roots.
#[derive(Debug)]
pub(crate) struct Cells {
    arena: Arena,
    /// What is known of each: a word.
    roots: Box<[AtomicU32]>,
    limits: Limits,
}

/// Where the word of a cell is: a line, and which of its words.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Place(pub(crate) u32);

impl Place {
    /// Greater than any.
    pub(crate) const END: u32 = Arena::LINES * Line::WORDS as u32;

    #[inline(always)]
    fn new(line: u32, word: u32) -> Self {
        Self(line * Line::WORDS as u32 + word)
    }

    #[inline(always)]
    fn line(self) -> u32 {
        self.0 / Line::WORDS as u32
    }
}

/// Where it goes on from a cell.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Next {
    /// In a part of it.
    Cell(Place),
    /// In its list, which begins in this line.
    List(u32),
    /// In the leaf with this word, all that is in its list.
    Leaf(u32),
    /// Nowhere: its rays meet nothing.
    Done,
    /// There is no list.
    Nowhere,
    /// Nothing is known yet.
    Unknown,
}

/// Nobody has begun.
const EMPTY: u32 = 0;
/// Somebody is making it, or there is no room.
const NOTHING: u32 = 1;
/// Its rays meet nothing.
const FREE: u32 = 2;
/// With a line: of the words of its parts, then of its [`Above`].
const PARTS: u32 = 1 << 29;
/// With a line: of its list.
const LIST: u32 = 2 << 29;
/// From here on: the word of a leaf.
const LEAF: u32 = 4 << 29;
/// What kind of word it is, if not of a leaf.
const KIND: u32 = 3 << 29;

const _: () = assert!(Arena::LINES <= PARTS, "numbers of lines leave room for kinds");

/// What cells are made of.
pub(crate) struct Maker<'a> {
    pub(crate) forest: &'a Forest,
    pub(crate) family: &'a dyn Family,
    /// The rays of a cell, what lists are sorted by, and how far places on the main axis may be
    /// off.
    pub(crate) beam: &'a dyn Fn(Cell) -> (Beam, Key, f32),
}

/// What a cell that was cut says to its parts.
struct Above {
    /// Cuts on the way here since lists last became much shorter.
    idle: u32,
    /// What its beam meets, as a cut of the tree.
    cut: Vec<Name>,
}

impl Cells {
    pub(crate) fn new(roots: usize, limits: Limits) -> Self {
        let roots = (0..roots).map(|_| AtomicU32::new(EMPTY)).collect();
        let first = limits.first.min(Limits::FIRST);
        Self { arena: Arena::new(limits.memory), roots, limits: Limits { first, ..limits } }
    }

    /// Gives up what was made so far: leaves are about to be called otherwise.
    pub(crate) fn forget(&mut self) {
        *self = Self::new(self.roots.len(), self.limits);
    }

    pub(crate) fn bytes(&self) -> u64 {
        self.arena.bytes() + size_of_val(&*self.roots) as u64
    }

    /// How often roots are halved at once.
    pub(crate) fn first(&self) -> u32 {
        self.limits.first
    }

    /// Most halves on the way to a cell.
    pub(crate) fn deepest(&self) -> u32 {
        self.limits.first + 4 * self.limits.depth
    }

    /// Where a line is.
    #[inline(always)]
    pub(crate) fn address(&self, line: u32) -> *const u8 {
        self.arena.address(line)
    }

    /// Where a place is; to fetch early.
    #[inline(always)]
    pub(crate) fn address_of(&self, place: Place) -> *const u8 {
        self.arena.address(place.line())
    }

    /// A line of a list.
    #[inline(always)]
    pub(crate) fn line(&self, line: u32) -> &Line {
        self.arena.line(line)
    }

    /// The cell that `path` leads to from a root.
    #[inline(always)]
    pub(crate) fn enter(&self, root: u32, path: Path) -> Option<Place> {
        let word = &self.roots[root as usize];
        let known = match word.load(Ordering::Acquire) {
            EMPTY => self.make(word, || self.taken(PARTS, &self.empty_root())),
            known => known,
        };
        let at = path.first(self.limits.first);
        (known & KIND == PARTS).then(|| Place::new(known & !KIND, at))
    }

    /// What is known of the cell at `place`, to which `bits` of a path lead; `rest` is what
    /// follows in the path.
    #[inline(always)]
    pub(crate) fn next(&self, place: Place, rest: Path) -> Next {
        let known = self.word(place).load(Ordering::Acquire);
        match known {
            EMPTY => Next::Unknown,
            NOTHING => Next::Nowhere,
            FREE => Next::Done,
            LEAF.. => Next::Leaf(known),
            _ if known & KIND == PARTS => Next::Cell(Place::new(known & !KIND, rest.first(4))),
            _ => Next::List(known & !KIND),
        }
    }

    #[inline(always)]
    fn word(&self, place: Place) -> &AtomicU32 {
        self.arena.line(place.line()).word(place.0 as usize % Line::WORDS)
    }

    /// Makes what there is to know of the cell at `place`, if nobody has begun to.
    #[cold]
    pub(crate) fn know(&self, place: Place, cell: Cell, maker: &Maker<'_>) {
        self.make(self.word(place), || {
            let above = (cell.bits() > self.limits.first).then(|| self.above(place.line()));
            self.known(cell, above, maker)
        });
    }

    /// Stores what `known` says, or that there is nothing to know.
    #[cold]
    fn make(&self, word: &AtomicU32, known: impl FnOnce() -> Option<u32>) -> u32 {
        let begun = word.compare_exchange(EMPTY, NOTHING, Ordering::Relaxed, Ordering::Relaxed);
        if begun.is_err() || self.arena.is_full() {
            return NOTHING;
        }
        let known = known();
        // Without room nothing is ever known; if others just make some, the next ray tries.
        let known = known.unwrap_or(if self.arena.is_full() { NOTHING } else { EMPTY });
        word.store(known, Ordering::Release);
        known
    }

    /// The words of all cells of a root, about which nothing is known.
    fn empty_root(&self) -> Vec<[u32; Line::WORDS]> {
        vec![[EMPTY; Line::WORDS]; (1usize << self.limits.first).div_ceil(Line::WORDS)]
    }

    /// Puts lines into memory that nobody else knows of yet; which kind they are and where.
    fn taken(&self, kind: u32, lines: &[[u32; Line::WORDS]]) -> Option<u32> {
        let first = self.arena.take(lines.len() as u32)?;
        for (number, words) in (first..).zip(lines) {
            let line = self.arena.line(number);
            for (at, &word) in words.iter().enumerate() {
                line.word(at).store(word, Ordering::Relaxed);
            }
        }
        Some(kind | first)
    }
}

/// So many times more leaves than a list may have are looked at closely.
const HOPE: usize = 6;
/// Most parts of a cut that the cells below begin with.
const BROAD: usize = 64;

impl Cells {
    /// What there is to know of a cell, all of whose rays meet nothing but what the cell above
    /// says.
    fn known(&self, cell: Cell, above: Option<Above>, maker: &Maker<'_>) -> Option<u32> {
        let (beam, key, slack) = (maker.beam)(cell);
        let Maker { forest, family, .. } = *maker;
        let mut cut = forest.cut(&beam, above.as_ref().map(|above| &*above.cut), BROAD);
        let is_last = cell.bits() >= self.deepest();
        // With many more there is no hope that few are left.
        if cut.whole.is_empty() && (is_last || cut.count() <= HOPE * self.limits.most) {
            forest.keep_met(family, &beam, &mut cut.leaves);
        }
        let few = cut.whole.is_empty() && cut.count() <= self.limits.most.min(list::ROOM);
        let idle = above.map_or(0, |above| {
            let much = !cut.whole.is_empty() || 4 * cut.count() <= 3 * above.cut.len();
            if much { 0 } else { above.idle + 1 }
        });
        if !few && !is_last && idle < self.limits.idle {
            return self.taken(PARTS, &Above { idle, cut: cut.names() }.lines());
        }
        if cut.count() > list::ROOM {
            cut = forest.cut(&beam, None, list::ROOM);
        }
        match &list::lines(forest, family, &beam, (key, slack), cut.into_parts())[..] {
            [line] if let Some(word) = line.alone() => Some(word.unwrap_or(FREE)),
            lines => self.taken(LIST, &lines.iter().map(Parts::line).collect::<Vec<_>>()),
        }
    }

    /// What the cell whose parts are in a line said.
    fn above(&self, line: u32) -> Above {
        let word = |at: usize| {
            let line = self.arena.line(line + 1 + (at / Line::WORDS) as u32);
            line.word(at % Line::WORDS).load(Ordering::Relaxed)
        };
        let count = word(0) as usize;
        Above { idle: word(1), cut: (0..count).map(|at| Name::from_word(word(2 + at))).collect() }
    }
}

impl Above {
    /// The words of sixteen parts about which nothing is known, and then what it says.
    fn lines(&self) -> Vec<[u32; Line::WORDS]> {
        let names = self.cut.iter().map(|name| name.word());
        let says: Vec<u32> = [self.cut.len() as u32, self.idle].into_iter().chain(names).collect();
        let mut lines = vec![[EMPTY; Line::WORDS]];
        lines.extend(says.chunks(Line::WORDS).map(|words| {
            let mut line = [0; Line::WORDS];
            line[..words.len()].copy_from_slice(words);
            line
        }));
        lines
    }
}
