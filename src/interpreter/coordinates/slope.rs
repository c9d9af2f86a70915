//! The profile of the acceleration that a program selects (R11.20).
//!
//! PM/n is page n of the TF5200 programming manual, HSC/n one of the HSC package.

use super::contouring::value_after;
use crate::machine::SlopeProfile;

/// A selection of the profile.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::interpreter) enum SlopeSelection {
    /// The profile of the channel list, as at the start of a program.
    Channel,
    /// A profile that the command names.
    Program(SlopeProfile),
    /// An unknown profile, or one whose use of the jerk is optimized (`NO_OPT=0`).
    Unknown,
}

impl SlopeSelection {
    /// The selection of `#SLOPE [TYPE=SIN2]`, `#SLOPE DEFAULT` (PM/207190411) or the older
    /// `#SET SLOPE PROFIL [2]` (HSC/15427921547); `None` for another command.
    pub(in crate::interpreter) fn of(
        name: &str,
        bracket: &str,
        mut number: impl FnMut(&str) -> Option<f64>,
    ) -> Option<Self> {
        let upper = bracket.to_ascii_uppercase();
        let profile = match name {
            "#SLOPE DEFAULT" => return Some(Self::Channel),
            "#SLOPE" => match value_after("TYPE", &upper, &upper)? {
                "STEP" => Some(SlopeProfile::Step),
                "TRAPEZ" => Some(SlopeProfile::Trapez),
                "SIN2" => Some(SlopeProfile::Sin2),
                "HSC" => Some(SlopeProfile::Hsc),
                _ => None,
            },
            "#SET SLOPE PROFIL" => {
                let first = bracket.trim_matches(['[', ']']).split(',').next()?;
                number(first.trim()).and_then(SlopeProfile::numbered)
            }
            _ => return None,
        };
        let optimized = value_after("NO_OPT", bracket, &upper).map(&mut number);
        let is_plain = optimized.is_none_or(|given| given == Some(1.0));
        let known = profile.filter(|_| is_plain);
        Some(known.map_or(Self::Unknown, Self::Program))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn commands_select_a_profile() {
        // R11.20
        let of =
            |name, bracket| SlopeSelection::of(name, bracket, |value: &str| value.parse().ok());
        let program = |profile| Some(SlopeSelection::Program(profile));
        assert_eq!(of("#SLOPE", "[TYPE=SIN2]"), program(SlopeProfile::Sin2));
        assert_eq!(
            of("#SLOPE", "[ type = hsc NO_OPT=1 ]"),
            program(SlopeProfile::Hsc)
        );
        assert_eq!(
            of("#SLOPE", "[TYPE=STEP NO_OPT=0]"),
            Some(SlopeSelection::Unknown)
        );
        assert_eq!(of("#SLOPE", "[TYPE=ROUND]"), Some(SlopeSelection::Unknown));
        assert_eq!(of("#SLOPE", "[]"), None);
        assert_eq!(of("#SLOPE DEFAULT", ""), Some(SlopeSelection::Channel));
        assert_eq!(
            of("#SET SLOPE PROFIL", "[1]"),
            program(SlopeProfile::Trapez)
        );
        assert_eq!(
            of("#SET SLOPE PROFIL", "[0, 2]"),
            program(SlopeProfile::Step)
        );
        assert_eq!(
            of("#SET SLOPE PROFIL", "[V.E.A]"),
            Some(SlopeSelection::Unknown)
        );
        assert_eq!(of("#HSC ON", ""), None);
    }
}
