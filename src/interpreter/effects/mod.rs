//! What a part of a block does to the run, and what it makes unknown.

pub(super) mod called_words;
pub(super) mod couple;
pub(super) mod descriptions;
pub(super) mod evaluate;
pub(super) mod exchange;
pub(super) mod external;
pub(super) mod havoc;
pub(super) mod machine_data;
pub(super) mod roots;
