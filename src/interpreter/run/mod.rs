//! What a run consists of, as data, and what it tells.

pub(super) mod at;
pub(super) mod channel_axes;
pub(super) mod condition;
pub(super) mod control;
pub(super) mod coupling;
pub(super) mod cycles;
pub(super) mod description;
pub(super) mod event;
pub(super) mod hash_parts;
pub(super) mod intent;
pub(super) mod interpreter;
pub(super) mod journal;
pub(super) mod limits;
pub(super) mod options;
pub(super) mod path;
pub(super) mod possible;
pub(super) mod possible_state;
pub(super) mod region;
pub(super) mod stack;
pub(super) mod state;
pub(super) mod step;
pub(super) mod stopping;
pub(super) mod undecided;
pub(super) mod way_set;
pub(super) mod ways;
pub(super) mod work;
