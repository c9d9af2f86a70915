//! Many programs: which there are, how they call each other, what their order does.

mod audits;
mod baseline;
mod call_graph;
mod changed_programs;
mod checks;
mod cures;
mod first_look;
mod git;
mod left_out;
mod main_programs;
mod unread;
mod walk;

pub use audits::{ArchiveAuditor, AuditOptions, programs_in_order};
pub use baseline::{Baseline, KnownFindings};
pub use call_graph::{CallGraph, FoundCall, GraphProgram, MissingCall};
pub use changed_programs::ChangedPrograms;
pub use checks::{
    CalledPrograms, CheckOptions, CheckedProgram, CheckedPrograms, ProgramsOnMachines,
};
pub use cures::MendedProgram;
pub use first_look::{FoundList, lists_below, outline_of};
pub use git::{ChangedFile, OldFile, Revision};
pub use left_out::{LeftOutFile, LeftOutFiles, WhyLeftOut};
pub use unread::{UnreadVariable, unread_variables};
pub use walk::{FoundPrograms, find_programs};
