//! Velocity of the path that follows from a programmed F: the unit, the main spindle, programmed overrides (R5.1), the
//! profile of the acceleration that a program selects (R11.20), the modes in which no feed is in force (R2.110), and
//! the rounding of transitions between blocks (R11.21): the parameters of `#CONTOUR MODE` and `#HSC`.
//!
//! PM/n is page n of the TF5200 programming manual, HSC/n one of the HSC package.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use crate::comp::AxisIndex;
use crate::language::{ContouringCommand, SlopeForm};
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
    /// Factor of feed motions: G01, G02, G03.
    pub(crate) feed: Option<f64>,
    /// Factor of rapid motions: G00.
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

/// Haste of a motion: rapid or not.
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

    /// Returns the unit of an F word with G94 where lengths are in `length_mm`. G70 makes it inch/min; its effect on
    /// m/min is not documented.
    pub(crate) fn unit_per_min(&self, length_mm: Option<f64>) -> Option<f64> {
        let (unit, length) = (self.feed_unit_mm?, length_mm?);
        #[allow(clippy::float_cmp)] // both are constants
        let plain = unit == 1.0 || length == 1.0;
        plain.then_some(unit * length)
    }

    /// Sets the speed of the main spindle by an S word.
    pub(crate) fn speed(&mut self, value: Option<f64>) {
        self.spindle.speed_per_min = value.filter(|_| !self.spindle.cuts);
    }

    /// Sets the meaning of S: G96, G97.
    pub(crate) fn cut(&mut self, cuts: bool) {
        self.spindle.cuts = cuts;
        self.spindle.speed_per_min = None;
    }

    /// Executes an M function of the main spindle.
    pub(crate) fn m(&mut self, number: i64) {
        match number {
            3 | 4 => self.spindle.stands = false,
            5 | 19 => self.spindle.stands = true,
            _ => {}
        }
    }

    /// Makes the spindle speed unknown: another spindle became the main one, or the speed may be any.
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

    /// Changes the overrides that `#OVERRIDE` names.
    pub(crate) fn override_path(&mut self, change: impl FnOnce(&mut Factors)) {
        change(&mut self.overrides.get_or_insert_default().path);
    }

    /// Changes the override of an axis: `X[OVERRIDE …]`.
    pub(crate) fn override_axis(&mut self, axis: AxisIndex, change: impl FnOnce(&mut Factors)) {
        let overrides = self.overrides.get_or_insert_default();
        change(overrides.axes.entry(axis.get()).or_default());
    }

    /// Sets the weight of rapid motions by G129.
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

    /// Returns the weight of G129 alone, which G166 does not suppress.
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

    /// Makes the spindle speed and the overrides unknown.
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
    /// Returns the selection of a command; `None` where its bracket names no profile.
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
    /// The modes that certainly lack a feed.
    certain: u8,
    /// The modes that possibly lack a feed.
    possible: u8,
}

impl LackingFeeds {
    const ALL: u8 = 0b1111;

    /// Returns the state before the first feed is programmed.
    pub(crate) fn all() -> Self {
        Self {
            certain: Self::ALL,
            possible: Self::ALL,
        }
    }

    /// Gives the mode at a place a feed from here on.
    pub(crate) fn give(&mut self, place: usize) {
        self.certain &= !(1 << place);
        self.possible &= !(1 << place);
    }

    /// Gives the mode at a place the feed 0 from here on.
    pub(crate) fn take(&mut self, place: usize) {
        self.certain |= 1 << place;
        self.possible |= 1 << place;
    }

    /// Merges another way that reaches the same block.
    pub(crate) fn join(&mut self, other: Self) {
        self.certain &= other.certain;
        self.possible |= other.possible;
    }

    /// Returns whether the mode at a place may lack a feed.
    #[inline]
    pub(crate) fn contains(self, place: usize) -> bool {
        self.possible & 1 << place != 0
    }

    /// Returns whether the program has certainly given no feed in any mode.
    pub(crate) fn is_certain(self) -> bool {
        self.certain == Self::ALL
    }
}

/// Rounding of transitions between blocks. Lengths are in mm; `None` means no limit.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct Contouring {
    /// Permitted deviation from the programmed path; 0 where it is not known.
    pub tolerance_mm: Option<f64>,
    /// Permitted length off the programmed blocks, before and after a corner.
    pub distance_mm: Option<f64>,
    /// The largest share of a block that a corner takes at either end.
    pub reach: f64,
    /// The sharpest corner that is rounded, in degrees.
    pub max_angle_deg: Option<f64>,
    /// Blocks that become one curve.
    pub joining: Joining,
    /// Whether the path becomes a spline, `OPMODE 2` (R2.111).
    pub is_spline: bool,
}

/// Selection of the straight blocks that become one curve.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[non_exhaustive]
pub enum Joining {
    /// Blocks that follow a curve already, within a fraction of a µm (R11.22).
    Fine,
    /// All blocks within the tolerance.
    WithinTolerance,
}

/// Default of `PATH_DEV` and `PRE_DIST` (PM/475164939, PM/475180811).
const CONTOUR_MM: f64 = 1.0;
/// Default of `CONTERROR` (PM/207285131).
const CONTOUR_ERROR_MM: f64 = 0.1;
/// Default of `PATH_DEV` and `MAX_ANGLE` of B-splines (PM/207308683).
const SPLINE_MM: f64 = 0.2;
const SPLINE_ANGLE_DEG: f64 = 5.0;

impl ContouringCommand {
    /// Returns the parameters in the bracket of the command; `number` gives the value of an expression.
    /// A value that is not named is that of `before`; in a bracket of `#CONTOUR MODE` with a mode, and in
    /// any bracket of `#HSC`, it is the default.
    pub(crate) fn parameters(
        self,
        before: Contouring,
        (arguments, text): (&BracketArguments, &str),
        mut number: impl FnMut(&Argument) -> Option<f64>,
    ) -> Contouring {
        let has = |word: &str| arguments.has(word, text);
        // `Some(None)` is a value that is not known.
        let mut value = |key: &str| arguments.after(key, text).map(&mut number);
        match self {
            Self::Contour => {
                let mut next = before;
                if has("DEV") || has("PTP") {
                    next = Contouring::default();
                } else if has("DIST") || has("POS") || has("DIST_SOFT") || has("DIST_MASTER") {
                    next = Contouring {
                        tolerance_mm: None,
                        distance_mm: Some(CONTOUR_MM),
                        ..Contouring::default()
                    };
                }
                if let Some(given) = value("PATH_DEV") {
                    next.tolerance_mm = Some(given.unwrap_or(0.0).max(0.0));
                }
                let keys = ["PRE_DIST", "POST_DIST", "PATH_DIST", "SYM_DIST"];
                let distances = keys.into_iter().filter_map(&mut value);
                let shortest = distances
                    .map(|given| given.unwrap_or(0.0))
                    // -1 switches a distance off (PM/475198987).
                    .filter(|distance| *distance >= 0.0)
                    .reduce(f64::min);
                next.distance_mm = shortest.or(next.distance_mm);
                if let Some(given) = value("REMAIN_PART") {
                    let remains = given.map_or(1.0, |percent| percent / 100.0);
                    next.reach = (1.0 - remains.clamp(0.0, 1.0)) / 2.0;
                }
                next
            }
            Self::HighSpeed => {
                let spline = has("BSPLINE") || has("SURFACE");
                let mut next = if arguments.iter().next().is_none() {
                    before
                } else {
                    Contouring::high_speed()
                };
                next.is_spline |= has("BSPLINE");
                if spline {
                    next.tolerance_mm = Some(SPLINE_MM);
                    next.max_angle_deg = Some(SPLINE_ANGLE_DEG);
                }
                if let Some(given) = value("OPMODE")
                    && given != Some(1.0)
                {
                    next.tolerance_mm = None;
                    next.is_spline = given.is_none_or(|mode| (mode - 2.0).abs() < 0.5);
                }
                for key in ["CONTERROR", "PATH_DEV"] {
                    match value(key) {
                        // 0 means no monitoring (PM/207308683).
                        Some(Some(0.0)) if key == "PATH_DEV" => next.tolerance_mm = None,
                        Some(given) => next.tolerance_mm = Some(given.unwrap_or(0.0).max(0.0)),
                        None => {}
                    }
                }
                if let Some(given) = value("MAX_ANGLE") {
                    next.max_angle_deg = given.filter(|angle| *angle > 0.0);
                }
                next
            }
        }
    }
}

impl Default for Contouring {
    /// Returns `#CONTOUR MODE` at the start of a program: `DEV` with 1 mm (PM/475164939).
    fn default() -> Self {
        Self {
            tolerance_mm: Some(CONTOUR_MM),
            distance_mm: None,
            reach: 0.5,
            max_angle_deg: None,
            joining: Joining::Fine,
            is_spline: false,
        }
    }
}

impl Contouring {
    /// Returns `#HSC ON` without parameters: `OPMODE 1` (PM/207285131).
    pub(crate) fn high_speed() -> Self {
        Self {
            tolerance_mm: Some(CONTOUR_ERROR_MM),
            joining: Joining::WithinTolerance,
            ..Self::default()
        }
    }

    /// Parameters that are not known: nothing is rounded.
    pub(crate) fn unknown(self) -> Self {
        Self {
            tolerance_mm: Some(0.0),
            ..self
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::interpreter::motion::pace::plain_number;
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

    fn of(command: &str, bracket: &str) -> Contouring {
        let text = format!("{command} {bracket}");
        let block = parse_block(&text);
        let [Item::Hash(hash)] = block.items.as_slice() else {
            panic!("{text}")
        };
        let HashAction::Round(command) = hash.command.action else {
            panic!("{text}")
        };
        let before = match command {
            ContouringCommand::Contour => Contouring::default(),
            ContouringCommand::HighSpeed => Contouring::high_speed(),
        };
        command.parameters(before, (&hash.brackets, &text), plain_number)
    }

    #[test]
    fn parameters_are_those_of_the_bracket() {
        // R11.21
        let contour = |bracket| of("#CONTOUR MODE", bracket);
        assert_eq!(contour("").tolerance_mm, Some(1.0));
        assert_eq!(contour("[DEV PATH_DEV=0.25]").tolerance_mm, Some(0.25));
        assert_eq!(contour("[dev path_dev = 0.5 ]").tolerance_mm, Some(0.5));
        assert_eq!(contour("[DEV PATH_DEV=V.P.A]").tolerance_mm, Some(0.0));
        let distance = contour("[DIST PRE_DIST=3 POST_DIST=2]");
        assert_eq!(
            (distance.tolerance_mm, distance.distance_mm),
            (None, Some(2.0))
        );
        assert!((contour("[DEV REMAIN_PART=20]").reach - 0.4).abs() < 1e-12);
        let fast = |bracket| of("#HSC", bracket);
        assert_eq!(fast("").tolerance_mm, Some(0.1));
        assert_eq!(fast("[OPMODE 1 CONTERROR 0.01]").tolerance_mm, Some(0.01));
        assert_eq!(fast("[OPMODE 2]").tolerance_mm, None);
        let spline = fast("[BSPLINE PATH_DEV=0.05 MAX_ANGLE=10]");
        assert_eq!(
            (spline.tolerance_mm, spline.max_angle_deg),
            (Some(0.05), Some(10.0))
        );
        assert_eq!(fast("[BSPLINE PATH_DEV=0]").tolerance_mm, None);
    }
}
