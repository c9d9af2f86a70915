//! The values of programs: values, names, memory, expressions.

pub(super) mod carried;
pub(super) mod cause;
pub(super) mod expression;
pub(super) mod externals;
pub(super) mod found;
pub(super) mod functions;
pub(super) mod handover;
pub(super) mod held;
pub(super) mod location;
pub(super) mod memory;
pub(super) mod names;
pub(super) mod parameter_values;
pub(super) mod persistent;
pub(super) mod plain;
pub(super) mod reads;
pub(super) mod rows;
pub(super) mod shared;
pub(super) mod value;
pub(super) mod value_type;
pub(super) mod work_budget;
