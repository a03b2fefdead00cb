//! How leaves are packed.

use nestray_core::huge::Huge;
use nestray_core::names::Names;
use nestray_core::simd::Simd;
use nestray_core::technique::{Leaf, Leaves};

use super::test::Shear;

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
    /// Writes one block of as many of `faces` as fit; says how many did, and the name of
    /// the block.
    fn write(
        vertices: &[[f32; 3]],
        faces: &[[u32; 3]],
        first: u32,
        blocks: &mut Vec<[u32; 8]>,
    ) -> (usize, Leaf);

    /// Loads a block and moves it into the space of the ray.
    fn load<S: Simd>(simd: S, blocks: &Huge<[u32; 8]>, leaf: Leaf, shear: &Shear) -> Block<S>;

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
    pub(super) blocks: Vec<[u32; 8]>,
    pub(super) primitives: Vec<u32>,
    pub(super) leaves: Vec<Leaf>,
}

/// Packs all leaves, each as a chain of blocks, primitives ascending.
pub(super) fn pack<L: Layout>(
    vertices: &[[f32; 3]],
    faces: &[[u32; 3]],
    leaves: &Leaves,
    names: &Names,
) -> Packed {
    let mut packed = Packed { blocks: Vec::new(), primitives: Vec::new(), leaves: Vec::new() };
    for number in 0..leaves.count() {
        let mut children: Vec<u32> =
            leaves.of(number).iter().map(|&child| names.child(child)).collect();
        children.sort_unstable();
        let triangles: Vec<[u32; 3]> = children.iter().map(|&c| faces[c as usize]).collect();
        let mut done = 0;
        let mut previous = None;
        while done < triangles.len() {
            let first = packed.primitives.len() as u32;
            let (count, leaf) = L::write(vertices, &triangles[done..], first, &mut packed.blocks);
            packed.primitives.extend_from_slice(&children[done..done + count]);
            match previous {
                None => packed.leaves.push(leaf),
                Some(before) => packed.blocks[L::place(before)][7] = leaf.0,
            }
            previous = Some(leaf);
            done += count;
        }
    }
    packed
}
