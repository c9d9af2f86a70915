//! Wishes of a user for an identified value list.

use thiserror::Error;

use super::identified::IdentifyOptions;
use super::support::RequestedPoints;

/// The most points of a list whose error is bounded.
const MOST: usize = 20;

/// The largest error that can be asked for, in per cent of the friction.
const LARGEST: f64 = 50.0;

/// Points and error of a value list, and the feed at which the machine works.
#[derive(Debug, Clone, Copy)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct ListRequest {
    /// The number of points; with an error the largest one.
    pub points: Option<usize>,
    /// The largest error in per cent of the friction.
    pub max_error_percent: Option<f64>,
    /// The feed in mm/min.
    pub feed_mm_per_min: f64,
}

/// Reason why a list cannot be made as requested.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
#[non_exhaustive]
pub enum ListRequestError {
    /// `0`, or not a number.
    #[error("a feed of {0} mm/min cannot be used")]
    Feed(f64),
    /// `1`.
    #[error("a value list has from 2 to 200 points")]
    Points(usize),
    /// `0`, or more than half of the friction.
    #[error("an error of {0} % is not possible")]
    MaxError(f64),
}

impl ListRequest {
    /// Returns the options of an identification.
    ///
    /// # Errors
    /// A number is outside its range.
    pub fn options(self) -> Result<IdentifyOptions, ListRequestError> {
        let feed = self.feed_mm_per_min;
        if !(feed > 0.0 && feed.is_finite()) {
            return Err(ListRequestError::Feed(feed));
        }
        let mut options = IdentifyOptions {
            working_speed: feed / 60.0,
            ..IdentifyOptions::default()
        };
        if let Some(points) = self.points {
            if !(2..=200).contains(&points) {
                return Err(ListRequestError::Points(points));
            }
            options.wanted = RequestedPoints::Points(points);
        }
        if let Some(percent) = self.max_error_percent {
            if !(percent > 0.0 && percent <= LARGEST) {
                return Err(ListRequestError::MaxError(percent));
            }
            options.accuracy = percent / 100.0;
            options.wanted = RequestedPoints::Error {
                part: options.accuracy,
                most: self.points.unwrap_or(MOST),
            };
        }
        Ok(options)
    }
}
