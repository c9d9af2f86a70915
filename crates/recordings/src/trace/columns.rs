//! The meaning of the columns of a table.

use super::cell::Separator;
use super::channel::Channel;
use super::recording::Layout;

/// A line of a file without its end.
#[derive(Debug, Clone)]
pub(super) struct FileLine {
    pub(super) number: u64,
    pub(super) bytes: Vec<u8>,
}

/// Form of the times.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum TimeScale {
    /// Times of Scope: ms from the first point, or FILETIME, 100 ns since the year 1601.
    Scope,
    /// Times in a unit of the given length in seconds.
    Seconds(f64),
}

/// Columns that share a column of times.
#[derive(Debug, Clone, Copy)]
pub(super) struct ColumnGroup {
    /// The column of the times, if there is one.
    pub(super) time: Option<usize>,
    pub(super) scale: TimeScale,
}

/// A channel with its place.
#[derive(Debug, Clone)]
pub(super) struct ChannelColumn {
    pub(super) channel: Channel,
    pub(super) at: usize,
    pub(super) group: usize,
}

/// Meaning of the columns of a table.
#[derive(Debug, Clone)]
pub(super) struct TableColumns {
    pub(super) layout: Layout,
    pub(super) separator: Separator,
    /// Number of cells of a row.
    pub(super) count: usize,
    pub(super) described: Vec<ChannelColumn>,
    pub(super) groups: Vec<ColumnGroup>,
    /// Remark on the assumptions about them.
    pub(super) remark: Option<&'static str>,
}
