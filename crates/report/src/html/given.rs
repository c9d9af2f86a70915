//! The inputs of a report other than the records.

use std::path::Path;

use frictcomp::interpreter::StopPolicy;
use frictcomp::lists::Parameter;
use frictcomp::machine::{AxisReport, Setting};
use frictcomp::text::shown_path;

/// Inputs of the report other than the records.
#[derive(Debug, Clone, Copy, Default)]
pub struct RunInputs<'a> {
    /// Options given by the user for the run.
    pub given: GivenForRun<'a>,
    /// The parameters in effect, by axis.
    pub parameters: &'a [AxisReport],
    /// The programs and macros that the configuration names.
    pub programs: &'a [Parameter],
}

/// Options given by the user for a run.
#[derive(Debug, Clone, Copy, Default)]
pub struct GivenForRun<'a> {
    /// The file that describes the machine.
    pub machine: Option<&'a Path>,
    /// The axes on which friction compensation is assumed.
    pub enabled: &'a [String],
    /// Values of variables.
    pub variables: &'a [(String, Setting)],
    /// The file that holds the state from one run to the next.
    pub state: Option<&'a Path>,
    /// Positions of axes before the first program.
    pub start: &'a [(String, f64)],
    /// Reaction to an error.
    pub stop: StopPolicy,
}

impl GivenForRun<'_> {
    /// Returns the options in the words of the command line: names and values.
    pub(super) fn settings(&self) -> Vec<(&'static str, String)> {
        let mut settings = vec![match self.machine {
            Some(path) => ("machine", shown_path(path)),
            None => ("machine", "not configured".to_owned()),
        }];
        if !self.enabled.is_empty() {
            settings.push(("--enable", self.enabled.join(", ")));
        }
        settings.extend(self.variables.iter().map(|(name, setting)| {
            let value = match setting {
                Setting::Number(number) => number.to_string(),
                Setting::Text(text) => format!("\"{text}\""),
            };
            ("variable", format!("{name} = {value}"))
        }));
        settings.push(match self.state {
            Some(path) => ("--state", shown_path(path)),
            None => (
                "state at start",
                "that of a restart of the control".to_owned(),
            ),
        });
        let start = self.start.iter();
        settings.extend(start.map(|(axis, position)| ("--start", format!("{axis} at {position}"))));
        let policy = match self.stop {
            StopPolicy::FirstError => "the session stops, as the control does",
            StopPolicy::KeepGoing => "the command is passed over (--keep-going)",
            StopPolicy::CheckAll => "the command is passed over, and every block is checked",
        };
        settings.push(("at an error", policy.to_owned()));
        settings
    }
}
