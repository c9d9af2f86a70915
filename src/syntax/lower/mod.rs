//! pest pairs to blocks.

mod block;
mod flow;
mod hash;
mod word;

pub(super) use block::block;
#[cfg(test)]
pub(super) use block::{block_as, read_as};
