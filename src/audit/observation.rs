//! What one run of a program did to each axis.

use std::sync::Arc;

use serde::Serialize;

use super::effect::{FirstMotion, Pace, Site, WhyUnknown};
use crate::comp::{AxisIndex, Compensation, Kind, KindSet};
use crate::diagnostic::{Code, Diagnostic, Severity};
use crate::interpreter::{Ended, EndedBy, Event, Executed, Group, Outcome};
use crate::machine::Machine;

/// So many blocks of the main program are remembered before its end.
pub(super) const LAST_BLOCKS: usize = 8;

/// A kind of compensation on an axis that is configured for it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct AuditedKind {
    /// The axis.
    pub axis: AxisIndex,
    /// The kind.
    pub kind: Kind,
}

/// What is looked at on a machine: each configured kind of each axis, of which friction compensation
/// alone counts unless others are asked for.
#[derive(Debug, Clone)]
pub struct Scope {
    subjects: Vec<AuditedKind>,
    /// For each axis, which of the subjects are its own.
    by_axis: Vec<std::ops::Range<usize>>,
    start_up: Compensation,
}

impl Scope {
    /// The configured axes of a machine, and the kinds that count.
    pub fn new(machine: &Machine, kinds: KindSet) -> Self {
        let start_up = machine.compensation();
        let mut subjects = Vec::new();
        let by_axis = (0..start_up.len()).map(AxisIndex::new).map(|axis| {
            let from = subjects.len();
            let configured = kinds
                .iter()
                .filter(|kind| start_up.is_configured(axis, *kind));
            subjects.extend(configured.map(|kind| AuditedKind { axis, kind }));
            from..subjects.len()
        });
        let by_axis = by_axis.collect();
        Self {
            subjects,
            by_axis,
            start_up,
        }
    }

    /// The kinds of axes that are looked at, in the order of the machine's axes.
    pub fn subjects(&self) -> &[AuditedKind] {
        &self.subjects
    }

    /// The state at the start of the control (R1.22).
    pub fn start_up(&self) -> &Compensation {
        &self.start_up
    }

    /// The same with every subject away from its start-up state: a state that programs may leave.
    pub fn away(&self) -> Compensation {
        let mut away = self.start_up.clone();
        for (position, range) in self.by_axis.iter().enumerate() {
            let axis = AxisIndex::new(position);
            let mut selected = away.selected(axis);
            for subject in &self.subjects[range.clone()] {
                if selected.contains(subject.kind) {
                    selected.remove(subject.kind);
                } else {
                    selected.insert(subject.kind);
                }
            }
            let unknown = away.unknown(axis);
            away.restore(axis, selected, unknown);
        }
        away
    }

    /// Whether a subject is selected at the start of the control.
    pub(super) fn is_on_at_start_up(&self, subject: AuditedKind) -> bool {
        self.start_up.selected(subject.axis).contains(subject.kind)
    }
}

/// The selection of a kind of compensation on an axis (R1.23), whatever the parameterisation.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Selected {
    /// It is selected.
    On,
    /// It is not.
    Off,
    /// It is not known offline.
    Unknown,
}

impl Selected {
    /// The word of the records.
    pub fn as_str(self) -> &'static str {
        match self {
            Self::On => "on",
            Self::Off => "off",
            Self::Unknown => "unknown",
        }
    }

    fn digit(self) -> u64 {
        match self {
            Self::On => 1,
            Self::Off => 2,
            Self::Unknown => 3,
        }
    }

    pub(super) fn of(compensation: &Compensation, subject: AuditedKind) -> Self {
        let AuditedKind { axis, kind } = subject;
        if compensation.unknown(axis).contains(kind) {
            Self::Unknown
        } else if compensation.selected(axis).contains(kind) {
            Self::On
        } else {
            Self::Off
        }
    }
}

/// What made a selection what it is.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) enum Deed {
    /// A command that was executed.
    Command(Site),
    /// Something that is not known offline.
    Doubt(WhyUnknown),
}

/// A motion word, and which executed block it is.
#[derive(Debug, Clone)]
pub(super) struct Moved {
    pub(super) seq: u64,
    pub(super) motion: FirstMotion,
    /// The line of the main program that was executed or called from.
    pub(super) main: Option<u32>,
}

/// What a run did to one subject.
#[derive(Debug, Clone, Default)]
pub(super) struct Observed {
    /// The last that changed it or set it anew.
    pub(super) last: Option<Deed>,
    /// Whether a command of the program named it.
    pub(super) commanded: bool,
    /// The first motion word before any command.
    pub(super) inherited: Option<Moved>,
    /// The first motion word after a command in a state that is unknown all the same.
    pub(super) doubtful: Option<Moved>,
    /// The first motion word away from its start-up state.
    pub(super) astray: Option<Moved>,
    /// A digest of the selection at every motion word.
    pub(super) motions: u64,
}

/// What one run of a program did.
#[derive(Debug, Clone)]
pub(super) struct Observation {
    pub(super) observed: Vec<Observed>,
    /// Why it ended; `None` where nobody waited for the end.
    pub(super) by: Option<EndedBy>,
    /// The block of the main program that ended it.
    pub(super) end: Option<u32>,
    /// What stopped it.
    pub(super) stopped: Option<WhyUnknown>,
    /// The state that it left, by subject.
    pub(super) left: Vec<Selected>,
    /// The lines of the blocks of the main program that were executed last, the last one first.
    pub(super) last_lines: Vec<u32>,
    /// The line of its first block.
    pub(super) first_line: Option<u32>,
    ring: [u32; LAST_BLOCKS],
    main_blocks: usize,
    doubt: Option<WhyUnknown>,
}

impl Observation {
    /// Before a run.
    pub(super) fn new(scope: &Scope) -> Self {
        let count = scope.subjects.len();
        Self {
            observed: vec![Observed::default(); count],
            by: None,
            end: None,
            stopped: None,
            left: vec![Selected::Unknown; count],
            last_lines: Vec::new(),
            first_line: None,
            ring: [0; LAST_BLOCKS],
            main_blocks: 0,
            doubt: None,
        }
    }

    /// Takes an event of the run.
    pub(super) fn event(&mut self, scope: &Scope, event: Event<'_>) {
        match event {
            Event::Executed(executed) => self.executed(scope, &executed),
            Event::Ended(ended) => self.ended(scope, &ended),
            _ => {}
        }
    }

    #[inline]
    fn executed(&mut self, scope: &Scope, executed: &Executed<'_>) {
        if executed.level.is_none() {
            self.first_line.get_or_insert(executed.line);
            self.ring[self.main_blocks % LAST_BLOCKS] = executed.line;
            self.main_blocks += 1;
        }
        let quiet = executed.outcomes.is_empty()
            && executed.changes.is_empty()
            && executed.doubted.is_empty()
            && executed.diagnostics.is_empty()
            && executed.perhaps_moved.is_empty();
        if !quiet {
            self.deeds(scope, executed);
        }
        // The commands of a block act before its motion (R1.9).
        for word in executed.moved {
            self.moved(scope, executed, word.axis);
        }
    }

    #[inline(never)]
    fn deeds(&mut self, scope: &Scope, executed: &Executed<'_>) {
        self.heed(executed);
        for outcome in executed.outcomes {
            self.command(scope, executed, outcome);
        }
        for change in executed.changes {
            let kinds = KindSet::of(change.kind);
            self.doubts(scope, (change.axis, kinds), executed);
        }
        for &(axis, kinds) in executed.doubted {
            self.doubts(scope, (axis, kinds), executed);
        }
        for &axis in executed.perhaps_moved {
            for at in scope.by_axis[axis.get()].clone() {
                let observed = &mut self.observed[at];
                if !observed.commanded && observed.inherited.is_none() {
                    let mut moved = moved_at(executed, self.last_main());
                    moved.motion.perhaps = true;
                    moved.motion.motion = Pace::Unknown;
                    self.observed[at].inherited = Some(moved);
                }
            }
        }
    }

    /// Remembers what is not known, and what stops the program.
    fn heed(&mut self, executed: &Executed<'_>) {
        let site = Site {
            file: Arc::clone(executed.file),
            line: executed.line,
        };
        for said in executed.diagnostics {
            if said.code == Code::Fc901 || said.code == Code::Fc902 {
                self.doubt = Some(reason(said, Some(site.clone())));
            }
        }
        if executed.stopped {
            let errors = executed.diagnostics.iter();
            let mut errors = errors.filter(|said| said.severity == Severity::Error);
            self.stopped = errors.next().map(|said| reason(said, Some(site)));
        }
    }

    fn command(&mut self, scope: &Scope, executed: &Executed<'_>, outcome: &Outcome) {
        let Ok(axis) = outcome.result else {
            return;
        };
        let kinds = outcome.command.selection.kinds();
        for at in scope.by_axis[axis.get()].clone() {
            if kinds.contains(scope.subjects[at].kind) {
                let observed = &mut self.observed[at];
                observed.commanded = true;
                observed.last = Some(Deed::Command(Site {
                    file: Arc::clone(executed.file),
                    line: executed.line,
                }));
            }
        }
    }

    /// What the block leaves unknown of an axis.
    fn doubts(
        &mut self,
        scope: &Scope,
        (axis, kinds): (AxisIndex, KindSet),
        executed: &Executed<'_>,
    ) {
        let lost = executed.compensation.unknown(axis).intersection(kinds);
        if lost.is_empty() {
            return;
        }
        for at in scope.by_axis[axis.get()].clone() {
            if lost.contains(scope.subjects[at].kind) {
                let reason = self.doubt.clone().unwrap_or_else(|| WhyUnknown {
                    code: None,
                    message: "what this block does is not known offline".to_owned(),
                    site: Some(Site {
                        file: Arc::clone(executed.file),
                        line: executed.line,
                    }),
                });
                self.observed[at].last = Some(Deed::Doubt(reason));
            }
        }
    }

    #[inline]
    fn moved(&mut self, scope: &Scope, executed: &Executed<'_>, axis: AxisIndex) {
        for at in scope.by_axis[axis.get()].clone() {
            let subject = scope.subjects[at];
            let selected = Selected::of(executed.compensation, subject);
            let is_home = (selected == Selected::On) == scope.is_on_at_start_up(subject)
                && selected != Selected::Unknown;
            let observed = &mut self.observed[at];
            // FNV-1a.
            let step = observed.motions ^ selected.digit();
            observed.motions = step.wrapping_mul(0x0100_0000_01b3);
            let inherits = !observed.commanded;
            let doubts = !inherits && selected == Selected::Unknown;
            let is_known = observed.inherited.is_some() || !inherits;
            if is_known
                && (observed.doubtful.is_some() || !doubts)
                && (observed.astray.is_some() || is_home)
            {
                continue;
            }
            let moved = moved_at(executed, self.last_main());
            let observed = &mut self.observed[at];
            if inherits {
                observed.inherited.get_or_insert_with(|| moved.clone());
            }
            if doubts {
                observed.doubtful.get_or_insert_with(|| moved.clone());
            }
            if !is_home {
                observed.astray.get_or_insert(moved);
            }
        }
    }

    /// The line of the main program that is executed or called from.
    fn last_main(&self) -> Option<u32> {
        let last = self.main_blocks.checked_sub(1)?;
        Some(self.ring[last % LAST_BLOCKS])
    }

    fn ended(&mut self, scope: &Scope, ended: &Ended<'_>) {
        self.by = Some(ended.by);
        self.end = ended.at.map(|place| place.first_line);
        let of_subject = |subject: &AuditedKind| Selected::of(ended.compensation, *subject);
        self.left = scope.subjects.iter().map(of_subject).collect();
        let has_failed = matches!(ended.by, EndedBy::Error | EndedBy::Budget);
        if has_failed && self.stopped.is_none() {
            let said = ended.diagnostics.first();
            self.stopped = Some(said.map_or_else(
                || WhyUnknown {
                    code: None,
                    message: "the program was stopped".to_owned(),
                    site: None,
                },
                |said| reason(said, Some(site_of(said))),
            ));
        }
        for (observed, left) in self.observed.iter_mut().zip(&self.left) {
            let is_doubt = matches!(observed.last, Some(Deed::Doubt(_)));
            if *left == Selected::Unknown && !is_doubt {
                observed.last = self.doubt.clone().map(Deed::Doubt);
            }
        }
        let count = self.main_blocks.min(LAST_BLOCKS);
        let back = (1..=count).map(|back| self.ring[(self.main_blocks - back) % LAST_BLOCKS]);
        self.last_lines = back.collect();
    }
}

fn moved_at(executed: &Executed<'_>, main: Option<u32>) -> Moved {
    let functions = &executed.modal.functions;
    let motion = match functions.motion {
        _ if !executed.modal.is_known(Group::Motion) => Pace::Unknown,
        0 => Pace::Rapid,
        _ => Pace::Feed,
    };
    Moved {
        seq: executed.seq,
        motion: FirstMotion {
            site: Site {
                file: Arc::clone(executed.file),
                line: executed.line,
            },
            motion,
            perhaps: false,
        },
        main: if executed.level.is_none() {
            Some(executed.line)
        } else {
            main
        },
    }
}

fn site_of(said: &Diagnostic) -> Site {
    Site {
        file: Arc::clone(&said.place.file),
        line: said.place.start().line,
    }
}

fn reason(said: &Diagnostic, site: Option<Site>) -> WhyUnknown {
    WhyUnknown {
        code: Some(said.code),
        message: said.message.clone(),
        site,
    }
}
