//! From a programmed F to the velocity of the path: the unit, the main spindle, programmed overrides (R5.1), the profile of the
//! acceleration that a program selects (R11.20), and the modes in which no feed is in force (R2.110).
//!
//! PM/n is page n of the TF5200 programming manual, HSC/n one of the HSC package.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use crate::comp::AxisIndex;
use crate::language::SlopeForm;
use crate::lists::SlopeProfile;
use crate::syntax::ast::{Argument, BracketArguments};

/// A programmed F.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct ProgrammedFeed {
    /// The number after F.
    pub value: f64,
    /// The unit of lengths in mm that was in force, where that is known.
    pub unit_mm: Option<f64>,
}

/// Effect of a command on the speed of paths, as shares of the programmed one; `None` where it is not
/// known.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub(crate) struct Factors {
    /// With G01, G02, G03.
    pub(crate) feed: Option<f64>,
    /// With G00.
    pub(crate) rapid: Option<f64>,
}

impl Default for Factors {
    fn default() -> Self {
        Self {
            feed: Some(1.0),
            rapid: Some(1.0),
        }
    }
}

/// Whether a motion is a rapid one.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Haste {
    /// G00.
    Rapid,
    /// G01, G02, G03.
    Feed,
}

impl Factors {
    fn of(self, haste: Haste) -> Option<f64> {
        match haste {
            Haste::Rapid => self.rapid,
            Haste::Feed => self.feed,
        }
    }
}

/// Programmed overrides.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
struct Overrides {
    /// `#OVERRIDE` (PM/207625099).
    path: Factors,
    /// `X[OVERRIDE …]`, by axis (PM/208662411).
    axes: BTreeMap<usize, Factors>,
    /// G129 (PM/206578955).
    rapid: Factors,
}

/// Speed of the main spindle (PM/208046347).
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
struct Spindle {
    /// The last S in 1/min, where it is known.
    speed_per_min: Option<f64>,
    /// G96: S is a cutting speed, and the spindle follows the diameter.
    cuts: bool,
    /// M5 or M19 stopped it.
    stands: bool,
}

/// State that turns a programmed F into the velocity of the path.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct Pace {
    /// The unit of F in mm/min (P-CHAN-00108), where it is known.
    feed_unit_mm: Option<f64>,
    spindle: Spindle,
    /// Overrides, where there are any or may be.
    overrides: Option<Box<Overrides>>,
}

impl Pace {
    pub(crate) fn new(feed_unit_mm: Option<f64>) -> Self {
        Self {
            feed_unit_mm,
            spindle: Spindle::default(),
            overrides: None,
        }
    }

    /// The unit of an F word with G94 where lengths are in `length_mm`. G70 makes it inch/min; its
    /// effect on m/min is not documented.
    pub(crate) fn unit_per_min(&self, length_mm: Option<f64>) -> Option<f64> {
        let (unit, length) = (self.feed_unit_mm?, length_mm?);
        #[allow(clippy::float_cmp)] // both are constants
        let plain = unit == 1.0 || length == 1.0;
        plain.then_some(unit * length)
    }

    /// An S word of the main spindle.
    pub(crate) fn speed(&mut self, value: Option<f64>) {
        self.spindle.speed_per_min = value.filter(|_| !self.spindle.cuts);
    }

    /// G96, G97: the meaning of S.
    pub(crate) fn cut(&mut self, cuts: bool) {
        self.spindle.cuts = cuts;
        self.spindle.speed_per_min = None;
    }

    /// An M function of the main spindle.
    pub(crate) fn m(&mut self, number: i64) {
        match number {
            3 | 4 => self.spindle.stands = false,
            5 | 19 => self.spindle.stands = true,
            _ => {}
        }
    }

    /// Another spindle became the main one, or the speed may be any.
    pub(crate) fn havoc_spindle(&mut self) {
        self.spindle = Spindle::default();
    }

    /// Revolutions per minute for G95.
    ///
    /// # Errors
    /// The reason why they are not known.
    pub(crate) fn per_minute(&self) -> Result<f64, &'static str> {
        match self.spindle {
            Spindle { stands: true, .. } => Err("G95 needs a spindle that turns"),
            Spindle { cuts: true, .. } => Err("with G96 the spindle speed follows the diameter"),
            Spindle { speed_per_min, .. } => speed_per_min
                .filter(|speed| *speed > 0.0)
                .ok_or("G95 needs the speed of the main spindle, `S`"),
        }
    }

    /// `#OVERRIDE`: changes the overrides that it names.
    pub(crate) fn override_path(&mut self, change: impl FnOnce(&mut Factors)) {
        change(&mut self.overrides.get_or_insert_default().path);
    }

    /// `X[OVERRIDE …]`
    pub(crate) fn override_axis(&mut self, axis: AxisIndex, change: impl FnOnce(&mut Factors)) {
        let overrides = self.overrides.get_or_insert_default();
        change(overrides.axes.entry(axis.get()).or_default());
    }

    /// G129: the weight of rapid motions.
    pub(crate) fn weigh_rapid(&mut self, weight: Option<f64>) {
        self.overrides.get_or_insert_default().rapid.rapid = weight;
    }

    /// Returns the share of the velocity that overrides leave to a motion of some axes: that of the path
    /// times the least of the axes; G166 makes it 1. `None` where it is not known.
    pub(crate) fn share(
        &self,
        haste: Haste,
        moving: impl Iterator<Item = AxisIndex>,
    ) -> Option<f64> {
        let Some(overrides) = &self.overrides else {
            return Some(1.0);
        };
        let mut least = f64::INFINITY;
        for axis in moving {
            let own = overrides.axes.get(&axis.get()).copied().unwrap_or_default();
            least = least.min(own.of(haste)?);
        }
        let own = if least.is_finite() { least } else { 1.0 };
        let path = overrides.path.of(haste)? * overrides.rapid.of(haste)?;
        Some(path * own)
    }

    /// The weight of G129 alone, which G166 does not suppress.
    pub(crate) fn weight(&self, haste: Haste) -> Option<f64> {
        let overrides = self.overrides.as_ref();
        overrides.map_or(Some(1.0), |it| it.rapid.of(haste))
    }

    /// Overrides may have been changed in any way.
    pub(crate) fn havoc_overrides(&mut self) {
        self.overrides.get_or_insert_default().path = Factors {
            feed: None,
            rapid: None,
        };
    }

    /// Everything may have been changed in any way.
    pub(crate) fn havoc(&mut self) {
        self.havoc_spindle();
        self.havoc_overrides();
    }

    /// Makes unknown what differs between two states.
    pub(crate) fn join(&mut self, other: &Self) {
        if self.spindle != other.spindle {
            self.havoc_spindle();
        }
        if self.overrides != other.overrides {
            self.havoc_overrides();
        }
    }
}

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
pub(crate) fn plain_number(argument: &Argument) -> Option<f64> {
    match argument.value? {
        crate::syntax::ast::Operand::Number(number) => Some(number),
        crate::syntax::ast::Operand::Expression(_) => None,
    }
}

/// The modes of F that lack a feed or have the feed 0, a bit each in the order of
/// [`crate::interpreter::motion::modal::GFunctions::feeds`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub(crate) struct LackingFeeds {
    /// Those that certainly do.
    certain: u8,
    /// Those that may.
    possible: u8,
}

impl LackingFeeds {
    const ALL: u8 = 0b1111;

    /// No feed was programmed.
    pub(crate) fn all() -> Self {
        Self {
            certain: Self::ALL,
            possible: Self::ALL,
        }
    }

    /// The mode at a place has a feed from here on.
    pub(crate) fn give(&mut self, place: usize) {
        self.certain &= !(1 << place);
        self.possible &= !(1 << place);
    }

    /// The mode at a place has the feed 0 from here on.
    pub(crate) fn take(&mut self, place: usize) {
        self.certain |= 1 << place;
        self.possible |= 1 << place;
    }

    /// Another way reaches the same block.
    pub(crate) fn join(&mut self, other: Self) {
        self.certain &= other.certain;
        self.possible |= other.possible;
    }

    /// Whether the mode at a place may lack a feed.
    #[inline]
    pub(crate) fn contains(self, place: usize) -> bool {
        self.possible & 1 << place != 0
    }

    /// Whether the program has certainly given no feed in any mode.
    pub(crate) fn is_certain(self) -> bool {
        self.certain == Self::ALL
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
