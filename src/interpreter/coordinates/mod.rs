//! The meaning of words of geometry: G functions, positions, motions.

pub(super) mod arc;
pub(super) mod axis_words;
pub(super) mod contouring;
pub(super) mod g_functions;
pub(super) mod geometry;
pub(super) mod lacking_feed;
pub(super) mod modal;
pub(super) mod motion;
pub(super) mod moving;
pub(super) mod pace;
pub(super) mod saved;
pub(super) mod slope;
