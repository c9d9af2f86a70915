//! The subject of the report: archives by machine, and the words for effects of programs.

use std::collections::BTreeSet;
use std::fmt::Write as _;
use std::path::Path;

use crate::document::{Headline, Standing, Tone};
use crate::wording::counted;
use frictcomp::audit::{
    Archive, AxisAudit, AxisFinding, Cure, Ending, ProgramAudit, ProgramEffect,
};
use frictcomp::comp::{Kind, State};
use frictcomp::machine::Machine;
use frictcomp::text::shown_path;
use frictcomp::timeline::ReadingsInForce;

/// Archives by machine, with what was found in each.
#[derive(Debug, Clone, Default)]
pub struct AuditReport {
    /// The machines, each with its programs.
    pub machines: Vec<MachineAudit>,
    /// The programs that were not looked at, counted by kind (R18.5).
    pub not_checked: Option<String>,
}

/// The programs of one machine.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct MachineAudit {
    /// The configuration or start-up list of the machine, if there is one.
    pub origin: Option<String>,
    /// The programs.
    pub archive: Archive,
    /// Effects of all programs together.
    pub findings: Vec<AxisFinding>,
    /// The readings on which these effects rest.
    pub rests_on: ReadingsInForce,
    /// The lines that assume friction compensation of axes, in words (R18.2).
    pub assumption: Option<String>,
}

impl AuditReport {
    /// Creates the report on the archive of each machine, with the file that describes it.
    pub fn new<'a>(
        machines: impl Iterator<Item = (Option<&'a Path>, &'a Machine)>,
        archives: Vec<Archive>,
        not_checked: Option<String>,
    ) -> Self {
        let machines = machines.zip(archives).map(|((origin, machine), archive)| {
            MachineAudit::new(origin.map(shown_path), machine, archive)
        });
        Self {
            machines: machines.collect(),
            not_checked,
        }
    }
}

impl MachineAudit {
    /// Finds the effects of the programs of a machine together.
    fn new(origin: Option<String>, machine: &Machine, archive: Archive) -> Self {
        let archive = archive.without_unswitched();
        Self {
            findings: archive.findings(),
            rests_on: ReadingsInForce::of(archive.rests_on(), machine),
            assumption: machine.assumption(),
            origin,
            archive,
        }
    }
}

/// The place of a block that ends the hazards of a program, in its file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum CurePlace {
    Beginning,
    Before(u32),
    End,
}

impl MachineAudit {
    /// Returns the findings that have any content: a kind that no program switches is left out.
    pub(super) fn shown(&self) -> impl Iterator<Item = &AxisFinding> {
        let programs = self.archive.programs();
        let is_switched = move |at: usize| {
            let mut programs = programs.iter();
            programs.any(|program| program.axes[at].effect != ProgramEffect::Keeps)
        };
        let findings = self.findings.iter();
        findings.filter(move |it| it.kind == Kind::Frict || is_switched(it.at))
    }

    /// Returns the programs, those with the most dangerous effect on an axis first.
    pub(super) fn by_danger(&self, findings: &[&AxisFinding]) -> Vec<&ProgramAudit> {
        let mut programs: Vec<&ProgramAudit> = self.archive.programs().iter().collect();
        programs.sort_by_cached_key(|program| {
            let words = findings.iter().map(|it| Word::of(&program.axes[it.at]));
            words.min()
        });
        programs
    }

    /// Returns the programs that the cure of an axis changes, each with the place of its block.
    pub(super) fn cures(&self, finding: &AxisFinding) -> Vec<(&ProgramAudit, CurePlace)> {
        let place = |program: &ProgramAudit| {
            let motion = program.axes[finding.at].inherits.motion();
            match (finding.cure(), program.ending, motion) {
                (Cure::Inheritors, _, Some(motion)) if *motion.site.file == *program.file => {
                    CurePlace::Before(motion.site.line)
                }
                (Cure::Inheritors, ..) => CurePlace::Beginning,
                (_, Ending::At(line), _) => CurePlace::Before(line),
                _ => CurePlace::End,
            }
        };
        let programs = match finding.cure() {
            Cure::Leavers => finding.leavers.clone(),
            Cure::Inheritors => finding.movers(),
            _ => Vec::new(),
        };
        let programs = programs.iter().map(|&at| &self.archive.programs()[at]);
        programs.map(|it| (it, place(it))).collect()
    }
}

/// Returns the number of programs that leave an axis away from its start-up state on some ways only.
pub(super) fn possible_leavers(archive: &Archive, finding: &AxisFinding) -> usize {
    let effect = |at: &&usize| archive.programs()[**at].axes[finding.at].effect;
    let leavers = finding.leavers.iter();
    leavers
        .filter(|at| effect(at) == ProgramEffect::Depends)
        .count()
}

/// Returns text such as "33 programs leave X off, 2 may, 262 run with it off", without what none does; `of_machine`
/// tells the axis from that of another machine.
fn cause(archive: &Archive, finding: &AxisFinding, of_machine: &str) -> String {
    let possible = possible_leavers(archive, finding);
    let counts = [finding.leavers.len() - possible, finding.inheritors.len()];
    let verb = |count, one: &'static str, several| if count == 1 { one } else { several };
    let away = if finding.on_at_start_up { "off" } else { "on" };
    let axis = format!(
        "{}{of_machine} {away}",
        axis_name(&finding.axis, finding.kind)
    );
    let mut cause = match (counts[0], possible) {
        (0, _) => format!("{} may leave {axis}", counted(possible, "program")),
        (sure, _) => format!(
            "{} {} {axis}",
            counted(sure, "program"),
            verb(sure, "leaves", "leave")
        ),
    };
    if counts[0] > 0 && possible > 0 {
        let _ = write!(cause, ", {possible} may");
    }
    if counts[1] > 0 {
        let runs = verb(counts[1], "runs", "run");
        let _ = write!(cause, ", {} {runs} with it {away}", counts[1]);
    }
    cause
}

/// Returns the programs of a machine whose effect on some axis is not known.
fn unknown_programs(machine: &MachineAudit) -> impl Iterator<Item = &ProgramAudit> {
    let unknown = machine.findings.iter().flat_map(|it| &it.unknown);
    let unknown: BTreeSet<usize> = unknown.copied().collect();
    unknown
        .into_iter()
        .map(|at| &machine.archive.programs()[at])
}

/// Returns whether the verdict says of a program whose effect on some axis is not known what it does to another one.
fn names_unknown(machine: &MachineAudit) -> bool {
    let left = machine.findings.iter();
    let left = left.filter(|it| !it.leavers.is_empty());
    let named = left.flat_map(|it| it.leavers.iter().chain(&it.inheritors));
    let named: BTreeSet<usize> = named.copied().collect();
    let mut unknown = machine.findings.iter().flat_map(|it| &it.unknown);
    unknown.any(|at| named.contains(at))
}

/// Axes that the verdict names; further ones are counted.
const NAMED: usize = 3;

impl AuditReport {
    /// Returns the verdict: how many programs leave an axis away from its start-up state, and how many run with it
    /// (R10.2, R18.23).
    pub fn headline(&self) -> Headline {
        let programs = counted(self.programs(), "program");
        let (standing, text) = if self.programs() == 0 {
            (Standing::Open, "no program was audited".to_owned())
        } else if self.findings().next().is_none() {
            let text = format!("{programs}: no axis is configured for friction compensation");
            (Standing::Open, text)
        } else if self.hazards() > 0 {
            let said = self.causes().into_iter().chain(self.not_known());
            let said: Vec<String> = said.collect();
            (Standing::Bad, said.join("; "))
        } else if self.possible_hazards() > 0 {
            let possible = "in some order, one may move an axis that another left away from its start-up state";
            let said = self.causes().into_iter().chain([possible.into()]);
            let said: Vec<String> = said.chain(self.not_known()).collect();
            (Standing::Open, format!("{programs}: {}", said.join("; ")))
        } else if let Some(unknown) = self.not_known() {
            let said = self.causes().into_iter().chain([unknown]);
            let said: Vec<String> = said.collect();
            (Standing::Open, format!("{programs}: {}", said.join("; ")))
        } else {
            let (standing, left) = match &*self.causes().join("; ") {
                "" => (Standing::Good, String::new()),
                left => (Standing::Open, format!("{left}, but ")),
            };
            let order =
                "in no order does one move an axis that another left away from its start-up state";
            (standing, format!("{programs}: {left}{order}"))
        };
        let assumptions = self.assumptions().map(str::to_owned);
        Headline::new(standing, text).assuming(assumptions)
    }

    /// Returns in words of how many programs the effect on some axis is not known.
    fn not_known(&self) -> Option<String> {
        let unknown: Vec<&ProgramAudit> = self.machines.iter().flat_map(unknown_programs).collect();
        let of = if unknown.len() == self.programs() {
            String::new()
        } else {
            format!("of {} ", counted(unknown.len(), "program"))
        };
        let what = if self.machines.iter().any(names_unknown) {
            "what else"
        } else {
            "what"
        };
        let they = if unknown.len() == 1 {
            "it leaves or inherits"
        } else {
            "they leave or inherit"
        };
        (!unknown.is_empty()).then(|| format!("{of}it is not known {what} {they}"))
    }

    /// Returns what happens to each axis that programs leave away from its start-up state in words, those with hazards
    /// first, with its machine where several have an axis of its name.
    fn causes(&self) -> Vec<String> {
        let named = self.machines.iter().flat_map(|machine| {
            let left = machine.findings.iter();
            let left = left.filter(|it| !it.leavers.is_empty());
            left.map(move |it| (machine, it))
        });
        let mut named: Vec<(&MachineAudit, &AxisFinding)> = named.collect();
        named.sort_by_key(|(_, it)| (it.hazards() == 0, it.possible_hazards() == 0));
        let is_alone = |finding: &AxisFinding| {
            let same = named
                .iter()
                .filter(|(_, it)| (&it.axis, it.kind) == (&finding.axis, finding.kind));
            same.count() == 1
        };
        let said = named.iter().map(|(machine, finding)| {
            let origin = self.origin_among_several(machine);
            let origin = origin.filter(|_| !is_alone(finding));
            let of_machine = origin.map_or(String::new(), |it| format!(" ({it})"));
            cause(&machine.archive, finding, &of_machine)
        });
        let mut said: Vec<String> = said.collect();
        let more = said.len().saturating_sub(NAMED);
        said.truncate(NAMED);
        said.extend(match more {
            0 => None,
            1 => Some("1 more axis is left away, or may be".to_owned()),
            _ => Some(format!("{more} more axes are left away, or may be")),
        });
        said
    }

    pub(super) fn findings(&self) -> impl Iterator<Item = &AxisFinding> {
        self.machines.iter().flat_map(|machine| &machine.findings)
    }

    /// Returns the readings on which the findings rest.
    pub(super) fn rests_on(&self) -> ReadingsInForce {
        let mut all = ReadingsInForce::default();
        for machine in &self.machines {
            all.extend(machine.rests_on.clone());
        }
        all
    }

    /// Returns the assumptions about axes on which the findings rest.
    pub(super) fn assumptions(&self) -> impl Iterator<Item = &str> {
        self.machines
            .iter()
            .filter_map(|it| it.assumption.as_deref())
    }

    /// Returns the hazards of all axes.
    pub fn hazards(&self) -> u64 {
        let hazards = self.findings().map(AxisFinding::hazards);
        hazards.fold(0, u64::saturating_add)
    }

    /// Returns the possible hazards of all axes.
    pub fn possible_hazards(&self) -> u64 {
        let hazards = self.findings().map(AxisFinding::possible_hazards);
        hazards.fold(0, u64::saturating_add)
    }

    /// Returns whether something has to be corrected, or is not known.
    pub fn has_warnings(&self) -> bool {
        self.findings().any(AxisFinding::is_worth_a_warning)
    }

    /// Returns the axes and kinds for which the effect of a program is not known, or only on some ways.
    pub fn unknown(&self) -> impl Iterator<Item = (&str, Kind)> {
        let programs = self.machines.iter().flat_map(|it| it.archive.programs());
        let axes = programs.flat_map(|program| &program.axes);
        let unknown =
            axes.filter(|axis| axis.effect == ProgramEffect::Unknown || axis.possible.is_some());
        unknown.map(|axis| (axis.axis.as_str(), axis.kind))
    }

    /// Returns the number of audited programs.
    pub fn programs(&self) -> usize {
        let programs = self.machines.iter().map(|it| it.archive.programs().len());
        programs.sum()
    }

    /// Returns the machine's name if there are several machines.
    pub(super) fn origin_among_several<'a>(&self, machine: &'a MachineAudit) -> Option<&'a str> {
        let several = self.machines.len() > 1;
        several.then(|| machine.origin.as_deref().unwrap_or("no configuration"))
    }
}

frictcomp::words! {
    /// Effect of a program on an axis, as one word; the most dangerous comes first.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
    #[non_exhaustive]
    pub enum Word {
        /// Motion of the axis as it is found, and an end away from its start-up state.
        Both = "both",
        /// End with the axis away from its start-up state.
        Leaves = "leaves",
        /// Such an effect on some ways.
        Depends = "depends",
        /// Effect not known offline.
        Unknown = "unknown",
        /// Motion of the axis in the state that is found.
        Inherits = "inherits",
        /// Possible motion of the axis in the state that is found.
        Perhaps = "perhaps",
        /// End with the axis in its start-up state, and no motion of it before that.
        StartUp = "start-up",
        /// No effect: the axis is neither taken away from its start-up state nor moved before it is set.
        Keeps = "keeps",
    }
}

impl Word {
    /// Returns the word for the effect of a program on an axis.
    pub fn of(axis: &AxisAudit) -> Self {
        match axis.effect {
            _ if axis.leaves_away() && axis.is_inheritor() => Self::Both,
            ProgramEffect::Depends if axis.leaves_away() => Self::Depends,
            _ if axis.leaves_away() => Self::Leaves,
            _ if axis.is_unknown() => Self::Unknown,
            _ if axis.is_inheritor() => Self::Inherits,
            _ if axis.may_inherit() => Self::Perhaps,
            ProgramEffect::Keeps | ProgramEffect::Depends => Self::Keeps,
            _ => Self::StartUp,
        }
    }

    /// Returns the tone of a cell with the word.
    pub(super) fn tone(self) -> Tone {
        match self {
            Self::Both | Self::Leaves | Self::Depends => Tone::Away,
            Self::Unknown => Tone::State(State::Unknown),
            Self::Inherits | Self::Perhaps => Tone::State(State::Inactive),
            Self::StartUp => Tone::State(State::Active),
            Self::Keeps => Tone::Quiet,
        }
    }

    /// Returns the meaning.
    pub fn meaning(self) -> &'static str {
        match self {
            Self::Both => {
                "moves the axis as it finds it, and leaves it away from its start-up state"
            }
            Self::Leaves => "leaves the axis away from its start-up state",
            Self::Depends => {
                "leaves the axis away from its start-up state, depending on a condition"
            }
            Self::Unknown => "it is not known offline what the program leaves or inherits",
            Self::Inherits => "moves the axis in the state that it finds",
            Self::Perhaps => "may move the axis in the state that it finds",
            Self::StartUp => {
                "leaves the axis in its start-up state, and does not move it before that"
            }
            Self::Keeps => {
                "neither takes the axis away from its start-up state nor moves it before it is set"
            }
        }
    }
}

/// Returns an axis, with its kind if that is not friction compensation.
pub(super) fn axis_name(axis: &str, kind: Kind) -> String {
    if kind == Kind::Frict {
        axis.to_owned()
    } else {
        format!("{axis} {}", kind.as_str())
    }
}
