//! Compares programs whose conditions only the machine knows with runs for every answer: a state that any of them
//! reaches is never missing, and if the conditions are plain and asked once, no other state is named.

#[path = "both_sides/plc.rs"]
mod plc;

use std::collections::BTreeSet;
use std::fmt::Write as _;
use std::num::NonZero;
use std::ops::ControlFlow;

use frictcomp::comp::{AxisIndex, Kind, State};
use frictcomp::interpreter::{
    EndedBy, Event, Interpreter, Limits, Motions, NoFiles, Options, RunOutcome,
};
use frictcomp::machine::{Machine, Setting};
use frictcomp::text::SourceFile;
use frictcomp::{Code, SkipLevels};

const AXES: [&str; 3] = ["X", "Y", "Z"];

/// The axes, one that is not configured, and a program of M6.
fn machine() -> Machine {
    let mut text = "[machine.programs]\nM06 = \"m6.nc\"\n".to_owned();
    for axis in AXES {
        let _ = writeln!(text, "[[axis]]\nname = \"{axis}\"\nenable = true");
    }
    text.push_str("[[axis]]\nname = \"W\"\nfrict_comp = false\n");
    Machine::from_toml(&text).expect("a machine")
}

/// The files that programs call.
fn called(name: &str) -> Option<SourceFile> {
    let text = match name {
        "m6.nc" => "X[COMP OFF FRICT]\nP2=P2+1\nM17\n",
        "cycle.nc" => {
            "P4=P4+1\n$IF P4 == 2\nZ[COMP OFF FRICT]\n$ENDIF\n$IF @P1 == 1\nY[COMP ON FRICT]\n$ENDIF\nM17\n"
        }
        _ => return None,
    };
    Some(SourceFile::new(name, text))
}

struct XorShift(u64);

impl XorShift {
    fn roll(&mut self, sides: u64) -> u64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 11) % sides
    }

    fn pick(&mut self, of: usize) -> usize {
        usize::try_from(self.roll(of as u64)).expect("a small number")
    }
}

/// The permitted contents of a program.
#[derive(Clone, Copy, PartialEq)]
enum Sort {
    /// Conditions that are asked once and are plain.
    Exact,
    /// Anything.
    Any,
}

struct Writer {
    random: XorShift,
    sort: Sort,
    text: String,
    /// The number of answers of each machine variable.
    asked: Vec<u64>,
    skips: bool,
    labels: u32,
    calls: u32,
    subprograms: String,
    most: usize,
}

impl Writer {
    fn line(&mut self, line: &str) {
        let _ = writeln!(self.text, "{line}");
    }

    /// Creates a machine variable with this many values, 0 and up.
    fn variable(&mut self, values: u64) -> String {
        if self.sort == Sort::Any && !self.asked.is_empty() && self.random.roll(3) == 0 {
            let at = self.random.pick(self.asked.len());
            return format!("V.E.C{at}");
        }
        self.asked.push(values);
        format!("V.E.C{}", self.asked.len() - 1)
    }

    fn condition(&mut self) -> String {
        let any = self.sort == Sort::Any;
        match self.random.roll(if any { 8 } else { 4 }) {
            0 => format!("NOT [{} == 1]", self.variable(2)),
            1 => format!("{} != 0", self.variable(2)),
            2 | 3 => format!("{} == 1", self.variable(2)),
            4 => format!("P{} == {}", self.random.roll(3) + 1, self.random.roll(3)),
            5 => format!("{} == 1 && {} == 1", self.variable(2), self.variable(2)),
            6 => format!("P{} > {}", self.random.roll(3) + 1, self.random.roll(3)),
            _ => {
                let axis = AXES[self.random.pick(3)];
                format!("V.A.FRICT_COMP_ACTIVE.{axis} == {}", self.random.roll(2))
            }
        }
    }

    fn command(&mut self) {
        let axis = AXES[self.random.pick(3)];
        let word = if self.random.roll(2) == 0 {
            "ON"
        } else {
            "OFF"
        };
        self.line(&format!("{axis}[COMP {word} FRICT]"));
    }

    /// A block at which the control stops, or may.
    fn error(&mut self) -> String {
        let any = self.sort == Sort::Any && !self.full();
        match self.random.roll(if any { 6 } else { 5 }) {
            0 => "#ERROR [ID=5 RC=2]".to_owned(),
            1 => "#ERROR [RC[1+1], ID 7]".to_owned(),
            2 => "#ERROR [ID1 RC 1 PV1=\"RC=0\"]".to_owned(),
            3 => "W[COMP ON FRICT]".to_owned(),
            4 => "L MISSING.NC".to_owned(),
            _ => format!("#ERROR [ID=5 RC={}]", self.variable(3)),
        }
    }

    /// A block that ends the program, or one of some others.
    fn end(&mut self, others: &[&str]) -> String {
        match self.random.pick(others.len() + 2) {
            0 => "M30".to_owned(),
            1 => self.error(),
            other => others[other - 2].to_owned(),
        }
    }

    fn blocks(&mut self, depth: u32) {
        for _ in 0..=self.random.roll(3) {
            self.block(depth);
        }
    }

    fn full(&self) -> bool {
        self.asked.len() >= self.most
    }

    fn block(&mut self, depth: u32) {
        if depth == 0 || self.full() {
            if self.sort == Sort::Any && self.random.roll(3) == 0 {
                return self.assignment();
            }
            return self.command();
        }
        let sorts = if self.sort == Sort::Any { 24 } else { 10 };
        match self.random.roll(sorts) {
            0 | 1 => self.command(),
            2..=4 => self.branch(depth),
            5 => self.switch(depth),
            6 => {
                let condition = self.condition();
                self.line(&format!("$IF {condition}"));
                self.blocks(depth - 1);
                let end = self.end(&[]);
                self.line(&end);
                self.line("$ENDIF");
            }
            7 => {
                self.labels += 10;
                let label = 1000 + self.labels;
                let condition = self.condition();
                self.line(&format!("$IF {condition} $GOTO N{label}"));
                self.blocks(depth - 1);
                self.line(&format!("N{label}:"));
            }
            8 => self.skip(),
            9 => self.call(depth),
            10 => self.assignment(),
            11 => {
                let end = self.variable(3);
                let p = self.random.roll(3) + 1;
                self.line(&format!("$FOR P{p} = 1, {end}, 1"));
                self.blocks(depth - 1);
                self.leave_loop();
                self.line("$ENDFOR");
            }
            12 => {
                let end = self.variable(3);
                self.line("P9 = 0");
                self.line(&format!("$WHILE P9 < {end}"));
                self.line("P9 = P9 + 1");
                self.blocks(depth - 1);
                self.leave_loop();
                self.line("$ENDWHILE");
            }
            13 => {
                let p = self.random.roll(3) + 1;
                self.line(&format!("$FOR P{p} = 1, 3, 1"));
                self.blocks(depth - 1);
                self.leave_loop();
                self.line("$ENDFOR");
            }
            14 => {
                let end = self.variable(3);
                self.line("P8 = 0");
                self.line("$REPEAT");
                self.line("P8 = P8 + 1");
                self.blocks(depth - 1);
                self.line(&format!("$UNTIL P8 >= {end}"));
            }
            15 => self.computed_jump(depth),
            16 => self.macro_of_words(),
            17 => {
                let condition = self.condition();
                self.line(&format!("\"ASKED\" = \"{condition}\""));
                self.line("$IF \"ASKED\"");
                self.blocks(depth - 1);
                self.line("$ENDIF");
            }
            18 => self.call_with_parameter(depth),
            19 => self.recursion(depth),
            20 => {
                let number = self.variable(2);
                self.line(&format!("P5 = 5 + {number}"));
                self.line("M=P5");
            }
            21 => self.modal_cycle(depth),
            22 => {
                let condition = self.condition();
                self.skips = true;
                self.line(&format!("/$IF {condition}"));
                self.command();
                self.line("/$ENDIF");
            }
            23 if self.random.roll(4) == 0 => {
                self.line("FOO[1]");
                self.command();
            }
            _ => {
                self.labels += 10;
                let label = 1000 + self.labels;
                let end = self.variable(3);
                self.line("P7 = 0");
                self.line(&format!("N{label}: P7 = P7 + 1"));
                self.blocks(depth - 1);
                self.line(&format!("$IF P7 < {end} $GOTO N{label}"));
            }
        }
    }

    /// A jump whose target only the machine knows.
    fn computed_jump(&mut self, depth: u32) {
        self.labels += 10;
        let label = 1000 + self.labels;
        let target = self.variable(2);
        self.line(&format!("$GOTO N[{label} + {target}]"));
        self.blocks(depth - 1);
        self.line(&format!("N{label}:"));
        self.blocks(depth - 1);
        self.line(&format!("N{}:", label + 1));
    }

    /// A command in a macro, which is used on some way.
    fn macro_of_words(&mut self) {
        let axis = AXES[self.random.pick(3)];
        self.line(&format!("\"OFF\" = \"{axis}[COMP OFF FRICT]\""));
        let condition = self.condition();
        self.line(&format!("$IF {condition}"));
        self.line("\"OFF\"");
        self.line("$ENDIF");
        if self.random.roll(2) == 0 {
            self.line("\"OFF\"");
        }
    }

    /// A subprogram that asks its parameter, called with two values.
    fn call_with_parameter(&mut self, depth: u32) {
        self.calls += 1;
        let name = format!("SUB{}", self.calls);
        let outer = std::mem::take(&mut self.text);
        self.line(&format!("%L {name}"));
        let asked = self.random.roll(2);
        self.line(&format!("$IF @P1 == {asked}"));
        self.blocks(depth - 1);
        self.line("$ENDIF");
        self.command();
        self.line("M17");
        let sub = std::mem::replace(&mut self.text, outer);
        self.subprograms.push_str(&sub);
        let value = self.variable(2);
        self.line(&format!("LL CYCLE [NAME={name} @P1={value}]"));
        if self.random.roll(2) == 0 {
            self.line(&format!("LL CYCLE [NAME={name} @P1=P1]"));
        }
    }

    /// A subprogram that calls itself as often as the machine says.
    fn recursion(&mut self, depth: u32) {
        self.calls += 1;
        let name = format!("SUB{}", self.calls);
        let outer = std::mem::take(&mut self.text);
        self.line(&format!("%L {name}"));
        self.line("P6 = P6 - 1");
        self.line("$IF P6 > 0");
        self.line(&format!("LL {name}"));
        self.line("$ENDIF");
        self.blocks(depth - 1);
        self.line("M17");
        let sub = std::mem::replace(&mut self.text, outer);
        self.subprograms.push_str(&sub);
        let times = self.variable(3);
        self.line(&format!("P6 = {times}"));
        self.line(&format!("LL {name}"));
    }

    /// A cycle after each motion, from some way on.
    fn modal_cycle(&mut self, depth: u32) {
        self.line("P4 = 0");
        let condition = self.condition();
        self.line(&format!("$IF {condition}"));
        let given = self.random.roll(2);
        self.line(&format!("L CYCLE [NAME=cycle.nc MODAL_MOVE @P1={given}]"));
        self.line("$ENDIF");
        self.line("X1");
        self.blocks(depth - 1);
        self.line("X2");
        self.line("#DISABLE MODAL CYCLE");
        self.command();
    }

    fn leave_loop(&mut self) {
        if !self.full() && self.random.roll(3) == 0 {
            let condition = self.condition();
            self.line(&format!("$IF {condition}"));
            self.command();
            let word = self.end(&["$BREAK", "$CONTINUE"]);
            self.line(&word);
            self.line("$ENDIF");
            self.command();
        }
    }

    fn assignment(&mut self) {
        let p = self.random.roll(3) + 1;
        let line = match self.random.roll(3) {
            0 => format!("P{p} = {}", self.random.roll(3)),
            1 => format!("P{p} = P{} + 1", self.random.roll(3) + 1),
            _ if self.full() => format!("P{p} = 1"),
            _ => format!("P{p} = {}", self.variable(3)),
        };
        self.line(&line);
    }

    fn branch(&mut self, depth: u32) {
        let condition = self.condition();
        self.line(&format!("$IF {condition}"));
        self.blocks(depth - 1);
        if self.random.roll(3) == 0 && !self.full() {
            let condition = self.condition();
            self.line(&format!("$ELSEIF {condition}"));
            self.blocks(depth - 1);
        }
        if self.random.roll(2) == 0 {
            self.line("$ELSE");
            self.blocks(depth - 1);
        }
        self.line("$ENDIF");
    }

    fn switch(&mut self, depth: u32) {
        let subject = self.variable(3);
        self.line(&format!("$SWITCH {subject}"));
        for case in 0..=self.random.roll(2) {
            self.line(&format!("$CASE {case}"));
            self.blocks(depth - 1);
            if self.random.roll(4) > 0 {
                self.line("$BREAK");
            }
        }
        if self.random.roll(2) == 0 {
            self.line("$DEFAULT");
            self.blocks(depth - 1);
        }
        self.line("$ENDSWITCH");
    }

    fn skip(&mut self) {
        self.skips = true;
        for _ in 0..=self.random.roll(2) {
            let axis = AXES[self.random.pick(3)];
            let word = if self.random.roll(2) == 0 {
                "ON"
            } else {
                "OFF"
            };
            self.line(&format!("/{axis}[COMP {word} FRICT]"));
        }
        if self.random.roll(4) == 0 {
            let error = self.error();
            self.line(&format!("/{error}"));
        }
    }

    /// Writes a local subprogram, called once.
    fn call(&mut self, depth: u32) {
        self.calls += 1;
        let name = format!("SUB{}", self.calls);
        let outer = std::mem::take(&mut self.text);
        self.line(&format!("%L {name}"));
        self.blocks(depth - 1);
        if !self.full() && self.random.roll(3) == 0 {
            let condition = self.condition();
            self.line(&format!("$IF {condition}"));
            self.command();
            let word = self.end(&["M17"]);
            self.line(&word);
            self.line("$ENDIF");
            self.command();
        }
        self.line("M17");
        let sub = std::mem::replace(&mut self.text, outer);
        self.subprograms.push_str(&sub);
        self.line(&format!("LL {name}"));
    }
}

struct Program {
    text: String,
    asked: Vec<u64>,
    skips: bool,
}

fn program(seed: u64, sort: Sort) -> Program {
    let mut writer = Writer {
        random: XorShift(seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) | 1),
        sort,
        text: String::new(),
        asked: Vec::new(),
        skips: false,
        labels: 0,
        calls: 0,
        subprograms: String::new(),
        most: if sort == Sort::Exact { 4 } else { 3 },
    };
    for _ in 0..8 {
        writer.random.roll(2);
    }
    writer.line("%MAIN");
    if sort == Sort::Any {
        for p in 1..=3 {
            writer.line(&format!("P{p} = 0"));
        }
    }
    let depth = 2 + u32::try_from(writer.random.roll(2)).expect("a small number");
    writer.blocks(depth);
    writer.blocks(depth);
    writer.line("M30");
    Program {
        text: writer.subprograms + &writer.text,
        asked: writer.asked,
        skips: writer.skips,
    }
}

/// The errors of the blocks at which the control stops.
const STOPS: [Code; 3] = [Code::PErr70495, Code::Fc209, Code::Fc320];

/// Returns the state of each axis at the end, which an error may be; `None` if the program does not end.
fn run(text: &str, given: &[u64], skip: Option<SkipLevels>) -> Option<Vec<State>> {
    let machine = machine();
    let compensation = machine.compensation();
    let blocks = if skip.is_some() { 600 } else { 50_000 };
    let limits = Limits::default().with_blocks(blocks);
    let options = Options::default().with_skip(skip).with_limits(limits);
    let mut run = Interpreter::new(machine, compensation, options);
    for (at, value) in given.iter().enumerate() {
        run.set(
            &format!("V.E.C{at}"),
            &Setting::Number(f64::from(u32::try_from(*value).expect("a small number"))),
        );
    }
    let mut left = None;
    let mut said = Vec::new();
    let source = SourceFile::new("a.nc", text);
    let outcome = run.program(
        source,
        &mut |name: &str, _: &str| called(name),
        &mut |event: Event<'_>| {
            if let Event::Executed(executed) = &event {
                let errors = executed.diagnostics.iter();
                let errors = errors.filter(|it| it.code.severity() == frictcomp::Severity::Error);
                let errors = errors.filter(|it| !STOPS.contains(&it.code));
                said.extend(errors.map(|it| it.message.clone()));
            }
            if let Event::Ended(ended) = event {
                let axes = (0..AXES.len()).map(AxisIndex::new);
                let states = axes.map(|axis| ended.compensation.state(axis, Kind::Frict));
                left = Some(states.collect());
            }
            ControlFlow::Continue(())
        },
    );
    assert!(said.is_empty(), "{text}\n{said:?}");
    match outcome {
        RunOutcome::Ended(EndedBy::Budget) if skip.is_some() => None,
        // Some way never ends, so nothing is reported about the end.
        RunOutcome::Ended(EndedBy::Budget) => Some(vec![State::Unknown; AXES.len()]),
        _ => left,
    }
}

/// Returns the states found by runs with every answer.
fn enumerated(program: &Program) -> Vec<BTreeSet<&'static str>> {
    let mut found = vec![BTreeSet::new(); AXES.len()];
    let count: u64 = program.asked.iter().product();
    for number in 0..count {
        let mut rest = number;
        let given: Vec<u64> = program
            .asked
            .iter()
            .map(|values| {
                let value = rest % values;
                rest /= values;
                value
            })
            .collect();
        let skips: &[SkipLevels] = if program.skips {
            &[SkipLevels::NONE, SkipLevels::ALL]
        } else {
            &[SkipLevels::NONE]
        };
        for skip in skips {
            for (axis, state) in run(&program.text, &given, Some(*skip))
                .into_iter()
                .flatten()
                .enumerate()
            {
                found[axis].insert(state.as_str());
            }
        }
    }
    found
}

fn compare(seed: u64, sort: Sort) {
    let program = program(seed, sort);
    let found = enumerated(&program);
    let Some(states) = run(&program.text, &[], None) else {
        panic!("seed {seed}: the run does not end\n{}", program.text);
    };
    for (axis, state) in states.iter().enumerate() {
        let found = &found[axis];
        let is_sound = *state == State::Unknown || found.iter().all(|it| *it == state.as_str());
        assert!(
            is_sound,
            "seed {seed}: {} is {state}, runs find {found:?}\n{}",
            AXES[axis], program.text
        );
        let is_exact = *state != State::Unknown || found.len() > 1;
        assert!(
            sort == Sort::Any || is_exact,
            "seed {seed}: {} is {state}, runs find {found:?}\n{}",
            AXES[axis],
            program.text
        );
    }
}

/// Returns the number of programs that are compared: 400, or `BOTH_SIDES_PROGRAMS`.
fn count() -> u64 {
    let given = std::env::var("BOTH_SIDES_PROGRAMS").ok();
    given.and_then(|it| it.parse().ok()).unwrap_or(400)
}

/// Compares the programs on all processors.
fn compare_all(sort: Sort) {
    let threads = std::thread::available_parallelism().map_or(1, NonZero::get);
    std::thread::scope(|scope| {
        for first in 1..=threads {
            scope.spawn(move || {
                let seeds = (first as u64..=count() / 2).step_by(threads);
                seeds.for_each(|seed| compare(seed, sort));
            });
        }
    });
}

#[test]
fn plain_conditions_that_are_asked_once_find_what_runs_with_values_find() {
    // R14.1, R14.2, R18.10
    compare_all(Sort::Exact);
}

#[test]
fn no_state_is_missing_that_a_run_with_values_finds() {
    // R14.1, R14.3, R18.10
    compare_all(Sort::Any);
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
        let compensation = machine.compensation();
        let mut run = Interpreter::new(machine, compensation, Options::default());
        let source = SourceFile::new("a.nc", text);
        run.program(source, &mut NoFiles, &mut |_: Event<'_>| {
            ControlFlow::Continue(())
        });
        assert_eq!(
            run.compensation().state(AxisIndex::new(0), Kind::Frict),
            known
        );
    }
}

#[test]
fn no_way_is_chosen_where_motion_is_computed() {
    // R14.8
    let text = "$IF V.E.A == 1\nX[COMP OFF FRICT]\n$ENDIF\nM30";
    let options = Options::default().with_motions(Motions::Taken);
    assert_eq!(rows(text, options), (2, 0));
}

#[test]
fn the_states_that_are_possible_name_their_ways() {
    // R14.2
    let machine = Machine::enabled(AXES);
    let compensation = machine.compensation();
    let mut run = Interpreter::new(machine, compensation, Options::default());
    let text = "$IF V.E.MATERIAL == 2\nX[COMP OFF FRICT]\n$ENDIF\n/Y[COMP OFF FRICT]\n\
                $SWITCH V.E.PART\n$CASE 1\n$CASE 2\nZ[COMP OFF FRICT]\n$ENDSWITCH\nM30";
    let source = SourceFile::new("a.nc", text);
    run.program(source, &mut NoFiles, &mut |_: Event<'_>| {
        ControlFlow::Continue(())
    });
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
