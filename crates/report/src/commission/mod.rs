//! Commissioning: the measuring programs and the instructions for the operator.

mod plants;
mod program;
mod readme;
mod results;
mod summary;
mod words;

pub use plants::{PlantVerdict, Plants};
pub(crate) use plants::{list_on, parameters};
pub use program::render_program;
pub use readme::render_readme;
pub use results::{
    AxisVerdict, InputFile, Results, ResultsReport, Round, glitch_unit, render_results,
    render_results_json,
};
pub use summary::{PlanReport, render_file, render_json, render_text};
