//! The effect of the order of programs (chapter 10 of the rules).
//!
//! The state of compensation outlives a program, so an archive is more than its programs: what one leaves, another
//! finds. Each program is treated as a function from the states that it finds to the states that it leaves: a
//! [`ProgramAudit`]. One dry run gives it, in which each configured axis is found in its start-up state or away from
//! it, by a condition of its own; where a program depends on what it finds in other ways, a run from each start. An
//! [`Archive`] puts the programs of one machine together and finds which programs leave an axis away from its start-up
//! state and which would inherit that, without ever looking at pairs. [`Mending`] finds the block that ends the hazard,
//! and [`Step`] describes the effect in one given order.
//!
//! Nothing here opens a file: the host runs its programs on the interpreter that an [`Auditor`]
//! hands out.

mod archive;
mod effect;
mod mending;
mod observation;
mod program;
mod runs;

pub use archive::{Archive, AxisFinding, MendedEnd, Sequence, Step, StepAxis};
pub use effect::{AuditedKind, Scope, Selected};
pub use effect::{FirstMotion, Inherits, ProgramEffect, Site, WhyUnknown};
pub use mending::{
    Affected, Cure, CuredMotions, Insertion, Mended, Mending, Missed, WhyMissed, insertions, mend,
};
pub use program::{Auditor, AxisAudit, Ending, ProgramAudit};
