//! What both forms of the command draw and say.

use std::path::Path;

use super::super::console::Console;
use super::super::failure::Failure;
use super::super::outputs::{Outputs, write_text};
use crate::host::OutputFile;
use crate::report::pictures::{AxisPlot, CurrentPlot};
use crate::report::svg::Frame;

/// A picture that is drawn while the cycles come in, and the file that it goes into.
pub(super) struct Plot {
    file: OutputFile,
    pub(super) traces: CurrentPlot,
}

impl Plot {
    /// The picture that the user asked for.
    pub(super) fn create(
        path: Option<&Path>,
        outputs: &mut Outputs,
        axes: Vec<AxisPlot>,
    ) -> Result<Option<Self>, Failure> {
        let file = outputs.optional("--plot", path)?;
        Ok(file.map(|file| Self {
            file,
            traces: CurrentPlot::new(axes),
        }))
    }

    /// Writes the picture.
    pub(super) fn finish(mut self) -> Result<(), Failure> {
        write_text(&mut self.file, &self.traces.chart().render(Frame::Alone))
    }
}

/// Says which outputs were cut to 16 bit.
pub(super) fn say_saturated(axis: &str, cycles: u64) {
    if cycles > 0 {
        Console::talk(&format!(
            "FC137: the current of {cycles} cycles{axis} exceeds 16 bits and was limited"
        ));
    }
}
