//! The side of a hazard on which it is mended.

use serde::Serialize;

crate::words! {
    /// The programs to mend: the side of each hazard with fewer programs (R10.3).
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
    #[serde(rename_all = "lowercase")]
    #[non_exhaustive]
    pub enum Cure {
        /// There is no hazard.
        None = "none",
        /// Those that leave the axis away from its start-up state; mended by a command before the
        /// end.
        Leavers = "leavers",
        /// Those that inherit it; mended by a command before the first motion.
        Inheritors = "inheritors",
    }
}

/// A subject to mend in a program.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct Mending {
    /// The position of the axis and kind in [`ProgramAudit::axes`](super::ProgramAudit::axes).
    pub at: usize,
    /// Side of the hazards to mend: [`Cure::Leavers`] or [`Cure::Inheritors`].
    pub cure: Cure,
}
