//! Why a recording of a commissioning is not used.

use thiserror::Error;

use crate::error::HostError;
use frictcomp_recordings::commission::NotFollowed;
use frictcomp_recordings::identify::{IdentifyError, TraceFinding};

/// Why a recording of a commissioning is not used: one sentence in lower case.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum UnusedRecording {
    /// It cannot be read, or lacks channels.
    #[error(transparent)]
    Host(#[from] HostError),
    /// No friction is found in it.
    #[error("{error}")]
    Friction {
        /// The reason.
        error: IdentifyError,
        /// Findings about its channels.
        findings: Vec<TraceFinding>,
    },
    /// Its axis does not follow its commands, or the following error is missing.
    #[error(transparent)]
    NotFollowed(#[from] NotFollowed),
    /// A motor of a gantry, with the reason.
    #[error("{motor}: {reason}")]
    Motor {
        /// Name of the motor.
        motor: String,
        /// The reason.
        reason: Box<UnusedRecording>,
    },
    /// The torque of the other motors of a gantry has no channels of their own.
    #[error("their torque is not read")]
    NoTorques,
    /// A motor of a gantry that was recorded at other times than the first one.
    #[error("that of {motor} has other samples than that of {axis}")]
    OtherSamples {
        /// Name of the motor.
        motor: String,
        /// Name of the first one.
        axis: String,
    },
    /// Its program moves an axis that the plan does not have.
    #[error("its axis is not in the plan")]
    NoAxis,
    /// A number that belongs to no program.
    #[error("it carries the number {0}, which no plan in this folder has")]
    NoProgram(u16),
    /// No signature, and its program is not named.
    #[error("it has no signature")]
    NoSignature {
        /// Name of the file.
        file: String,
    },
    /// Strokes of another program than the one that is named.
    #[error("its strokes give the number {found}, but it is said to be {said}")]
    OtherProgram {
        /// The number of its strokes.
        found: u16,
        /// The number that is given.
        said: u16,
    },
    /// Several programs in one recording.
    #[error("it holds several programs, {}: record each alone", numbers(.0))]
    Several(Vec<u16>),
    /// The channels of two axes are exchanged.
    #[error(
        "the strokes at its start are not those of `{0}`: the channels of two axes are swapped"
    )]
    Swapped(String),
}

fn numbers(numbers: &[u16]) -> String {
    let numbers: Vec<String> = numbers.iter().map(u16::to_string).collect();
    numbers.join(", ")
}
