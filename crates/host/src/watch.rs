//! Progress reports of long work, for a watcher (R9.75).

use std::fmt;
use std::fs::File;
use std::io::Read;
use std::ops::ControlFlow;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex};
use std::time::Duration;

use frictcomp::timeline::{Record, Row, Sink};

/// Number of blocks between two looks at the clock.
const STEP: u64 = 1 << 14;

/// Watcher of long work.
pub trait Watcher: fmt::Debug + Send + Sync {
    /// Returns whether a progress report is due. Called often, and by several threads.
    fn is_due(&self) -> bool;

    /// Receives the progress of the work.
    fn show(&self, progress: &Progress);

    /// Returns whether the work is to stop. It then ends early, and its result is not usable.
    fn is_stopped(&self) -> bool {
        false
    }
}

/// Progress of long work.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub struct Progress {
    /// Completed part.
    pub done: Done,
    /// The program that runs, counted from 1, and how many there are, where there are several.
    pub program: Option<(u64, u64)>,
    /// The current line of the program.
    pub line: Option<u32>,
    /// The lines of the program, where control goes through them once.
    pub lines: Option<u64>,
}

/// Part of long work.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub enum Done {
    /// Executed blocks.
    Blocks(u64),
    /// CNC cycles of a trace.
    Cycles(u64),
    /// Whole seconds of machine time, and those of the whole program.
    MachineTime {
        /// Machine time covered.
        seconds: u64,
        /// Machine time of the whole program.
        all: u64,
    },
    /// Runs of a simulation.
    Runs {
        /// Subject of the simulation.
        of: &'static str,
        /// The completed runs.
        done: usize,
        /// All runs of this step.
        all: usize,
    },
}

impl From<Done> for Progress {
    fn from(done: Done) -> Self {
        Self {
            done,
            program: None,
            line: None,
            lines: None,
        }
    }
}

impl Progress {
    /// Returns the part of the whole that is done, where the whole is known.
    pub fn part(&self) -> Option<f64> {
        let count = |count: usize| u64::try_from(count).unwrap_or(u64::MAX);
        let (done, all) = match self.done {
            Done::Runs { done, all, .. } => (count(done), count(all)),
            Done::MachineTime { seconds, all } => (seconds, all),
            Done::Blocks(_) | Done::Cycles(_) => (self.line?.into(), self.lines?),
        };
        let part = Duration::from_secs(done).as_secs_f64() / Duration::from_secs(all).as_secs_f64();
        (self.program.is_none() && part > 0.0 && part <= 1.0).then_some(part)
    }
}

/// `program 2 of 12: 300000 blocks, line 20 of 400 (5 %)`
impl fmt::Display for Progress {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some((current, all)) = self.program {
            write!(f, "program {current} of {all}: ")?;
        }
        match self.done {
            Done::Blocks(blocks) => write!(f, "{blocks} blocks")?,
            Done::Cycles(cycles) => write!(f, "{cycles} cycles")?,
            Done::MachineTime { seconds, all } => {
                write!(f, "{seconds} of {all} s of machine time")?;
                let percent = seconds.saturating_mul(100).checked_div(all);
                if let Some(percent) = percent.filter(|percent| *percent <= 100) {
                    write!(f, " ({percent} %)")?;
                }
            }
            Done::Runs { of, done, all } => write!(f, "{of}: {}", bar(done, all))?,
        }
        let Some(line) = self.line else {
            return Ok(());
        };
        let all = self.lines.unwrap_or_default();
        match u64::from(line).saturating_mul(100).checked_div(all) {
            Some(percent) if percent <= 100 => write!(f, ", line {line} of {all} ({percent} %)"),
            _ => write!(f, ", line {line}"),
        }
    }
}

/// Returns a bar such as `[#####...............] 25 %`.
fn bar(done: usize, all: usize) -> String {
    const WIDTH: usize = 20;
    let part = |whole: usize| done.saturating_mul(whole) / all.max(1);
    let filled = part(WIDTH).min(WIDTH);
    let percent = part(100).min(100);
    format!(
        "[{}{}] {percent} %",
        "#".repeat(filled),
        ".".repeat(WIDTH - filled)
    )
}

/// Progress of the programs of a piece of work.
#[derive(Debug, Default)]
pub struct Watch {
    watcher: Option<Arc<dyn Watcher>>,
    programs: AtomicU64,
    done: AtomicU64,
    /// The lines of the program that was shown last.
    lines: Mutex<Option<(String, u64)>>,
}

impl Watch {
    /// Creates a watch that reports to a watcher.
    pub fn by(watcher: Arc<dyn Watcher>) -> Self {
        Self {
            watcher: Some(watcher),
            ..Self::default()
        }
    }

    /// Announces the number of programs to run.
    pub fn expect(&self, programs: usize) {
        let programs = u64::try_from(programs).unwrap_or(u64::MAX);
        self.programs.store(programs, Ordering::Relaxed);
    }

    /// Counts a program that has run.
    pub fn program_done(&self) {
        self.done.fetch_add(1, Ordering::Relaxed);
    }

    /// Returns whether there is a watcher.
    pub fn is_on(&self) -> bool {
        self.watcher.is_some()
    }

    /// Returns whether the watcher stops the work.
    pub fn is_stopped(&self) -> bool {
        self.watcher.as_ref().is_some_and(|it| it.is_stopped())
    }

    /// Shows the progress of work that does not run programs.
    pub fn show(&self, done: impl FnOnce() -> Done) {
        if let Some(watcher) = self.watcher.as_ref().filter(|it| it.is_due()) {
            watcher.show(&done().into());
        }
    }

    /// Shows the progress of a program: the work done, and its current line.
    pub fn show_program(&self, done: Done, reached: Reached<'_>, passes: Passes) {
        let Some(watcher) = self.watcher.as_ref().filter(|it| it.is_due()) else {
            return;
        };
        let Reached { file, line } = reached;
        // If another program is being shown, this one need not wait.
        let Ok(mut known) = self.lines.try_lock() else {
            return;
        };
        if passes == Passes::Once && known.as_ref().is_none_or(|(known, _)| known != file) {
            *known = Some((file.to_owned(), count_lines(file)));
        }
        let lines = known.as_ref().map(|(_, lines)| *lines);
        let programs = self.programs.load(Ordering::Relaxed);
        let current = self.done.load(Ordering::Relaxed) + 1;
        watcher.show(&Progress {
            done,
            program: (programs > 1).then(|| (current.min(programs), programs)),
            line: Some(line),
            lines: lines.filter(|_| passes == Passes::Once),
        });
    }
}

/// The line of a program that control has reached.
#[derive(Debug, Clone, Copy)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct Reached<'a> {
    /// The name of the program.
    pub file: &'a str,
    /// Line, from 1.
    pub line: u32,
}

/// Number of passes of control flow through a program.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[non_exhaustive]
pub enum Passes {
    /// One pass, from the first line to the last.
    #[default]
    Once,
    /// Unknown number of passes: the program jumps back.
    Repeated,
}

/// Tracks whether control flow passes through the lines of a program once.
#[derive(Debug, Default)]
pub struct LineTracker {
    line: u32,
    passes: Passes,
}

impl LineTracker {
    /// Notes that control flow has reached a line.
    pub fn reach(&mut self, line: u32) -> Passes {
        if line < self.line {
            self.passes = Passes::Repeated;
        }
        self.line = line;
        self.passes
    }
}

/// Returns the number of lines of a program; 0 where it cannot be read again.
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

/// Reports records to a watch on their way to a sink.
pub(super) struct Watched<'a> {
    sink: &'a mut dyn Sink,
    watch: &'a Watch,
    blocks: u64,
    tracker: LineTracker,
}

impl<'a> Watched<'a> {
    /// Watches the records of one program.
    pub(super) fn new(sink: &'a mut dyn Sink, watch: &'a Watch) -> Self {
        Self {
            sink,
            watch,
            blocks: 0,
            tracker: LineTracker::default(),
        }
    }

    fn step(&mut self, row: &Row<'_>) {
        self.blocks += 1;
        if row.level.is_none() {
            self.tracker.reach(row.line);
        }
        if self.blocks.is_multiple_of(STEP) {
            let done = Done::Blocks(self.blocks);
            let reached = Reached {
                file: row.file,
                line: row.line,
            };
            self.watch.show_program(done, reached, self.tracker.passes);
        }
    }
}

impl Sink for Watched<'_> {
    fn record(&mut self, record: &Record<'_>) -> ControlFlow<()> {
        if let Record::Block(row) = record {
            self.step(row);
            if self.blocks.is_multiple_of(STEP) && self.watch.is_stopped() {
                return ControlFlow::Break(());
            }
        }
        self.sink.record(record)
    }

    fn takes_quiet(&mut self) -> bool {
        // At every step its place is shown.
        let is_step = (self.blocks + 1).is_multiple_of(STEP);
        let is_taken = is_step || self.sink.takes_quiet();
        self.blocks += u64::from(!is_taken);
        is_taken
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_share_of_the_whole_is_shown() {
        // R5.37 R9.75
        let mut far = Progress::from(Done::Blocks(5));
        assert_eq!(far.to_string(), "5 blocks");
        far.program = Some((2, 9));
        far.line = Some(3);
        assert_eq!(far.to_string(), "program 2 of 9: 5 blocks, line 3");
        far.lines = Some(12);
        far.program = None;
        assert_eq!(far.to_string(), "5 blocks, line 3 of 12 (25 %)");
        assert_eq!(far.part(), Some(0.25));
        let tuned = Done::Runs {
            of: "tune",
            done: 1000,
            all: 4000,
        };
        assert_eq!(
            Progress::from(tuned).to_string(),
            "tune: [#####...............] 25 %"
        );
        let mut tracker = LineTracker::default();
        let passes = [1, 2, 2, 1, 2].map(|line| tracker.reach(line));
        assert_eq!(
            passes,
            [
                Passes::Once,
                Passes::Once,
                Passes::Once,
                Passes::Repeated,
                Passes::Repeated
            ]
        );
        let driven = Done::MachineTime {
            seconds: 30,
            all: 120,
        };
        assert_eq!(
            Progress::from(driven).to_string(),
            "30 of 120 s of machine time (25 %)"
        );
        let file = tempfile::NamedTempFile::new().unwrap();
        std::fs::write(file.path(), "N1\nN2\n").unwrap();
        assert_eq!(count_lines(&file.path().display().to_string()), 2);
    }
}
