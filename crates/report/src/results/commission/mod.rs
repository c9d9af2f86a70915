//! Commissioning: the measuring programs and the instructions for the operator.

mod acceptance;
mod picture;
mod plants;
mod program;
mod readme;
mod results;
mod summary;
mod words;

pub use acceptance::Acceptance;
pub use results::{document, render_results_json};
pub use summary::{plan_document, plan_texts, render_json};
