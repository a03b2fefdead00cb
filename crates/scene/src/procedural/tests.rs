//! What the scenes must be like.

mod known;
mod list;
mod nff;
mod ours;
