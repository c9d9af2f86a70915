//! Incoming tables: lines of bytes, the header, then rows.

use super::choice::Demand;
use super::columns::{FileLine, TableColumns};
use super::error::TraceProblem;
use super::head::Head;
use super::recording::TraceRecording;
use super::table::ChannelTable;

/// Maximum length of a line.
const MOST_LINE: usize = 4 << 20;

/// A table that is being read.
#[derive(Default)]
pub(super) struct CsvTable {
    /// The start of a line whose end is in the next piece.
    begun: Vec<u8>,
    lines: u64,
    stage: CsvStage,
}

#[derive(Default)]
enum CsvStage {
    /// The lines above the numbers.
    Head(Head),
    /// Among the numbers.
    Rows(Box<ChannelTable>),
    /// Between the two, and after a problem.
    #[default]
    Empty,
}

impl CsvTable {
    pub(super) fn new() -> Self {
        Self {
            stage: CsvStage::Head(Head::default()),
            ..Self::default()
        }
    }

    /// Takes the next bytes.
    pub(super) fn feed(
        &mut self,
        piece: &[u8],
        demand: &mut Demand<'_>,
    ) -> Result<(), TraceProblem> {
        let mut rest = piece;
        while let Some(end) = memchr::memchr(b'\n', rest) {
            let (line, after) = (&rest[..end], &rest[end + 1..]);
            if self.begun.is_empty() {
                self.line(line, demand)?;
            } else {
                let mut whole = std::mem::take(&mut self.begun);
                whole.extend(line);
                self.line(&whole, demand)?;
                whole.clear();
                self.begun = whole;
            }
            rest = after;
        }
        if self.begun.len() + rest.len() > MOST_LINE {
            return Err(TraceProblem::Long {
                line: self.lines + 1,
                most: MOST_LINE,
            });
        }
        self.begun.extend(rest);
        Ok(())
    }

    /// Takes the last line, and returns everything.
    pub(super) fn finish(
        mut self,
        demand: &mut Demand<'_>,
    ) -> Result<TraceRecording, TraceProblem> {
        if !self.begun.is_empty() {
            let last = std::mem::take(&mut self.begun);
            self.line(&last, demand)?;
        }
        match self.stage {
            CsvStage::Head(head) => Ok(Self::table(head, demand)?.finish()),
            CsvStage::Rows(table) => Ok(table.finish()),
            CsvStage::Empty => Err(TraceProblem::NoRows),
        }
    }

    fn line(&mut self, line: &[u8], demand: &mut Demand<'_>) -> Result<(), TraceProblem> {
        self.lines += 1;
        let line = line.strip_suffix(b"\r").unwrap_or(line);
        match &mut self.stage {
            CsvStage::Rows(table) => table.row(self.lines, line),
            CsvStage::Head(head) => {
                if memchr::memchr(0, line).is_some() {
                    return Err(TraceProblem::Binary);
                }
                let line = FileLine {
                    number: self.lines,
                    bytes: line.to_vec(),
                };
                if let Some(columns) = head.line(line)? {
                    let head = std::mem::take(head);
                    self.stage = CsvStage::Rows(Self::begun(head, columns, demand)?);
                }
                Ok(())
            }
            CsvStage::Empty => Ok(()),
        }
    }

    fn table(head: Head, demand: &mut Demand<'_>) -> Result<Box<ChannelTable>, TraceProblem> {
        let columns = head.end()?;
        Self::begun(head, columns, demand)
    }

    /// Creates a table with the rows that came while its columns were not known.
    fn begun(
        head: Head,
        columns: TableColumns,
        demand: &mut Demand<'_>,
    ) -> Result<Box<ChannelTable>, TraceProblem> {
        let mut table = Box::new(ChannelTable::new(columns, demand)?);
        for row in head.rows() {
            table.row(row.number, &row.bytes)?;
        }
        Ok(table)
    }
}
