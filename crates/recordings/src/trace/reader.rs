//! Bytes of a trace, piece by piece.

use super::channel::Channel;
use super::choice::{Choice, Demand};
use super::csv::CsvTable;
use super::error::{SelectError, TraceProblem};
use super::recording::TraceRecording;
use super::wide::Letters;
use super::xml::Xml;

/// Reads a trace whose bytes come piece by piece.
///
/// ```
/// use frictcomp_recordings::trace::{Choice, TraceReader};
///
/// let mut reader = TraceReader::new(1000, |channels| Ok(Choice::all(channels, None)));
/// reader.feed(b"t;torq")?;
/// reader.feed(b"ue [%]\r\n0,000;1,5\r\n0,001;1,7\r\n")?;
/// let recording = reader.finish()?;
/// let torque = recording.kept().nth(1).expect("two channels");
/// assert_eq!(recording.channels()[torque.get()].unit.as_deref(), Some("%"));
/// assert_eq!(recording.values(torque), [1.5, 1.7]);
/// # Ok::<(), frictcomp_recordings::trace::TraceProblem>(())
/// ```
pub struct TraceReader<'a> {
    demand: Demand<'a>,
    letters: Letters,
    /// The first bytes, until there are enough to recognise the file.
    first: Vec<u8>,
    form: FileForm,
}

enum FileForm {
    Unknown,
    Csv(CsvTable),
    Xml(Box<Xml>),
}

/// Number of bytes from the start of a file by which its layout is recognised.
const ENOUGH: usize = 1024;

/// The first bytes of a file that gzip compressed.
const GZIP: &[u8] = b"\x1f\x8b";

impl<'a> TraceReader<'a> {
    /// Creates a reader with a limit of rows that calls `choose` once for the channels to keep.
    pub fn new(
        most_rows: usize,
        choose: impl FnMut(&[Channel]) -> Result<Choice, SelectError> + Send + 'a,
    ) -> Self {
        Self {
            demand: Demand {
                choose: Box::new(choose),
                most_rows,
            },
            letters: Letters::default(),
            first: Vec::new(),
            form: FileForm::Unknown,
        }
    }

    /// Takes the next bytes.
    ///
    /// # Errors
    /// They do not belong to a trace, or not to one with the requested channels.
    pub fn feed(&mut self, piece: &[u8]) -> Result<(), TraceProblem> {
        if !matches!(self.form, FileForm::Unknown) {
            return self.give(piece);
        }
        self.first.extend(piece);
        if self.first.len() < ENOUGH {
            return Ok(());
        }
        self.begin()
    }

    /// Ends the bytes; returns the channels with their samples.
    ///
    /// # Errors
    /// The bytes are not a trace, or not one with the requested channels.
    pub fn finish(mut self) -> Result<TraceRecording, TraceProblem> {
        if matches!(self.form, FileForm::Unknown) {
            self.begin()?;
        }
        match self.form {
            FileForm::Csv(csv) => csv.finish(&mut self.demand),
            FileForm::Xml(xml) => xml.finish(&mut self.demand),
            FileForm::Unknown => Err(TraceProblem::NoRows),
        }
    }

    /// Recognises the file by its first bytes.
    fn begin(&mut self) -> Result<(), TraceProblem> {
        let first = std::mem::take(&mut self.first);
        if first.starts_with(GZIP) {
            return Err(TraceProblem::Gzip);
        }
        let mark = self.letters.begin(&first);
        let text = self.letters.narrow(&first[mark..]).into_owned();
        if text.iter().take(ENOUGH).any(|&byte| byte == 0) {
            return Err(TraceProblem::Binary);
        }
        self.form = Self::form(&text);
        self.give_narrow(&text)
    }

    fn form(text: &[u8]) -> FileForm {
        match text.trim_ascii_start().first() {
            Some(b'<') => FileForm::Xml(Box::default()),
            // Without the reader of XML, its text is a table without numbers.
            _ => FileForm::Csv(CsvTable::new()),
        }
    }

    fn give(&mut self, piece: &[u8]) -> Result<(), TraceProblem> {
        match self.letters.narrow(piece) {
            std::borrow::Cow::Borrowed(piece) => self.give_narrow(piece),
            std::borrow::Cow::Owned(piece) => self.give_narrow(&piece),
        }
    }

    fn give_narrow(&mut self, piece: &[u8]) -> Result<(), TraceProblem> {
        match &mut self.form {
            FileForm::Csv(csv) => csv.feed(piece, &mut self.demand),
            FileForm::Xml(xml) => xml.feed(piece, &self.demand),
            FileForm::Unknown => Ok(()),
        }
    }
}
