//! The program as people run it.

mod bad_input;
#[cfg(unix)]
mod interrupt;
mod program;
mod verbs;
