//! The results of all recordings of a commissioning (R16.2, R16.9).

use serde::{Deserialize, Serialize};

use super::at_feed::AtFeed;
use super::found::{CirclesFound, FrictionFound};
use super::strokes::StrokesFound;

/// A recording in the folder.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct RecordingResult {
    /// Name of the file.
    pub file: String,
    /// The SHA-256 of its bytes.
    pub sha256: String,
    /// The SHA-256 of the plan and the options that it was read with; if they change, it is read again.
    pub read_with: String,
    /// The number of its program.
    pub program: Option<u16>,
    /// Result.
    pub found: RecordingOutcome,
}

/// Result of a recording.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub enum RecordingOutcome {
    /// The friction of an axis.
    Friction(FrictionFound),
    /// Circles.
    Circles(CirclesFound),
    /// Strokes of an axis alone.
    Strokes(StrokesFound),
    /// No usable result, with the reason.
    Refused(String),
}

impl RecordingOutcome {
    /// Reasons why nothing is concluded from it.
    pub fn against(&self) -> &[String] {
        match self {
            Self::Friction(found) => &found.against,
            Self::Circles(found) => &found.against,
            Self::Strokes(found) => &found.against,
            Self::Refused(reason) => std::slice::from_ref(reason),
        }
    }

    /// Remarks.
    pub fn notes(&self) -> &[String] {
        match self {
            Self::Friction(found) => &found.notes,
            Self::Circles(found) => &found.notes,
            Self::Strokes(found) => &found.notes,
            Self::Refused(_) => &[],
        }
    }

    /// Whether it counts for its program: there are no reasons against it, and it was driven at the planned feeds or
    /// near them. A first pass at 10 % override does not count.
    pub fn is_used(&self) -> bool {
        self.against().is_empty() && self.reversals().all(|it| it.is_near())
    }

    /// The recorded feeds as a part of the planned ones, if they are known.
    pub fn driven_part(&self) -> Option<f64> {
        match self {
            Self::Friction(found) => found.override_part,
            _ => self.reversals().map(|it| it.driven / it.feed).next(),
        }
    }

    /// Refuses it with a reason.
    pub fn refuse(&mut self, reason: String) {
        match self {
            Self::Friction(found) => found.against.push(reason),
            Self::Circles(found) => found.against.push(reason),
            Self::Strokes(found) => found.against.push(reason),
            Self::Refused(_) => {}
        }
    }

    /// Adds a remark.
    pub fn note(&mut self, remark: String) {
        match self {
            Self::Friction(found) => found.notes.push(remark),
            Self::Circles(found) => found.notes.push(remark),
            Self::Strokes(found) => found.notes.push(remark),
            Self::Refused(_) => {}
        }
    }

    /// The results of reversals at each feed.
    fn reversals(&self) -> impl Iterator<Item = AtFeed> {
        let circles = match self {
            Self::Circles(found) => found.at_feed(),
            _ => None,
        };
        let strokes = match self {
            Self::Strokes(found) => &found.reversals[..],
            _ => &[],
        };
        let strokes = strokes.iter().map(|it| AtFeed {
            feed: it.feed,
            driven: it.measured_feed,
            glitch: it.glitch,
        });
        circles.into_iter().chain(strokes)
    }
}

/// Recorded glitches at a feed with compensation off and on: in µm, or 0.001° of a rotary axis.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct BeforeAfter {
    /// The planned feed in mm/min or °/min.
    pub feed: f64,
    /// The feed that was driven.
    pub driven: f64,
    /// The largest glitch with compensation off.
    pub off: f64,
    /// The largest glitch with compensation on.
    pub on: f64,
}

impl BeforeAfter {
    /// Whether compensation leaves more than is left without it.
    pub fn is_worse(&self) -> bool {
        self.on > self.off
    }

    /// Whether compensation leaves clearly less than is left without it.
    pub fn shows_an_effect(&self) -> bool {
        const LEAST: f64 = 0.05;
        self.on < self.off * (1.0 - LEAST)
    }

    /// Whether off and on are alike here, although compensation leaves at most a part of the glitch without it at
    /// the two neighbouring feeds: it was on in both recordings, or in none.
    fn stands_out(&self, next: [&Self; 2], part: f64) -> bool {
        !self.shows_an_effect() && next.iter().all(|it| it.on < it.off * part)
    }
}

/// The feeds, slowest first, at which off and on are alike, although at the neighbouring feeds they are not. At the
/// slowest one they may be: there compensation takes little away.
pub fn without_effect(recorded: &[BeforeAfter]) -> Vec<f64> {
    const BETWEEN: f64 = 0.8;
    const FASTEST: f64 = 0.6;
    let mut alike = Vec::new();
    for three in recorded.windows(3) {
        if three[1].stands_out([&three[0], &three[2]], BETWEEN) {
            alike.push(three[1].feed);
        }
    }
    if let [.., one, other, fastest] = recorded
        && fastest.stands_out([one, other], FASTEST)
    {
        alike.push(fastest.feed);
    }
    alike
}

/// The feeds that were recorded with compensation off and on, and with no reasons against the recordings, slowest
/// first. Programs are recognised by their numbers. Of several recordings those count that were driven at the feed of
/// the program, otherwise those next to it; of those the smallest glitch without and the largest with compensation.
pub fn before_after(
    results: &[RecordingResult],
    is_off: impl Fn(u16) -> bool,
    is_on: impl Fn(u16) -> bool,
) -> Vec<BeforeAfter> {
    let recorded = |is_so: &dyn Fn(u16) -> bool| {
        let used = results.iter().filter(|it| it.found.against().is_empty());
        let used = used.filter(|it| it.program.is_some_and(is_so));
        let shown = used.flat_map(|it| it.found.reversals());
        shown.filter(AtFeed::is_near).collect::<Vec<AtFeed>>()
    };
    let on = recorded(&is_on);
    let mut pairs: Vec<(f64, BeforeAfter)> = Vec::new();
    for off in recorded(&is_off) {
        for on in on.iter().filter(|it| off.is_driven_as(it)) {
            let pair = BeforeAfter {
                feed: off.feed,
                driven: off.driven,
                off: off.glitch,
                on: on.glitch,
            };
            let beside = off.beside();
            let known = pairs
                .iter_mut()
                .find(|(_, it)| it.feed.total_cmp(&off.feed).is_eq());
            match known {
                None => pairs.push((beside, pair)),
                Some(known) if beside < known.0 => *known = (beside, pair),
                Some((is_beside, known)) if beside.total_cmp(is_beside).is_eq() => {
                    known.off = known.off.min(pair.off);
                    known.on = known.on.max(pair.on);
                }
                Some(_) => {}
            }
        }
    }
    let mut pairs: Vec<BeforeAfter> = pairs.into_iter().map(|it| it.1).collect();
    pairs.sort_by(|one, other| one.feed.total_cmp(&other.feed));
    pairs
}

/// Refuses recordings that cannot belong to the others: the same bytes twice, and circles about another centre
/// than those before them (R16.9).
pub fn refuse_strangers(results: &mut [RecordingResult]) {
    /// Centres of one machine are at most this far apart, in mm.
    const SAME_CENTRE_MM: f64 = 1.0;
    let mut first: Option<([f64; 2], String)> = None;
    for at in 0..results.len() {
        let (earlier, rest) = results.split_at_mut(at);
        let Some(result) = rest.first_mut() else {
            return;
        };
        if let Some(same) = earlier.iter().find(|it| it.sha256 == result.sha256) {
            result
                .found
                .refuse(format!("it is a copy of `{}`", same.file));
            continue;
        }
        let RecordingOutcome::Circles(found) = &mut result.found else {
            continue;
        };
        if !found.against.is_empty() {
            continue;
        }
        let [x, y] = found.centre_mm;
        match &first {
            None => first = Some((found.centre_mm, result.file.clone())),
            Some(([first_x, first_y], file)) => {
                if (x - first_x).hypot(y - first_y) > SAME_CENTRE_MM {
                    found.against.push(format!(
                        "its centre is at {x:.1}, {y:.1} and that of `{file}` at {first_x:.1}, {first_y:.1}: it is of \
                         another place or machine"
                    ));
                }
            }
        }
    }
}
