//! Files as Scope and SINUMERIK write them, made from the rules and not from the reader.

use std::fmt::Write as _;

/// A channel that is written.
#[derive(Debug, Clone)]
pub struct Signal {
    /// Name in the recording.
    pub name: String,
    /// Comment, of one line or several.
    pub comment: String,
    /// Unit, or nothing.
    pub unit: String,
    /// Number of the axis.
    pub axis: u32,
    /// Samples, from the first on.
    pub samples: Vec<f64>,
}

/// Channels with a column of times.
#[derive(Debug, Clone)]
pub struct Task {
    /// Time between two samples in ms.
    pub step_ms: f64,
    /// Channels, in the order of their columns.
    pub signals: Vec<Signal>,
}

/// The lines above the numbers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Header {
    /// Every row of attributes.
    Full,
    /// Only the row `Name`, which describes the channels.
    Names,
    /// Only the row `SymbolName`.
    Symbols,
    /// Rows of attributes, but none about the file.
    WithoutFile,
    /// No header.
    None,
}

/// The form of the times.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Times {
    /// Milliseconds since the start.
    Milliseconds,
    /// 100 ns since the year 1601.
    FileTime,
    /// No columns of times.
    None,
}

/// The contents of the rows of a channel that is sampled less often.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Filled {
    /// Samples at the top, with blank rows below.
    Blank,
    /// Samples at the top, with short rows below.
    Short,
    /// Each sample repeated until the next one.
    Repeated,
    /// Each sample at its time, with blanks in between.
    Shifted,
}

/// The form of comments of several lines.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Comments {
    /// Comments in quotation marks.
    Quoted,
    /// Comments as they are.
    Bare,
}

/// The encoding of the bytes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Letters {
    /// UTF-8.
    Utf8,
    /// UTF-8 with a byte order mark.
    Marked,
    /// ISO 8859-1.
    Latin,
    /// UTF-16, low byte first.
    Little,
    /// UTF-16, high byte first.
    Big,
}

/// The cell of a channel in a row of attributes.
type Cell<'a> = &'a dyn Fn(&Task, &Signal) -> String;

/// An export of Scope.
#[derive(Debug, Clone)]
pub struct Export {
    /// Tasks, each with its column of times.
    pub tasks: Vec<Task>,
    /// Character between two cells.
    pub separator: char,
    /// Decimal point or comma.
    pub decimal: char,
    /// Lines above the numbers.
    pub header: Header,
    /// Form of the times.
    pub times: Times,
    /// Rows of channels that are sampled less often.
    pub filled: Filled,
    /// Form of comments of several lines.
    pub comments: Comments,
    /// Encoding.
    pub letters: Letters,
    /// Line end.
    pub end: &'static str,
    /// Whether a last line says `EOF`.
    pub has_eof: bool,
    /// Whether each line ends with a separator.
    pub ends_in_separator: bool,
}

const ORIGIN: u64 = 132_959_733_843_760_000;

impl Export {
    /// Returns the bytes of the file.
    pub fn bytes(&self) -> Vec<u8> {
        let text = self.text().replace('\n', self.end);
        match self.letters {
            Letters::Utf8 => text.into_bytes(),
            Letters::Marked => [&b"\xef\xbb\xbf"[..], text.as_bytes()].concat(),
            Letters::Latin => text
                .chars()
                .map(|it| u8::try_from(it as u32).unwrap_or(b'?'))
                .collect(),
            Letters::Little => {
                let units = format!("\u{feff}{text}");
                units.encode_utf16().flat_map(u16::to_le_bytes).collect()
            }
            Letters::Big => {
                let units = format!("\u{feff}{text}");
                units.encode_utf16().flat_map(u16::to_be_bytes).collect()
            }
        }
    }

    fn text(&self) -> String {
        let mut text = String::new();
        let s = self.separator;
        if matches!(self.header, Header::Full | Header::Names | Header::Symbols) {
            let _ = write!(
                text,
                "Name{s}Friction of X\nFile{s}C:\\traces\\friction.csv\n\
                 Starttime of export{s}{ORIGIN}{s}Montag, 2. Mai 2022{s}15:56:24.376\n\
                 Endtime of export{s}{}{s}Montag, 2. Mai 2022{s}15:56:25.375\n\n\n",
                ORIGIN + 10_000_000
            );
        }
        let offset = |signal: &Signal| (signal.axis * 0x1_0000 + 0x17).to_string();
        let symbol = |signal: &Signal| format!("Axes.{}", signal.name.replace(' ', "_"));
        let all: [(&str, Cell<'_>); 12] = [
            ("Name", &|_, signal| signal.name.clone()),
            ("SymbolComment", &|_, signal| self.comment(&signal.comment)),
            ("Data-Type", &|_, _| "REAL64".to_owned()),
            // Written in the language of the system, whatever the numbers below look like.
            ("SampleTime[ms]", &|task, _| {
                task.step_ms.to_string().replace('.', ",")
            }),
            ("VariableSize", &|_, _| "8".to_owned()),
            ("IndexGroup", &|_, _| 0x12_0300.to_string()),
            ("IndexOffset", &|_, signal| offset(signal)),
            ("SymbolName", &|_, signal| symbol(signal)),
            ("Offset", &|_, _| "5".to_owned()),
            ("ScaleFactor", &|_, _| "-1".to_owned()),
            ("Unit", &|_, signal| match signal.unit.as_str() {
                "" => "(None)".to_owned(),
                unit => format!("{unit} (Something)"),
            }),
            ("Unit ScaleFactor", &|_, _| "1".to_owned()),
        ];
        let rows = all.iter().filter(|(key, _)| match self.header {
            Header::Full | Header::WithoutFile => true,
            Header::Names => *key == "Name",
            Header::Symbols => *key == "SymbolName",
            Header::None => false,
        });
        for (key, cell) in rows {
            let mut cells = Vec::new();
            for task in &self.tasks {
                cells.push((*key).to_owned());
                cells.extend(task.signals.iter().map(|signal| cell(task, signal)));
            }
            self.row(&mut text, &cells);
        }
        if self.header != Header::None {
            text.push('\n');
        }
        self.numbers(&mut text);
        if self.has_eof {
            text.push_str("EOF\n");
        }
        text
    }

    fn comment(&self, comment: &str) -> String {
        match self.comments {
            Comments::Quoted if comment.contains('\n') => {
                format!("\"{}\"", comment.replace('"', "\"\""))
            }
            _ => comment.to_owned(),
        }
    }

    fn row(&self, text: &mut String, cells: &[String]) {
        text.push_str(&cells.join(&self.separator.to_string()));
        if self.ends_in_separator {
            text.push(self.separator);
        }
        text.push('\n');
    }

    fn number(&self, number: f64) -> String {
        number.to_string().replace('.', &self.decimal.to_string())
    }

    fn time(&self, task: &Task, at: usize) -> Vec<String> {
        let ms = task.step_ms * at as f64;
        match self.times {
            Times::Milliseconds => vec![self.number((ms * 1e6).round() / 1e6)],
            Times::FileTime => vec![(ORIGIN + (ms * 1e4).round() as u64).to_string()],
            Times::None => Vec::new(),
        }
    }

    fn numbers(&self, text: &mut String) {
        let fastest = self
            .tasks
            .iter()
            .map(|task| task.step_ms)
            .fold(f64::INFINITY, f64::min);
        let longest = |task: &Task| {
            task.signals
                .iter()
                .map(|it| it.samples.len())
                .max()
                .unwrap_or(0)
        };
        let ratio = |task: &Task| (task.step_ms / fastest).round() as usize;
        let rows = self.tasks.iter().map(|task| match self.filled {
            Filled::Blank | Filled::Short => longest(task),
            Filled::Repeated | Filled::Shifted => longest(task) * ratio(task),
        });
        for row in 0..rows.max().unwrap_or(0) {
            let mut cells = Vec::new();
            for task in &self.tasks {
                let ratio = ratio(task);
                let at = match self.filled {
                    Filled::Blank | Filled::Short => Some(row),
                    Filled::Repeated => Some(row / ratio),
                    Filled::Shifted => (row % ratio == 0).then_some(row / ratio),
                };
                let at = at.filter(|&at| at < longest(task));
                let blank = vec![String::new(); usize::from(self.times != Times::None)];
                cells.extend(at.map_or(blank, |at| self.time(task, at)));
                for signal in &task.signals {
                    let sample = at.and_then(|at| signal.samples.get(at));
                    cells.push(sample.map_or_else(String::new, |&it| self.number(it)));
                }
            }
            if self.filled == Filled::Short {
                while cells.last().is_some_and(String::is_empty) {
                    cells.pop();
                }
                let _ = writeln!(text, "{}", cells.join(&self.separator.to_string()));
            } else {
                self.row(text, &cells);
            }
        }
    }
}

/// Returns a trace of a SINUMERIK control.
pub fn sinumerik(task: &Task, are_names_apart: bool) -> String {
    let mut text = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<traceSession>\n".to_owned();
    let escape = |text: &str| {
        text.replace('&', "&amp;")
            .replace('<', "&lt;")
            .replace('"', "&quot;")
    };
    let describe = |at: usize, signal: &Signal| {
        format!(
            "name=\"/Nck/{}\" description=\"{}\" units=\"{}\" key=\"k{at}\"",
            at,
            escape(&signal.name),
            escape(&signal.unit)
        )
    };
    if are_names_apart {
        text.push_str(" <traceDisplaySetup><signals>\n");
        for (at, signal) in task.signals.iter().enumerate().rev() {
            let _ = writeln!(text, "  <signal {}/>", describe(at, signal));
        }
        text.push_str(" </signals></traceDisplaySetup>\n");
    }
    text.push_str(" <traceData><!-- > --><dataFrame>\n");
    for (at, signal) in task.signals.iter().enumerate() {
        let attributes = if are_names_apart {
            format!("key=\"k{at}\"")
        } else {
            describe(at, signal)
        };
        let _ = writeln!(text, "  <dataSignal {attributes}/>");
    }
    let rows = task
        .signals
        .iter()
        .map(|it| it.samples.len())
        .max()
        .unwrap_or(0);
    for row in 0..rows {
        let _ = write!(
            text,
            "  <rec time=\"{}\"",
            task.step_ms * row as f64 / 1000.0
        );
        for (at, signal) in task.signals.iter().enumerate() {
            if let Some(sample) = signal.samples.get(row) {
                let _ = write!(text, " f{}=\"{sample}\"", at + 1);
            }
        }
        text.push_str("/>\n");
    }
    text.push_str(" </dataFrame></traceData>\n</traceSession>\n");
    text
}
