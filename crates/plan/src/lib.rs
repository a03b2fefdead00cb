//! How a scene is put in order: plans, checked and built.
