//! The effect of the order of programs, in every format (R10.5).

mod csv;
mod mended;
mod records;
mod sequence;
mod subject;
mod text;

pub use csv::render_csv;
pub use mended::{also_mended_text, changed_text, missed_text, to_write_text};
pub use records::records;
pub use sequence::{SequenceReport, sequence_records, sequence_text};
pub use subject::{AuditReport, MachineAudit, Word};
pub(crate) use subject::{CurePlace, axis_name};
pub use text::{Length, render_text};
