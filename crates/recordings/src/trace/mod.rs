//! Recorded traces: the texts that Scope, the trace of a control and spreadsheets write, as channels.
//!
//! Nothing here opens a file: bytes go in piece by piece ([`TraceReader`]), a [`TraceRecording`] comes out.
//! Only the requested channels are kept, each with the times at which it was sampled.

mod align;
mod cell;
mod channel;
mod choice;
mod clock;
mod columns;
mod csv;
mod error;
mod head;
mod held;
mod plain;
mod reader;
mod recognised;
mod recording;
mod scope;
mod select;
mod summary;
mod table;
mod unit;
mod wide;
mod xml;

pub use align::{Aligned, NotAligned};
pub use channel::{Channel, ChannelIndex, CncObject, Contains, ScopeDrawing};
pub use choice::{Choice, TimeSource};
pub use clock::Clock;
pub use error::{SelectError, TraceProblem};
pub use reader::TraceReader;
pub use recognised::{ChannelRole, RecognisedChannel};
pub use recording::{Layout, Missing, TraceRecording};
pub use select::{ChannelSelection, Pick};
pub use summary::ChannelSummary;
pub use unit::{AxisMotion, ChannelQuantity, Unit};
