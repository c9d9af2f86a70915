//! The words of the language as tables: what each command and function is, and what it does (R2.45, R2.70).
//!
//! `hash` has a row for each `#` command, `g` for each G function, `bracket` for each command in the bracket of an axis,
//! `refusal` for each error that a program causes, `system_variable` for each variable that it may only read.
//! Everything else asks the columns of a row: a command or function is described in one place.

#![cfg_attr(not(feature = "unstable"), allow(unreachable_pub))]

/// Columns of a table: each sets the value of a row, with the arguments that a row gives it.
macro_rules! columns {
    ($($column:ident($($argument:ident: $type:ty),+) = $value:expr;)+) => {
        $(const fn $column(self, $($argument: $type),+) -> Self {
            Self { $column: $value, ..self }
        })+
    };
}
use columns;

mod bracket;
mod g;
mod hash;
mod motion;
mod refusal;
mod state;
mod system_variable;

pub(crate) use bracket::AxisAction;
pub use bracket::AxisCommand;
pub use g::Group;
pub(crate) use g::{BlockGroup, CoordinateEffect, GAction, GFunction, GroupSet};
pub use hash::BlockSharing;
pub(crate) use hash::{
    ConfigAction, ContouringCommand, Described, Exchange, FileAction, Flushes, FurtherWord,
    HashAction, HashArguments, HashCommand, HashWords, MembersBy, PathFlow, Plc, SlopeForm,
    Touches, is_command,
};
pub(crate) use motion::Holds;
pub(crate) use motion::{AxisWords, ChainStep, MotionEffect, Moves, OnOff};
pub use motion::{Certainty, MotionKind};
pub use motion::{Simplification, Simplifications};
pub use refusal::{ControlError, ControlErrorCheck};
pub(crate) use state::{ChannelState, Mode, Modes, RefusedIn};
pub(crate) use system_variable::is_read_only;
