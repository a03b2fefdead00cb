//! How leaves are packed.

use std::ops::Range;

use nestray_core::dispatch;
use nestray_core::huge::Huge;
use nestray_core::simd::{Level, Simd};
use nestray_core::technique::{Leaf, Leaves};
use rayon::prelude::*;

use super::bodies::Bodies;
use super::shear::Shear;
use super::triangles::Triangles;

/// Depths of up to 16 shared vertices, and which of them each corner of each triangle is.
pub(super) type Depths<S> = ([<S as Simd>::F32; 2], [[u8; 8]; 3]);

/// A block as loaded: up to eight triangles in the space of the ray.
#[derive(Clone, Copy)]
#[expect(missing_debug_implementations, reason = "registers")]
pub struct Block<S: Simd> {
    /// Corners of the triangles: x, y, and z where it is known already.
    pub(super) corners: [[S::F32; 3]; 3],
    /// Depths of shared vertices, still to be picked, and by which indices.
    pub(super) shared: Option<Depths<S>>,
    /// Lanes in use.
    pub(super) lanes: u32,
    /// Place of the first triangle in the table of primitives.
    pub(super) first: u32,
    /// The rest of the leaf.
    pub(super) next: Option<Leaf>,
}

/// A way to pack a leaf of triangles into blocks of at most eight.
pub trait Layout: Clone + Send + Sync + 'static {
    /// How many lines a leaf can tell apart.
    const MOST_LINES: usize;

    /// Writes one block of as many triangles as fit, given by their corners; says how many did,
    /// and the name of the block.
    fn write<S: Simd>(
        simd: S,
        triangles: &[[[f32; 3]; 3]],
        first: u32,
        blocks: &mut Vec<[u32; 8]>,
    ) -> (usize, Leaf);

    /// Loads a block and moves it into the space of the ray.
    fn load<S: Simd>(simd: S, blocks: &Huge<[u32; 8]>, leaf: Leaf, shear: &Shear) -> Block<S>;

    /// How many vertices the block called `leaf` has.
    fn vertices(leaf: Leaf) -> usize;

    /// Where the vertices of a block are, one after the other.
    fn places<'a>(blocks: &'a Huge<[u32; 8]>, leaf: Leaf) -> impl Iterator<Item = [f32; 3]> + 'a;

    /// Which vertices the corners of a triangle of a block are, given its first line.
    fn corners(header: &[u32; 8], leaf: Leaf, triangle: usize) -> [usize; 3];

    /// Depths of the three corners.
    fn depths<S: Simd>(simd: S, block: &Block<S>) -> [S::F32; 3];

    /// Where a block begins.
    fn address(blocks: &Huge<[u32; 8]>, leaf: Leaf) -> *const u8;

    /// How many triangles the block called `leaf` holds.
    fn len(leaf: Leaf) -> usize {
        (leaf.0 >> 28) as usize + 1
    }

    /// Where in the blocks the block called `leaf` begins.
    fn place(leaf: Leaf) -> usize;
}

/// In the last word of a block's first line: no block follows.
pub(super) const LAST: u32 = u32::MAX;

pub(super) struct Packed {
    pub(super) blocks: Huge<[u32; 8]>,
    pub(super) numbers: Huge<u32>,
    pub(super) leaves: Vec<Leaf>,
}

/// Some leaves in a row, as if they were the first.
#[derive(Default)]
struct Piece {
    blocks: Vec<[u32; 8]>,
    numbers: Vec<u32>,
    leaves: Vec<Leaf>,
}

/// Packs all leaves, each as a chain of blocks, triangles ascending, by all cores; `number` says
/// which a child is.
pub(super) fn pack<L: Layout>(
    bodies: &Bodies,
    number: &(impl Fn(u32) -> u32 + Sync),
    leaves: &Leaves,
) -> Packed {
    /// Leaves that one thread packs.
    const CHUNK: usize = 512;
    let mut pieces: Vec<Piece> = (0..leaves.count().div_ceil(CHUNK))
        .into_par_iter()
        .map(|chunk| {
            let range = chunk * CHUNK..((chunk + 1) * CHUNK).min(leaves.count());
            dispatch!(Level::best(), simd =>
                Piece::new::<_, L>(simd, bodies, number, leaves, range))
        })
        .collect();
    let (mut begin, mut lines, mut first) = (Vec::new(), 0, 0);
    for piece in &pieces {
        begin.push((lines as u32, first as u32));
        (lines, first) = (lines + piece.blocks.len(), first + piece.numbers.len());
    }
    assert!(lines <= L::MOST_LINES, "no more packed triangles per mesh than a leaf can name");
    let places = pieces.par_iter_mut().zip(begin);
    places.for_each(|(piece, (line, first))| piece.place::<L>(line, first));
    let blocks: Vec<&[[u32; 8]]> = pieces.iter().map(|piece| &piece.blocks[..]).collect();
    let numbers: Vec<&[u32]> = pieces.iter().map(|piece| &piece.numbers[..]).collect();
    Packed {
        // A full set of lanes may be read past the last block.
        blocks: Huge::joined(&blocks, 256),
        numbers: Huge::joined(&numbers, 32),
        leaves: pieces.iter().flat_map(|piece| piece.leaves.iter().copied()).collect(),
    }
}

impl Piece {
    #[inline(always)]
    fn new<S: Simd, L: Layout>(
        simd: S,
        bodies: &Bodies,
        number: &impl Fn(u32) -> u32,
        leaves: &Leaves,
        range: Range<usize>,
    ) -> Self {
        let mut piece = Self::default();
        for leaf in range.clone() {
            let first = piece.numbers.len();
            piece.numbers.extend(leaves.of(leaf).iter().map(|&child| number(child)));
            piece.numbers[first..].sort_unstable();
        }
        // All at once: they come from anywhere, and none waits for the one before.
        let faces: Vec<(&Triangles, [u32; 3])> =
            piece.numbers.iter().map(|&i| bodies.face(i)).collect();
        let corners: Vec<[[f32; 3]; 3]> = faces
            .iter()
            .map(|(of, face)| face.map(|vertex| of.positions[vertex as usize]))
            .collect();
        let mut first = 0;
        for leaf in range {
            let end = first + leaves.of(leaf).len();
            let mut previous = None;
            while first < end {
                let rest = &corners[first..end];
                let (count, leaf) = L::write(simd, rest, first as u32, &mut piece.blocks);
                match previous {
                    None => piece.leaves.push(leaf),
                    Some(before) => piece.blocks[L::place(before)][7] = leaf.0,
                }
                (previous, first) = (Some(leaf), first + count);
            }
        }
        piece
    }

    /// Moves it to where it begins in the whole.
    fn place<L: Layout>(&mut self, line: u32, first: u32) {
        for leaf in &mut self.leaves {
            let mut next = leaf.0;
            while next != LAST {
                let header = &mut self.blocks[L::place(Leaf(next))];
                header[6] += first;
                next = header[7];
                if next != LAST {
                    header[7] += line;
                }
            }
            leaf.0 += line;
        }
    }
}
