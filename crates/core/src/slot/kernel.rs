//! The slot itself: a flag, and memory that is written once, before the flag says so.
#![allow(unsafe_code, reason = "the flag says whether the memory was written; see `Slot`")]

use std::fmt;
use std::mem::MaybeUninit;

#[cfg(loom)]
use loom::cell::UnsafeCell;
#[cfg(loom)]
use loom::sync::atomic::{AtomicU8, Ordering};
#[cfg(not(loom))]
use std::sync::atomic::{AtomicU8, Ordering};

/// What `loom` wraps around the memory, to see who reads and writes it.
#[cfg(not(loom))]
struct UnsafeCell<T>(std::cell::UnsafeCell<T>);

#[cfg(not(loom))]
impl<T> UnsafeCell<T> {
    const fn new(value: T) -> Self {
        Self(std::cell::UnsafeCell::new(value))
    }

    #[inline(always)]
    fn with<R>(&self, read: impl FnOnce(*const T) -> R) -> R {
        read(self.0.get())
    }

    #[inline(always)]
    fn with_mut<R>(&self, write: impl FnOnce(*mut T) -> R) -> R {
        write(self.0.get())
    }
}

/// Nobody has begun.
const EMPTY: u8 = 0;
/// Somebody is making the value.
const BEGUN: u8 = 1;
/// The value is there, and stays as it is.
const READY: u8 = 2;

/// Room for one value, which is written once and only read from then on.
pub struct Slot<T> {
    /// Goes from [`EMPTY`] to [`BEGUN`] for one thread only, and by that thread to [`READY`].
    state: AtomicU8,
    /// Written between [`BEGUN`] and [`READY`], by the thread that began; read after.
    value: UnsafeCell<MaybeUninit<T>>,
}

// SAFETY: the value is moved in by one thread and dropped by another (`Send`), and shared
// between all once it is there (`Sync`); the flag orders the two.
unsafe impl<T: Send + Sync> Sync for Slot<T> {}
// SAFETY: it owns its value.
unsafe impl<T: Send> Send for Slot<T> {}

impl<T> Slot<T> {
    /// With nothing in it.
    #[cfg(not(loom))]
    #[must_use]
    pub const fn new() -> Self {
        Self { state: AtomicU8::new(EMPTY), value: UnsafeCell::new(MaybeUninit::uninit()) }
    }

    /// With nothing in it.
    #[cfg(loom)]
    #[must_use]
    pub fn new() -> Self {
        Self { state: AtomicU8::new(EMPTY), value: UnsafeCell::new(MaybeUninit::uninit()) }
    }

    /// The value, if it is there.
    #[inline(always)]
    pub fn get(&self) -> Option<&T> {
        if self.state.load(Ordering::Acquire) != READY {
            return None;
        }
        // SAFETY: written before the flag was set, by the order of the two; never written again.
        Some(self.value.with(|value| unsafe { (*value).assume_init_ref() }))
    }

    /// The value; makes it if nobody has begun to. None while another thread makes it, and for
    /// ever if `make` panicked.
    #[inline]
    pub fn get_or_make(&self, make: impl FnOnce() -> T) -> Option<&T> {
        self.get().or_else(|| self.make(make))
    }

    #[cold]
    fn make(&self, make: impl FnOnce() -> T) -> Option<&T> {
        let begun = self.state.compare_exchange(EMPTY, BEGUN, Ordering::Relaxed, Ordering::Relaxed);
        if begun.is_ok() {
            let made = make();
            // SAFETY: only one thread comes here, once, and nobody reads before the next line.
            self.value.with_mut(|value| unsafe { (*value).write(made) });
            self.state.store(READY, Ordering::Release);
        }
        self.get()
    }
}

impl<T> Default for Slot<T> {
    fn default() -> Self {
        Self::new()
    }
}

impl<T> Drop for Slot<T> {
    fn drop(&mut self) {
        if self.get().is_some() {
            // SAFETY: it is there, and this is the last to see it.
            self.value.with_mut(|value| unsafe { (*value).assume_init_drop() });
        }
    }
}

impl<T: fmt::Debug> fmt::Debug for Slot<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_tuple("Slot").field(&self.get()).finish()
    }
}

#[cfg(all(test, not(loom)))]
mod tests {
    use std::sync::Arc;
    use std::sync::atomic::AtomicU32;
    use std::thread;

    use super::*;

    #[test]
    fn one_of_many_threads_makes_the_value_and_none_sees_half_of_it() {
        for round in 0..200u64 {
            let (slot, made) = (Slot::new(), AtomicU32::new(0));
            thread::scope(|scope| {
                let come = || {
                    for _ in 0..100 {
                        let value = slot.get_or_make(|| {
                            made.fetch_add(1, Ordering::Relaxed);
                            Box::new([round; 64])
                        });
                        assert!(value.is_none_or(|value| **value == [round; 64]));
                    }
                };
                let threads: Vec<_> = (0..8).map(|_| scope.spawn(come)).collect();
                // ThreadSanitizer does not see the end of the scope.
                threads.into_iter().for_each(|thread| thread.join().expect("it is right"));
            });
            assert_eq!(made.load(Ordering::Relaxed), 1);
            assert!(slot.get().is_some());
        }
    }

    #[test]
    fn the_value_is_dropped_once_if_there_is_one() {
        let shared = Arc::new(());
        let slot = Slot::new();
        slot.get_or_make(|| Arc::clone(&shared));
        slot.get_or_make(|| Arc::clone(&shared));
        assert_eq!(Arc::strong_count(&shared), 2);
        drop(slot);
        assert_eq!(Arc::strong_count(&shared), 1);
        drop(Slot::<Arc<()>>::new());
    }

    #[test]
    fn who_comes_while_the_value_is_made_does_without() {
        let slot = Slot::new();
        let inner = slot.get_or_make(|| slot.get_or_make(|| false).is_none());
        assert_eq!(inner, Some(&true));
    }
}

#[cfg(all(test, loom))]
mod model {
    use loom::sync::Arc;
    use loom::thread;

    use super::*;

    /// All orders in which three threads can come to a slot.
    #[test]
    fn every_order_of_three_threads_publishes_one_whole_value() {
        loom::model(|| {
            let slot = Arc::new(Slot::new());
            let others: Vec<_> = (1..3)
                .map(|me| {
                    let slot = Arc::clone(&slot);
                    thread::spawn(move || {
                        slot.get_or_make(|| [me; 2]).is_none_or(|value| value[0] == value[1])
                    })
                })
                .collect();
            let mine = slot.get_or_make(|| [3; 2]).copied();
            assert!(mine.is_none_or(|value| value[0] == value[1]));
            for other in others {
                assert!(other.join().expect("it does not panic"));
            }
            let value = *slot.get().expect("one of them made it");
            assert!(value[0] == value[1] && (1..=3).contains(&value[0]));
        });
    }
}
