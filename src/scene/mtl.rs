//! mtl
