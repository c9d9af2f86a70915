//! The effects of the words and statements of a block.

pub(super) mod call;
pub(super) mod carry;
pub(super) mod comp;
pub(super) mod declare;
pub(super) mod feed;
pub(super) mod flow;
pub(super) mod hash;
pub(super) mod implicit;
pub(super) mod items;
pub(super) mod macros;
pub(super) mod pace;
pub(super) mod parting;
pub(super) mod probing;
pub(super) mod refused;
mod reported;
pub(super) mod required;
pub(super) mod resolve;
pub(super) mod sequence;
pub(super) mod travel;
pub(super) mod waiting;
pub(super) mod words;
