//! The Python module `frictcomp._engine`: the features of `frictcomp` as Python classes and functions.
//! They are documented where Python users read it, in `python/frictcomp/_engine.pyi`.

mod advice;
mod arrow;
mod ask;
mod audit;
mod check;
mod command;
mod commission;
mod contour;
mod current;
mod exceptions;
mod explain;
mod failure;
mod identify;
mod json;
mod kinds;
mod learn;
mod limits;
mod machine;
mod messages;
mod notebook;
mod outputs;
mod per_axis;
mod pickled;
mod planned;
mod planner;
mod program;
mod recording;
mod replay;
mod run;
mod sequence;
mod several;
mod simulated;
mod start;
mod state;
mod states;
mod timeline;
mod words;
mod work;

/// The module.
#[pyo3::pymodule]
mod _engine {
    /// The parser of this module is not shared with any other module of the process.
    #[pymodule_init]
    #[allow(clippy::unnecessary_wraps, reason = "PyO3 asks for a result")]
    fn begin(_module: &pyo3::Bound<'_, pyo3::types::PyModule>) -> pyo3::PyResult<()> {
        frictcomp::syntax::bound_reading();
        Ok(())
    }

    #[pymodule_export]
    use super::ask::{ask_list, ask_read, ask_write};
    #[pymodule_export]
    use super::audit::{PyAudit, audit};
    #[pymodule_export]
    use super::check::check;
    #[pymodule_export]
    use super::command::command;
    #[pymodule_export]
    use super::commission::{evaluate_commissioning, friction_trend};
    #[pymodule_export]
    use super::contour::{PyContour, contour};
    #[pymodule_export]
    use super::current::{PyAxisCurrent, PyCurrents, current, current_of_recording};
    #[pymodule_export]
    use super::explain::explain;
    #[pymodule_export]
    use super::identify::{PyIdentified, identify};
    #[pymodule_export]
    use super::learn::learn;
    #[pymodule_export]
    use super::limits::PyLimits;
    #[pymodule_export]
    use super::machine::PyMachine;
    #[pymodule_export]
    use super::messages::{PyEnd, PyFix, PyMessage, PyMessages};
    #[pymodule_export]
    use super::planned::plan;
    #[pymodule_export]
    use super::program::PyText;
    #[pymodule_export]
    use super::recording::{trace_recording, verify_list};
    #[pymodule_export]
    use super::replay::replay;
    #[pymodule_export]
    use super::run::run;
    #[pymodule_export]
    use super::sequence::{PyAuditSequence, audit_sequence};
    #[pymodule_export]
    use super::simulated::{PyCircle, PyTuned, circle, tune};
    #[pymodule_export]
    use super::state::PyState;
    #[pymodule_export]
    use super::timeline::{PyProgramRun, PyTimeline};
}
