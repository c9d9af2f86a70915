//! How far the programs of a command are, for who watches (R9.75).

use std::fs::File;
use std::io::Read;
use std::ops::ControlFlow;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Mutex, PoisonError};

use super::progress::Progress;
use crate::timeline::{Record, Row, Sink};

/// Blocks between two looks at the clock.
const STEP: u64 = 1 << 14;

/// How far the programs of a command are.
#[derive(Debug)]
pub(super) struct Watch {
    programs: AtomicU64,
    done: AtomicU64,
    shown: Mutex<Shown>,
}

#[derive(Debug)]
struct Shown {
    progress: Progress,
    /// The lines of the program that is shown.
    lines: Option<(String, u64)>,
}

impl Default for Watch {
    fn default() -> Self {
        let shown = Shown {
            progress: Progress::new(),
            lines: None,
        };
        Self {
            programs: AtomicU64::new(0),
            done: AtomicU64::new(0),
            shown: Mutex::new(shown),
        }
    }
}

impl Watch {
    /// So many programs are to run.
    pub(super) fn expect(&self, programs: usize) {
        let programs = u64::try_from(programs).unwrap_or(u64::MAX);
        self.programs.store(programs, Ordering::Relaxed);
    }

    /// A program has run.
    pub(super) fn program_done(&self) {
        self.done.fetch_add(1, Ordering::Relaxed);
    }

    /// Whether somebody watches.
    pub(super) fn is_on(&self) -> bool {
        let shown = self.shown.lock().unwrap_or_else(PoisonError::into_inner);
        shown.progress.is_watched()
    }

    /// Shows how far a program is: what was done of it, and at which line it stands.
    pub(super) fn show(&self, done: &str, (file, line): (&str, u32), way: Way) {
        // Who comes while another program shows itself need not wait.
        let Ok(mut shown) = self.shown.try_lock() else {
            return;
        };
        let Shown { progress, lines } = &mut *shown;
        progress.show(|| {
            if way == Way::Down && lines.as_ref().is_none_or(|(known, _)| known != file) {
                *lines = Some((file.to_owned(), count_lines(file)));
            }
            let all = lines.as_ref().map_or(0, |(_, all)| *all);
            let all = if way == Way::Down { all } else { 0 };
            let programs = self.programs.load(Ordering::Relaxed);
            let current = self.done.load(Ordering::Relaxed) + 1;
            far((current, programs), &format!("{done}{}", share(line, all)))
        });
    }
}

/// How control goes through a program.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) enum Way {
    /// From its first line to its last.
    #[default]
    Down,
    /// It comes back: nobody knows how often.
    Back,
}

/// Which way control went through a program so far.
#[derive(Debug, Default)]
pub(super) struct Course {
    line: u32,
    way: Way,
}

impl Course {
    /// Control reaches a line.
    pub(super) fn reach(&mut self, line: u32) -> Way {
        if line < self.line {
            self.way = Way::Back;
        }
        self.line = line;
        self.way
    }
}

/// `program 2 of 12: 300000 blocks, line 20 of 400 (5 %)`
fn far((current, programs): (u64, u64), what: &str) -> String {
    if programs > 1 {
        format!("program {} of {programs}: {what}", current.min(programs))
    } else {
        what.to_owned()
    }
}

fn share(line: u32, all: u64) -> String {
    match u64::from(line).saturating_mul(100).checked_div(all) {
        Some(percent) if percent <= 100 => format!(", line {line} of {all} ({percent} %)"),
        _ => format!(", line {line}"),
    }
}

/// The lines of a program; 0 where it cannot be read again.
fn count_lines(file: &str) -> u64 {
    let path = std::path::Path::new(file);
    if !path.is_file() {
        return 0;
    }
    let Ok(mut file) = File::open(path) else {
        return 0;
    };
    let mut piece = vec![0; 256 * 1024];
    let mut lines = 0;
    while let Ok(count) = file.read(&mut piece) {
        if count == 0 {
            break;
        }
        lines += memchr::memchr_iter(b'\n', &piece[..count]).count();
    }
    u64::try_from(lines).unwrap_or(u64::MAX)
}

/// Lets a watch see the records on their way to a sink.
pub(super) struct Watched<'a> {
    sink: &'a mut dyn Sink,
    watch: &'a Watch,
    blocks: u64,
    course: Course,
}

impl<'a> Watched<'a> {
    /// The records of one program.
    pub(super) fn new(sink: &'a mut dyn Sink, watch: &'a Watch) -> Self {
        Self {
            sink,
            watch,
            blocks: 0,
            course: Course::default(),
        }
    }

    fn step(&mut self, row: &Row<'_>) {
        self.blocks += 1;
        if row.level.is_none() {
            self.course.reach(row.line);
        }
        if self.blocks.is_multiple_of(STEP) {
            let done = format!("{} blocks", self.blocks);
            self.watch
                .show(&done, (row.file, row.line), self.course.way);
        }
    }
}

impl Sink for Watched<'_> {
    fn record(&mut self, record: &Record<'_>) -> ControlFlow<()> {
        if let Record::Block(row) = record {
            self.step(row);
        }
        self.sink.record(record)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_share_of_the_whole_is_shown() {
        // R9.75
        assert_eq!(
            far((1, 1), &format!("5 blocks{}", share(3, 12))),
            "5 blocks, line 3 of 12 (25 %)"
        );
        assert_eq!(far((2, 9), "5 blocks"), "program 2 of 9: 5 blocks");
        assert_eq!(share(3, 0), ", line 3");
        let mut course = Course::default();
        let ways = [1, 2, 2, 1, 2].map(|line| course.reach(line));
        assert_eq!(
            ways,
            [Way::Down, Way::Down, Way::Down, Way::Back, Way::Back]
        );
        let file = tempfile::NamedTempFile::new().unwrap();
        std::fs::write(file.path(), "N1\nN2\n").unwrap();
        assert_eq!(count_lines(&file.path().display().to_string()), 2);
    }
}
