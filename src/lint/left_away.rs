//! FC401: a program leaves a kind away from home (R1.50). FC407: it moved the axis before, so that
//! its second run differs from the first (R1.53).

use super::memory::{Deed, KindMemory, Site};
use super::{EndNote, LeftAway, Linter};
use crate::comp::{AxisIndex, Compensation, Kind, State};
use crate::diagnostic::{Code, Diagnostic};

pub(super) fn lint(linter: &Linter<'_>, left: &Compensation, past: &str) -> Vec<LeftAway> {
    let mut found = Vec::new();
    for axis in (0..left.len()).map(AxisIndex::new) {
        for kind in Kind::ALL {
            let end = left.state(axis, kind);
            if end == linter.history.home(axis, kind) {
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
                    past,
                };
                let diagnostic = match moved_before(linter, axis, did) {
                    _ if end == State::Unknown => subject.may_be_left(site),
                    Some(moved) => subject.second_run_differs(site, moved),
                    None => subject.left_changed(site),
                };
                let note = EndNote {
                    seq: site.seq,
                    diagnostic,
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
    past: &'a str,
}

impl Subject<'_> {
    fn left_changed(&self, site: &Site) -> Diagnostic {
        let (name, keyword) = (self.linter.name(self.axis), self.kind.keyword());
        let message = format!(
            "`{keyword}` of axis `{name}` is left {} past {}; the control starts with it {}",
            self.end.as_str(),
            self.past,
            self.linter.history.home(self.axis, self.kind).as_str()
        );
        Diagnostic::new(Code::Fc401, site.place.clone(), message)
            .with_axis(name)
            .with_help(format!("bring it home before M30: `{}`", self.way_home()))
    }

    /// What hangs on a value that only the machine knows may be left away as well.
    fn may_be_left(&self, site: &Site) -> Diagnostic {
        let (name, keyword) = (self.linter.name(self.axis), self.kind.keyword());
        let home = self.linter.history.home(self.axis, self.kind);
        let (away, way) = match home {
            State::Inactive => (State::Active, "OFF"),
            _ => (State::Inactive, "ON"),
        };
        let message = format!(
            "`{keyword}` of axis `{name}` may be left {} past {}, which is not known offline; the \
             control starts with it {}",
            away.as_str(),
            self.past,
            home.as_str()
        );
        let help = format!("bring it home before M30: `{name}[COMP {way} {keyword}]`");
        Diagnostic::new(Code::Fc401, site.place.clone(), message)
            .with_axis(name)
            .with_help(help)
    }

    fn second_run_differs(&self, site: &Site, moved: &Site) -> Diagnostic {
        let (name, keyword) = (self.linter.name(self.axis), self.kind.keyword());
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
                "set it before the first motion, and bring it home before M30: `{}`",
                self.way_home()
            ))
            .with_label(moved.place.clone(), "the axis moves here first")
    }

    fn way_home(&self) -> String {
        let way = match self.end {
            State::Inactive => "ON",
            _ => "OFF",
        };
        let name = self.linter.name(self.axis);
        format!("{name}[COMP {way} {}]", self.kind.keyword())
    }
}
