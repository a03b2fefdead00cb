//! Memory that only grows: lines of words, which any thread may add to while others read.

use std::array;
use std::sync::atomic::{AtomicU32, Ordering};

use nestray_core::slot::Slot;

/// Sixteen words: one line of the cache. They are written before anybody is told its number, by
/// a word that is stored with [`Ordering::Release`]; so they can be read in any order after that
/// was loaded with [`Ordering::Acquire`].
#[derive(Debug, Default)]
#[repr(C, align(64))]
pub(crate) struct Line([AtomicU32; Self::WORDS]);

impl Line {
    pub(crate) const WORDS: usize = 16;

    /// One of its words.
    #[inline(always)]
    pub(crate) fn word(&self, number: usize) -> &AtomicU32 {
        &self.0[number % Self::WORDS]
    }

    #[inline(always)]
    pub(crate) fn words(&self) -> [u32; Self::WORDS] {
        array::from_fn(|word| self.0[word].load(Ordering::Relaxed))
    }
}

/// Lines, in chunks that never move.
#[derive(Debug)]
pub(crate) struct Arena {
    chunks: Box<[Slot<Box<[Line]>>]>,
    /// The first line that nobody has taken.
    next: AtomicU32,
    /// Lines there may be.
    most: u32,
}

/// Lines of the first chunk; the next have twice as many each, up to [`CHUNK`].
const FIRST: u32 = 1 << 6;
/// Lines of a chunk, but for the first few.
const CHUNK: u32 = 1 << 12;
/// Chunks smaller than that.
const SMALL: u32 = CHUNK.ilog2() - FIRST.ilog2();

/// The chunk of a line, and which of its lines it is.
#[inline(always)]
fn place(line: u32) -> [u32; 2] {
    let from = line + FIRST;
    if from < 2 * CHUNK {
        let size = from.ilog2();
        return [size - FIRST.ilog2(), from - (1 << size)];
    }
    [SMALL + from / CHUNK - 1, from % CHUNK]
}

/// How many lines a chunk has.
fn size(chunk: u32) -> u32 {
    if chunk < SMALL { FIRST << chunk } else { CHUNK }
}

impl Arena {
    /// Most lines there ever are: numbers of lines have 26 bits.
    pub(crate) const LINES: u32 = 1 << 26;
    /// Most lines taken at once.
    pub(crate) const AT_ONCE: u32 = CHUNK;

    /// Takes up to `bytes`, little of it at once.
    pub(crate) fn new(bytes: u64) -> Self {
        let lines = (bytes / size_of::<Line>() as u64).clamp(1, u64::from(Self::LINES)) as u32;
        let [last, _] = place(lines - 1);
        let chunks = (0..=last).map(|_| Slot::new()).collect();
        Self { chunks, next: AtomicU32::new(0), most: lines }
    }

    /// A line that was taken.
    #[inline(always)]
    pub(crate) fn line(&self, line: u32) -> &Line {
        let [chunk, offset] = place(line);
        let chunk = self.chunks[chunk as usize].get().expect("it was there when it was taken");
        &chunk[offset as usize]
    }

    /// Where a line is; to fetch early.
    #[inline(always)]
    pub(crate) fn address(&self, line: u32) -> *const u8 {
        let [chunk, offset] = place(line % Self::LINES);
        let chunk = self.chunks.get(chunk as usize).and_then(Slot::get);
        chunk.map_or(std::ptr::null(), |chunk| chunk.as_ptr().wrapping_add(offset as usize).cast())
    }

    /// Takes lines that follow each other, up to [`AT_ONCE`](Self::AT_ONCE), all words zero. None
    /// if there is no room, or while another thread makes it.
    pub(crate) fn take(&self, count: u32) -> Option<u32> {
        let mut first = None;
        let taken = self.next.fetch_update(Ordering::Relaxed, Ordering::Relaxed, |next| {
            let mut at = next;
            // None across the end of a chunk.
            while let [chunk, offset] = place(at)
                && offset + count > size(chunk)
            {
                at += size(chunk) - offset;
            }
            first = Some(at);
            at.checked_add(count).filter(|&end| end <= self.most)
        });
        if taken.is_err() {
            // Nobody else needs to look for room.
            self.next.fetch_max(self.most, Ordering::Relaxed);
            return None;
        }
        let first = first?;
        let [chunk, _] = place(first);
        let lines = || (0..size(chunk)).map(|_| Line::default()).collect();
        self.chunks[chunk as usize].get_or_make(lines)?;
        Some(first)
    }

    /// Whether nothing more can be taken.
    pub(crate) fn is_full(&self) -> bool {
        self.next.load(Ordering::Relaxed) >= self.most
    }

    /// Memory in use.
    pub(crate) fn bytes(&self) -> u64 {
        let lines: usize = self.chunks.iter().filter_map(Slot::get).map(|chunk| chunk.len()).sum();
        (lines * size_of::<Line>() + size_of_val(&*self.chunks)) as u64
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_line_has_a_place_of_its_own() {
        let mut before = place(0);
        assert_eq!(before, [0, 0]);
        for line in 1..5 * CHUNK {
            let here = place(line);
            let next = if before[1] + 1 == size(before[0]) {
                [before[0] + 1, 0]
            } else {
                [before[0], before[1] + 1]
            };
            assert_eq!(here, next, "line {line}");
            before = here;
        }
    }

    #[test]
    fn threads_take_lines_that_do_not_overlap_until_nothing_is_left() {
        let arena = Arena::new(3 * u64::from(CHUNK) * 64);
        let mut taken: Vec<(u32, u32)> = std::thread::scope(|scope| {
            let threads: Vec<_> = (1..5)
                .map(|count| {
                    let arena = &arena;
                    scope.spawn(move || {
                        let mut taken = Vec::new();
                        while !arena.is_full() && taken.len() < 1 << 16 {
                            if let Some(first) = arena.take(count) {
                                for line in first..first + count {
                                    let word = arena.line(line).word(3);
                                    assert_eq!(word.swap(count, Ordering::Relaxed), 0);
                                }
                                taken.push((first, count));
                            } else {
                                break;
                            }
                        }
                        taken
                    })
                })
                .collect();
            threads
                .into_iter()
                .flat_map(|thread| thread.join().expect("it does not panic"))
                .collect()
        });
        taken.sort_unstable();
        assert!(taken.windows(2).all(|pair| pair[0].0 + pair[0].1 <= pair[1].0));
        assert!(arena.take(Arena::AT_ONCE).is_none());
        assert!(arena.bytes() <= 4 * u64::from(CHUNK) * 64);
    }
}
