//! The parts of a contour that are kept or written while it is made.

use std::collections::BTreeMap;
use std::io::{self, Write};
use std::sync::Arc;

use super::records::{CSV_HEADER, push_csv_row, reversal_record};
use crate::pictures::ContourPicture;
use crate::wording::to_json_line;
use frictcomp_physics::contour::{ContourPoint, ContourReversal, ContourSink};
use frictcomp_physics::motion::Movement;

/// Number of the worst reversals kept.
const WORST: usize = 10;

/// Limit of the switches kept.
const MOST_SWITCHES: usize = 100;

/// Destination of the reversals.
enum ReversalSink<'a> {
    /// Only the worst reversals are kept.
    Worst,
    /// All reversals are kept, and the largest deviation of each block.
    Kept,
    /// Each reversal is written as a line of JSON.
    Ndjson(&'a mut (dyn Write + Send)),
    /// Each reversal is written as a row.
    Csv(&'a mut (dyn Write + Send)),
}

/// Takes a contour and keeps or writes the requested parts.
pub struct ContourRecorder<'a> {
    names: Vec<String>,
    reversals: ReversalSink<'a>,
    all: Vec<ContourReversal>,
    worst: Vec<ContourReversal>,
    switches: Vec<ContourReversal>,
    more_switches: u64,
    blocks: BTreeMap<(Arc<str>, u32), f64>,
    picture: Option<ContourPicture>,
    error: Option<io::Error>,
}

impl<'a> ContourRecorder<'a> {
    /// Keeps the worst reversals of axes with these names.
    pub fn new(names: Vec<String>) -> Self {
        Self {
            names,
            reversals: ReversalSink::Worst,
            all: Vec::new(),
            worst: Vec::new(),
            switches: Vec::new(),
            more_switches: 0,
            blocks: BTreeMap::new(),
            picture: None,
            error: None,
        }
    }

    /// Keeps all reversals, and the largest deviation of each block.
    pub fn keeping_all(self) -> Self {
        Self {
            reversals: ReversalSink::Kept,
            ..self
        }
    }

    /// Writes each reversal as a line of JSON.
    pub fn writing_ndjson(self, writer: &'a mut (dyn Write + Send)) -> Self {
        Self {
            reversals: ReversalSink::Ndjson(writer),
            ..self
        }
    }

    /// Writes each reversal as a row, below a header.
    pub fn writing_csv(mut self, writer: &'a mut (dyn Write + Send)) -> Self {
        self.error = writer.write_all(CSV_HEADER.as_bytes()).err();
        Self {
            reversals: ReversalSink::Csv(writer),
            ..self
        }
    }

    /// Draws the contour.
    pub fn drawing(self, picture: ContourPicture) -> Self {
        Self {
            picture: Some(picture),
            ..self
        }
    }

    /// Returns all reversals, if they are kept.
    pub fn reversals(&self) -> &[ContourReversal] {
        &self.all
    }

    /// Returns the reversals in feed moves with the largest glitches, the largest first.
    pub fn worst(&self) -> &[ContourReversal] {
        &self.worst
    }

    /// Returns the first switches of compensation during a motion of the axis, and the number of
    /// further ones.
    pub fn switches(&self) -> (&[ContourReversal], u64) {
        (&self.switches, self.more_switches)
    }

    /// Returns the largest deviation of each block in µm, by file and line, if everything is kept.
    pub fn blocks(&self) -> &BTreeMap<(Arc<str>, u32), f64> {
        &self.blocks
    }

    /// Returns the picture.
    pub fn take_picture(&mut self) -> Option<ContourPicture> {
        self.picture.take()
    }

    /// Returns the error that ended the writing.
    pub fn take_error(&mut self) -> Option<io::Error> {
        self.error.take()
    }

    fn keep_worst(&mut self, reversal: &ContourReversal) {
        let glitch = |it: &ContourReversal| it.glitch_um.programmed;
        let at = self
            .worst
            .partition_point(|it| glitch(it) >= glitch(reversal));
        if at < WORST {
            self.worst.insert(at, reversal.clone());
            self.worst.truncate(WORST);
        }
    }
}

impl ContourSink for ContourRecorder<'_> {
    fn point(&mut self, point: &ContourPoint<'_>) {
        if let Some(picture) = &mut self.picture {
            picture.point(point);
        }
        if matches!(self.reversals, ReversalSink::Kept) && point.counts {
            let deviation = point.space_um.programmed;
            let key = (Arc::clone(&point.cause.file), point.cause.line);
            let max = self.blocks.entry(key).or_default();
            *max = max.max(deviation);
        }
    }

    fn reversal(&mut self, reversal: &ContourReversal) {
        if reversal.movement != Movement::Rapid && reversal.has_figure() {
            self.keep_worst(reversal);
        }
        if let Some(picture) = &mut self.picture {
            picture.reversal(reversal);
        }
        let written = match &mut self.reversals {
            ReversalSink::Worst => Ok(()),
            ReversalSink::Kept => {
                self.all.push(reversal.clone());
                Ok(())
            }
            ReversalSink::Ndjson(writer) => {
                let mut record = reversal_record(reversal, &self.names);
                record["record"] = "reversal".into();
                writer.write_all(to_json_line(&record).as_bytes())
            }
            ReversalSink::Csv(writer) => {
                let mut row = Vec::new();
                push_csv_row(&mut row, reversal, &self.names);
                writer.write_all(&row)
            }
        };
        if let Err(error) = written {
            self.error.get_or_insert(error);
        }
    }

    fn switch(&mut self, switch: &ContourReversal) {
        if self.switches.len() < MOST_SWITCHES {
            self.switches.push(switch.clone());
        } else {
            self.more_switches += 1;
        }
    }

    fn is_closed(&self) -> bool {
        self.error.is_some()
    }
}
