//! The program as people run it.

mod auto;
mod bad_input;
mod bench;
mod explain;
#[cfg(unix)]
mod interrupt;
mod optimize;
mod program;
mod verbs;
