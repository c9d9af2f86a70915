//! The control's ASCII lists: their lines, their contents, and the control's checks.

mod axis;
mod channel_keys;
mod channel_settings;
mod check;
mod dynamics;
mod entry;
mod friction;
#[cfg_attr(not(feature = "unstable"), allow(unreachable_pub))]
mod keywords;
mod kind;
mod line;
mod monitor;
mod parameter;
mod program;
mod project;
mod startup;

pub use axis::AxisValues;
pub(crate) use axis::{AXIS_NAME_HELP, is_axis_name};
pub use channel_keys::ChannelKey;
pub use channel_settings::{ChannelDraft, ChannelSettings, ChannelSwitch, FeedUnit, SlopeProfile};
pub use check::{Conditions, FrictionReading, Verdict};
pub use dynamics::{DynamicsDraft, ListedDynamics};
pub use entry::{Entry, Given, Number, Written};
pub use friction::{
    DEFAULT_MAX_POINTS, Field, FrictionDraft, FrictionList, ListHead, NoValues, Points, ReadList,
    TablePoint, WrittenPoint, write_value_list,
};
#[cfg(feature = "unstable")]
pub use keywords::{KnownKey, known_keys};
pub use kind::ListKind;
pub use line::Entries;
pub use monitor::Monitor;
pub use parameter::{AxisType, Origin, Parameter, UnknownAxisType};
pub use program::{ChannelPrograms, ProgramRole};
pub use project::is_xml;
pub(crate) use project::{NoProject, Project, ProjectList, ProjectReference};
pub(crate) use startup::AxisPlacement;
pub use startup::{ChannelAxis, ChannelList, NamedList, StartupList};
