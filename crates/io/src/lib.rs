//! Readers and writers of scenes and pictures.
