//! FC401: a program leaves a kind away from its start-up state (R1.50). FC407: it moved the axis before, so that
//! its second run differs from the first (R1.53).

use crate::comp::{AxisIndex, Kind, State};
use crate::diagnostic::{Code, Diagnostic, Fix, Severity};
use crate::interpreter::{
    BlockSite, Ended, EndedBy, KindEffect, PossibleStates, ProgramEnd, limit_to,
};
use crate::lint::linter::{EndNote, LeftAway, Linter};
use crate::lint::memory::{MovedBefore, command_to};
use crate::syntax::is_lone_end;
use crate::text::{Place, Span};

pub(super) fn lint(linter: &Linter<'_>, ended: &Ended<'_>) -> Vec<LeftAway> {
    let left = ended.compensation;
    let mut found = Vec::new();
    for axis in (0..left.len()).map(AxisIndex::new) {
        for kind in Kind::ALL {
            let end = left.state(axis, kind);
            if end == linter.states.start_up(axis, kind) {
                continue;
            }
            let did = linter.memory.axis(axis).kind(kind);
            let is_told = |effect: KindEffect| match effect {
                KindEffect::On | KindEffect::Off => end != State::Unknown,
                KindEffect::Doubted => end == State::Unknown,
                // FC902 already reported this for every axis.
                KindEffect::Lost => false,
            };
            let latest = ended.found.history.last(axis, kind);
            let last = latest.filter(|(effect, _)| is_told(*effect));
            let possible = ended.possible.iter();
            let mut possible = possible.filter(|it| (it.axis, it.kind) == (axis, kind));
            let possible = possible.next();
            // If ways differ, the command that leads away on some of them counts.
            let command = command_to(ended, (axis, kind), &linter.states.start_up);
            let leading = match linter.states.start_up(axis, kind) {
                State::Inactive => KindEffect::On,
                _ => KindEffect::Off,
            };
            let away = ended.found.history.latest(axis, kind, leading);
            // It was brought back, but the program may end before that.
            let is_lost = matches!(latest, Some((KindEffect::Lost, _)));
            let passed = away.filter(|_| end == State::Unknown && !is_lost);
            let passed = passed.filter(|_| has_other_ends(ended));
            // FC902 already reported what only a call decides.
            let parted = possible.filter(|it| !(is_lost && it.rests_on_calls()));
            let parted = parted.and(away);
            let known = command.filter(|_| end != State::Unknown);
            // Blocks that are passed over may lead away, too.
            let doubted = ended.found.history.latest(axis, kind, KindEffect::Doubted);
            let doubted = away
                .or(doubted)
                .filter(|_| end == State::Unknown && !is_lost);
            let site = passed.or(parted).or(known);
            if let Some(site) = site.or(last.map(|(_, site)| site)).or(doubted) {
                let subject = LeftAwayKind {
                    linter,
                    axis,
                    kind,
                    end,
                    possible,
                    ended,
                };
                let ending = subject.ending(&site.place);
                let moved_before = did.moved_before.as_ref().filter(|_| did.is_commanded);
                let what = moved_before.and_then(|moved| subject.what_is_left(moved, site));
                let diagnostic = match (moved_before, what) {
                    (Some(moved), Some(what)) => subject.second_run_differs(site, moved, &what),
                    _ if end == State::Unknown => subject.may_be_left(site, &ending),
                    _ => subject.left_changed(site, &ending),
                };
                let mut diagnostic = subject.with_ends(diagnostic);
                diagnostic.fixes.extend(subject.fix(diagnostic.code));
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

/// Returns whether the program may end elsewhere than in the dry run.
fn has_other_ends(ended: &Ended<'_>) -> bool {
    ended.ends.iter().any(|end| end.cause.is_some())
}

/// A kind of an axis that is left away, with its cause.
struct LeftAwayKind<'a> {
    linter: &'a Linter<'a>,
    axis: AxisIndex,
    kind: Kind,
    end: State,
    /// The possible states, if ways differ.
    possible: Option<&'a PossibleStates>,
    ended: &'a Ended<'a>,
}

impl LeftAwayKind<'_> {
    fn left_changed(&self, site: &BlockSite, ending: &str) -> Diagnostic {
        let (name, keyword) = (self.linter.name(self.axis), self.kind.as_str());
        let message = format!(
            "`{keyword}` of axis `{name}` is left {} after {ending}; the control starts with it {}",
            self.end.as_str(),
            self.linter.states.start_up(self.axis, self.kind).as_str()
        );
        Diagnostic::new(Code::Fc401, site.place.clone(), message)
            .with_axis(name)
            .with_help(self.restore(&site.place))
    }

    /// Reports that a selection may also be left away, depending on a value that only the machine knows.
    fn may_be_left(&self, site: &BlockSite, ending: &str) -> Diagnostic {
        let (name, keyword) = (self.linter.name(self.axis), self.kind.as_str());
        let start_up = self.linter.states.start_up(self.axis, self.kind);
        let away = match start_up {
            State::Inactive => State::Active,
            _ => State::Inactive,
        };
        let away = away.as_str();
        let what = match self.ways_away(&site.place.file) {
            Some(ways) => format!("is left {away} after {ending} {ways}"),
            None => format!("may be left {away} after {ending}, which is not known offline"),
        };
        let message = format!(
            "`{keyword}` of axis `{name}` {what}; the control starts with it {}",
            start_up.as_str()
        );
        let mut diagnostic = Diagnostic::new(Code::Fc401, site.place.clone(), message)
            .with_axis(name)
            .with_help(self.restore(&site.place));
        if self.needs_change() {
            diagnostic.lower(Severity::Info);
        }
        diagnostic
    }

    /// Returns the state that a command leaves after a motion, with the ways on which it does; `None` if that is
    /// unknown, or if the two need not occur together.
    fn what_is_left(&self, moved: &MovedBefore, site: &BlockSite) -> Option<String> {
        if self.end != State::Unknown {
            return Some(self.end.as_str().to_owned());
        }
        if !moved.ways.is_empty() || self.needs_change() {
            return None;
        }
        let file = &site.place.file;
        let (_, away) = self.state_away()?;
        Some(format!("{} {}", away.as_str(), self.ways_away(file)?))
    }

    fn second_run_differs(&self, site: &BlockSite, moved: &MovedBefore, what: &str) -> Diagnostic {
        let (name, keyword) = (self.linter.name(self.axis), self.kind.as_str());
        let place = &site.place;
        let message = format!(
            "the second run differs from the first: {} moves axis `{name}` before the program sets \
             `{keyword}`, and line {} leaves it {what}",
            moved.site.seen_from(&place.file),
            place.start().line,
        );
        let mut diagnostic = Diagnostic::new(Code::Fc407, place.clone(), message)
            .with_axis(name)
            .with_help(format!(
                "set it before the first motion, and {}",
                self.restore(place)
            ))
            .with_label(moved.site.place.clone(), "the axis moves here first");
        if !moved.ways.is_empty() {
            limit_to(&mut diagnostic, &moved.ways);
        }
        diagnostic
    }

    /// Returns the state away from the start-up state that some ways leave.
    fn state_away(&self) -> Option<(&PossibleStates, State)> {
        let start_up = self.linter.states.start_up(self.axis, self.kind);
        let possible = self.possible?;
        let mut states = possible.states.iter().map(|it| it.state);
        Some((possible, states.find(|state| *state != start_up)?))
    }

    /// Returns whether it is left away only if a machine value changes in the meantime (R14.1).
    fn needs_change(&self) -> bool {
        let away = self.state_away();
        away.is_some_and(|(possible, away)| possible.needs_change(away))
    }

    /// Returns the ways on which it is left away (R14.5).
    fn ways_away(&self, file: &str) -> Option<String> {
        let start_up = self.linter.states.start_up(self.axis, self.kind);
        let (possible, away) = self.state_away()?;
        let ways = possible.ways_to(away, file);
        ways.or_else(|| possible.unless(start_up, file))
    }

    /// Returns the command that restores the state at the start of the control.
    fn way_home(&self) -> String {
        let start_up = self.linter.states.start_up(self.axis, self.kind);
        let way = match (self.end, start_up) {
            (State::Inactive, _) => "ON",
            (State::Unknown, start_up) if start_up != State::Inactive => "ON",
            _ => "OFF",
        };
        let name = self.linter.name(self.axis);
        format!("{name}[COMP {way} {}]", self.kind.as_str())
    }

    /// Returns whether the program writes the parameters of the kind, so that no command makes it known.
    fn is_rewritten(&self) -> bool {
        self.ends()
            .any(|end| end.compensation.rewritten(self.axis).contains(self.kind))
    }

    /// Returns the ends at which the kind is, or may be, away from its start-up state.
    fn ends(&self) -> impl Iterator<Item = &ProgramEnd> {
        let start_up = self.linter.states.start_up(self.axis, self.kind);
        let ends = self.ended.ends.iter();
        ends.filter(move |end| end.compensation.state(self.axis, self.kind) != start_up)
    }

    /// Returns what ends the program where the kind is left away, as seen from a file.
    fn ending(&self, site: &Place) -> String {
        if self.ended.endless {
            return "the reset that ends it".to_owned();
        }
        let mut ends = self.ends().map(|end| (end.by, place_seen_from(end, site)));
        match (ends.next(), ends.next()) {
            (Some((EndedBy::Error, place)), None) => format!("the error in {place}"),
            (Some((EndedBy::Error, _)), Some((EndedBy::Error, _)))
                if ends.all(|(by, _)| by == EndedBy::Error) =>
            {
                "an error".to_owned()
            }
            _ => "program end".to_owned(),
        }
    }

    /// Returns the remedy, as seen from a file. Nothing runs after a loop that only a reset ends.
    fn restore(&self, site: &Place) -> String {
        if self.is_rewritten() {
            return "run the program with a configuration that has the values which it writes into the machine data"
                .to_owned();
        }
        let command = self.way_home();
        if self.ended.endless {
            return format!("restore it in the loop, which only a reset ends: `{command}`");
        }
        format!("restore it before {}: `{command}`", self.place_of_end(site))
    }

    /// Returns the ends as named by a message in a file.
    fn place_of_end(&self, site: &Place) -> String {
        let mut ends = self.ends().map(|end| (end.by, place_seen_from(end, site)));
        let word = match self.ended.by {
            EndedBy::M02 => "M02",
            _ => "M30",
        };
        match (ends.next(), ends.next()) {
            (Some((EndedBy::Error, only)), None) => format!("the error in {only}"),
            (Some((_, only)), None) if self.ended.at.is_some() => format!("{word} in {only}"),
            (Some(first), Some(second)) => {
                let all = [first, second].into_iter().chain(ends);
                let all: Vec<String> = all.map(|(_, place)| place).collect();
                format!(
                    "each end that the program may reach, as no single block is right for all of them ({})",
                    all.join(", ")
                )
            }
            _ => word.to_owned(),
        }
    }

    /// Adds the ends to the diagnostic.
    fn with_ends(&self, mut diagnostic: Diagnostic) -> Diagnostic {
        diagnostic.ends = self.ends().map(|end| end.place.clone()).collect();
        let has_others = has_other_ends(self.ended);
        let is_said = |end: &&ProgramEnd| has_others || end.by == EndedBy::Error;
        for end in self.ends().filter(is_said) {
            let what = match end.by {
                EndedBy::Error => "an error ends the program here",
                EndedBy::Budget => "only a reset ends the program here",
                _ => "the program ends here",
            };
            let text = match end.decided_by() {
                Some(cause) => format!("{what}, depending on {cause}"),
                None if has_others => format!("{what} otherwise"),
                None => what.to_owned(),
            };
            diagnostic = diagnostic.with_label(end.place.clone(), text);
        }
        diagnostic
    }

    /// Returns the fix: the command in a block before the end, if one place is right on every way (R1.58); for FC407
    /// also before the first block.
    fn fix(&self, code: Code) -> Option<Fix> {
        let mut ends = self.ends();
        let (only, None) = (ends.next()?, ends.next()) else {
            return None;
        };
        // Where an error ends every way, what follows it is no place to restore anything.
        let is_place =
            only.is_passed_into && self.ended.by != EndedBy::Error && is_lone_end(&only.place.text);
        if !is_place || self.is_rewritten() {
            return None;
        }
        let command = self.way_home();
        let restored = Fix::block(start_of(&only.place), &command);
        if code != Code::Fc407 {
            return Some(restored);
        }
        let begin = self.linter.begin.clone()?;
        let is_one_file = begin.file == only.place.file;
        is_one_file.then(|| Fix::block(begin, &command).with(restored))
    }
}

/// Returns the place of an end, as named by a message in a file.
fn place_seen_from(end: &ProgramEnd, site: &Place) -> String {
    let line = end.place.start().line;
    if end.place.file == site.file {
        format!("line {line}")
    } else {
        format!("{}:{line}", end.place.file)
    }
}

/// Returns the empty place at the start of a block.
fn start_of(block: &Place) -> Place {
    Place {
        span: Span::default(),
        ..block.clone()
    }
}
