//! The control's ASCII lists: their lines, their contents, and the control's checks.

mod axis;
mod channel_settings;
mod check;
mod friction;
#[cfg_attr(not(feature = "unstable"), allow(unreachable_pub))]
mod keywords;
mod kind;
mod line;
mod parameter;
mod project;
mod startup;

pub use axis::AxisValues;
pub use axis::Monitor;
pub(crate) use axis::{AXIS_NAME_HELP, is_axis_name};
pub use axis::{DynamicsDraft, ListedDynamics};
pub use channel_settings::{ChannelDraft, ChannelSettings, ChannelSwitch, FeedUnit, SlopeProfile};
pub use check::{Conditions, FrictionReading, Verdict};
pub use friction::{
    DEFAULT_MAX_POINTS, Field, FrictionDraft, FrictionList, ListHead, NoValues, Points, ReadList,
    TablePoint, WrittenPoint, write_value_list,
};
pub use keywords::ChannelKey;
#[cfg(feature = "unstable")]
pub use keywords::{KnownKey, known_keys};
pub use kind::ListKind;
pub use line::Entries;
pub use line::{Entry, Given, Number, Written};
pub use parameter::{AxisType, Origin, Parameter, UnknownAxisType};
pub use project::is_xml;
pub(crate) use project::{NoProject, Project, ProjectList, ProjectReference};
pub(crate) use startup::AxisPlacement;
pub use startup::{ChannelAxis, ChannelList, NamedList, StartupList};
pub use startup::{ChannelPrograms, ProgramRole};
