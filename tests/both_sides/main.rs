//! Compares programs whose conditions only the machine knows with runs for every answer: a state that any of them
//! reaches, in a line or at the end, is never missing, and if the conditions are plain and asked once, no other state
//! is named.
//!
//! The programs are those of [`Profile::ASKED_ONCE`] and [`Profile::ASKED_AGAIN`]: branches, switches, loops, jumps to
//! targets that only the machine knows, some of which are missing, calls with parameters and recursion, macros, modal
//! cycles, M, T and G words of unknown number, couplings, structures of which only one end has a skip mark, words that
//! nobody knows, variables of the machine that are written and read, and errors on ways.
//!
//! `both_sides/known.txt` has the number of states that are known in these programs and in `programs/`, which may not
//! fall; `UPDATE_DOCS=1 cargo test --test both_sides` writes it again.

mod known;
mod plc;

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write as _;
use std::num::NonZero;
use std::ops::ControlFlow;

use frictcomp::comp::{AxisIndex, Kind, State};
use frictcomp::interpreter::{
    EndedBy, Event, Interpreter, Limits, Motions, NoFiles, Options, PossibleStates, RunOutcome,
};
use frictcomp::machine::{Machine, Setting};
use frictcomp::text::{SourceFile, TextLines};
use frictcomp::{diagnostic::Code, syntax::SkipLevels};
use frictcomp_testing::generator::{Choices, NcProgram, Profile, Style};
use known::Tally;

const AXES: [&str; 3] = ["X", "Y", "Z"];

/// Returns the axes, one that is not configured, and programs of words.
fn machine() -> Machine {
    let words = "M06 = \"m6.nc\"\nT = \"t.nc\"\nG80 = \"g80.nc\"\nG81 = \"g81.nc\"";
    let mut text = format!("[machine.programs]\n{words}\n");
    for axis in AXES {
        let _ = writeln!(text, "[[axis]]\nname = \"{axis}\"\nenable = true");
    }
    text.push_str("[[axis]]\nname = \"W\"\nfrict_comp = false\n");
    Machine::from_toml(&text).expect("a machine")
}

/// Returns the files that programs call.
fn called(name: &str) -> Option<SourceFile> {
    let text = match name {
        "m6.nc" => "X[COMP OFF FRICT]\nP2=P2+1\nM17\n",
        "t.nc" => "Z[COMP ON FRICT]\nM17\n",
        "g80.nc" => "Y[COMP OFF FRICT]\nM17\n",
        "g81.nc" => "P1=P1+1\n$IF P1 > 1\nY[COMP ON FRICT]\n$ENDIF\nM17\n",
        "cycle.nc" => {
            "P4=P4+1\n$IF P4 == 2\nZ[COMP OFF FRICT]\n$ENDIF\n$IF @P1 == 1\nY[COMP ON FRICT]\n$ENDIF\nM17\n"
        }
        _ => return None,
    };
    Some(SourceFile::new(name, text))
}

/// The errors of the blocks at which the control stops.
const STOPS: [Code; 7] = [
    Code::PErr20472,
    Code::PErr70495,
    Code::PErr21381,
    Code::PErr21403,
    Code::PErr21480,
    Code::Fc209,
    Code::Fc320,
];

/// States of an axis, by their names.
type Possible = BTreeSet<&'static str>;

/// The states of each axis that a run shows.
#[derive(Default)]
struct Shown {
    /// States after each line of the main file.
    lines: BTreeMap<u32, [Possible; AXES.len()]>,
    /// States at the end, which an error may be; `None` if the program does not end.
    end: Option<[Possible; AXES.len()]>,
    /// The lines and axes of which no state is known, nor a set of them.
    unknown: BTreeSet<(u32, usize)>,
    /// Whether some way never ends.
    never_ends: bool,
    /// Whether a region was passed over (R2.51), of which further passes have no rows.
    has_region: bool,
    /// The errors at which the control stops, or may: the program's name, the line, the code.
    stops: BTreeSet<(String, u32, Code)>,
}

/// Returns the states of an axis: that which is known, or those that are possible.
fn states(state: State, possible: Option<&PossibleStates>) -> Possible {
    match (state, possible) {
        (State::Unknown, Some(possible)) => {
            possible.states.iter().map(|it| it.state.as_str()).collect()
        }
        (State::Unknown, None) => [State::Active, State::Inactive].map(State::as_str).into(),
        _ => [state.as_str()].into(),
    }
}

impl Shown {
    fn add(&mut self, other: Self) {
        for (line, states) in other.lines {
            let mine = self.lines.entry(line).or_default();
            for (mine, states) in mine.iter_mut().zip(states) {
                mine.extend(states);
            }
        }
        if let Some(states) = other.end {
            let mine = self.end.get_or_insert_default();
            for (mine, states) in mine.iter_mut().zip(states) {
                mine.extend(states);
            }
        }
    }

    fn event(&mut self, event: &Event<'_>) {
        match event {
            Event::Executed(executed) if &**executed.file == "a.nc" => {
                self.has_region |= !executed.doubted.is_empty();
                let mine = self.lines.entry(executed.line).or_default();
                for (at, mine) in mine.iter_mut().enumerate() {
                    let axis = AxisIndex::new(at);
                    let state = executed.compensation.state(axis, Kind::Frict);
                    let possible = executed.possible_of(axis, Kind::Frict);
                    mine.extend(states(state, possible));
                    if state == State::Unknown && possible.is_none() {
                        self.unknown.insert((executed.line, at));
                    }
                }
            }
            Event::Ended(ended) => {
                let of = |at| {
                    let axis = AxisIndex::new(at);
                    let mut possible = ended.possible.iter();
                    let possible = possible.find(|it| it.axis == axis && it.kind == Kind::Frict);
                    states(ended.compensation.state(axis, Kind::Frict), possible)
                };
                self.end = Some([0, 1, 2].map(of));
                self.never_ends = ended.ends.iter().any(|end| end.by == EndedBy::Budget);
            }
            _ => {}
        }
    }
}

/// Way in which a program is handed over.
#[derive(Clone, Copy, PartialEq)]
enum Handed {
    Whole,
    LineByLine,
}

/// Runs a program with values of the machine's variables and a decision on blocks with a skip mark, or without.
fn run(text: &str, given: &[usize], skip: Option<SkipLevels>, handed: Handed) -> Shown {
    let machine = machine();
    let compensation = machine.compensation();
    let blocks = if skip.is_some() { 600 } else { 50_000 };
    let limits = Limits::default().with_blocks(blocks);
    let options = Options::default().with_skip(skip).with_limits(limits);
    let mut run = Interpreter::new(machine, compensation, options);
    for (at, value) in given.iter().enumerate() {
        let value = u32::try_from(*value).expect("a small number");
        run.set(&format!("V.E.C{at}"), &Setting::Number(f64::from(value)));
    }
    let mut shown = Shown::default();
    let mut said = Vec::new();
    let mut finder = |name: &str, _: &str| called(name);
    let mut observer = |event: Event<'_>| {
        if let Event::Executed(executed) = &event {
            let errors = executed.diagnostics.iter();
            let errors =
                errors.filter(|it| it.code.severity() == frictcomp::diagnostic::Severity::Error);
            for error in errors {
                let place = (executed.file.to_string(), executed.line, error.code);
                if STOPS.contains(&error.code) {
                    shown.stops.insert(place);
                } else if skip.is_some() || error.code != Code::Fc311 {
                    // A jump to any label may lead past what no value of these runs leads past.
                    said.push(error.message.clone());
                }
            }
        }
        shown.event(&event);
        ControlFlow::Continue(())
    };
    let outcome = match handed {
        Handed::Whole => run.program(SourceFile::new("a.nc", text), &mut finder, &mut observer),
        Handed::LineByLine => {
            let mut lines = TextLines::new(text);
            run.stream("a.nc", &mut lines, &mut finder, &mut observer)
        }
    };
    assert!(said.is_empty(), "{text}\n{said:?}");
    let never_ends = skip.is_some() && shown.never_ends;
    if outcome == RunOutcome::Ended(EndedBy::Budget) || never_ends {
        // Some way never ends, so nothing is reported about the end.
        let any = states(State::Unknown, None);
        shown.end = skip.is_none().then(|| [0, 1, 2].map(|_| any.clone()));
    }
    shown
}

/// Returns whether the end of a run with answers is not compared with what is told without: the state at an error in
/// the program of a word whose number only the machine knows.
fn is_left_out(shown: &Shown) -> bool {
    let mut stops = shown.stops.iter();
    stops.any(|(file, ..)| file != "a.nc" && file != "cycle.nc")
}

/// Returns the states found by runs with every answer.
fn enumerated(program: &NcProgram, text: &str) -> Shown {
    let mut found = Shown::default();
    let count: usize = program.values.iter().product();
    let skips: &[SkipLevels] = if text.lines().any(|line| line.starts_with('/')) {
        &[SkipLevels::NONE, SkipLevels::ALL]
    } else {
        &[SkipLevels::NONE]
    };
    for number in 0..count {
        let mut rest = number;
        let given = program.values.iter().map(|values| {
            let value = rest % values;
            rest /= values;
            value
        });
        let given: Vec<usize> = given.collect();
        for skip in skips {
            let mut shown = run(text, &given, Some(*skip), Handed::Whole);
            if is_left_out(&shown) {
                shown.end = None;
            }
            found.add(shown);
        }
    }
    found
}

/// The permitted contents of a program.
#[derive(Clone, Copy, PartialEq)]
enum Sort {
    /// Conditions that are asked once and are plain.
    Exact,
    /// Any content.
    Any,
}

impl Sort {
    fn profile(self) -> Profile {
        match self {
            Self::Exact => Profile::ASKED_ONCE,
            Self::Any => Profile::ASKED_AGAIN,
        }
    }
}

/// Compares a program; returns what is known of its states.
fn compare(seed: u64, sort: Sort) -> Tally {
    let mut program = NcProgram::choose(&sort.profile(), &mut Choices::of_seed(seed));
    let text = program.write(Style::default());
    let told = run(&text, &[], None, Handed::Whole);
    let arriving = run(&text, &[], None, Handed::LineByLine);
    let is_same = (&arriving.lines, &arriving.end) == (&told.lines, &told.end);
    assert!(is_same, "seed {seed}, line by line\n{text}");
    let found = enumerated(&program, &text);
    let holds = |(told, found): (&[Possible; 3], &[Possible; 3]), place: &str| {
        for ((told, found), axis) in told.iter().zip(found).zip(AXES) {
            let is_exact = sort == Sort::Any || found == told;
            assert!(
                found.is_subset(told) && is_exact,
                "seed {seed}, {place}: {axis} is {told:?}, runs find {found:?}\n{text}"
            );
        }
    };
    if let Some(found) = &found.end {
        holds((told.end.as_ref().expect("every run ends"), found), "end");
    }
    // Not compared: the lines of passes without rows, where conditions are passed over.
    for (line, found) in found.lines.iter().filter(|_| !told.has_region) {
        // After an endless loop there are no rows.
        if let Some(told) = told.lines.get(line) {
            holds((told, found), &format!("line {line}"));
        }
    }
    Tally::of(&told, &found)
}

/// Returns the number of programs that are compared: 400, or `BOTH_SIDES_PROGRAMS`.
fn count() -> u64 {
    let given = std::env::var("BOTH_SIDES_PROGRAMS").ok();
    given.and_then(|it| it.parse().ok()).unwrap_or(COUNTED)
}

/// Number of programs whose known states are counted.
const COUNTED: u64 = 400;

/// Compares the programs on all processors; returns what is known in those that are counted.
fn compare_all(sort: Sort) -> Tally {
    let threads = std::thread::available_parallelism().map_or(1, NonZero::get);
    std::thread::scope(|scope| {
        let of_thread = |first: usize| {
            scope.spawn(move || {
                let mut tally = Tally::default();
                for seed in (first as u64..=count() / 2).step_by(threads) {
                    let of_program = compare(seed, sort);
                    if seed <= COUNTED / 2 {
                        tally += of_program;
                    }
                }
                tally
            })
        };
        let threads: Vec<_> = (1..=threads).map(of_thread).collect();
        let tallies = threads
            .into_iter()
            .map(|it| it.join().expect("a comparison"));
        tallies.sum()
    })
}

#[test]
fn plain_conditions_that_are_asked_once_find_what_runs_with_values_find() {
    // R14.1, R14.2, R18.10
    compare_all(Sort::Exact).is_no_less("asked once");
}

#[test]
fn no_state_is_missing_that_a_run_with_values_finds() {
    // R14.1, R14.3, R18.10
    compare_all(Sort::Any).is_no_less("asked again");
}

/// Runs a program on a machine.
fn ran(machine: Machine, text: &str) -> Interpreter {
    let compensation = machine.compensation();
    let mut run = Interpreter::new(machine, compensation, Options::default());
    let source = SourceFile::new("a.nc", text);
    run.program(source, &mut NoFiles, &mut |_: Event<'_>| {
        ControlFlow::Continue(())
    });
    run
}

/// Returns the number of executed blocks of a program, and the number of rows that name a branch.
fn rows(text: &str, options: Options) -> (u64, usize) {
    let machine = Machine::enabled(AXES);
    let compensation = machine.compensation();
    let mut run = Interpreter::new(machine, compensation, options);
    let mut named = 0;
    let source = SourceFile::new("a.nc", text);
    run.program(source, &mut NoFiles, &mut |event: Event<'_>| {
        if let Event::Executed(executed) = event {
            named += usize::from(executed.branch.is_some());
        }
        ControlFlow::Continue(())
    });
    (run.blocks(), named)
}

#[test]
fn conditions_one_after_another_cost_their_sum() {
    // R14.4
    let mut text = String::new();
    for number in 0..100 {
        let _ = writeln!(text, "$IF V.E.C{number} == 1\nX[COMP OFF FRICT]\n$ENDIF");
    }
    text.push_str("M30\n");
    assert_eq!(rows(&text, Options::default()), (301, 100));
}

#[test]
fn loops_in_one_another_cost_their_depth() {
    // R14.3, R14.4
    let openers: [fn(u64) -> (String, String); 4] = [
        |n| (format!("$WHILE V.E.A{n}"), "$ENDWHILE".to_owned()),
        |n| ("$REPEAT".to_owned(), format!("$UNTIL V.E.A{n}")),
        |n| ("$DO".to_owned(), format!("$ENDDO V.E.A{n}")),
        |n| (format!("$FOR P{n} = 1, V.E.A{n}, 1"), "$ENDFOR".to_owned()),
    ];
    for of in openers {
        for depth in [3, 12, 50] {
            let mut lines = vec!["X[COMP OFF FRICT]".to_owned()];
            for number in (0..depth).rev() {
                let (opener, end) = of(number);
                lines.insert(0, opener);
                lines.push(end);
            }
            let (blocks, _) = rows(&lines.join("\n"), Options::default());
            assert!(
                blocks < 120 * depth,
                "{blocks} blocks for {depth} of {}",
                lines[0]
            );
        }
    }
}

#[test]
fn calls_on_both_sides_of_conditions_cost_their_sum() {
    // R14.4
    for (depth, most) in [(6, 500), (24, 40_000), (40, 40_000)] {
        let mut text = String::new();
        for number in 0..depth {
            let call = if number + 1 < depth {
                format!("LL S{}", number + 1)
            } else {
                "X[COMP OFF FRICT]".to_owned()
            };
            let _ = writeln!(
                text,
                "%L S{number}\n$IF V.E.A{number}\n{call}\n$ELSE\n{call}\n$ENDIF\nM17"
            );
        }
        text.push_str("%MAIN\nLL S0\nM30");
        let run = ran(Machine::enabled(AXES), &text);
        assert!(
            run.blocks() < most,
            "{} blocks for {depth} levels",
            run.blocks()
        );
        let states = run.compensation();
        assert_eq!(
            states.state(AxisIndex::new(0), Kind::Frict),
            State::Inactive
        );
    }
}

#[test]
fn a_stable_variable_has_one_answer() {
    // R14.1: V.E. may change at any time, unless the machine says otherwise.
    let text =
        "$IF V.E.A == 1\nX[COMP OFF FRICT]\n$ENDIF\n$IF v.e.A == 1\nX[COMP ON FRICT]\n$ENDIF\nM30";
    for (stable, known) in [
        (vec![], State::Unknown),
        (vec!["V.E.A".to_owned()], State::Active),
    ] {
        let mut machine = Machine::enabled(AXES);
        machine.stable = stable;
        let run = ran(machine, text);
        assert_eq!(
            run.compensation().state(AxisIndex::new(0), Kind::Frict),
            known
        );
    }
}

#[test]
fn the_side_ways_have_no_row_where_motion_is_computed() {
    // R14.8: all four blocks are executed.
    let text = "$IF V.E.A == 1\nX[COMP OFF FRICT]\n$ENDIF\nM30";
    let options = Options::default().with_motions(Motions::Taken);
    assert_eq!(rows(text, options), (4, 0));
}

#[test]
fn the_states_that_are_possible_name_their_ways() {
    // R14.2
    let text = "$IF V.E.MATERIAL == 2\nX[COMP OFF FRICT]\n$ENDIF\n/Y[COMP OFF FRICT]\n\
                $SWITCH V.E.PART\n$CASE 1\n$CASE 2\nZ[COMP OFF FRICT]\n$ENDSWITCH\nM30";
    let run = ran(Machine::enabled(AXES), text);
    let said: Vec<String> = run
        .possible()
        .iter()
        .map(|it| it.in_words("a.nc"))
        .collect();
    assert_eq!(
        said,
        [
            "inactive if V.E.MATERIAL == 2 (line 1), else active",
            "inactive if skip level 1 is off, else active",
            "inactive if [V.E.PART == 1 || V.E.PART == 2] (line 5), else active",
        ]
    );
}
