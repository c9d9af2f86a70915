//! FC401: a program leaves a kind away from its start-up state (R1.50). FC407: it moved the axis before, so that
//! its second run differs from the first (R1.53).

use super::linter::{EndNote, LeftAway, Linter};
use super::memory::{Deed, KindMemory, Site};
use crate::comp::{AxisIndex, Kind, State};
use crate::diagnostic::{Code, Diagnostic, Fix};
use crate::interpreter::Ended;
use crate::syntax::is_lone_m;
use crate::text::{Place, Span};

pub(super) fn lint(linter: &Linter<'_>, ended: &Ended<'_>, ending: &str) -> Vec<LeftAway> {
    let left = ended.compensation;
    let before_end = ended.at.filter(|at| is_lone_m(&at.text)).map(start_of);
    let mut found = Vec::new();
    for axis in (0..left.len()).map(AxisIndex::new) {
        for kind in Kind::ALL {
            let end = left.state(axis, kind);
            if end == linter.history.start_up(axis, kind) {
                continue;
            }
            let did = linter.memory.axis(axis).kind(kind);
            let is_told = |deed: Deed| match deed {
                Deed::On | Deed::Off => end != State::Unknown,
                Deed::Unknown => end == State::Unknown,
                // FC902 has said it of every axis.
                Deed::Lost => false,
            };
            if let Some((_, site)) = did.last.as_ref().filter(|(deed, _)| is_told(*deed)) {
                let subject = Subject {
                    linter,
                    axis,
                    kind,
                    end,
                    ending,
                    before_end: before_end.as_ref(),
                };
                let diagnostic = match moved_before(linter, axis, did) {
                    _ if end == State::Unknown => subject.may_be_left(site),
                    Some(moved) => subject.second_run_differs(site, moved),
                    None => subject.left_changed(site),
                };
                let note = EndNote {
                    seq: site.seq,
                    diagnostic: subject.with_way_home(diagnostic),
                };
                found.push(LeftAway { axis, kind, note });
            }
        }
    }
    found
}

/// The first motion of the axis, where it comes before the first command on the kind.
fn moved_before<'a>(linter: &'a Linter<'_>, axis: AxisIndex, did: &KindMemory) -> Option<&'a Site> {
    let moved = linter.memory.axis(axis).moved.as_ref()?;
    did.first
        .is_some_and(|first| moved.seq < first)
        .then_some(moved)
}

/// What is left, and how.
struct Subject<'a> {
    linter: &'a Linter<'a>,
    axis: AxisIndex,
    kind: Kind,
    end: State,
    /// What ends the program.
    ending: &'a str,
    /// Where a block before the program end begins.
    before_end: Option<&'a Place>,
}

impl Subject<'_> {
    fn left_changed(&self, site: &Site) -> Diagnostic {
        let (name, keyword) = (self.linter.name(self.axis), self.kind.as_str());
        let message = format!(
            "`{keyword}` of axis `{name}` is left {} after {}; the control starts with it {}",
            self.end.as_str(),
            self.ending,
            self.linter.history.start_up(self.axis, self.kind).as_str()
        );
        Diagnostic::new(Code::Fc401, site.place.clone(), message)
            .with_axis(name)
            .with_help(format!("restore it before M30: `{}`", self.way_home()))
    }

    /// What depends on a value that only the machine knows may be left away as well.
    fn may_be_left(&self, site: &Site) -> Diagnostic {
        let (name, keyword) = (self.linter.name(self.axis), self.kind.as_str());
        let start_up = self.linter.history.start_up(self.axis, self.kind);
        let away = match start_up {
            State::Inactive => State::Active,
            _ => State::Inactive,
        };
        let message = format!(
            "`{keyword}` of axis `{name}` may be left {} after {}, which is not known offline; the \
             control starts with it {}",
            away.as_str(),
            self.ending,
            start_up.as_str()
        );
        Diagnostic::new(Code::Fc401, site.place.clone(), message)
            .with_axis(name)
            .with_help(format!("restore it before M30: `{}`", self.way_home()))
    }

    fn second_run_differs(&self, site: &Site, moved: &Site) -> Diagnostic {
        let (name, keyword) = (self.linter.name(self.axis), self.kind.as_str());
        let place = &site.place;
        let message = format!(
            "the second run differs from the first: {} moves axis `{name}` before the program sets \
             `{keyword}`, and line {} leaves it {}",
            moved.seen_from(&place.file),
            place.start().line,
            self.end.as_str()
        );
        Diagnostic::new(Code::Fc407, place.clone(), message)
            .with_axis(name)
            .with_help(format!(
                "set it before the first motion, and restore it before M30: `{}`",
                self.way_home()
            ))
            .with_label(moved.place.clone(), "the axis moves here first")
    }

    /// The command that makes the state that of the start of the control.
    fn way_home(&self) -> String {
        let start_up = self.linter.history.start_up(self.axis, self.kind);
        let way = match (self.end, start_up) {
            (State::Inactive, _) => "ON",
            (State::Unknown, start_up) if start_up != State::Inactive => "ON",
            _ => "OFF",
        };
        let name = self.linter.name(self.axis);
        format!("{name}[COMP {way} {}]", self.kind.as_str())
    }

    /// The diagnostic with the command in a block before the program end.
    fn with_way_home(&self, diagnostic: Diagnostic) -> Diagnostic {
        match self.before_end {
            Some(place) => {
                let block = format!("{}\n", self.way_home());
                diagnostic.with_fix(Fix::guess(place.clone(), block))
            }
            None => diagnostic,
        }
    }
}

/// The empty place at the start of a block.
fn start_of(block: &Place) -> Place {
    Place {
        span: Span::default(),
        ..block.clone()
    }
}
