//! Testing a child at most once per traversal.

/// Remembers which children a traversal has tested, exactly.
///
/// Every traversal has a set of its own, so an aggregate met twice by one ray, through two
/// instances, starts afresh each time; a mark kept per *ray* would wrongly skip the second
/// visit. Sets are bits, one per child, cleared by undoing what was marked, and are used
/// again: after the first rays nothing is allocated.
#[derive(Debug, Default)]
pub struct Mailbox {
    sets: Vec<Set>,
    free: Vec<u32>,
}

/// The children one traversal has tested.
#[derive(Debug, Default)]
struct Set {
    bits: Vec<u64>,
    /// Words of it that are not 0.
    marked: Vec<u32>,
}

/// A traversal's set in a [`Mailbox`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Stamp(u32);

impl Stamp {
    /// No set taken yet.
    pub const NONE: Self = Self(u32::MAX);
}

impl Default for Stamp {
    fn default() -> Self {
        Self::NONE
    }
}

impl Mailbox {
    /// Marks `child`, one of `count`, and says whether this traversal had not seen it. Takes
    /// a set if `stamp` has none yet; give it back with [`close`](Self::close).
    #[inline]
    pub fn first_visit(&mut self, stamp: &mut Stamp, child: u32, count: u32) -> bool {
        if *stamp == Stamp::NONE {
            *stamp = self.open(count as usize);
        }
        let set = &mut self.sets[stamp.0 as usize];
        let (word, bit) = ((child / 64) as usize, 1 << (child % 64));
        let new = set.bits[word] & bit == 0;
        if new {
            set.bits[word] |= bit;
            set.marked.push(word as u32);
        }
        new
    }

    /// The same for the rays of a packet, a bit each: those that had not seen the child.
    #[inline]
    pub fn first_visits(&mut self, stamp: &mut Stamp, child: u32, count: u32, rays: u32) -> u32 {
        if *stamp == Stamp::NONE {
            *stamp = self.open(count as usize * u32::BITS as usize);
        }
        let set = &mut self.sets[stamp.0 as usize];
        let (word, shift) = ((child / 2) as usize, child % 2 * u32::BITS);
        let seen = (set.bits[word] >> shift) as u32;
        if seen == 0 {
            set.marked.push(word as u32);
        }
        set.bits[word] |= u64::from(rays) << shift;
        rays & !seen
    }

    /// Gives a set back, if one was taken.
    #[inline]
    pub fn close(&mut self, stamp: Stamp) {
        if stamp != Stamp::NONE {
            self.clear(stamp);
        }
    }

    #[cold]
    fn open(&mut self, count: usize) -> Stamp {
        let id = self.free.pop().unwrap_or_else(|| {
            self.sets.push(Set::default());
            self.sets.len() as u32 - 1
        });
        let bits = &mut self.sets[id as usize].bits;
        if bits.len() < count.div_ceil(64) {
            bits.resize(count.div_ceil(64), 0);
        }
        Stamp(id)
    }

    fn clear(&mut self, stamp: Stamp) {
        let set = &mut self.sets[stamp.0 as usize];
        for word in set.marked.drain(..) {
            set.bits[word as usize] = 0;
        }
        self.free.push(stamp.0);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_ray_of_a_packet_visits_once() {
        let mut mailbox = Mailbox::default();
        let mut stamp = Stamp::NONE;
        assert_eq!(mailbox.first_visits(&mut stamp, 4, 7, 0b0110), 0b0110);
        assert_eq!(mailbox.first_visits(&mut stamp, 5, 7, 0b0110), 0b0110);
        assert_eq!(mailbox.first_visits(&mut stamp, 4, 7, 1 << 31 | 0b1100), 1 << 31 | 0b1000);
        assert_eq!(mailbox.first_visits(&mut stamp, 4, 7, u32::MAX), !(1 << 31 | 0b1110));
        mailbox.close(stamp);
        let mut again = Stamp::NONE;
        assert!((0..7 * 32).all(|child| mailbox.first_visit(&mut again, child, 7 * 32)));
    }

    #[test]
    fn traversals_do_not_see_each_others_marks() {
        let mut mailbox = Mailbox::default();
        let (mut outer, mut inner) = (Stamp::NONE, Stamp::NONE);
        assert!(mailbox.first_visit(&mut outer, 5, 10));
        assert!(mailbox.first_visit(&mut inner, 5, 1000));
        assert!(mailbox.first_visit(&mut inner, 999, 1000));
        assert!(!mailbox.first_visit(&mut outer, 5, 10));
        mailbox.close(inner);
        assert!(!mailbox.first_visit(&mut outer, 5, 10));
        let mut third = Stamp::NONE;
        assert!(mailbox.first_visit(&mut third, 999, 1000), "a set given back is empty");
    }
}
