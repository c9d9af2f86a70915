//! The files that work leaves.

use frictcomp_host::OutputFiles;

use crate::failure::Failure;
use crate::work::Stop;

/// Puts all files in place, or none if the work was cancelled.
pub(crate) fn place(outputs: OutputFiles, stop: &Stop) -> Result<(), Failure> {
    stop.refuse()?;
    Ok(outputs.finish(|_| ())?)
}
