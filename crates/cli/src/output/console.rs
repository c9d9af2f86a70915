//! The destinations of results and messages: results to stdout, messages to stderr (R9.27).

use std::io::{self, IsTerminal, Write};

use anstream::{AutoStream, ColorChoice};
use clap::ValueEnum;

use super::code_page::{CodePage, Encoded};
use super::failure::Failure;
use super::painted::painted;
use super::piped::Piped;
use super::progress::{OverProgress, clear};
use frictcomp::diagnostic::Diagnostic;
use frictcomp_host::Replaces;
use frictcomp_report::{
    Detail, FALLBACK_WIDTH, Look, Paint, command_line, fitted, leading, render, visible, wrap,
};

/// Widths that text can be laid out for.
pub(crate) const WIDTHS: std::ops::RangeInclusive<usize> = 20..=1000;

/// When output is coloured.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, ValueEnum)]
pub(crate) enum Color {
    /// On a terminal, unless `NO_COLOR` is set.
    #[default]
    Auto,
    /// Always.
    Always,
    /// Never.
    Never,
}

/// The user's terminal, or its replacement.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Console {
    color: Color,
    /// Value of `--width`.
    width: Option<usize>,
    remarks: RemarkOutput,
    /// Extent of text.
    pub(crate) detail: Detail,
    written: OutputContents,
    /// Files that every output may replace by `--force`.
    pub(crate) forced: Option<Replaces>,
}

/// Contents of standard output.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum OutputContents {
    /// Text for people.
    Text,
    /// Records for programs, which are UTF-8 everywhere.
    Records,
}

/// Treatment of remarks in addition to the results.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum RemarkOutput {
    Said,
    Kept,
}

/// A destination for data, and how text looks there.
pub(crate) struct DataTarget {
    pub(crate) writer: Box<dyn Write + Send>,
    pub(crate) look: Look,
}

/// Reception of the output: whole, or broken off.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Printed {
    /// All output was read.
    Read,
    /// The pipe was closed.
    Unread,
}

impl DataTarget {
    /// Writes a text; a closed pipe is not an error.
    pub(crate) fn text(&mut self, text: &str) -> Result<Printed, Failure> {
        let written = self.writer.write_all(text.as_bytes());
        match written.and_then(|()| self.writer.flush()) {
            Ok(()) => Ok(Printed::Read),
            Err(error) if error.kind() == io::ErrorKind::BrokenPipe => Ok(Printed::Unread),
            Err(error) => Err(Failure::output(error)),
        }
    }

    /// Writes a text, with lines in the styles that `style` returns.
    pub(crate) fn painted(
        &mut self,
        text: &str,
        style: fn(&str) -> anstyle::Style,
    ) -> Result<Printed, Failure> {
        self.text(&painted(&visible(text), self.look, style))
    }
}

impl Console {
    pub(crate) fn new(color: Color, width: Option<usize>) -> Self {
        Self {
            color,
            width,
            remarks: RemarkOutput::Said,
            detail: Detail::Brief,
            written: OutputContents::Text,
            forced: None,
        }
    }

    /// Returns the console with the setting of `--force`.
    pub(crate) fn forcing(self, forced: Option<Replaces>) -> Self {
        Self { forced, ..self }
    }

    /// Returns the console with the extent of text set.
    pub(crate) fn detailed(self, detail: Detail) -> Self {
        Self { detail, ..self }
    }

    /// Returns the console with the contents of standard output set.
    pub(crate) fn writing(self, written: OutputContents) -> Self {
        Self { written, ..self }
    }

    /// Returns the columns available for text: from the user, else from the terminal, else from `COLUMNS`, else
    /// 100 (R9.72).
    fn width(self, terminal: Option<(terminal_size::Width, terminal_size::Height)>) -> usize {
        let terminal = terminal.map(|(width, _)| usize::from(width.0));
        self.width.unwrap_or_else(|| {
            terminal
                .or_else(columns)
                .unwrap_or(FALLBACK_WIDTH)
                .clamp(*WIDTHS.start(), *WIDTHS.end())
        })
    }

    /// Returns the console without remarks, only with results and failures, if the user asks for no more of them.
    pub(crate) fn quiet(self) -> Result<Self, Failure> {
        let remarks = RemarkOutput::Kept;
        match self.detail {
            Detail::Brief => Ok(Self { remarks, ..self }),
            Detail::Full => Err(Failure::new("`--quiet` and `--verbose` exclude each other")),
        }
    }

    /// Returns the appearance of text in a file.
    pub(crate) fn file_look(self) -> Look {
        let paint = match self.color {
            Color::Always => Paint::Styled,
            Color::Auto | Color::Never => Paint::Plain,
        };
        Look {
            paint,
            width: self.width(None),
            detail: self.detail,
        }
    }

    /// Returns standard output.
    pub(crate) fn stdout(self) -> DataTarget {
        let stdout = io::stdout();
        let choice = self.choice(AutoStream::choice(&stdout));
        let width = self.width(terminal_size::terminal_size_of(&stdout));
        DataTarget {
            look: Look {
                paint: paint(choice),
                width,
                detail: self.detail,
            },
            // Old Windows consoles need their own calls; elsewhere nothing is in between.
            writer: match (self.code_page(&stdout), paint(choice)) {
                (Some(page), _) => Box::new(Encoded::new(Piped(stdout), page)),
                (None, Paint::Styled) => Box::new(OverProgress(AutoStream::new(stdout, choice))),
                (None, Paint::Plain) if stdout.is_terminal() => Box::new(OverProgress(stdout)),
                (None, Paint::Plain) => Box::new(Piped(stdout)),
            },
        }
    }

    /// Returns the code page of the text that goes to standard output, if that is not UTF-8.
    fn code_page(self, stdout: &io::Stdout) -> Option<CodePage> {
        match self.written {
            OutputContents::Text => CodePage::behind(stdout),
            OutputContents::Records => None,
        }
    }

    /// Writes a text to stdout, with symbols for invisible characters (R9.76); a closed pipe is not an
    /// error.
    pub(crate) fn print(self, text: &str) -> Result<Printed, Failure> {
        self.stdout().text(&visible(text))
    }

    /// Returns a text for people, wrapped to fit the lines of stdout (R9.72).
    pub(crate) fn fitted(self, text: &str) -> String {
        let width = self.width(terminal_size::terminal_size_of(io::stdout()));
        fitted(&visible(text), width)
    }

    /// Writes a text to stdout, with lines in the styles that `style` returns.
    pub(crate) fn print_painted(
        self,
        text: &str,
        style: fn(&str) -> anstyle::Style,
    ) -> Result<Printed, Failure> {
        self.stdout().painted(text, style)
    }

    /// Writes a line to stderr; a closed stderr is not an error.
    pub(crate) fn talk(line: &str) {
        clear();
        let _ = writeln!(stderr(ColorChoice::Never), "{}", leading(line));
    }

    /// Writes a line to stderr, unless the user asked only for what matters.
    pub(crate) fn remark(self, line: &str) {
        if self.remarks == RemarkOutput::Said {
            Self::talk(line);
        }
    }

    /// Writes a line to stderr if the user asked for full detail.
    pub(crate) fn detail(self, line: &str) {
        if self.detail == Detail::Full {
            self.remark(line);
        }
    }

    /// Shows diagnostics on stderr.
    pub(crate) fn show(self, diagnostics: &[Diagnostic]) {
        let stderr = io::stderr();
        let choice = self.choice(AutoStream::choice(&stderr));
        let look = Look {
            paint: paint(choice),
            width: self.width(terminal_size::terminal_size_of(&stderr)),
            detail: self.detail,
        };
        let mut writer = self::stderr(choice);
        for diagnostic in diagnostics {
            let mut diagnostic = diagnostic.clone();
            diagnostic.reword(Some(command_line));
            let _ = writeln!(writer, "{}", render(&diagnostic, look));
        }
    }

    /// Writes to stderr why the tool could not do its work.
    pub(crate) fn explain(self, failure: &Failure) {
        self.show(&failure.diagnostics);
        let stderr = io::stderr();
        let choice = self.choice(AutoStream::choice(&stderr));
        let look = Look {
            paint: paint(choice),
            width: self.width(terminal_size::terminal_size_of(&stderr)),
            detail: self.detail,
        };
        let mut writer = self::stderr(choice);
        let (bold, plain) = match look.paint {
            Paint::Plain => (anstyle::Style::new(), anstyle::Style::new()),
            Paint::Styled => (
                anstyle::AnsiColor::Red.on_default().bold(),
                anstyle::AnsiColor::Cyan.on_default(),
            ),
        };
        let message = wrap(&failure.message, look.width, 7).replace('\n', "\n       ");
        let _ = writeln!(writer, "{bold}error{bold:#}: {message}");
        for help in &failure.help {
            let help = wrap(help, look.width, 6).replace('\n', "\n      ");
            let _ = writeln!(writer, "{plain}help{plain:#}: {help}");
        }
    }

    fn choice(self, automatic: ColorChoice) -> ColorChoice {
        match self.color {
            Color::Auto => automatic,
            Color::Always => ColorChoice::Always,
            Color::Never => ColorChoice::Never,
        }
    }
}

/// Returns standard error, in the code page of its reader.
fn stderr(choice: ColorChoice) -> Box<dyn Write> {
    let stderr = io::stderr();
    match (CodePage::behind(&stderr), paint(choice)) {
        (Some(page), _) => Box::new(Encoded::new(stderr.lock(), page)),
        (None, Paint::Plain) => Box::new(stderr.lock()),
        (None, Paint::Styled) => Box::new(AutoStream::new(stderr.lock(), choice)),
    }
}

/// Returns the width that the environment gives.
fn columns() -> Option<usize> {
    std::env::var("COLUMNS")
        .ok()?
        .trim()
        .parse()
        .ok()
        .filter(|&columns| columns > 0)
}

fn paint(choice: ColorChoice) -> Paint {
    match choice {
        ColorChoice::Never => Paint::Plain,
        ColorChoice::Auto | ColorChoice::Always | ColorChoice::AlwaysAnsi => Paint::Styled,
    }
}
