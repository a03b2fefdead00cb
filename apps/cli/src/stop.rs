//! Being told to stop.

use std::sync::atomic::{AtomicBool, Ordering};

use crate::errors::Failure;

static STOP: AtomicBool = AtomicBool::new(false);

/// From now on an interrupt asks to stop, and a second one stops at once.
pub(crate) fn listen() -> Result<(), Failure> {
    let heard = || {
        if STOP.swap(true, Ordering::Relaxed) {
            std::process::exit(i32::from(Failure::INTERRUPTED));
        }
    };
    ctrlc::set_handler(heard).map_err(|error| Failure::new(Failure::FAILED, error))
}

/// Whether to stop.
pub(crate) fn asked() -> bool {
    STOP.load(Ordering::Relaxed)
}

/// Stops here if asked to, with nothing to show for it.
pub(crate) fn check() -> Result<(), Failure> {
    if asked() { Err(interrupted("nothing was written")) } else { Ok(()) }
}

/// The failure of a run that was interrupted.
pub(crate) fn interrupted(what: impl std::fmt::Display) -> Failure {
    Failure::new(Failure::INTERRUPTED, format!("interrupted: {what}"))
}
