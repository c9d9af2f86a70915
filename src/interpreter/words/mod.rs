//! Execution of the words of a block, by construct.

pub(super) mod assignment;
pub(super) mod calls;
mod channel;
pub(super) mod comp;
pub(super) mod exchange;
pub(super) mod flow;
pub(super) mod hash;
pub(super) mod havoc;
pub(super) mod implicit;
pub(super) mod items;
pub(super) mod letters;
pub(super) mod motion;
pub(super) mod parting;
pub(super) mod passing;
pub(super) mod questions;
pub(super) mod refusal;
pub(super) mod refused_words;
