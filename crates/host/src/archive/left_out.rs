//! Contents of folders besides the programs that are taken (R18.5).

use std::collections::{BTreeMap, HashSet};
use std::ffi::{OsStr, OsString};
use std::io::Read;
use std::path::{Path, PathBuf};

use crate::disk::{
    CONFIG_NAME, Disk, FileRegistry, LineReader, decode, is_known_otherwise, open_regular,
};
use crate::machines::Machines;
use frictcomp::diagnostic::{Advice, Code, Diagnostic};
use frictcomp::syntax::{Scan, ScanQuestion, SwitchedAxes, reads_as_program};
use frictcomp::text::{LineSource, Place, Span, shown_path};
use frictcomp::words;

/// Number of bytes that show whether a file is a program.
const FIRST_BYTES: u64 = 64 * 1024;

/// Number of bytes that are read of a file at most.
const MAX_BYTES: u64 = 1 << 20;

words! {
    /// Reason why a file of a folder is not taken as a program.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
    #[non_exhaustive]
    pub enum WhyLeftOut {
        /// File in a folder that an ignore file names.
        IgnoredFolder = "ignored folder",
        /// File in a hidden folder.
        HiddenFolder = "hidden folder",
        /// File in a folder to which a link leads.
        LinkedFolder = "linked folder",
        /// File that an ignore file names.
        Ignored = "ignored",
        /// Hidden file.
        Hidden = "hidden",
        /// Link.
        Link = "link",
        /// File that reads as a program, but has no extension of one.
        Extension = "extension",
        /// File that a pattern of the user names.
        Excluded = "excluded",
        /// File that does not read as a program.
        NoProgram = "no program",
    }
}

/// A file that is not taken as a program.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub struct LeftOutFile {
    /// Path; of what a pattern names, perhaps that of a folder.
    pub path: PathBuf,
    /// The reason.
    pub why: WhyLeftOut,
    /// The place of its first COMP command, where it was read.
    pub switch: Option<Place>,
}

/// The files that are not taken as programs.
#[derive(Debug, Clone, Default)]
#[non_exhaustive]
pub struct LeftOutFiles {
    /// The files, in the order of the folders.
    pub files: Vec<LeftOutFile>,
    /// Whether folders hold too many ignored and hidden entries to look at all of them.
    pub is_cut: bool,
}

impl LeftOutFile {
    /// Creates a file that is not read.
    pub(crate) fn new(path: PathBuf, why: WhyLeftOut) -> Self {
        let switch = None;
        Self { path, why, switch }
    }

    /// Creates a file whose content says whether it is a program.
    pub(crate) fn read(path: PathBuf, why: WhyLeftOut) -> Self {
        let text = Some(&path).filter(|path| !is_known_otherwise(path));
        match text.and_then(|path| program_text(path)) {
            Some(text) => Self::program(path, why, &text),
            None => Self::new(path, WhyLeftOut::NoProgram),
        }
    }

    fn program(path: PathBuf, why: WhyLeftOut, text: &str) -> Self {
        let switch = first_switch(&shown_path(&path), text);
        Self { path, why, switch }
    }

    /// Creates a file in memory whose extension is none of a program; its text says whether it is one.
    pub fn in_memory(path: PathBuf, text: &str) -> Self {
        if !is_known_otherwise(&path) && reads_as_program(text) {
            return Self::program(path, WhyLeftOut::Extension, text);
        }
        Self::new(path, WhyLeftOut::NoProgram)
    }

    /// Returns whether it is a program that the user may believe to be checked.
    pub fn is_program(&self) -> bool {
        !matches!(self.why, WhyLeftOut::Excluded | WhyLeftOut::NoProgram)
    }

    /// Returns whether a list of what is not taken names it, unless all files are asked for.
    pub fn is_listed(&self) -> bool {
        self.why != WhyLeftOut::NoProgram
    }

    /// Returns the reason in words.
    pub fn reason(&self) -> String {
        match self.why {
            WhyLeftOut::IgnoredFolder => "an ignore file names its folder".to_owned(),
            WhyLeftOut::HiddenFolder => "its folder is hidden".to_owned(),
            WhyLeftOut::LinkedFolder => "it lies behind a link".to_owned(),
            WhyLeftOut::Ignored => "an ignore file names it".to_owned(),
            WhyLeftOut::Hidden => "it is hidden".to_owned(),
            WhyLeftOut::Link => "it is a link".to_owned(),
            WhyLeftOut::Extension => match extension(&self.path) {
                Some(extension) => format!("`.{extension}` is no extension of programs"),
                None => "it has no extension".to_owned(),
            },
            WhyLeftOut::Excluded => "it is excluded".to_owned(),
            WhyLeftOut::NoProgram => "it is no program".to_owned(),
        }
    }

    /// Returns FC105 for a program with a COMP command.
    fn diagnostic(&self) -> Option<Diagnostic> {
        let place = self.switch.clone()?;
        let message = format!(
            "this file reads as an NC program and switches compensation, but it is not checked: {}",
            self.reason()
        );
        let help = match (self.why, extension(&self.path)) {
            (WhyLeftOut::Extension, Some(extension)) => Advice::from(format!(
                "add `\"{}\"` to `extensions` in `[check]`, or exclude it",
                extension.to_lowercase()
            )),
            (WhyLeftOut::Extension, None) => Advice::from("give it an extension, or exclude it"),
            _ => Advice::TakeIgnored,
        };
        Some(Diagnostic::new(Code::Fc105, place, message).with_help(help))
    }
}

impl LeftOutFiles {
    /// Removes the programs that were read nevertheless, because others call them.
    pub fn forget_read(&mut self, registry: &FileRegistry) {
        let programs = self.files.iter().filter(|file| file.is_program());
        let names: HashSet<OsString> = programs.filter_map(|it| name_of(&it.path)).collect();
        if names.is_empty() {
            return;
        }
        let read = registry.programs().into_iter();
        let read = read.filter(|path| name_of(path).is_some_and(|name| names.contains(&name)));
        let read: HashSet<PathBuf> = read.map(|path| Disk::place(&path)).collect();
        let is_read = |file: &LeftOutFile| read.contains(&Disk::place(&file.path));
        self.files
            .retain(|file| !file.is_program() || !is_read(file));
    }

    /// Returns FC105 for each program with a COMP command that was not looked at, with the severity that the
    /// configuration of its folder says.
    pub fn diagnostics(&self, machines: &mut Machines) -> Vec<Diagnostic> {
        let mut said = Vec::new();
        for file in &self.files {
            let Some(mut diagnostic) = file.diagnostic() else {
                continue;
            };
            let folder = file.path.parent().unwrap_or(Path::new(""));
            // A configuration that cannot be used is reported where a program needs it.
            let levels = machines
                .for_folder(folder)
                .map(|loaded| loaded.levels.clone());
            if let Some(severity) = levels.unwrap_or_default().severity(diagnostic.code) {
                diagnostic.severity = severity;
                said.push(diagnostic);
            }
        }
        said
    }

    /// Returns the number of other files, which are neither programs nor configurations.
    pub fn others(&self) -> usize {
        let is_other = |file: &&LeftOutFile| {
            file.why == WhyLeftOut::NoProgram && !file.path.ends_with(CONFIG_NAME)
        };
        self.files.iter().filter(is_other).count()
    }

    /// Returns the programs that were not looked at, counted by kind: `153 programs in ignored folders, 2 .prg`.
    pub fn in_words(&self) -> Option<String> {
        let mut kinds: BTreeMap<(WhyLeftOut, String), usize> = BTreeMap::new();
        for file in self.files.iter().filter(|file| file.is_program()) {
            let ending = match file.why {
                WhyLeftOut::Extension => extension(&file.path).unwrap_or_default().to_lowercase(),
                _ => String::new(),
            };
            *kinds.entry((file.why, ending)).or_default() += 1;
        }
        if kinds.is_empty() {
            return None;
        }
        let kinds = kinds.iter().map(|((why, ending), count)| {
            let programs = if *count == 1 { "program" } else { "programs" };
            match why {
                WhyLeftOut::Extension if ending.is_empty() => {
                    format!("{count} {programs} without an extension")
                }
                WhyLeftOut::Extension => format!("{count} `.{ending}`"),
                WhyLeftOut::IgnoredFolder => format!("{count} {programs} in ignored folders"),
                WhyLeftOut::HiddenFolder => format!("{count} {programs} in hidden folders"),
                WhyLeftOut::LinkedFolder => format!("{count} {programs} in linked folders"),
                WhyLeftOut::Link if *count == 1 => "1 link".to_owned(),
                WhyLeftOut::Link => format!("{count} links"),
                _ => format!("{count} {} {programs}", why.as_str()),
            }
        });
        let kinds: Vec<String> = kinds.collect();
        let more = if self.is_cut { "at least " } else { "" };
        Some(format!("{more}{}", kinds.join(", ")))
    }
}

fn name_of(path: &Path) -> Option<OsString> {
    path.file_name().map(OsStr::to_owned)
}

fn extension(path: &Path) -> Option<&str> {
    path.extension()?.to_str()
}

/// Returns the text of a file that reads as a program, at most 1 MB of it.
fn program_text(path: &Path) -> Option<String> {
    let (mut file, _) = open_regular(path).ok()?;
    let mut bytes = Vec::new();
    file.by_ref()
        .take(FIRST_BYTES)
        .read_to_end(&mut bytes)
        .ok()?;
    let is_whole = (bytes.len() as u64) < FIRST_BYTES;
    if !is_whole && reads_as_program(&whole_lines(&bytes)) {
        file.take(MAX_BYTES - FIRST_BYTES)
            .read_to_end(&mut bytes)
            .ok()?;
        return Some(whole_lines(&bytes));
    }
    let text = decode(bytes);
    (is_whole && reads_as_program(&text)).then_some(text)
}

/// Returns the whole lines of a text that was cut.
fn whole_lines(bytes: &[u8]) -> String {
    let mut text = decode(bytes.to_vec());
    text.truncate(text.rfind(['\n', '\r']).unwrap_or(text.len()));
    text
}

/// Returns the place of the first COMP command of a program.
fn first_switch(file: &str, text: &str) -> Option<Place> {
    let switches = |text: &str| {
        let mut scan = Scan::new(SwitchedAxes::default());
        scan.feed(text.as_bytes());
        !scan.question.0.is_empty()
    };
    if !switches(text) {
        return None;
    }
    let place = |line: &str, first_line| Place {
        file: file.into(),
        text: line.trim_end().into(),
        first_line,
        span: Span::new(0, line.trim_end().len()),
    };
    let mut lines = LineReader::new(text.as_bytes());
    let mut number = 0;
    while lines.advance() {
        number += 1;
        let line = lines.line().text;
        if SwitchedAxes::default().next(line.as_bytes(), 0).is_some() && switches(line) {
            return Some(place(line, number));
        }
    }
    // A command over several lines.
    Some(place("", 1))
}
