//! The range that the control accepts as MP1511, and the manual's recommendations (R8.3).

use std::ops::RangeInclusive;

use serde::Serialize;

/// Accepted values of MP1511, in µs.
pub const MP1511_RANGE_US: RangeInclusive<f64> = 0.0..=16_777_215.0;

/// Recommended values of MP1511, in µs.
pub const MP1511_GUIDELINE_US: RangeInclusive<f64> = 5000.0..=10_000.0;

/// Number of counting steps below which MP1512 stays; otherwise the axis oscillates at standstill.
pub const MP1512_GUIDELINE: f64 = 50.0;

/// A guideline of the manual that a value does not keep.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub enum Guideline {
    /// MP1511 is outside 5000 to 10 000 µs.
    Mp1511,
    /// MP1512 is 50 or more: the axis may oscillate at standstill.
    Mp1512,
}

/// Returns the guidelines that the known values do not keep.
pub(super) fn not_kept(mp1511_us: Option<f64>, mp1512: Option<f64>) -> Vec<Guideline> {
    let factor = mp1511_us.filter(|it| !MP1511_GUIDELINE_US.contains(it));
    let limit = mp1512.filter(|it| *it >= MP1512_GUIDELINE);
    let found = [
        factor.map(|_| Guideline::Mp1511),
        limit.map(|_| Guideline::Mp1512),
    ];
    found.into_iter().flatten().collect()
}
