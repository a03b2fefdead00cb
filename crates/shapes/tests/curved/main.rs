//! Curved shapes against dense references in doubles.

mod bezier;
mod csg;
mod height_field;
mod numbers;
mod roots;
