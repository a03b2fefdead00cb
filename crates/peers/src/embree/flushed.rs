//! Arithmetic as Embree wants it while it is called.

mod kernel;

pub(super) use self::kernel::Flushed;
