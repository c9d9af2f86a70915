//! What a report needs beside the records.

use crate::lists::Parameter;
use crate::machine::AxisReport;

/// What the report tells beside the records.
#[derive(Debug, Clone, Copy, Default)]
pub struct RunInputs<'a> {
    /// What the user gave for the run: names and values.
    pub settings: &'a [(String, String)],
    /// The parameters in effect, by axis.
    pub parameters: &'a [AxisReport],
    /// The programs and macros that the configuration names.
    pub programs: &'a [Parameter],
}
