//! The description of a channel before its first sample.

use std::fmt;

use super::unit::split_unit;

/// The number of a channel in its recording, in the order of the file.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct ChannelIndex(pub(super) usize);

impl ChannelIndex {
    /// Converts from an index of [`TraceRecording::channels`](super::TraceRecording::channels).
    pub(crate) fn new(index: usize) -> Self {
        Self(index)
    }

    /// Converts to an index of [`TraceRecording::channels`](super::TraceRecording::channels).
    pub fn get(self) -> usize {
        self.0
    }
}

/// A recorded signal.
#[derive(Debug, Clone, PartialEq, Default)]
#[non_exhaustive]
pub struct Channel {
    /// Name in the file; without a header `column 1` and so on.
    pub name: String,
    /// The comment or the description that the file gives.
    pub comment: String,
    /// The symbol or path of the variable, if the file names it.
    pub symbol: String,
    /// The unit as the file writes it.
    pub unit: Option<String>,
    /// Recorded object of the CNC.
    pub object: Option<CncObject>,
    /// The time between two samples according to the file.
    pub sample_time_s: Option<f64>,
    /// Scope draws the channel with a factor or an offset.
    pub is_drawn_scaled: bool,
    /// The factor and the offset, with the evidence whether the samples contain them.
    pub drawn: Option<ScopeDrawing>,
    /// `Unit ScaleFactor` and `Unit Offset` of Scope, if they are not 1 and 0.
    pub unit_scale: Option<[f64; 2]>,
}

impl Channel {
    /// Returns the unit that the file gives, in a row of units or in the name.
    pub fn named_unit(&self) -> Option<&str> {
        let unit = self.unit.as_deref();
        let unit = unit.or_else(|| split_unit(&self.name).1);
        unit.filter(|unit| !["", "-", "(None)", "None"].contains(&unit.trim()))
    }
}

/// Factor and offset with which Scope draws a channel.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct ScopeDrawing {
    /// `ScaleFactor`.
    pub factor: f64,
    /// `Offset`.
    pub offset: f64,
    /// Whether the variable is of a type without decimals.
    pub is_whole: bool,
    /// The least and the greatest drawn value, if the header has them.
    pub range: Option<[f64; 2]>,
}

/// Treatment of the factor and the offset of the drawing in the samples.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Contains {
    /// Factor and offset are in the samples.
    Scale,
    /// The samples are those of the variable.
    Raw,
    /// No evidence in the file.
    Open,
}

/// Minimum number of different values that show anything.
const TELLING: usize = 8;

#[allow(clippy::cast_possible_truncation)] // what a variable of the control holds
fn as_whole(value: f64) -> i64 {
    value as i64
}

impl ScopeDrawing {
    /// Returns the contents of the samples, if the range in the header or the type of the variable
    /// decides them (R6.23).
    pub fn contained_in(&self, samples: &[f64]) -> Contains {
        let finite = || samples.iter().copied().filter(|it| it.is_finite());
        let [least, most] = finite().fold([f64::MAX, f64::MIN], |[least, most], it| {
            [least.min(it), most.max(it)]
        });
        if least > most {
            return Contains::Open;
        }
        if let Some([low, high]) = self.range {
            let scaled = [least, most].map(|it| it * self.factor + self.offset);
            let scaled = [scaled[0].min(scaled[1]), scaled[0].max(scaled[1])];
            let near = |found: [f64; 2]| {
                let tolerance = 1e-6 * (high.abs() + low.abs());
                (found[0] - low).abs() <= tolerance && (found[1] - high).abs() <= tolerance
            };
            match (near([least, most]), near(scaled)) {
                (true, false) => return Contains::Scale,
                (false, true) => return Contains::Raw,
                _ => {}
            }
        }
        if !self.is_whole {
            return Contains::Open;
        }
        if finite().any(|it| it.fract() != 0.0) {
            return Contains::Scale;
        }
        // Both are whole: few values may lie on the coarser grid by chance, many do not.
        let mut values: Vec<i64> = finite().map(as_whole).collect();
        values.sort_unstable();
        values.dedup();
        let step = self.factor.abs();
        if values.len() < TELLING || (step - 1.0).abs() < 1e-9 {
            return Contains::Open;
        }
        let is_multiple = |it: f64| {
            let rest = ((it - self.offset) / self.factor).fract().abs();
            rest.min(1.0 - rest) < 1e-6
        };
        if step > 1.0 && finite().all(is_multiple) {
            return Contains::Scale;
        }
        Contains::Raw
    }
}

/// An object of the CNC as ADS addresses it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct CncObject {
    /// The index group: the part of the control.
    pub group: u32,
    /// The index offset, `0x<axis>nnnn`.
    pub offset: u32,
}

impl CncObject {
    /// Returns the number of the axis, 0 for an object without an axis.
    pub fn axis(self) -> u32 {
        self.offset >> 16
    }

    /// Returns the number of the object below its axis.
    pub fn element(self) -> u32 {
        self.offset & 0xffff
    }
}

impl fmt::Display for CncObject {
    /// Writes `0x120300:0x501D3`.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "0x{:X}:0x{:X}", self.group, self.offset)
    }
}

/// Returns a whole number as headers write it, `1180416` or `0x120300`.
pub(super) fn parse_address(text: &str) -> Option<u32> {
    let text = text.trim();
    match text.strip_prefix("0x").or_else(|| text.strip_prefix("0X")) {
        Some(digits) => u32::from_str_radix(digits, 16).ok(),
        None => text.parse().ok(),
    }
}
