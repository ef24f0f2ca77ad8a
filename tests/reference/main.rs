//! The reference against closed forms, its two intersectors against each other, and its sampling against its densities.

#[path = "../common/mod.rs"]
mod common;

mod bodies;
mod brushed;
mod coats;
mod directed;
mod environment;
mod estimators;
mod exposure;
mod facets;
mod impulses;
mod intersection;
mod layers;
mod light;
mod light_tree;
mod lost_light;
mod luminaire_choice;
mod overlapping_lamps;
mod physical;
mod relief;
mod roulette;
mod sampling;
mod scattering;
mod sensor;
mod textures;
mod transport;
mod vertex_colours;
