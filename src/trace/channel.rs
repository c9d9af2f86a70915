//! What is known of a channel before its first sample.

use std::fmt;

/// The number of a channel in its recording, in the order of the file.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct ChannelIndex(pub(super) usize);

impl ChannelIndex {
    /// As an index of [`TraceRecording::channels`](super::TraceRecording::channels).
    pub fn get(self) -> usize {
        self.0
    }
}

/// A recorded signal.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Channel {
    /// Its name in the file; without a header `column 1` and so on.
    pub name: String,
    /// The comment or the description that the file gives.
    pub comment: String,
    /// The symbol or path of the variable, where the file names it.
    pub symbol: String,
    /// The unit as the file writes it.
    pub unit: Option<String>,
    /// Which object of the CNC was recorded.
    pub object: Option<CncObject>,
    /// The time between two samples that the file announces.
    pub sample_time_s: Option<f64>,
    /// Scope draws the channel with a factor or an offset, which its values do not contain.
    pub is_drawn_scaled: bool,
}

/// An object of the CNC as ADS addresses it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct CncObject {
    /// The index group: which part of the control.
    pub group: u32,
    /// The index offset, `0x<axis>nnnn`.
    pub offset: u32,
}

impl CncObject {
    /// The number of the axis, 0 for an object of no axis.
    pub fn axis(self) -> u32 {
        self.offset >> 16
    }

    /// The number of the object below its axis.
    pub fn element(self) -> u32 {
        self.offset & 0xffff
    }
}

impl fmt::Display for CncObject {
    /// `0x120300:0x501D3`.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "0x{:X}:0x{:X}", self.group, self.offset)
    }
}

/// A whole number as headers write it, `1180416` or `0x120300`.
pub(super) fn parse_address(text: &str) -> Option<u32> {
    let text = text.trim();
    match text.strip_prefix("0x").or_else(|| text.strip_prefix("0X")) {
        Some(digits) => u32::from_str_radix(digits, 16).ok(),
        None => text.parse().ok(),
    }
}
