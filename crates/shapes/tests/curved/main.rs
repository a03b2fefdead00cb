//! Curved shapes against dense references in doubles.

mod bezier;
mod numbers;
