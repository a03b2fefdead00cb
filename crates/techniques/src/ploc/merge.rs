//! Rounds of merging: each cluster finds its nearest in a window along the curve, and those
//! that find each other become one [Meister 18].

use nestray_core::aabb::Aabb;
use rayon::prelude::*;

use crate::wide_tree::{Contents, area};

/// A round that merges fewer than one in this many clusters is helped: each that is left over
/// merges with the next that is. No input takes more than a few hundred rounds.
const FEW: usize = 32;

/// Fewer clusters are not worth sharing between threads.
const SHARED: usize = 4096;

/// Children merged so far: a name, and a box around all of them.
#[derive(Clone, Copy)]
struct Cluster {
    name: u32,
    bounds: Aabb,
}

/// All merges, in order; see [`Binary::merged`](crate::wide_tree::Binary::merged).
pub(super) fn merges(of: &Contents, window: usize) -> Vec<[u32; 2]> {
    let children = of.boxes.len();
    let mut clusters: Vec<Cluster> = along_curve(of)
        .into_iter()
        .map(|child| Cluster { name: child, bounds: of.boxes[child as usize] })
        .collect();
    let mut merges = Vec::with_capacity(children);
    while clusters.len() > 1 {
        let nearest: Vec<u32> = (0..clusters.len())
            .into_par_iter()
            .with_min_len(SHARED)
            .map(|i| nearest(&clusters, i, window))
            .collect();
        let mut next = Vec::with_capacity(clusters.len());
        let mut join = |a: Cluster, b: Cluster| {
            merges.push([a.name, b.name]);
            let name = (children + merges.len() - 1) as u32;
            Cluster { name, bounds: a.bounds.join(b.bounds) }
        };
        let partner = |i: usize| {
            let other = nearest[i] as usize;
            (nearest[other] as usize == i).then_some(other)
        };
        let pairs = (0..clusters.len()).filter(|&i| partner(i).is_some()).count() / 2;
        let help = pairs * FEW < clusters.len();
        let mut left_over: Option<usize> = None;
        for (i, &cluster) in clusters.iter().enumerate() {
            match partner(i) {
                Some(other) if i < other => next.push(join(cluster, clusters[other])),
                Some(_) => {}
                None if help => match left_over.take() {
                    Some(at) => next[at] = join(next[at], cluster),
                    None => {
                        left_over = Some(next.len());
                        next.push(cluster);
                    }
                },
                None => next.push(cluster),
            }
        }
        clusters = next;
    }
    merges
}

/// The cluster in the window with which `i` has the smallest joint box. Of equal ones that with
/// the number most like `i`, so that many at one place pair up all at once.
fn nearest(clusters: &[Cluster], i: usize, window: usize) -> u32 {
    let bounds = clusters[i].bounds;
    let from = i.saturating_sub(window);
    let to = (i + window + 1).min(clusters.len());
    let mut best = (f64::INFINITY, usize::MAX);
    for j in (from..to).filter(|&j| j != i) {
        let candidate = (area(bounds.join(clusters[j].bounds)), i ^ j);
        if candidate.0 < best.0 || (candidate.0 == best.0 && candidate.1 < best.1) {
            best = candidate;
        }
    }
    (i ^ best.1) as u32
}

/// The children along a curve that stays near where it is [Morton 66].
fn along_curve(of: &Contents) -> Vec<u32> {
    /// Cells along each axis, less one.
    const CELLS: f64 = ((1 << 21) - 1) as f64;
    let all = of.boxes.iter().fold(Aabb::EMPTY, |all, &bounds| all.join(bounds));
    let low = all.min.as_dvec3();
    let size = (all.max.as_dvec3() - low).max_element().max(f64::MIN_POSITIVE);
    let mut keyed: Vec<(u64, u32)> = (0..of.boxes.len() as u32)
        .into_par_iter()
        .with_min_len(SHARED)
        .map(|child| {
            let bounds = of.boxes[child as usize];
            let center = (bounds.min.as_dvec3() + bounds.max.as_dvec3()) * 0.5;
            let cell = (center - low) / size * CELLS;
            (spread(cell.x) | spread(cell.y) << 1 | spread(cell.z) << 2, child)
        })
        .collect();
    keyed.par_sort_unstable();
    keyed.into_iter().map(|(_, child)| child).collect()
}

/// The lowest 21 bits of a cell, two places free after each.
fn spread(cell: f64) -> u64 {
    let mut bits = cell as u64 & 0x1f_ffff;
    bits = (bits | bits << 32) & 0x1f_0000_0000_ffff;
    bits = (bits | bits << 16) & 0x1f_0000_ff00_00ff;
    bits = (bits | bits << 8) & 0x100f_00f0_0f00_f00f;
    bits = (bits | bits << 4) & 0x10c3_0c30_c30c_30c3;
    (bits | bits << 2) & 0x1249_2492_4924_9249
}

#[cfg(test)]
mod tests {
    use glam::Vec3A;
    use nestray_core::huge::Huge;

    use super::*;

    fn contents(centers: impl Iterator<Item = Vec3A>) -> Contents {
        let boxes: Vec<Aabb> =
            centers.map(|center| Aabb { min: center, max: center + 1e-3 }).collect();
        let weights = vec![1.0; boxes.len()];
        Contents { weights, boxes: Huge::new(&boxes, 0), together: 1 }
    }

    fn check(of: &Contents) -> Vec<[u32; 2]> {
        let merges = merges(of, 4);
        let (children, mut seen) = (of.boxes.len(), vec![false; 2 * of.boxes.len() - 1]);
        assert_eq!(merges.len(), children - 1);
        for (merge, at) in merges.iter().zip(children..) {
            for &side in merge {
                assert!((side as usize) < at, "made of what was there");
                assert!(!std::mem::replace(&mut seen[side as usize], true), "{side} twice");
            }
        }
        merges
    }

    #[test]
    fn bits_are_spread_to_every_third_place() {
        for bit in 0..21 {
            assert_eq!(spread((1u64 << bit) as f64), 1 << (3 * bit));
        }
        assert_eq!(spread(2_097_151.0), 0x1249_2492_4924_9249);
    }

    #[test]
    fn groups_merge_when_all_of_each_is_one_cluster() {
        let group = |i: u16| Vec3A::splat(f32::from(i / 8) * 10.0 + f32::from(i % 8) * 0.1);
        let of = contents((0..64).map(group));
        // Which group the first child is of, and how many there are.
        let mut clusters: Vec<(u32, u32)> = (0..64).map(|i| (i / 8, 1)).collect();
        for [a, b] in check(&of) {
            let (a, b) = (clusters[a as usize], clusters[b as usize]);
            let whole = a.1 % 8 == 0 && b.1 % 8 == 0;
            assert!(a.0 == b.0 || whole, "{a:?} and {b:?}");
            clusters.push((a.0, a.1 + b.1));
        }
    }

    #[test]
    fn clustering_ends_soon_whatever_comes() {
        check(&contents(std::iter::repeat_n(Vec3A::ONE, 100_000)));
        // Each is nearest to the one before.
        check(&contents((0..20_000u16).map(|i| Vec3A::X * f32::from(i) * f32::from(i))));
        let doubling = (0..100u32).map(|i| Vec3A::splat(f32::from_bits((77 + i) << 23)));
        check(&contents(doubling));
    }
}
