//! One or two recorded circles with their figures.

use super::circle::RecordedCircle;
use super::error::RecordedError;
use super::limits::{LIKE, MOST_MM};
use crate::circle::figures::{Nominal, Paths};
use crate::circle::geometry::PathCentre;
use crate::circle::simulated::Side;

/// One or two recorded circles with their figures.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct Recording {
    /// The circles.
    pub circles: Vec<RecordedCircle>,
    /// Commanded circle.
    pub commanded: CommandedCircle,
    /// The figures.
    pub side: Side,
}

/// Commanded values of recorded circles, if they are known.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct CommandedCircle {
    /// The radius.
    pub radius_mm: Option<f64>,
    /// The feed; without it, the feed from the times of the recording.
    pub feed_mm_per_min: Option<f64>,
}

impl Recording {
    /// Checks that a number of recordings of such circles can be evaluated together.
    ///
    /// # Errors
    /// There are more than two, or a radius or feed that no circle has.
    pub fn check(recordings: usize, commanded: CommandedCircle) -> Result<(), RecordedError> {
        if recordings > 2 {
            return Err(RecordedError::Count(recordings));
        }
        match commanded.radius_mm {
            Some(radius) if !(0.001..=1e6).contains(&radius) => {
                return Err(RecordedError::CommandedRadius(radius));
            }
            _ => {}
        }
        match commanded.feed_mm_per_min {
            Some(feed) if !(0.1..=1e6).contains(&feed) => Err(RecordedError::CommandedFeed(feed)),
            _ => Ok(()),
        }
    }

    /// Returns the figures of one circle, or of one in each direction: G, F and D about the least-squares centre of
    /// each, G(b) and H about `centre`.
    ///
    /// # Errors
    /// Two circles in the same direction, with centres that are far apart, or at different feeds or another one than
    /// the commanded one by their times.
    pub fn new(
        circles: Vec<RecordedCircle>,
        commanded: CommandedCircle,
        centre: PathCentre,
    ) -> Result<Self, RecordedError> {
        if circles.len() > 2 {
            return Err(RecordedError::Count(circles.len()));
        }
        if let [first, second] = &circles[..] {
            if first.direction == second.direction {
                return Err(RecordedError::SameDirection(first.direction));
            }
            if let [Some(one), Some(other)] = [first, second].map(RecordedCircle::feed_mm_per_min)
                && !LIKE.contains(&(one / other))
            {
                return Err(RecordedError::OtherFeeds([one, other]));
            }
            let [x, y] = [0, 1].map(|axis| first.centre_mm[axis] - second.centre_mm[axis]);
            let distance_mm = x.hypot(y);
            if centre == PathCentre::Common && distance_mm > MOST_MM {
                return Err(RecordedError::Apart { distance_mm });
            }
        }
        let circles: Vec<RecordedCircle> = match commanded.feed_mm_per_min {
            Some(feed) => {
                let driven = circles.into_iter().map(|it| it.driven_at(feed));
                driven.collect::<Result<_, _>>()?
            }
            None => circles,
        };
        let mut paths = Paths::default();
        for circle in &circles {
            paths.set(circle.direction, circle.profile.clone());
        }
        let nominal = match commanded.radius_mm {
            Some(_) => Nominal::Commanded,
            None => Nominal::Fitted,
        };
        Ok(Self {
            side: Side::of(paths, nominal, centre),
            commanded,
            circles,
        })
    }
}
