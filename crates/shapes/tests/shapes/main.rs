//! What every single shape promises, tried on random ones of each kind.

mod areas;
mod beams;
mod broken;
mod gaps;
mod hits;
mod joined;
mod leaving;
mod numbers;
mod parts;
mod places;
mod reference;
mod samples;
