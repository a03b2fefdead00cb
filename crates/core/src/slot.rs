//! A value that the first who needs it makes, and nobody waits for.
//!
//! What a technique leaves unbuilt until a ray comes stands in a slot. One thread makes the
//! value; any other that comes meanwhile is told that there is none yet, and does without: it
//! tests what would have been put in order. So no thread waits for another, none ever sees
//! half a value, and answers do not depend on who came first.

mod kernel;

pub use self::kernel::Slot;
