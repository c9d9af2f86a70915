//! Where ways part: questions to the machine, errors that end some ways, states that only the machine knows, and the
//! blocks that are passed over because no way can execute them.

pub(super) mod branching;
pub(super) mod leaving;
pub(super) mod passing;
pub(super) mod search;
pub(super) mod stops;
