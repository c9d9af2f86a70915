//! The figures of ISO 230-4 and the glitches at the crossings (R5.22, R5.24).

mod glitch;
mod path_figures;
mod quiet;
mod waveform;

pub use glitch::{AxisShape, Bulge, Glitch, PathShape};
pub(crate) use path_figures::Nominal;
pub use path_figures::{Figures, PathFigures, Paths};
pub use waveform::Waveform;
