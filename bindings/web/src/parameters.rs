//! The parameters of the machine, and the curves of its value lists.

use frictcomp::lists::Parameter;
use frictcomp::machine::AcceptedList;
use frictcomp_report::pictures::value_curves;
use frictcomp_report::results::lists::cells;
use frictcomp_report::svg::Frame;
use serde::Serialize;

use crate::dropped::Dropped;
use crate::refusal::Refusal;
use crate::run::json;

#[derive(Serialize)]
struct ParametersAnswer {
    tables: Vec<ParameterTable>,
    /// The curves of the value lists that the control accepts; none where there is none.
    svg: Option<String>,
}

/// The parameters of an axis, or of the channel.
#[derive(Serialize)]
struct ParameterTable {
    name: String,
    /// Number, key, value with its unit, and origin.
    rows: Vec<[String; 4]>,
}

impl ParameterTable {
    fn new(name: String, parameters: &[Parameter]) -> Self {
        Self {
            name,
            rows: parameters.iter().map(cells).collect(),
        }
    }
}

/// Returns the effective parameters of a program, with their origins, and the curves.
pub(crate) fn answer(
    dropped: &mut Dropped,
    program: &str,
    enable: &[String],
) -> Result<Vec<u8>, Refusal> {
    let input = dropped.program(program)?;
    let loaded = dropped.machine(&input, enable)?;
    let axes = loaded.reports.iter();
    let axes =
        axes.map(|report| ParameterTable::new(format!("Axis {}", report.axis), &report.parameters));
    let programs = ParameterTable::new("Programs and macros".to_owned(), &loaded.programs);
    let tables = axes.chain([programs]);
    let accepted = AcceptedList::of(&loaded.machine);
    let accepted: Vec<&AcceptedList> = accepted.iter().collect();
    let svg = (!accepted.is_empty()).then(|| value_curves(&accepted).render(Frame::Alone));
    Ok(json(&ParametersAnswer {
        tables: tables.filter(|table| !table.rows.is_empty()).collect(),
        svg,
    }))
}
