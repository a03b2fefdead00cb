//! How an acceleration technique leads rays.

use std::fmt::Debug;

use crate::family::Family;
use crate::packet::{Packet, Pencil};
use crate::ray::{Ray, RayKind};
use crate::simd::Simd;
use crate::technique::{Leaf, Leaves, Step};
use crate::trail::{Top, Trail};

/// What a technique makes: an index over boxes that yields, for a ray, the
/// children worth testing, roughly nearest first.
///
/// An index never sees an object, a hit or a material, and it never runs a loop of
/// its own: it says where one ray stands ([`Cursor`](Self::Cursor)) and how that ray
/// moves by one node or cell. The loops are written once, in [`accel`](crate::accel): one
/// ray at a time, or many in flight at once.
///
/// `start`, `step`, `resume`, `address`, `visit` and `listed` must be `#[inline(always)]`:
/// only then are they compiled for the vector instructions of `simd`.
pub trait Index: Debug + Send + Sync + Sized + 'static {
    /// Whether one child may stand in several leaves, and who sees to it that it is tested
    /// once.
    const REPEATS: Repeats;

    /// In how many leaves a child stands at most, on average, unless the technique says
    /// otherwise.
    const COPIES: usize = if matches!(Self::REPEATS, Repeats::Never) { 1 } else { 8 };

    /// Whether leaves are listed by the technique itself, while rays fly ([`listed`]), and
    /// not pushed when it is built. For techniques that refine themselves lazily.
    ///
    /// [`listed`]: Self::listed
    const LISTS: bool = false;

    /// Whether [`step`](Self::step) may say [`Step::HIT`], to a [`Query`] for any hit.
    const TELLS: bool = false;

    /// Whether it can lead packets of rays ([`lead_in`](Self::lead_in)).
    const LEADS: bool = false;

    /// Up to so many rays of a packet go on alone from where it is; see [`part`](Self::part).
    const FEW: u32 = 0;

    /// Where one ray stands, but for what it has put off ([`Trail`]): plain numbers, best
    /// within 48 bytes, so that it stays in registers or in one cache line.
    type Cursor: Copy + Default + Send;

    /// What a uniformly random ray that meets the joint bounds is expected to do. Asked
    /// once, right after it was built.
    fn expected(&self, family: &dyn Family, leaves: &Leaves) -> Expected;

    /// Replaces every leaf, numbered in the order pushed, by `leaves[number]`.
    fn rename_leaves(&mut self, leaves: &[Leaf]);

    /// Memory in use.
    fn bytes(&self) -> u64;

    /// Places a ray at the beginning.
    fn start<S: Simd>(&self, simd: S, walk: &mut Walk<'_>, limit: f32) -> (Self::Cursor, Step);

    /// Whether it leads packets of rays of this kind.
    #[inline(always)]
    fn leads(&self, _kind: RayKind) -> bool {
        Self::LEADS
    }

    /// Whether it may lead a packet to the same child more than once.
    #[inline(always)]
    fn leads_again(&self) -> bool {
        !matches!(Self::REPEATS, Repeats::Never)
    }

    /// Places a packet at the beginning; none if its rays do better apart.
    #[inline(always)]
    fn lead_in<S: Simd>(&self, _simd: S, _packet: &mut Packet, _trail: &mut Trail) -> Option<Lead> {
        None
    }

    /// Leads a packet to the next leaf that any of its rays may meet within its limit. As a ray
    /// that goes alone, each must be shown all of them in the end.
    #[inline(always)]
    fn lead_on<S: Simd>(
        &self,
        _simd: S,
        _packet: &Packet,
        _trail: &mut Trail,
        _lead: &mut Lead,
    ) -> Led {
        Led::Apart
    }

    /// Where one ray of a packet stands that goes on alone from where the packet is: nothing is
    /// put off. Of an index with [`FEW`](Self::FEW).
    #[inline(always)]
    fn part(&self, _packet: &Packet, _ray: usize, _trail: &mut Trail) -> Self::Cursor {
        Self::Cursor::default()
    }

    /// Moves a ray that stands at the node or cell `at` by one. It may be shown any leaf that
    /// begins within `[ray.t_min, limit]`, and must be shown all of them in the end; one that
    /// begins exactly *at* the limit counts.
    fn step<S: Simd, Q: Query>(
        &self,
        simd: S,
        walk: &mut Walk<'_>,
        cursor: &mut Self::Cursor,
        at: Step,
        limit: f32,
    ) -> Step;

    /// Goes on after a leaf was tested; the limit may have shrunk.
    fn resume<S: Simd, Q: Query>(
        &self,
        simd: S,
        walk: &mut Walk<'_>,
        cursor: &mut Self::Cursor,
        limit: f32,
    ) -> Step;

    /// What the next [`step`](Self::step) reads first; to fetch early, never to read.
    /// Called for leaves too, with no matter what answer.
    fn address(&self, cursor: &Self::Cursor, at: Step) -> *const u8;

    /// Whether `child`, shown in the leaf the ray stands at, was shown before. Asked if
    /// the technique [`REPEATS`](Self::REPEATS) by rule.
    #[inline(always)]
    fn visit(&self, _cursor: &Self::Cursor, _child: u32) -> Visit {
        Visit::First
    }

    /// The children of a leaf, if the technique [`LISTS`](Self::LISTS) them itself.
    #[inline(always)]
    fn listed(&self, _cursor: &Self::Cursor, _leaf: Leaf) -> &[u32] {
        &[]
    }
}

/// Where a packet stands, but for what it has put off.
#[derive(Clone, Copy, Debug)]
pub struct Lead {
    /// The beam of its rays.
    pub pencil: Pencil,
    /// What it has put off.
    pub top: Top,
    /// How many moves are left until its rays do better apart.
    pub left: u32,
    /// Up to so many rays go on alone from where they are.
    pub few: u32,
}

/// What a packet comes to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Led {
    /// A leaf, and the rays that may meet it.
    Leaf(Leaf, u32),
    /// A node or cell that these few rays go on from alone.
    Alone(Step, u32),
    /// Nothing any more.
    Done,
    /// Too much: its rays do better apart, from the beginning.
    Apart,
}

/// What surrounds a ray at every move.
#[expect(missing_debug_implementations, reason = "lives for one move")]
pub struct Walk<'a> {
    /// The ray.
    pub ray: &'a Ray,
    /// What it has put off.
    pub trail: &'a mut Trail,
    /// The children, for techniques that refine themselves.
    pub family: &'a dyn Family,
}

/// Who sees to it that a child that stands in several leaves is tested once.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Repeats {
    /// Nobody has to: each child stands in one leaf.
    Never,
    /// The technique can tell from where the ray stands ([`Index::visit`]).
    ByRule,
    /// The aggregate keeps a [`Mailbox`](crate::mailbox::Mailbox).
    Anywhere,
}

/// Whether a child was shown before.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Visit {
    /// It was not.
    First,
    /// It was.
    Again,
    /// The rule does not hold for this ray: ask a mailbox.
    Unknown,
}

/// What is asked, and how many rays are in flight: known when the loops are compiled.
pub trait Query: Copy {
    /// Any hit will do, so leaves may come in any order.
    const ANY: bool;
    /// Many rays take turns: no branch is predictable, so prefer code without.
    const MANY: bool;
    /// Every hit is wanted, so nothing may be left out because something hides it.
    const ALL: bool = false;
}

/// A [`Query`].
#[derive(Clone, Copy, Debug)]
pub struct Asks<const ANY: bool, const MANY: bool>;

impl<const ANY: bool, const MANY: bool> Query for Asks<ANY, MANY> {
    const ANY: bool = ANY;
    const MANY: bool = MANY;
}

/// A [`Query`] for every hit of one ray.
#[derive(Clone, Copy, Debug)]
pub struct Every;

impl Query for Every {
    const ANY: bool = true;
    const MANY: bool = false;
    const ALL: bool = true;
}

/// What one random ray is expected to do in an index.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Expected {
    /// Steps of the technique itself (nodes, cells).
    pub steps: f64,
    /// Expected tests of each child, one entry per box.
    pub tests: Vec<f32>,
}
