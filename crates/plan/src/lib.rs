//! How a scene is put in order: plans, which say what is nested in what, their schema, the
//! checks they must pass, and the objects built from them.

pub mod plan;

pub mod select;

pub mod parse;

pub mod schema;

pub mod error;

pub mod fingerprint;

pub mod check;

pub mod build;

pub mod presets;

pub mod single;

pub mod describe;

pub mod prices;

pub mod optimize;

pub mod calibrate;

pub mod explain;
