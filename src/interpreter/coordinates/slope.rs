//! The profile of the acceleration that a program selects (R11.20).
//!
//! PM/n is page n of the TF5200 programming manual, HSC/n one of the HSC package.

use crate::language::SlopeForm;
use crate::lists::SlopeProfile;
use crate::syntax::ast::{Argument, BracketArguments};

/// A selection of the profile.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum SlopeSelection {
    /// The profile of the channel list, as at the start of a program.
    Channel,
    /// A profile that the command names.
    Program(SlopeProfile),
    /// An unknown profile, or one whose use of the jerk is optimized (`NO_OPT=0`).
    Unknown,
}

/// The profiles that `TYPE` names.
const PROFILES: [(&str, SlopeProfile); 4] = [
    ("STEP", SlopeProfile::Step),
    ("TRAPEZ", SlopeProfile::Trapez),
    ("SIN2", SlopeProfile::Sin2),
    ("HSC", SlopeProfile::Hsc),
];

impl SlopeSelection {
    /// The selection of a command; `None` where its bracket names no profile.
    pub(crate) fn of(
        form: SlopeForm,
        (arguments, text): (&BracketArguments, &str),
        mut number: impl FnMut(&Argument) -> Option<f64>,
    ) -> Option<Self> {
        let profile = match form {
            SlopeForm::Channel => return Some(Self::Channel),
            SlopeForm::Named => {
                let named = arguments.after("TYPE", text)?.span.of(text);
                let named = PROFILES
                    .iter()
                    .find(|(name, _)| name.eq_ignore_ascii_case(named));
                named.map(|(_, profile)| *profile)
            }
            SlopeForm::Numbered => {
                let first = arguments.iter().next()?;
                number(first).and_then(SlopeProfile::numbered)
            }
        };
        let optimized = arguments.after("NO_OPT", text).map(&mut number);
        let is_plain = optimized.is_none_or(|given| given == Some(1.0));
        let known = profile.filter(|_| is_plain);
        Some(known.map_or(Self::Unknown, Self::Program))
    }
}

/// The value of an argument that is a plain number.
#[cfg(test)]
pub(super) fn plain_number(argument: &Argument) -> Option<f64> {
    match argument.value? {
        crate::syntax::ast::Operand::Number(number) => Some(number),
        crate::syntax::ast::Operand::Expression(_) => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::language::HashAction;
    use crate::syntax::ast::Item;
    use crate::syntax::parse_block;

    #[test]
    fn commands_select_a_profile() {
        // R11.20
        let of = |text: &str| {
            let block = parse_block(text);
            let [Item::Hash(hash)] = block.items.as_slice() else {
                panic!("{text}")
            };
            let HashAction::SelectSlope(form) = hash.command.action else {
                panic!("{text}")
            };
            SlopeSelection::of(form, (&hash.brackets, text), plain_number)
        };
        let program = |profile| Some(SlopeSelection::Program(profile));
        let unknown = Some(SlopeSelection::Unknown);
        assert_eq!(of("#SLOPE [TYPE=SIN2]"), program(SlopeProfile::Sin2));
        assert_eq!(
            of("#SLOPE [ type = hsc NO_OPT=1 ]"),
            program(SlopeProfile::Hsc)
        );
        assert_eq!(of("#SLOPE [TYPE=STEP NO_OPT=0]"), unknown);
        assert_eq!(of("#SLOPE [TYPE=ROUND]"), unknown);
        assert_eq!(of("#SLOPE []"), None);
        assert_eq!(of("#SLOPE DEFAULT"), Some(SlopeSelection::Channel));
        assert_eq!(of("#SET SLOPE PROFIL [1]"), program(SlopeProfile::Trapez));
        assert_eq!(of("#SET SLOPE PROFIL [0, 2]"), program(SlopeProfile::Step));
        assert_eq!(of("#SET SLOPE PROFIL [V.E.A]"), unknown);
    }
}
