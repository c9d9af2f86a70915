//! Searches for growth instead of listing it (R9.90): the elements of the language are repeated within a line, within a
//! continued block, over lines, over files and over list lines, and twice as many of them may take at most 2.2 times
//! the processor time.
//!
//! The measured time is the processor time of the thread, and it is measured again if it grows too fast, so that other
//! work on the machine does not cause a failure.

use std::fmt::Write as _;
use std::hint::black_box;
use std::ops::ControlFlow;

use fastrand::Rng;
use frictcomp::interpreter::{Limits, Options, StopPolicy};
use frictcomp::machine::{Machine, NoLists, check_list};
use frictcomp::session::{Program, Session, SessionOptions};
use frictcomp::text::SourceFile;
use frictcomp::timeline::{Record, Sink};

use crate::measure::{TWICE, excess, of_thread};
use crate::tokens;

/// Ways to repeat a sequence of tokens.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Repeated {
    /// Within one line.
    InLine,
    /// Within one block that continues over lines.
    InBlock,
    /// Line by line.
    OverLines,
    /// Each in a called file.
    OverFiles,
    /// Line by line in a list.
    OverListLines,
}

use Repeated::{InBlock, InLine, OverFiles, OverLines, OverListLines};

/// Ways to repeat tokens in programs.
const IN_PROGRAMS: [Repeated; 4] = [InLine, InBlock, OverLines, OverFiles];

/// Bytes of half the longest line.
const HALF_A_LINE: usize = 1_950;

impl Repeated {
    /// Returns the size of the long search: bytes, lines or files.
    fn size(self) -> usize {
        match self {
            InLine => HALF_A_LINE,
            InBlock => 4_000,
            OverLines => 200,
            OverFiles => 100,
            OverListLines => 3_200,
        }
    }

    /// Returns the separators between tokens and after the last one.
    fn between(self) -> &'static [&'static str] {
        match self {
            InLine | InBlock => &["", " "],
            OverLines | OverFiles | OverListLines => &[" "],
        }
    }

    /// Returns two sizes, one eight times the other. A line has at most 4000 characters.
    fn further(self, size: usize) -> [usize; 2] {
        match self {
            InLine => [HALF_A_LINE / 4, 2 * HALF_A_LINE],
            InBlock | OverLines | OverFiles | OverListLines => [size, 8 * size],
        }
    }

    fn run(self, sequence: &str, size: usize) {
        match self {
            InLine => run(&format!("{}\nM30\n", filled(sequence, size)), "", size),
            InBlock => run(&block(sequence, size), "", size),
            OverLines => run(
                &format!("{}M30\n", format!("{sequence}\n").repeat(size)),
                "",
                size,
            ),
            OverFiles => {
                let calls = (0..size).fold(String::new(), |mut calls, number| {
                    let _ = writeln!(calls, "L f{number}.nc");
                    calls
                });
                run(
                    &format!("{calls}M30\n"),
                    &format!("{sequence}\nM17\n"),
                    size,
                );
            }
            OverListLines => {
                let text = format!("{sequence}\n").repeat(size);
                let source = SourceFile::new("a.lis", text);
                black_box(check_list(source, None, &mut NoLists));
            }
        }
    }
}

/// Returns a sequence repeated up to a number of bytes.
fn filled(sequence: &str, bytes: usize) -> String {
    sequence.repeat(bytes / sequence.len())
}

/// Returns a block of this many bytes, on lines that are not too long.
fn block(sequence: &str, bytes: usize) -> String {
    let line = format!("{} \\\n", filled(sequence, 60.max(sequence.len())));
    format!("X1 \\\n{}X1\nM30\n", line.repeat(bytes / line.len()))
}

/// Takes records and keeps nothing.
struct Nothing;

impl Sink for Nothing {
    fn record(&mut self, _: &Record<'_>) -> ControlFlow<()> {
        ControlFlow::Continue(())
    }
}

/// Runs a program whose budgets grow with it.
fn run(text: &str, called: &str, size: usize) {
    let size = u64::try_from(size).expect("a small number");
    let limits = Limits::default()
        .with_blocks(4 * size)
        .with_work(1_000 * size);
    let options = Options::default()
        .with_stop(StopPolicy::CheckAll)
        .with_limits(limits);
    let mut session = Session::new(Machine::enabled(["X", "Y"]), SessionOptions::from(options));
    let mut finder =
        |name: &str, _: &str| (!called.is_empty()).then(|| SourceFile::new(name, called));
    let source = SourceFile::new("a.nc", text);
    let _ = session.program("a.nc", Program::Whole(source), &mut finder, &mut Nothing);
}

/// The number of finds that are enough to look for their cause.
const ENOUGH: usize = 8;

/// The thoroughness of the search.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Look {
    /// Search at an eighth of the size only, where the onset of budgets shows, too.
    Short,
    /// Search at the whole size as well.
    Long,
}

impl Look {
    /// Returns divisors of the size, and the factor that twice as much may take.
    fn bounds(self) -> &'static [(usize, f64)] {
        const LITTLE: (usize, f64) = (8, 1.5 * TWICE);
        match self {
            Self::Short => &[LITTLE],
            Self::Long => &[LITTLE, (1, TWICE)],
        }
    }
}

/// A search and its finds.
struct Search {
    look: Look,
    ways: &'static [Repeated],
    /// Number of combinations of which one is tried.
    step: usize,
    /// The number of combinations tried.
    looked: usize,
    found: Vec<String>,
}

impl Search {
    fn new(look: Look, ways: &'static [Repeated]) -> Self {
        Self {
            look,
            ways,
            step: 1,
            looked: 0,
            found: Vec::new(),
        }
    }

    /// Creates a long search, which `GROWTH_SHARE` may limit to a part.
    fn long(look: Look, ways: &'static [Repeated]) -> Self {
        let share = std::env::var("GROWTH_SHARE").ok();
        let share = share.map_or(1.0, |share| share.parse::<f64>().expect("a number"));
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
        let step = (1.0 / share).max(1.0) as usize;
        Self {
            step,
            ..Self::new(look, ways)
        }
    }

    #[allow(clippy::print_stdout, reason = "shown with `--nocapture`")]
    fn at(&mut self, how: Repeated, tokens: &[&str]) {
        self.looked += 1;
        for between in how.between() {
            if self.found.len() >= ENOUGH {
                return;
            }
            let sequence = format!("{}{between}", tokens.join(between));
            let found = self.look.bounds().iter().find_map(|&(share, bound)| {
                let size = how.size() / share;
                let run = |size| how.run(&sequence, size);
                let growth = excess([size, 2 * size], bound, run)?;
                // Slower memory, and bounds that end something at once, cause a single step; real growth continues.
                let further = how.further(size);
                excess(further, TWICE.powi(3), run)?;
                Some(format!("{how:?} {sequence:?}: {growth:.2} from {size}"))
            });
            if let Some(found) = found {
                println!("{:.1?}: {found}", of_thread());
                self.found.push(found);
            }
        }
    }

    /// Tries every combination of this many tokens.
    fn every(mut self, length: usize, tokens: &[String]) -> Self {
        let places = u32::try_from(length).expect("a few tokens");
        for number in (0..tokens.len().pow(places)).step_by(self.step) {
            let digit = |place| number / tokens.len().pow(place) % tokens.len();
            let combination: Vec<usize> = (0..places).rev().map(digit).collect();
            if is_first_rotation(&combination) {
                let chosen: Vec<&str> = combination.iter().map(|&at| tokens[at].as_str()).collect();
                self.ways.iter().for_each(|&how| self.at(how, &chosen));
            }
        }
        self
    }

    /// Tries a number of combinations of a number of tokens, the same in each run.
    fn some(mut self, (count, length): (usize, usize), tokens: &[String]) -> Self {
        let mut rng = Rng::with_seed(u64::try_from(length).expect("a small number"));
        for _ in 0..count {
            let token = |_| tokens[rng.usize(..tokens.len())].as_str();
            let chosen: Vec<&str> = (0..length).map(token).collect();
            self.at(self.ways[rng.usize(..self.ways.len())], &chosen);
        }
        self
    }

    #[track_caller]
    #[allow(clippy::print_stdout, reason = "shown with `--nocapture`")]
    fn finds_nothing(&self) {
        println!("{} combinations", self.looked);
        let found = &self.found;
        assert!(found.is_empty(), "{}", found.join("\n"));
    }
}

/// Returns whether a combination is the one to try among its rotations, which repeat the same text.
fn is_first_rotation(combination: &[usize]) -> bool {
    let length = combination.len();
    (1..length).all(|by| {
        let rotated = (0..length).map(|at| combination[(at + by) % length]);
        // A combination that equals its rotation repeats a shorter one.
        rotated.gt(combination.iter().copied())
    })
}

#[test]
fn each_token_repeated() {
    // R9.90
    Search::new(Look::Short, &IN_PROGRAMS)
        .every(1, &tokens::of_programs())
        .finds_nothing();
}

#[test]
fn some_combinations_repeated() {
    // R9.90
    Search::new(Look::Short, &IN_PROGRAMS)
        .some((150, 2), &tokens::of_programs())
        .some((100, 3), &tokens::of_programs())
        .some((50, 4), &tokens::of_programs())
        .finds_nothing();
}

#[test]
#[allow(clippy::print_stdout, reason = "shown with `--nocapture`")]
fn brackets_that_stay_open() {
    // R9.90: as many as may nest, with enough in each that a scan to the end of the block shows.
    const NESTED: [usize; 2] = [31, 62];
    let pairs = tokens::OPENERS
        .iter()
        .flat_map(|opener| tokens::FILLERS.iter().map(move |filler| (opener, filler)));
    let found = pairs.filter_map(|(opener, filler)| {
        let sequence = format!("{opener}{} \\\n", filler.repeat(60 / filler.len()));
        let run = |count| {
            let text = format!("X1 \\\n{}X1\nM30\n", sequence.repeat(count));
            run(&text, "", text.len());
        };
        let growth = excess(NESTED, 1.3 * TWICE, run)?;
        println!("{:.1?}: {sequence:?}: {growth:.2}", of_thread());
        Some(format!("{sequence:?}: {growth:.2}"))
    });
    let found: Vec<String> = found.take(ENOUGH).collect();
    assert!(found.is_empty(), "{}", found.join("\n"));
}

#[test]
fn each_pair_of_lists_repeated() {
    // R9.90
    let tokens = tokens::of_lists();
    let search = Search::new(Look::Short, &[OverListLines]);
    search.every(1, &tokens).every(2, &tokens).finds_nothing();
}

#[test]
fn marks_in_a_long_line_and_messages_in_a_long_block() {
    // R9.90
    let mut search = Search::new(Look::Long, &[InLine, InBlock]);
    for token in ["$IF", "X[COMP ON FRICT]"] {
        search.at(InBlock, &[token]);
    }
    for sequence in [["!=", "'"], ["\t", "'"], ["#", "1"], ["#", "<"]] {
        search.at(InLine, &sequence);
    }
    search.finds_nothing();
}

#[test]
#[ignore = "an hour: `scripts/full`"]
fn every_combination_of_one_or_two_tokens_repeated() {
    // R9.90
    let tokens = tokens::of_programs();
    let search = Search::long(Look::Long, &IN_PROGRAMS);
    search.every(1, &tokens).every(2, &tokens).finds_nothing();
}

#[test]
#[ignore = "an hour: `scripts/full`"]
fn every_combination_of_three_kinds_repeated() {
    // R9.90
    let search = Search::long(Look::Short, &IN_PROGRAMS);
    search.every(3, &tokens::kinds()).finds_nothing();
}

#[test]
#[ignore = "an hour: `scripts/full`"]
fn every_combination_of_four_kinds_in_a_line() {
    // R9.90
    let search = Search::long(Look::Short, &[InLine]);
    search.every(4, &tokens::kinds()).finds_nothing();
}

#[test]
#[ignore = "minutes: `scripts/full`"]
fn every_combination_in_lists_repeated() {
    // R9.90
    let tokens = tokens::of_lists();
    let search = Search::long(Look::Long, &[OverListLines]);
    search.every(2, &tokens).every(3, &tokens).finds_nothing();
}
