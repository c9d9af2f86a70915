//! Options in groups, and the values that they take.

mod channels;
mod control;
mod examples;
mod execution;
mod fail_on;
mod folders;
mod groups;
mod listing;
mod machine;
mod mend;
mod named_lists;
mod per_axis;
pub(crate) mod quantities;
pub(crate) mod settings;
mod simulated;
mod sole_file;
mod start;
pub(crate) mod values;
mod wildcards;

pub(crate) use channels::{
    AxisChannelArgs, CircleChannelArgs, FollowedChannels, MotionChannels, TorqueArgs,
    TorqueChannel, TorqueKindArgs, UnitArgs, named, parse_time_unit, refuse_alike,
};
pub(crate) use control::{CncBuildArgs, CurrentReadingArgs, CycleArgs, ToolArgs};
pub(crate) use examples::with_examples;
pub(crate) use execution::ExecutionArgs;
pub(crate) use fail_on::{FailOn, FailOnArgs, SeverityArgs, of_axis};
pub(crate) use folders::{FolderArgs, say_left_out};
pub(crate) use groups::in_groups;
pub(crate) use listing::{Lister, ListingArgs, Uncompensated, explain, passed_over, total};
pub(crate) use machine::{MachineArgs, remark, undescribed_remark, value_list};
pub(crate) use mend::{FixArgs, MendRun, differences};
pub(crate) use named_lists::NamedLists;
pub(crate) use per_axis::{ByAxis, PerAxis};
pub(crate) use settings::parse_width;
pub(crate) use simulated::{ModelArgs, PlantArgs, SimulationArgs, Tolerance};
pub(crate) use sole_file::Meant;
pub(crate) use start::StartArgs;
pub(crate) use wildcards::expanded;
