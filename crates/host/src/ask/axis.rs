//! The axis that questions are about.

use frictcomp::comp::CncBuild;

/// The axis under test.
#[derive(Debug, Clone)]
pub struct AskedAxis {
    /// Its name.
    pub name: String,
    /// Its logical number, P-AXIS-00016; without it axis exchange is not asked.
    pub number: Option<u32>,
    /// Its place among the axes of the channel, from 0.
    pub index: usize,
    /// The build of the control.
    pub build: Option<CncBuild>,
    /// Permitted travel in mm or degrees, from the present position in the positive direction and
    /// back.
    pub travel: f64,
}
