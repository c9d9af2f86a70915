//! A handmade session, played as an interpreter would.

use std::collections::BTreeMap;
use std::ops::ControlFlow;

use frictcomp::comp::{Change, Compensation, Kind, KindSet, Selection};
use frictcomp::diagnostic::{Code, Diagnostic, Severity};
use frictcomp::interpreter::{EndedBy, Modal};
use frictcomp::machine::{AxisSet, Machine};
use frictcomp::text::{SourceFile, Span};
use frictcomp::timeline::{
    AxisSummary, ChangedBy, End, EndNote, Record, Row, Sink, StateView, Summary,
};

/// The documented example (1.5), with a loop after it that changes nothing.
pub(super) const PROGRAM: &str = "\
%DEMO
; the documented example
N15 X[COMP ON FRICT] ;Activates X axis
N25 Y[COMP OFF FRICT] ;Deactivates \"Y\" axis
N35 X22 Y33 Z44
N45 X[COMP OFF FRICT] ;Deactivates X axis
N55 M30 ;Program end";

/// Returns the machine of the example with more axes after Z.
pub(super) fn machine(more: &[&str]) -> Machine {
    let mut machine = Machine::enabled(["X", "Y"]);
    machine.axes.truncate(3);
    machine.axis_set = AxisSet::Configured;
    machine
        .axes
        .extend(more.iter().map(|name| frictcomp::machine::Axis::new(*name)));
    for name in more {
        machine.enable(name);
    }
    machine
}

/// The state of a player, borrowed field by field.
macro_rules! state {
    ($player:ident) => {
        StateView {
            machine: $player.machine,
            compensation: &$player.comp,
            possible: &[],
            listed: &$player.listed,
            version: $player.version,
        }
    };
}

/// Plays the example into a sink, as an interpreter would.
pub(super) struct Player<'a> {
    machine: &'a Machine,
    comp: Compensation,
    pub(super) listed: Vec<bool>,
    pub(super) version: u64,
    seq: u64,
    sink: &'a mut dyn Sink,
}

impl<'a> Player<'a> {
    pub(super) fn new(machine: &'a Machine, sink: &'a mut dyn Sink) -> Self {
        Self {
            comp: machine.compensation(),
            listed: vec![true; machine.axes.len()],
            version: 1,
            seq: 0,
            machine,
            sink,
        }
    }

    pub(super) fn block(
        &mut self,
        line: u32,
        command: Option<(&str, Selection)>,
        said: &[Diagnostic],
    ) -> ControlFlow<()> {
        let text = PROGRAM.lines().nth(line as usize - 1).unwrap();
        self.text(line, text, command, said)
    }

    pub(super) fn text(
        &mut self,
        line: u32,
        text: &str,
        command: Option<(&str, Selection)>,
        said: &[Diagnostic],
    ) -> ControlFlow<()> {
        let mut changes: Vec<Change> = Vec::new();
        if let Some((axis, selection)) = command {
            let axis = self.machine.find(axis).unwrap();
            self.comp.switch(axis, selection, &mut changes).unwrap();
        }
        if !changes.is_empty() {
            self.version += 1;
        }
        self.seq += 1;
        let number = text
            .strip_prefix('N')
            .and_then(|rest| rest.split(' ').next()?.parse().ok());
        let (seq, level) = (self.seq, (line > 100).then_some(1));
        self.sink.record(&Record::Block(Row {
            program: 1,
            seq,
            file: if level.is_some() { "sub.nc" } else { "demo.nc" },
            line,
            number,
            level,
            text,
            changes: &changes,
            state: state!(self),
            modal: &Modal::new(self.machine.axes.len()),
            uncompensated: &[],
            motion: None,
            branch: None,
            diagnostics: said,
            reported: &[],
        }))
    }

    pub(super) fn begin(&mut self) {
        let _ = self.sink.record(&Record::Session {
            state: state!(self),
            remark: None,
        });
        let _ = self.sink.record(&Record::Program {
            program: 1,
            file: "demo.nc",
            name: Some("DEMO"),
            state: state!(self),
        });
    }

    pub(super) fn end(&mut self, notes: &[EndNote]) {
        let seq = self.seq;
        let _ = self.sink.record(&Record::End(End {
            program: 1,
            seq,
            by: EndedBy::M30,
            notes,
            repeated: &[],
            changes: &[],
            state: state!(self),
        }));
        let view = state!(self);
        let start = self.machine.compensation();
        let axes = view.axes().map(|(axis, name)| {
            let (from, to) = (
                start.state(axis, Kind::Frict),
                view.state(axis, Kind::Frict),
            );
            let changed = from != to;
            let (line, number) = if name == "X" { (6, 45) } else { (4, 25) };
            AxisSummary {
                others_away: frictcomp::comp::KindSet::NONE,
                axis,
                start: from,
                end: to,
                start_up: from,
                told: changed,
                changed_by: changed
                    .then(|| ChangedBy {
                        program: 1,
                        file: "demo.nc".to_owned(),
                        line,
                        number: Some(number),
                        to,
                    })
                    .into_iter()
                    .collect(),
                changes: u64::from(changed),
                feed_moves: frictcomp::timeline::FeedMoves::default(),
                is_undescribed: false,
                is_rewritten: false,
            }
        });
        let opaque = BTreeMap::from([("#HSC".to_owned(), 3)]);
        let summary = Summary {
            programs: 1,
            blocks: seq,
            counts: BTreeMap::from([(Severity::Info, 1), (Severity::Warning, 2)]),
            opaque: &opaque,
            axes: axes.collect(),
            assumed: std::collections::BTreeSet::new(),
            silenced: &std::collections::BTreeSet::new(),
            rests_on: frictcomp::readings::QuestionSet::default(),
            state: view,
        };
        let _ = self.sink.record(&Record::Summary(&summary));
    }
}

pub(super) const ON: Selection = Selection::On(KindSet::of(Kind::Frict));
pub(super) const OFF: Selection = Selection::Off(KindSet::of(Kind::Frict));

pub(super) fn about(code: Code, meant: &str, message: &str) -> Diagnostic {
    let file = SourceFile::new("demo.nc", PROGRAM);
    let start = PROGRAM.find(meant).unwrap();
    let place = file.place(Span::new(start, start + meant.len()));
    Diagnostic::new(code, place, message)
}

pub(super) fn play(machine: &Machine, sink: &mut dyn Sink) {
    let mut player = Player::new(machine, sink);
    player.begin();
    let nothing = about(
        Code::Fc402,
        "X[COMP ON FRICT]",
        "`X[COMP ON FRICT]` changes nothing, friction compensation of `X` is active already",
    )
    .with_axis("X");
    let _ = player.block(3, Some(("X", ON)), &[nothing]);
    let _ = player.block(4, Some(("Y", OFF)), &[]);
    let _ = player.block(5, None, &[]);
    let _ = player.block(6, Some(("X", OFF)), &[]);
    let _ = player.block(7, None, &[]);
    let left = about(
        Code::Fc401,
        "Y[COMP OFF FRICT]",
        "friction compensation of `Y` is left inactive",
    )
    .with_axis("Y")
    .with_help("add `Y[COMP ON FRICT]` before M30");
    player.end(&[EndNote {
        seq: 2,
        diagnostic: left,
    }]);
}
