//! Two versions of a program, compared by their switches.
//!
//! A [`Version`] takes the records of a session that runs one version; a [`VersionComparison`] lists
//! the blocks that switch in one version and not in the other, and the obstacles to a comparison of
//! the whole versions. Lines that only moved make no difference. A [`ContourComparison`] shows where
//! the contour of the new version deviates more.
//!
//! ```
//! use frictcomp::comp::{Kind, KindSet};
//! use frictcomp_physics::compare::{Agreement, Version, VersionComparison};
//! use frictcomp::{machine::Machine, text::SourceFile};
//!
//! let version = |text: &str| {
//!     let mut version = Version::new(KindSet::of(Kind::Frict));
//!     frictcomp::run(SourceFile::new("a.nc", text), Machine::enabled(["X"]), &mut version);
//!     version
//! };
//! let (old, new) = (version("N10 M30"), version("N5 X[COMP OFF FRICT]\nN10 M30"));
//! let comparison = VersionComparison::new(old, new);
//! assert_eq!(comparison.agreement(), Agreement::Different);
//! let (_, switch) = comparison.differences().next().expect("the new block");
//! assert_eq!(switch.to_string(), "X FRICT: active → inactive");
//! ```

mod alignment;
mod comparison;
mod contour;
mod moves;
mod obstacle;
mod switch;
mod version;

pub use comparison::{Agreement, ChangedEnd, PairedSwitch, VersionComparison, Which};
pub use contour::{BlockChange, ContourAgreement, ContourComparison, VersionContour};
pub use moves::ChangedMoves;
pub use obstacle::{Obstacle, Reason};
pub use switch::Switch;
pub use version::Version;
