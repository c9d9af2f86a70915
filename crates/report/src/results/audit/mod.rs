//! The effect of the order of programs, in every format (R10.5).

mod csv;
mod document;
mod mended;
mod records;
mod sequence;
mod subject;

pub use csv::render_csv;
pub use document::document;
pub use mended::{also_mended_text, changed_text, missed_text, to_write_text};
pub use records::records;
pub use sequence::{SequenceReport, sequence_records, sequence_text};
pub use subject::{AuditReport, MachineAudit, Word};
