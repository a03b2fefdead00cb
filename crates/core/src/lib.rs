//! The vocabulary of meta-hierarchies: objects, their children, and the
//! techniques that order those children along a ray.
//!
//! An *object* is anything a ray can be tested against. An *aggregate* is an
//! object made of other objects. A *technique* is the part of an aggregate that
//! decides which children a ray has to be tested against; it sees boxes, never
//! objects. See [Arvo 90, §3–4].

pub mod ray;

pub mod hit;

pub mod surface;

pub mod aabb;

pub mod beam;

pub mod object;

pub mod children;

pub mod names;

pub mod family;

pub mod technique;

pub mod accel;
pub mod aim;

pub mod instance;

pub mod moving;

pub mod by_kind;

pub mod fence;

pub mod lazy;

pub mod opened;

pub mod one_by_one;

pub mod packet;

pub mod cost;

pub mod counters;

pub mod mailbox;

pub mod scratch;

pub mod simd;
pub mod slot;

pub mod trail;

pub mod huge;
