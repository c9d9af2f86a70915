//! Transformation from values to places in the picture, and round numbers in between.

/// The division of an axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[non_exhaustive]
pub enum Spacing {
    /// Equal length of equal steps.
    #[default]
    Linear,
    /// Equal length of equal factors; values that are not above 0 make it linear.
    Logarithmic,
    /// Linear from 0 to the least value above it, logarithmic from there.
    LogarithmicFromZero,
}

/// The properties of an axis of a chart.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ChartAxis {
    /// The quantity with its unit, `velocity in mm/min`.
    pub label: String,
    /// Division.
    pub spacing: Spacing,
    /// Whether the axis contains 0, whatever the values are.
    pub from_zero: bool,
    /// The range in both directions, whatever the values are.
    pub reach: Option<f64>,
    /// The same values in another unit, on the other side.
    pub second: Option<SecondUnit>,
}

/// Another unit of an axis.
#[derive(Debug, Clone, PartialEq)]
pub struct SecondUnit {
    /// The quantity with its unit, `velocity in mm/min`.
    pub label: String,
    /// The number of these units in one of the first unit.
    pub factor: f64,
}

impl ChartAxis {
    /// Returns a linear axis.
    pub fn linear(label: impl Into<String>) -> Self {
        Self {
            label: label.into(),
            ..Self::default()
        }
    }

    /// Returns a logarithmic axis.
    pub fn logarithmic(label: impl Into<String>) -> Self {
        Self {
            label: label.into(),
            spacing: Spacing::Logarithmic,
            ..Self::default()
        }
    }

    /// Returns an axis with 0 that is logarithmic from the least value above it on.
    pub fn logarithmic_from_zero(label: impl Into<String>) -> Self {
        Self {
            label: label.into(),
            spacing: Spacing::LogarithmicFromZero,
            ..Self::default()
        }
    }

    /// Includes 0 on the axis.
    pub fn from_zero(mut self) -> Self {
        self.from_zero = true;
        self
    }

    /// Extends the axis this far in both directions.
    pub fn reaching(mut self, reach: f64) -> Self {
        self.reach = Some(reach);
        self
    }

    /// Adds another unit on the other side.
    pub fn with_second(mut self, label: impl Into<String>, factor: f64) -> Self {
        let label = label.into();
        self.second = Some(SecondUnit { label, factor });
        self
    }
}

/// Choice of the ends of a scale.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Ends {
    /// Round numbers, so that the first and the last tick are at the ends.
    Round,
    /// The least and the greatest value.
    Exact,
}

/// A range of values along a length.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Scale {
    low: f64,
    high: f64,
    spacing: Spacing,
    /// Value above which a scale from 0 becomes logarithmic.
    bend: f64,
    /// The values that are labelled, with their labels.
    pub(super) ticks: Vec<(f64, String)>,
}

/// A range that no unit of a machine resolves: values differ only by rounding.
const NOTHING: f64 = 1e-12;

/// Maximum number of ticks.
const MAX_TICKS: u32 = 60;

impl Scale {
    /// Returns a scale that holds all finite values, with about `wanted` ticks.
    pub(super) fn over(
        values: impl Iterator<Item = f64>,
        spacing: Spacing,
        ends: Ends,
        wanted: u32,
    ) -> Self {
        let (mut low, mut high, mut bend) = (f64::INFINITY, f64::NEG_INFINITY, f64::INFINITY);
        for value in values.filter(|value| value.is_finite()) {
            (low, high) = (low.min(value), high.max(value));
            if value > 0.0 {
                bend = bend.min(value);
            }
        }
        if low > high {
            (low, high) = (0.0, 1.0);
        }
        // Beyond this, differences of values are not finite any more.
        (low, high) = (low.max(-1e300), high.min(1e300));
        if spacing == Spacing::Logarithmic && low > 1e-300 {
            return Self::logarithmic(low, high);
        }
        if spacing == Spacing::LogarithmicFromZero && low >= 0.0 && bend > 1e-300 && bend < high {
            return Self::logarithmic_from_zero(bend, high);
        }
        if high - low <= (low.abs().max(high.abs()) * 1e-9).max(NOTHING) {
            let is_zero = low.abs() <= NOTHING;
            let room = if is_zero { 1.0 } else { low.abs() * 0.1 };
            (low, high) = (low - room, high + room);
        }
        let step = round_step((high - low) / f64::from(wanted.max(1)));
        if ends == Ends::Round {
            low = (low / step + 1e-9).floor() * step;
            high = (high / step - 1e-9).ceil() * step;
        }
        let first = (low / step - 1e-9).ceil() * step;
        let ticks = (0..MAX_TICKS)
            .map(|count| first + f64::from(count) * step)
            .take_while(|&value| value <= high + step * 1e-6)
            .map(|value| {
                if value.abs() < step * 1e-6 {
                    0.0
                } else {
                    value
                }
            })
            .map(|value| (value, label(value, step)))
            .collect();
        Self {
            low,
            high,
            spacing: Spacing::Linear,
            bend: 0.0,
            ticks,
        }
    }

    /// Creates a scale that is linear from 0 to `bend`, from there to `high` logarithmic.
    fn logarithmic_from_zero(bend: f64, high: f64) -> Self {
        let mut ticks = vec![(0.0, label(0.0, 1.0)), (bend, number(bend))];
        ticks.extend(decades(bend * 1.15, high));
        Self {
            low: 0.0,
            high,
            spacing: Spacing::LogarithmicFromZero,
            bend,
            ticks,
        }
    }

    /// Returns the same scale in another unit, with its own ticks.
    pub(super) fn in_unit(&self, factor: f64) -> Self {
        let values = [self.low, self.bend, self.high].map(|value| value * factor);
        let inner = values
            .into_iter()
            .filter(|value| *value > 0.0 || self.low <= 0.0);
        Self::over(inner, self.spacing, Ends::Exact, 9)
    }

    fn logarithmic(least: f64, greatest: f64) -> Self {
        let low = least / 1.15;
        let high = greatest * 1.15;
        let mut ticks = decades(low, high);
        if ticks.len() < 2 {
            // A range within a decade.
            ticks = Self::over([low, high].into_iter(), Spacing::Linear, Ends::Exact, 4).ticks;
        }
        Self {
            low,
            high,
            spacing: Spacing::Logarithmic,
            bend: 0.0,
            ticks,
        }
    }

    /// Returns the place of a value, 0 at the low end and 1 at the high end.
    pub(super) fn share(&self, value: f64) -> f64 {
        match self.spacing {
            Spacing::Linear => (value - self.low) / (self.high - self.low),
            Spacing::Logarithmic => (value / self.low).ln() / (self.high / self.low).ln(),
            Spacing::LogarithmicFromZero if value <= self.bend => LINEAR_PART * value / self.bend,
            Spacing::LogarithmicFromZero => {
                let part = (value / self.bend).ln() / (self.high / self.bend).ln();
                LINEAR_PART + (1.0 - LINEAR_PART) * part
            }
        }
    }

    /// Returns whether a value lies strictly between the ends.
    pub(super) fn holds(&self, value: f64) -> bool {
        self.low < value && value < self.high
    }
}

/// The linear part of a scale from 0.
const LINEAR_PART: f64 = 0.14;

/// Returns round values from `low` to `high` on a logarithmic scale.
fn decades(low: f64, high: f64) -> Vec<(f64, String)> {
    let decades = high.log10() - low.log10();
    let factors: &[f64] = if decades < 0.8 {
        &[1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 7.0]
    } else if decades < 3.5 {
        &[1.0, 2.0, 5.0]
    } else {
        &[1.0]
    };
    let skip = (decades / 12.0).ceil().max(1.0);
    let first = low.log10().floor();
    (0..MAX_TICKS)
        .map(|count| 10_f64.powf(first + f64::from(count) * skip))
        .take_while(|&decade| decade <= high)
        .flat_map(|decade| factors.iter().map(move |factor| decade * factor))
        .filter(|value| (low..=high).contains(value))
        .map(|value| (value, label(value, value)))
        .collect()
}

/// Returns the next greater of 1, 2 and 5 times a power of ten.
pub(super) fn round_step(least: f64) -> f64 {
    let power = 10_f64.powf(least.max(1e-300).log10().floor());
    let mantissa = least / power;
    let round = [1.0, 2.0, 5.0]
        .into_iter()
        .find(|round| mantissa <= round * (1.0 + 1e-9))
        .unwrap_or(10.0);
    round * power
}

/// Returns a number alone, with all its decimals, six at most.
pub(crate) fn number(value: f64) -> String {
    label(value, value)
}

/// Returns a value as text, with as many decimals as the step between ticks needs.
pub(super) fn label(value: f64, step: f64) -> String {
    if value.abs() >= 1e7 || (step < 1e-5 && value != 0.0) {
        let text = format!("{value:.2e}");
        let (mantissa, power) = text.split_once('e').unwrap_or((&text, "0"));
        let mantissa = mantissa.trim_end_matches('0').trim_end_matches('.');
        return format!("{mantissa}e{power}").replace('-', "\u{2212}");
    }
    let decimals = (0..6_i32)
        .position(|decimals| {
            let scaled = step * 10_f64.powi(decimals);
            (scaled - scaled.round()).abs() < 1e-6 * scaled
        })
        .unwrap_or(6);
    let text = format!("{:.decimals$}", value.abs());
    let (whole, fraction) = text.split_once('.').unwrap_or((&text, ""));
    let mut shown = String::new();
    if value < 0.0 {
        shown.push('\u{2212}');
    }
    for (at, digit) in whole.chars().enumerate() {
        let left = whole.len() - at;
        if at > 0 && left.is_multiple_of(3) && whole.len() > 4 {
            shown.push('\u{202f}');
        }
        shown.push(digit);
    }
    if !fraction.is_empty() {
        shown.push('.');
        shown.push_str(fraction);
    }
    shown
}

#[cfg(test)]
mod tests {
    use super::*;

    fn labels(values: &[f64], spacing: Spacing) -> Vec<String> {
        let scale = Scale::over(values.iter().copied(), spacing, Ends::Round, 5);
        scale.ticks.into_iter().map(|(_, label)| label).collect()
    }

    #[test]
    fn ticks_are_round() {
        assert_eq!(
            labels(&[0.0, 16.0], Spacing::Linear),
            ["0", "5", "10", "15", "20"]
        );
        assert_eq!(
            labels(&[-0.13, 0.42], Spacing::Linear),
            ["−0.2", "0.0", "0.2", "0.4", "0.6"]
        );
        assert_eq!(
            labels(&[500.0, 5000.0], Spacing::Logarithmic),
            ["500", "1000", "2000", "5000"]
        );
        assert_eq!(labels(&[0.0, 40000.0], Spacing::Linear)[4], "40\u{202f}000");
    }

    #[test]
    fn a_scale_from_zero_shows_the_slow_values() {
        let values = [0.0, 100.0, 200.0, 100_000.0];
        let scale = Scale::over(
            values.into_iter(),
            Spacing::LogarithmicFromZero,
            Ends::Exact,
            9,
        );
        let places = [0.0, 50.0, 100.0, 100_000.0].map(|value| scale.share(value));
        assert!((places[1] - LINEAR_PART / 2.0).abs() < 1e-12);
        assert!((places[2] - LINEAR_PART).abs() < 1e-12);
        assert!((places[3] - 1.0).abs() < 1e-12 && places[0] == 0.0);
        assert!(places.is_sorted());
        let minutes = scale.in_unit(0.06);
        assert!((minutes.share(6.0) - scale.share(100.0)).abs() < 1e-12);
        assert!((minutes.share(600.0) - scale.share(10_000.0)).abs() < 1e-12);
        assert_eq!(minutes.ticks[0].1, "0");
    }

    #[test]
    fn rounding_has_no_scale_of_its_own() {
        // R18.25
        let values = [-1e-30, 0.0, 2e-17].into_iter();
        let scale = Scale::over(values, Spacing::Linear, Ends::Round, 5);
        let labels: Vec<&str> = scale
            .ticks
            .iter()
            .map(|(_, label)| label.as_str())
            .collect();
        assert_eq!(labels.first(), Some(&"−1.0"), "{labels:?}");
    }

    #[test]
    fn odd_ranges_have_a_scale() {
        for values in [
            &[][..],
            &[0.0],
            &[7.0, 7.0],
            &[f64::NAN, f64::INFINITY],
            &[1e-320, 2e-320],
            &[-1e308, 1e308],
            &[1.0, 1.0 + 1e-15],
            &[-3e12, -2.9e12],
        ] {
            for spacing in [
                Spacing::Linear,
                Spacing::Logarithmic,
                Spacing::LogarithmicFromZero,
            ] {
                let scale = Scale::over(values.iter().copied(), spacing, Ends::Round, 5);
                let count = scale.ticks.len();
                assert!((1..=60).contains(&count), "{values:?} has {count} ticks");
                assert!(
                    scale
                        .ticks
                        .iter()
                        .all(|(at, _)| scale.share(*at).is_finite())
                );
            }
        }
    }
}
