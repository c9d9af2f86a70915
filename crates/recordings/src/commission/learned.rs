//! The recordings of a round of learning: the turns of each circle, and whether there are two (R16.4).

use thiserror::Error;

use super::found::coarse;
use crate::identify::TraceFinding;

use frictcomp_physics::circle::{
    Circle, CircleError, Crossing, Direction, LearnedCircle, PlaneAxis, RecordedCircle,
    RecordedTwice,
};

/// Minimum number of feeds: between four up to 1.8 µm remain hidden (R16.4).
pub const LEAST_FEEDS: usize = 6;

/// Part within which turns have the same feed and the same radius.
const SAME: f64 = 0.02;

/// Largest distance of the centres of one machine, in mm.
const SAME_CENTRE_MM: f64 = 1.0;

/// Two recordings of one list differ by at most this part of their mean at a reversal …
const ALIKE: f64 = 0.5;

/// … or by this, in µm.
const ALIKE_UM: f64 = 1.5;

/// A turn of a recording, with the name of its file.
#[derive(Debug, Clone)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct RecordedTurn {
    /// Name of the file.
    pub file: String,
    /// The turn.
    pub circle: RecordedCircle,
    /// The unit that was assumed to read it, if one was.
    pub assumed: Option<TraceFinding>,
}

/// The circles of a round for X and for Y, the slowest first.
#[derive(Debug, Clone)]
pub struct LearnedCircles(pub [Vec<LearnedCircle>; 2]);

/// Recordings that do not make a round.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum LearnError {
    /// A recording without times.
    #[error("`{0}` has no times, so its feed is not known")]
    NoTimes(String),
    /// A unit that the recording does not give.
    #[error("`{file}`: {assumed}, which learning does not take for granted")]
    Unit {
        /// Name of the file.
        file: String,
        /// The unit that would be assumed, in words.
        assumed: String,
    },
    /// Samples that are too far apart to show a reversal.
    #[error("`{file}`: {coarse}")]
    Coarse {
        /// Name of the file.
        file: String,
        /// Distance between the recordings, and what to record, in words.
        coarse: String,
    },
    /// A feed that was recorded once, or more than twice.
    #[error(
        "F{feed:.0} {direction} was recorded {}; each circle is recorded twice with the same list",
        times(*.count)
    )]
    Count {
        /// The feed in mm/min.
        feed: f64,
        /// The direction of travel.
        direction: Direction,
        /// The number of files.
        count: usize,
    },
    /// Four feeds.
    #[error("recorded feeds: {0}, of at least {LEAST_FEEDS}")]
    Feeds(usize),
    /// Circles of 50 and of 100 mm.
    #[error("`{file}` has a radius of {found_mm:.1} mm, and others have {radius_mm:.1} mm")]
    Radius {
        /// Name of the file.
        file: String,
        /// Radius.
        found_mm: f64,
        /// The radius of the first recording.
        radius_mm: f64,
    },
    /// Recordings at two places, as of two machines.
    #[error("the centre of `{file}` is {distance_mm:.1} mm from that of `{other}`")]
    Apart {
        /// Name of the file.
        file: String,
        /// The first recording.
        other: String,
        /// The distance.
        distance_mm: f64,
    },
    /// A circle that is too small and fast.
    #[error("F{0:.0} is too fast for the radius: a glitch cannot be told from the next")]
    NoGlitch(f64),
    /// A circle that cannot be simulated.
    #[error(transparent)]
    Circle(#[from] CircleError),
    /// Two recordings of one list that are not alike.
    #[error(
        "at F{feed:.0} {crossing} {direction} one recording leaves {:.1} \u{b5}m and the other {:.1} \u{b5}m",
        .heights_um[0], .heights_um[1]
    )]
    NotAlike {
        /// The feed in mm/min.
        feed: f64,
        /// The crossing.
        crossing: Crossing,
        /// The direction of travel.
        direction: Direction,
        /// The glitch in each recording.
        heights_um: [f64; 2],
    },
    /// Rounds with different feeds.
    #[error("F{0:.0} was not recorded in every round")]
    OtherFeeds(f64),
}

fn times(count: usize) -> String {
    match count {
        1 => "once".to_owned(),
        several => format!("{several} times"),
    }
}

impl LearnError {
    /// Returns advice for the user.
    pub fn help(&self) -> &'static str {
        match self {
            Self::NoTimes(_) => "record the time in s as well, or name its channel",
            Self::Unit { .. } => "give the unit of the positions",
            Self::Coarse { .. } => "export it with every cycle of the control",
            Self::Count { count: 1, .. } => {
                "record it a second time: without a second recording the spread is not known"
            }
            Self::Count { .. } => "leave two of them in the folder",
            Self::Feeds(_) => {
                "add feeds over a decade, such as 500, 800, 1300, 2000, 3200 and 5000 mm/min: between four \
                 feeds up to 1.8 \u{b5}m hide"
            }
            Self::Radius { .. } => "record all circles with one radius",
            Self::Apart { .. } => {
                "record all circles of one machine at one place; recordings of another machine need a folder of \
                 their own"
            }
            Self::Circle(error) => error.help(),
            Self::NoGlitch(_) => "record a larger radius or a lower feed",
            Self::NotAlike { .. } => {
                "two recordings of one list on one warm machine agree: look for another machine, another list or a \
                 cold start, and record both again"
            }
            Self::OtherFeeds(_) => "record the same feeds in every round",
        }
    }
}

impl LearnedCircles {
    /// Pairs the turns of a round: every circle twice, at least six feeds, all with the radius and the centre of
    /// `reference`, the first turn of the first round.
    ///
    /// # Errors
    /// The turns do not make a round.
    pub fn of(
        turns: &[RecordedTurn],
        reference: &RecordedTurn,
        cycle_time_s: f64,
    ) -> Result<Self, LearnError> {
        one_machine(turns, reference)?;
        let groups = by_feed(turns)?;
        let mut circles = [Vec::new(), Vec::new()];
        for (feed, group) in &groups {
            let circle = Circle {
                radius_mm: reference.circle.radius_mm,
                feed_mm_per_min: *feed,
                cycle_time_s,
            };
            circle.check()?;
            let recordings = twice(*feed, group)?;
            for (axis, circles) in PlaneAxis::ALL.into_iter().zip(&mut circles) {
                let [first, second] = recordings.each_ref().map(Vec::as_slice);
                let recorded =
                    RecordedTwice::of(axis, [first, second]).ok_or(LearnError::NoGlitch(*feed))?;
                alike(axis, *feed, &recorded)?;
                circles.push(LearnedCircle { circle, recorded });
            }
        }
        if groups.len() < LEAST_FEEDS {
            return Err(LearnError::Feeds(groups.len()));
        }
        Ok(Self(circles))
    }

    /// Checks that another round has the same feeds.
    ///
    /// # Errors
    /// A feed that only one of them has.
    pub fn same_feeds(&self, other: &Self) -> Result<(), LearnError> {
        let feeds = |it: &Self| {
            let circles = it.0[0].iter();
            circles
                .map(|it| it.circle.feed_mm_per_min)
                .collect::<Vec<_>>()
        };
        let [one, two] = [feeds(self), feeds(other)];
        let lacks = |all: &[f64], feed: &f64| !all.iter().any(|it| is_same(*it, *feed));
        let alone = one.iter().find(|it| lacks(&two, it));
        match alone.or_else(|| two.iter().find(|it| lacks(&one, it))) {
            Some(feed) => Err(LearnError::OtherFeeds(*feed)),
            None => Ok(()),
        }
    }
}

/// Checks that all turns have the radius and the centre of the first one, and samples close enough to show a reversal.
fn one_machine(turns: &[RecordedTurn], first: &RecordedTurn) -> Result<(), LearnError> {
    for turn in turns {
        let [radius_mm, found_mm] = [&first.circle, &turn.circle].map(|it| it.radius_mm);
        if let Some(assumed) = &turn.assumed {
            return Err(LearnError::Unit {
                file: turn.file.clone(),
                assumed: assumed.message.clone(),
            });
        }
        if let Some(coarse) = coarse(&turn.circle) {
            let file = turn.file.clone();
            return Err(LearnError::Coarse { file, coarse });
        }
        if !is_same(found_mm, radius_mm) {
            let file = turn.file.clone();
            return Err(LearnError::Radius {
                file,
                found_mm,
                radius_mm,
            });
        }
        let [from, to] = [&first.circle, &turn.circle].map(|it| it.centre_mm);
        let distance_mm = (to[0] - from[0]).hypot(to[1] - from[1]);
        if distance_mm > SAME_CENTRE_MM {
            return Err(LearnError::Apart {
                file: turn.file.clone(),
                other: first.file.clone(),
                distance_mm,
            });
        }
    }
    Ok(())
}

fn is_same(one: f64, other: f64) -> bool {
    (one / other - 1.0).abs() <= SAME
}

/// Returns the turns of each feed in mm/min, the slowest first.
fn by_feed(turns: &[RecordedTurn]) -> Result<Vec<(f64, Vec<&RecordedTurn>)>, LearnError> {
    let mut timed = Vec::new();
    for turn in turns {
        let feed = turn.circle.feed_mm_per_min();
        timed.push((
            feed.ok_or_else(|| LearnError::NoTimes(turn.file.clone()))?,
            turn,
        ));
    }
    timed.sort_by(|one, other| one.0.total_cmp(&other.0));
    let mut groups: Vec<(f64, Vec<&RecordedTurn>)> = Vec::new();
    for (feed, turn) in timed {
        match groups.last_mut().filter(|it| is_same(feed, it.0)) {
            Some((_, group)) => group.push(turn),
            None => groups.push((feed, vec![turn])),
        }
    }
    Ok(groups)
}

/// Returns both recordings of a feed, each with its directions.
fn twice<'a>(
    feed: f64,
    group: &[&'a RecordedTurn],
) -> Result<[Vec<&'a RecordedCircle>; 2], LearnError> {
    let mut recordings = [Vec::new(), Vec::new()];
    for direction in Direction::ALL {
        let of_direction = group.iter().filter(|it| it.circle.direction == direction);
        let turns: Vec<_> = of_direction.map(|it| &it.circle).collect();
        match turns[..] {
            [] => {}
            [first, second] => {
                recordings[0].push(first);
                recordings[1].push(second);
            }
            _ => {
                let count = turns.len();
                return Err(LearnError::Count {
                    feed,
                    direction,
                    count,
                });
            }
        }
    }
    Ok(recordings)
}

/// Checks that both recordings leave about the same at each reversal.
fn alike(axis: PlaneAxis, feed: f64, recorded: &RecordedTwice) -> Result<(), LearnError> {
    const ERRORS: f64 = 3.0;
    let [first, second] = recorded.heights_um();
    let crossings = Crossing::ALL.into_iter().filter(|it| it.axis() == axis);
    let places = crossings.cycle().zip(recorded.directions());
    for ((crossing, direction), (one, other)) in places.zip(first.into_iter().zip(second)) {
        let heights_um = [one.0, other.0];
        let apart = (one.0 - other.0).abs();
        let most = ALIKE_UM
            .max(ALIKE * f64::midpoint(one.0, other.0))
            .max(ERRORS * one.1.hypot(other.1));
        if apart > most {
            return Err(LearnError::NotAlike {
                feed,
                crossing,
                direction,
                heights_um,
            });
        }
    }
    Ok(())
}
