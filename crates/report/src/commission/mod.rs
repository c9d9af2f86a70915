//! Commissioning: the measuring programs and what an operator has to know about them.

mod plants;
mod program;
mod readme;
mod results;
mod summary;
mod words;

pub(crate) use plants::parameters;
pub use plants::{PlantVerdict, Plants};
pub use program::render_program;
pub use readme::render_readme;
pub use results::{
    AxisVerdict, Results, ResultsReport, Round, Shows, glitch_unit, render_results,
    render_results_json,
};
pub use summary::{PlanFile, PlanReport, ValueListUsed, render_json, render_text};
