//! Pictures and messages of both forms of the command.

use super::args::CurrentArgs;
use crate::output::{Console, Failure, Outputs, write_page, write_picture};
use frictcomp::lists::FrictionList;
use frictcomp_host::OutputFile;
use frictcomp_physics::current::{Reading, Standstill};
use frictcomp_report::counted;
use frictcomp_report::pictures::{AxisPlot, CurrentPlot};
use frictcomp_report::results::current::document;

/// A picture that is drawn as the cycles arrive, and its output files.
pub(super) struct Plot {
    svg: Option<OutputFile>,
    html: Option<OutputFile>,
    pub(super) traces: CurrentPlot,
}

impl Plot {
    /// Creates the picture that the user asked for, alone or in a page.
    pub(super) fn create(
        args: &CurrentArgs,
        outputs: &mut Outputs,
        axes: Vec<AxisPlot>,
    ) -> Result<Option<Self>, Failure> {
        let svg = outputs.optional("--svg", args.svg.as_deref())?;
        let html = args.html.page(outputs)?;
        let is_wanted = svg.is_some() || html.is_some();
        Ok(is_wanted.then(|| Self {
            svg,
            html,
            traces: CurrentPlot::new(axes),
        }))
    }

    /// Writes the picture, and the page under its verdict.
    pub(super) fn finish(self, verdict: &str) -> Result<(), Failure> {
        let document = document(&self.traces, verdict);
        write_picture(self.svg, &document)?;
        write_page(self.html, &document)
    }
}

/// Reports, where it matters, what is added at standstill (C11).
pub(super) fn say_at_rest(axis: &str, reading: Reading, cycles: u64) {
    if cycles == 0 {
        return;
    }
    let (now, other) = match reading.standstill {
        Standstill::Zero => ("0", "with `--reading standstill=hold` it is held"),
        _ => ("held", "with `--reading standstill=zero` it is 0"),
    };
    Console::talk(&format!(
        "in {} at standstill the current{axis} is {now}; {other}",
        counted(cycles, "cycle")
    ));
}

/// Reports on which reading of the documents the sign of the currents depends (C12).
pub(super) fn say_sign<'a>(mut lists: impl Iterator<Item = &'a FrictionList>) {
    let adds = |list: &FrictionList| list.table.iter().any(|point| point.output != 0.0);
    if lists.any(adds) {
        Console::talk(
            "`out` is taken to have the sign of the torque at positive velocity; check the \
             sign on the machine first, `frictcomp explain P-COMP-00047` says how",
        );
    }
}

/// Reports which outputs were limited to 16 bits.
pub(super) fn say_saturated(axis: &str, cycles: u64) {
    if cycles > 0 {
        Console::talk(&format!(
            "FC137: the current of {}{axis} exceeds 16 bits and was limited",
            counted(cycles, "cycle")
        ));
    }
}
