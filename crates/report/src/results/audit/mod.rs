//! The effect of the order of programs, in every format (R10.5).

mod csv;
mod records;
mod sequence;
mod subject;
mod text;

pub use csv::render_csv;
pub use records::records;
pub use sequence::{sequence_records, sequence_text};
pub use subject::{AuditReport, MachineAudit, Word};
pub(crate) use subject::{axis_name, is_shown};
pub use text::{Length, render_text};
