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
pub use plants::{PlantVerdict, Plants};
pub use program::render_program;
pub use readme::render_readme;
pub use results::{
    AxisVerdict, InputFile, Results, ResultsReport, Round, document, glitch_unit,
    render_results_json,
};
pub use summary::{PlanReport, render_file, render_json, render_text};
