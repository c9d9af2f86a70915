//! The values of programs: values, names, memory, expressions.

pub(super) mod expression;
pub(super) mod externals;
pub(super) mod handover;
pub(super) mod location;
pub(super) mod memory;
pub(super) mod names;
pub(super) mod persistent;
pub(super) mod plain;
pub(super) mod rows;
pub(super) mod value;
pub(super) mod work_budget;
