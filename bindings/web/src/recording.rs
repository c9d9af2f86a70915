//! The channels of a dropped recording.

use std::path::Path;

use frictcomp_recordings::trace::{Choice, TraceReader};
use frictcomp_report::pictures::channels;
use frictcomp_report::svg::Frame;
use frictcomp_report::trace::{TraceReport, render_text};
use frictcomp_report::{FALLBACK_WIDTH, fitted};
use serde::Serialize;

use crate::dropped::Dropped;
use crate::refusal::Refusal;
use crate::run::json;

/// Samples of a channel that are kept.
const MOST_ROWS: usize = 5_000_000;

#[derive(Serialize)]
struct RecordingAnswer {
    svg: String,
    /// The channels, as on the command line.
    text: String,
}

/// The picture of a recording and the table of its channels.
pub(crate) fn answer(dropped: &mut Dropped, path: &str) -> Result<Vec<u8>, Refusal> {
    let disk = dropped.disk();
    let text = disk.text(Path::new(path));
    let text = text.ok_or_else(|| Refusal::new(format!("there is no file `{path}`")))?;
    let refused = |error: frictcomp_recordings::trace::TraceProblem| {
        Refusal::new(format!("`{path}` is not read as a recording: {error}"))
    };
    let mut reader = TraceReader::new(MOST_ROWS, |channels| Ok(Choice::all(channels, None)));
    reader.feed(text.as_bytes()).map_err(refused)?;
    let recording = reader.finish().map_err(refused)?;
    let report = TraceReport {
        name: path.to_owned(),
        recording: &recording,
    };
    Ok(json(&RecordingAnswer {
        svg: channels(&report).render(Frame::Alone),
        text: fitted(&render_text(&report), FALLBACK_WIDTH),
    }))
}
