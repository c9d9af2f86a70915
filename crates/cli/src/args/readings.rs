//! The option for what the documents of the current leave open.

use clap::Args;

use frictcomp_physics::current::Reading;

/// The readings of the additive current.
#[derive(Debug, Clone, Copy, Args)]
pub(crate) struct CurrentReadingArgs {
    /// How to read what the documents leave open: `standstill=zero,below=origin,delay=reversal`
    #[arg(
        long,
        value_name = "READING",
        default_value = "",
        hide_default_value = true
    )]
    pub(crate) reading: Reading,
}
