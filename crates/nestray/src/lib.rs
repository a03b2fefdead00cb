//! Ray tracing by nested acceleration techniques.
