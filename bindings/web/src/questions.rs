//! The questions of the page.

use serde::Deserialize;

use crate::circle::CircleSettings;
use crate::contour::ContourSettings;
use crate::recording::{RecordingSettings, VerifySettings};
use crate::run::{RunSettings, ShownBlocks};
use crate::tuning::TuneSettings;

/// A question of the page.
#[derive(Debug, Deserialize)]
#[serde(tag = "ask", rename_all = "camelCase")]
pub(crate) enum PageQuestion {
    /// Forget every file.
    Clear,
    /// The files and their roles, in JSON.
    Files,
    /// The text of a file.
    Text { path: String },
    /// Run a program and show it: the overview in JSON.
    Run {
        program: String,
        #[serde(default)]
        settings: RunSettings,
    },
    /// Items of the timeline that is shown, in JSON.
    Items {
        view: ShownBlocks,
        from: usize,
        count: usize,
    },
    /// The position of a block in a view.
    Place { view: ShownBlocks, block: u64 },
    /// The next block with a change or a message, or the one before.
    Notable { block: u64, forward: bool },
    /// The block that first executes a line of the program.
    BlockOfLine { line: u32 },
    /// The records of a program, line by line.
    Records {
        program: String,
        #[serde(default)]
        settings: RunSettings,
    },
    /// The report of a program as a page.
    Report {
        program: String,
        #[serde(default)]
        settings: RunSettings,
    },
    /// The effect of the order of all programs, in JSON.
    Audit {
        #[serde(default)]
        enable: Vec<String>,
    },
    /// The report of the audit as a page.
    AuditReport {
        #[serde(default)]
        enable: Vec<String>,
    },
    /// The additive current of a program: picture and notes, in JSON.
    Current {
        program: String,
        /// The axis positions at the start, in mm or degrees.
        #[serde(default)]
        start: Vec<(String, f64)>,
        #[serde(default)]
        settings: RunSettings,
    },
    /// The contour of a program: picture, figures and notes, in JSON.
    Contour(ContourSettings),
    /// The report of a contour as a page.
    ContourReport(ContourSettings),
    /// The value list with the smallest glitch: picture, figures and the list, in JSON.
    Tune(TuneSettings),
    /// The parameters of the machine of a program, and the curves of its value lists, in JSON.
    Parameters {
        program: String,
        #[serde(default)]
        enable: Vec<String>,
    },
    /// The channels of a recording and its circle: pictures and reports, in JSON.
    Recording(RecordingSettings),
    /// The fit of a value list to a recording: the report, in JSON.
    Verify(VerifySettings),
    /// The page about a code, as text.
    Explain { code: String },
    /// A simulated circular test: picture and figures, in JSON.
    Circle(CircleSettings),
    /// The report of the circular test as a page.
    CircleReport(CircleSettings),
}
