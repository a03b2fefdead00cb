//! The tree while it grows.
//!
//! Every volume and every child has a box that costs one test, so a volume costs its area times the
//! number of boxes in it; what testing the children themselves costs does not depend on where
//! they stand. The places for a child are looked through from the one that promises most on, and
//! given up where even a perfect fit would cost more than the best place found.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use nestray_core::aabb::Aabb;

use crate::wide_tree::area;

/// Most boxes in one volume.
const ROOM: usize = 8;

/// A tree of volumes over the children seen so far. Volume `i` is called `children + i`.
pub(super) struct Grown<'a> {
    boxes: &'a [Aabb],
    volumes: Vec<Volume>,
    /// A volume or a child; none while there is nothing.
    root: Option<u32>,
    visits: usize,
    /// Volumes still to be looked into; kept for its memory.
    open: BinaryHeap<Reverse<Open>>,
}

#[derive(Clone)]
struct Volume {
    bounds: Aabb,
    /// Volumes and children, by name.
    parts: [u32; ROOM],
    count: u8,
    /// A name; none at the root.
    parent: Option<u32>,
}

/// A volume to look into: by how much the cost grows at least, how late it was found, which one
/// it is, and by how much the cost grows down to it. Costs are bits: not negative, they sort alike.
type Open = (u64, u32, u32, u64);

/// Where a child may go.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Place {
    /// Into a volume.
    In(u32),
    /// Into a new volume, together with a volume or child that stands in the second volume.
    With(u32, Option<u32>),
}

impl<'a> Grown<'a> {
    pub(super) fn new(boxes: &'a [Aabb], visits: usize) -> Self {
        Self { boxes, volumes: Vec::new(), root: None, visits, open: BinaryHeap::new() }
    }

    /// Puts a child where the cost grows least.
    pub(super) fn insert(&mut self, child: u32) {
        let Some(root) = self.root else {
            self.root = Some(child);
            return;
        };
        let (place, _) = self.best(root, self.boxes[child as usize]);
        self.put(place, child);
    }

    fn put(&mut self, place: Place, child: u32) {
        match place {
            Place::In(name) => {
                let volume = &mut self.volumes[name as usize - self.boxes.len()];
                volume.parts[usize::from(volume.count)] = child;
                volume.count += 1;
                self.widen(Some(name), self.boxes[child as usize]);
            }
            Place::With(part, parent) => self.pair(part, parent, child),
        }
    }

    /// Expected box tests of a ray that meets the root [Goldsmith 87].
    pub(super) fn cost(&self) -> f64 {
        let root = self.root.map_or(1.0, |root| area(self.bounds(root)).max(f64::MIN_POSITIVE));
        self.whole() / root
    }

    /// The same, times the area of the root.
    fn whole(&self) -> f64 {
        let one = |volume: &Volume| area(volume.bounds) * f64::from(volume.count);
        self.volumes.iter().map(one).sum()
    }

    /// The best place below `root`, and by how much the cost grows there.
    fn best(&mut self, root: u32, bounds: Aabb) -> (Place, f64) {
        let fit = area(bounds);
        let mut best = (Place::With(root, None), f64::INFINITY);
        let mut found = 0;
        self.open.clear();
        self.look(root, None, (bounds, fit, 0.0), &mut best, &mut found);
        for _ in 0..self.visits {
            let Some(Reverse((least, _, name, growth))) = self.open.pop() else { break };
            if f64::from_bits(least) >= best.1 {
                break;
            }
            let growth = f64::from_bits(growth);
            let volume = &self.volumes[name as usize - self.boxes.len()];
            let here = growth + area(volume.bounds.join(bounds));
            if usize::from(volume.count) < ROOM && here < best.1 {
                best = (Place::In(name), here);
            }
            let (parts, count) = (volume.parts, usize::from(volume.count));
            for &part in &parts[..count] {
                self.look(part, Some(name), (bounds, fit, growth), &mut best, &mut found);
            }
        }
        best
    }

    /// Looks at a part of `parent`: it may make a pair with what has `bounds`, or be looked
    /// into later.
    fn look(
        &mut self,
        part: u32,
        parent: Option<u32>,
        (bounds, fit, growth): (Aabb, f64, f64),
        best: &mut (Place, f64),
        found: &mut u32,
    ) {
        let now = self.bounds(part);
        let joined = area(now.join(bounds));
        let pair = growth + 2.0 * joined;
        if pair < best.1 {
            *best = (Place::With(part, parent), pair);
        }
        let Some(at) = (part as usize).checked_sub(self.boxes.len()) else { return };
        let wider = (joined - area(now)).max(0.0);
        let growth = growth + wider * f64::from(self.volumes[at].count);
        if growth + fit < best.1 {
            self.open.push(Reverse(((growth + fit).to_bits(), *found, part, growth.to_bits())));
            *found += 1;
        }
    }

    /// Puts `child` into a new volume with `part`, where that stands.
    fn pair(&mut self, part: u32, parent: Option<u32>, child: u32) {
        let new = (self.boxes.len() + self.volumes.len()) as u32;
        let bounds = self.bounds(part).join(self.boxes[child as usize]);
        let mut parts = [0; ROOM];
        (parts[0], parts[1]) = (part, child);
        self.volumes.push(Volume { bounds, parts, count: 2, parent });
        if let Some(at) = (part as usize).checked_sub(self.boxes.len()) {
            self.volumes[at].parent = Some(new);
        }
        match parent {
            None => self.root = Some(new),
            Some(name) => {
                let parent = &mut self.volumes[name as usize - self.boxes.len()];
                let place = parent.parts.iter().position(|&other| other == part);
                parent.parts[place.expect("a parent holds its parts")] = new;
                self.widen(Some(name), self.boxes[child as usize]);
            }
        }
    }

    /// Makes a volume and those it is in wide enough for `bounds`.
    fn widen(&mut self, mut name: Option<u32>, bounds: Aabb) {
        while let Some(at) = name {
            let volume = &mut self.volumes[at as usize - self.boxes.len()];
            if volume.bounds.contains(&bounds) {
                return;
            }
            volume.bounds = volume.bounds.join(bounds);
            name = volume.parent;
        }
    }

    /// The box of a volume or child.
    fn bounds(&self, name: u32) -> Aabb {
        let name = name as usize;
        match name.checked_sub(self.boxes.len()) {
            None => self.boxes[name],
            Some(at) => self.volumes[at].bounds,
        }
    }

    /// The same tree in pairs, for [`Binary::merged`](crate::wide_tree::Binary::merged): the
    /// parts of a volume are put together two by two, the closest first.
    pub(super) fn merges(&self) -> Vec<[u32; 2]> {
        let children = self.boxes.len();
        // Parents first, to be gone through from the end.
        let mut order: Vec<u32> =
            self.root.into_iter().filter(|&root| root as usize >= children).collect();
        let mut next = 0;
        while let Some(&name) = order.get(next) {
            let volume = &self.volumes[name as usize - children];
            let parts = &volume.parts[..usize::from(volume.count)];
            order.extend(parts.iter().filter(|&&part| part as usize >= children));
            next += 1;
        }
        let mut merges = Vec::with_capacity(children);
        let mut merged = vec![0; self.volumes.len()];
        for &name in order.iter().rev() {
            let volume = &self.volumes[name as usize - children];
            let mut parts: Vec<(u32, Aabb)> = volume.parts[..usize::from(volume.count)]
                .iter()
                .map(|&part| {
                    let at = (part as usize).checked_sub(children);
                    (at.map_or(part, |at| merged[at]), self.bounds(part))
                })
                .collect();
            while parts.len() > 1 {
                let (a, b) = closest(&parts);
                let (second, first) = (parts.swap_remove(b), parts.swap_remove(a));
                merges.push([first.0, second.0]);
                parts.push(((children + merges.len() - 1) as u32, first.1.join(second.1)));
            }
            merged[name as usize - children] = parts[0].0;
        }
        merges
    }
}

/// The two whose joint box is smallest, in order.
fn closest(parts: &[(u32, Aabb)]) -> (usize, usize) {
    let mut best = (0, 1, f64::INFINITY);
    for b in 1..parts.len() {
        for a in 0..b {
            let joined = area(parts[a].1.join(parts[b].1));
            if joined < best.2 {
                best = (a, b, joined);
            }
        }
    }
    (best.0, best.1)
}

#[cfg(test)]
mod tests;
