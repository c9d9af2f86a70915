//! The chain of coordinates: what separates positions from those of the machine (R2.47, R2.82).

/// Effect of a command or function on positions.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) enum ChainStep {
    /// It switches to other coordinates, and back.
    Coordinates,
    /// It chooses the kinematics of a transformation, which others switch on (R1.42).
    Kinematics,
    /// It switches all offsets off, and on again (PM/208517515).
    Machine,
    /// It leaves the programmed points as they are and the path to them open (PM/207256971).
    Path,
    /// It moves the origin, by the machine's own values or for one block.
    Origin,
}

/// Direction in which a command or function switches.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) enum OnOff {
    On,
    Off,
}
