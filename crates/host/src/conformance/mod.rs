//! The agreed behaviour as data (R15.10): cases that others can run, on this engine (R15.11), on a
//! control, and the control's answers compared with the expectations.

mod answers;
mod case;
mod cycles;
mod export;
mod outcome;
mod run;

pub use answers::{Answers, Compared};
pub use case::{Case, CaseError, CaseFile, Expectation, Moment, find_cases};
pub use cycles::ExpectedCycles;
pub use export::{Exported, export};
pub use outcome::{CaseOutcome, Mismatch, Totals};
pub use run::run_case;
