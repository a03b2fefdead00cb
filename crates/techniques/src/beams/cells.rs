//! Squares of numbers cut into cells, each of which knows the list of its beam.

use std::sync::atomic::{AtomicI64, Ordering};

use nestray_core::beam::Beam;
use nestray_core::family::Family;
use nestray_core::slot::Slot;

use super::cut::{Forest, Name};
use super::list::{Key, List};

/// How far cells are cut.
#[derive(Clone, Copy, Debug)]
pub struct Limits {
    /// Cells along the side of a square, a power of two.
    pub side: u32,
    /// Cells with longer lists are cut into sixteen.
    pub most: usize,
    /// How often.
    pub depth: u32,
    /// Memory for lists, in bytes.
    pub memory: u64,
}

/// A place in a square: 24 bits along each side.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Address([u32; 2]);

const BITS: u32 = 24;

impl Address {
    /// Of a point in `[0, 1]²`; what is outside or not a number is moved inside.
    #[inline]
    pub(crate) fn new(x: f32, y: f32) -> Self {
        // Casts saturate.
        Self([x, y].map(|x| ((x * (1 << BITS) as f32) as u32).min((1 << BITS) - 1)))
    }

    /// Which of `2^bits` parts along each side it is in.
    #[inline]
    fn part(self, bits: u32) -> [u32; 2] {
        self.0.map(|x| x >> (BITS - bits))
    }
}

/// A cell: part `at` of `2^bits` along each side of its square.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Cell {
    bits: u32,
    at: [u32; 2],
}

impl Cell {
    /// The range of numbers along side `side`, wider than what rounding moves a point.
    pub(crate) fn range(self, side: usize) -> [f32; 2] {
        let width = 1.0 / (1u32 << self.bits) as f32;
        let low = self.at[side] as f32 * width;
        const SLACK: f32 = 4.0 / (1 << BITS) as f32;
        [low - SLACK, low + width + SLACK]
    }
}

/// What a cell knows.
#[derive(Debug)]
enum Known {
    List(List),
    /// It was cut.
    Parts(Box<Parts>),
}

/// A cell that was cut.
#[derive(Debug)]
struct Parts {
    /// What its beam meets, as a cut of the tree.
    cut: Box<[Name]>,
    slots: [Slot<Known>; 16],
}

/// How much memory lists may still take.
#[derive(Debug)]
pub(crate) struct Room {
    left: AtomicI64,
    limits: Limits,
}

impl Room {
    pub(crate) fn new(limits: Limits) -> Self {
        let left = AtomicI64::new(i64::try_from(limits.memory).unwrap_or(i64::MAX));
        Self { left, limits }
    }

    pub(crate) fn limits(&self) -> &Limits {
        &self.limits
    }

    pub(crate) fn take(&self, bytes: usize) {
        self.left.fetch_sub(bytes as i64, Ordering::Relaxed);
    }

    pub(crate) fn is_left(&self) -> bool {
        self.left.load(Ordering::Relaxed) > 0
    }

    /// What was taken.
    pub(crate) fn taken(&self) -> u64 {
        let left = self.left.load(Ordering::Relaxed);
        (i128::from(self.limits.memory) - i128::from(left)).max(0) as u64
    }
}

/// The cells of a square; nothing is there before the first ray comes.
#[derive(Debug, Default)]
pub(crate) struct Cells {
    slots: Slot<Box<[Slot<Known>]>>,
}

/// What lists are made with.
#[derive(Clone, Copy)]
pub(crate) struct Maker<'a> {
    pub(crate) forest: &'a Forest,
    pub(crate) family: &'a dyn Family,
    pub(crate) room: &'a Room,
    /// The rays of a cell.
    pub(crate) beam: &'a dyn Fn(Cell) -> Beam,
    /// What lists are sorted by, and how far places on the main axis may be off.
    pub(crate) key: (Key, f32),
}

impl Cells {
    /// The list of the cell that `address` is in, made if there is none; none while another
    /// thread makes it, or if there is no room for it.
    pub(crate) fn list<'a>(&'a self, address: Address, maker: &Maker<'_>) -> Option<&'a List> {
        let limits = &maker.room.limits;
        let slots = match self.slots.get() {
            Some(slots) => slots,
            None if maker.room.is_left() => self.slots.get_or_make(|| {
                let count = (limits.side * limits.side) as usize;
                maker.room.take(count * size_of::<Slot<Known>>());
                (0..count).map(|_| Slot::new()).collect()
            })?,
            None => return None,
        };
        let mut bits = limits.side.ilog2();
        let at = address.part(bits);
        let mut slot = &slots[(at[1] * limits.side + at[0]) as usize];
        let mut from: Option<&[Name]> = None;
        loop {
            let known = match slot.get() {
                Some(known) => known,
                None if maker.room.is_left() => {
                    slot.get_or_make(|| maker.known(Cell { bits, at: address.part(bits) }, from))?
                }
                None => return None,
            };
            match known {
                Known::List(list) => return Some(list),
                Known::Parts(parts) => {
                    bits += 2;
                    let [x, y] = address.part(bits);
                    from = Some(&parts.cut);
                    slot = &parts.slots[(y % 4 * 4 + x % 4) as usize];
                }
            }
        }
    }
}

/// Most parts of a cut that the cells below begin with.
const BROAD: usize = 64;

impl Maker<'_> {
    /// What there is to know of a cell, all of whose rays meet nothing but `from`.
    fn known(&self, cell: Cell, from: Option<&[Name]>) -> Known {
        let limits = &self.room.limits;
        let beam = (self.beam)(cell);
        let mut cut = self.forest.cut(&beam, from, BROAD);
        if cut.whole.is_empty() {
            self.forest.keep_met(self.family, &beam, &mut cut.leaves);
        }
        let few = cut.whole.is_empty() && cut.count() <= limits.most.min(List::ROOM);
        let deepest = (limits.side.ilog2() + 2 * limits.depth).min(BITS - 6);
        if !few && cell.bits + 2 <= deepest {
            let parts = Box::new(Parts { cut: cut.names(), slots: [const { Slot::new() }; 16] });
            self.room.take(size_of_val(&*parts) + size_of_val::<[Name]>(&parts.cut));
            return Known::Parts(parts);
        }
        if cut.count() > List::ROOM {
            cut = self.forest.cut(&beam, None, List::ROOM);
        }
        let list = List::new(self.forest, self.family, &beam, self.key, cut.into_parts());
        self.room.take(list.bytes());
        Known::List(list)
    }
}
