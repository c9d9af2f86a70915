//! The shapes that are fitted to a recorded path at once, with their standard errors and the residual (R5.28,
//! R5.34).

mod circle_evidence;
mod evidence_shape;
mod oscillation;
mod periodic;
mod pitch;
mod series;
mod shapes;
mod swings;
mod tail_search;
mod tails;

pub use circle_evidence::CircleEvidence;
pub use evidence_shape::{OtherShape, ShapeTerm, Term};
pub(crate) use tails::{TailPlace, Tails};
