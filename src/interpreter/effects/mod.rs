//! The effects of parts of a block on the run, and the unknown state that they leave.

pub(super) mod called_words;
pub(super) mod couple;
pub(super) mod descriptions;
pub(super) mod evaluate;
pub(super) mod exchange;
pub(super) mod external;
pub(super) mod files;
pub(super) mod havoc;
pub(super) mod machine_data;
pub(super) mod plc;
pub(super) mod restart;
pub(super) mod roots;
pub(super) mod saved_config;
