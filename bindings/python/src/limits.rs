//! Limits of a dry run.

use frictcomp::interpreter::{Limits, Options};
use frictcomp::syntax::SkipLevels;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::exceptions::refused;
use crate::several::Several;

/// The deepest nesting of macros that can be allowed.
const MACROS: u32 = 64;

/// Limits of a dry run; the defaults are those of the command line.
///
/// ``blocks`` bounds the executed blocks, ``work`` what macros, strings and unknown conditions cost
/// beyond them, ``values`` the values that a program keeps; ``calls``, ``nesting`` and ``macros``
/// bound the depth of calls, control blocks and macros. ``skip`` gives the skip levels that are on, all
/// others are off; without it and without ``skip`` in ``frictcomp.toml``, it is unknown whether a
/// block with a skip mark is executed.
#[pyclass(frozen, name = "Limits", module = "frictcomp")]
pub(crate) struct PyLimits(Options);

#[pymethods]
impl PyLimits {
    #[new]
    #[pyo3(signature = (*, blocks=None, work=None, values=None, calls=None, nesting=None, macros=None, skip=None))]
    // Each is a separate argument in Python.
    #[allow(clippy::too_many_arguments)]
    fn new(
        blocks: Option<u64>,
        work: Option<u64>,
        values: Option<u32>,
        calls: Option<u32>,
        nesting: Option<u32>,
        macros: Option<u32>,
        skip: Option<Several<u8>>,
    ) -> PyResult<Self> {
        let mut limits = Limits::default();
        limits.blocks = blocks.unwrap_or(limits.blocks);
        limits.work = work.unwrap_or(limits.work);
        limits.values = values.unwrap_or(limits.values);
        limits.calls = calls.unwrap_or(limits.calls);
        limits.nesting = nesting.unwrap_or(limits.nesting);
        limits.macros = macros.unwrap_or(limits.macros);
        for (name, limit) in [
            ("blocks", limits.blocks),
            ("values", limits.values.into()),
            ("calls", limits.calls.into()),
            ("nesting", limits.nesting.into()),
        ] {
            if limit == 0 {
                return Err(refused(format!("`{name}` of 0 lets nothing run")));
            }
        }
        if !(1..=MACROS).contains(&limits.macros) {
            return Err(refused(format!(
                "`macros`: they can be nested from 1 to {MACROS} deep"
            )));
        }
        let levels = skip.map(|Several(levels)| {
            levels.iter().try_fold(SkipLevels::NONE, |on, level| {
                let highest = SkipLevels::HIGHEST;
                let refuse = || {
                    refused(format!(
                        "`skip`: {level} is not a level from 1 to {highest}"
                    ))
                };
                on.with(*level).ok_or_else(refuse)
            })
        });
        let levels = levels.transpose()?;
        Ok(Self(
            Options::default().with_limits(limits).with_skip(levels),
        ))
    }

    fn __repr__(&self) -> String {
        let Options { limits, skip, .. } = self.0;
        let skip = skip.map_or_else(|| "None".to_owned(), |on| format!("{:?}", levels(on)));
        format!(
            "Limits(blocks={}, work={}, values={}, calls={}, nesting={}, macros={}, skip={skip})",
            limits.blocks, limits.work, limits.values, limits.calls, limits.nesting, limits.macros,
        )
    }

    fn __getnewargs_ex__<'py>(&self, py: Python<'py>) -> PyResult<((), Bound<'py, PyDict>)> {
        let Options { limits, skip, .. } = self.0;
        let given = PyDict::new(py);
        given.set_item("blocks", limits.blocks)?;
        given.set_item("work", limits.work)?;
        given.set_item("values", limits.values)?;
        given.set_item("calls", limits.calls)?;
        given.set_item("nesting", limits.nesting)?;
        given.set_item("macros", limits.macros)?;
        given.set_item("skip", skip.map(levels))?;
        Ok(((), given))
    }
}

/// The levels that are on.
fn levels(on: SkipLevels) -> Vec<u32> {
    let levels = 1..=u32::from(SkipLevels::HIGHEST);
    let is_on = |level: &u32| u8::try_from(*level).is_ok_and(|level| on.has(level));
    levels.filter(is_on).collect()
}

/// Returns the options of programs within limits.
pub(crate) fn options(limits: Option<&Bound<'_, PyLimits>>) -> Options {
    limits.map_or_else(Options::default, |limits| limits.get().0)
}

/// Returns the options of programs while a user waits: unless limits are given, loops and calls end soon (R9.91).
pub(crate) fn brief(limits: Option<&Bound<'_, PyLimits>>) -> Options {
    let given = limits.map(|limits| limits.get().0);
    given.unwrap_or_else(|| Options::default().with_limits(Limits::brief()))
}
