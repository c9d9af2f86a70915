//! The units of lists and traces: those of P-COMP-00043 and P-COMP-00046.

/// Units of position, 0.1 µm or 0.0001°, per millimetre or degree.
pub const POSITION_UNITS_PER_MM: f64 = 10_000.0;

/// Units of velocity, µm/s or 0.001°/s, per millimetre or degree per second.
pub const VELOCITY_UNITS_PER_MM_PER_S: f64 = 1000.0;
