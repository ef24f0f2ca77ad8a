//! The scene's plain data in the form of [`super::layout`].

pub(super) mod environment;
pub(super) mod frame;
pub(super) mod light_tree;
pub mod luminaire;
pub(super) mod material;
pub(super) mod physical;
pub(super) mod texture;
pub(super) mod triangle;
