//! Programs that run, and what is kept of a run.

mod contours;
mod dry_run;
mod golden;
mod state_file;

pub use contours::{ContourSetup, NoDrivenContour, drive_contour};
pub use dry_run::{
    Axes, Programs, RunContext, RunSummary, SingleRun, expect_axes, open_session, run_alone,
    run_program, run_programs,
};
pub use golden::{GoldenDrift, GoldenFile, GoldenKind, GoldenResults, UpdatedFolder};
pub use state_file::StateFile;
