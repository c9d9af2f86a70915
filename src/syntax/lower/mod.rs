//! pest pairs to blocks.

mod arguments;
mod block;
mod bracket;
mod call;
mod declaration;
mod flow;
mod hash;
mod lowering;
mod part;
mod word;

pub(super) use block::block;
#[cfg(test)]
pub(super) use block::{block_as, read_as};
