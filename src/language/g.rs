//! The G functions, one row each (R2.45, R2.94).
//!
//! A function without a row is FC210. Columns that a row leaves out have the values of [`GFunction::new`]: the function
//! leaves coordinates alone and is passed over.
//!
//! PM/n is page n of the TF5200 programming manual.

use serde::{Deserialize, Serialize};

use super::hash::Flushes;
use super::motion::{
    AxisWords, Certainty, ChainStep, Holds, MotionEffect, MotionKind, Moves, OnOff, Simplification,
};
use super::state::{ChannelState, Mode, RefusedIn};

/// A G function of the language, or neighbours that have everything in common.
#[derive(Debug)]
pub(crate) struct GFunction {
    first: u32,
    last: u32,
    /// Document or rule that describes it.
    #[allow(dead_code, reason = "it is there to be read")]
    source: &'static str,
    /// Execution in a dry run.
    pub(crate) action: GAction,
    /// Group of which one function is in force.
    pub(crate) group: Option<Group>,
    /// Further group of which a block takes one function.
    pub(crate) one_of: Option<BlockGroup>,
    /// Effect on positions, with the name in the state.
    pub(crate) chain: Option<(ChainStep, &'static str, OnOff)>,
    /// Motion of the axes, where it is another one than that of the group.
    pub(crate) motion: Option<MotionEffect>,
    /// Meaning of the axis words of its block.
    pub(crate) axis_words: AxisWords,
    /// Reason why the motion of its block is not modelled.
    pub(crate) unmodelled: Option<&'static str>,
    /// Simplification of the commanded trace.
    pub(crate) simplifies: Option<(Simplification, Holds)>,
    /// Effect on coordinates that is not in the other columns.
    pub(crate) coordinates: CoordinateEffect,
    /// Conditions under which it flushes the channel and the control refuses that (R2.111).
    pub(crate) flushes: Flushes,
    /// States in which the control refuses it for another reason (R2.111).
    pub(crate) refused: RefusedIn,
    /// Mode that it switches.
    pub(crate) mode: Option<(Mode, OnOff)>,
    /// Number of the group of a channel list in which it may be the default at program start (P-CHAN-00063).
    default_of: Option<u32>,
}

/// Execution of a G function in a dry run.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum GAction {
    /// No effect but those in the other columns.
    PassOver,
    /// Call of a program (P-CHAN-00187).
    Call,
    /// G04: the axes rest.
    Dwell,
    /// G20 to G23: coordinates are mirrored.
    Mirror,
    /// G150, G151: the path between the points is a spline.
    SwitchSpline,
    /// G68, G69: coordinates are rotated; the axis words of G68 are the centre.
    Rotate,
    /// G60: the axes come to rest at the end of the block.
    RestAtEnd,
    /// G92: axis words are offsets.
    SetReference,
    /// G96: S is a cutting speed.
    SetCuttingSpeed,
    /// G97: S is a speed of the spindle.
    SetSpindleSpeed,
    /// G129: rapid motions are weighted.
    WeighRapid,
    /// G163: the radius of circles.
    SetRadius,
    /// G166: overrides do not count.
    RunAtFullSpeed,
    /// G200: the operator moves axes before the program goes on (PM/206639371).
    WaitForOperator,
    /// G201, G202: the operator moves axes along with the program, or does not any more (PM/206633483).
    SwitchManual(OnOff),
}

/// A group of G functions of which a block takes one, and of which more than one may be in force (TF5200 Diagnosis).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum BlockGroup {
    /// The end of the block, together with G359 and G360 (error 20117).
    ExactStop,
    /// The transition between contours (error 20113).
    Transition,
    /// The programming of diameters (error 20115).
    Diameter,
    /// Deceleration (error 20977).
    Deceleration,
    /// Measuring (error 20123).
    Measuring,
    /// The selection of the cutter radius compensation (error 20126).
    RadiusSelection,
    /// The correction of the centre (error 20128).
    CentreCorrection,
    /// Look-ahead, with which N is a number of blocks, `G115 N5` (error 20124).
    LookAhead,
    /// Mirroring (error 20112).
    Mirror,
    /// The meaning of S (error 20122).
    SpindleSpeed,
}

/// Effect of a G function on coordinates.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum CoordinateEffect {
    /// No effect, or that in the other columns.
    None,
    /// Change to positions of the program: weights of axes, diameters, the operator's hand wheel.
    Unfollowed,
    /// Function of which only the group is known.
    NotKnown,
}

impl BlockGroup {
    /// Returns the index of the group, after those of the groups of which one function is in force.
    pub(crate) const fn place(self) -> usize {
        match self {
            Self::ExactStop => Group::ExactStop as usize,
            _ => Group::COUNT + self as usize - 1,
        }
    }
}

impl GFunction {
    const fn new((first, last): (u32, u32), source: &'static str) -> Self {
        Self {
            first,
            last,
            source,
            action: GAction::PassOver,
            group: None,
            one_of: None,
            chain: None,
            motion: None,
            axis_words: AxisWords::Motion,
            unmodelled: None,
            simplifies: None,
            coordinates: CoordinateEffect::None,
            flushes: Flushes::Never,
            refused: &[],
            mode: None,
            default_of: None,
        }
    }

    super::columns! {
        action(action: GAction) = action;
        group(group: Group) = Some(group);
        one_of(group: BlockGroup) = Some(group);
        chain(step: ChainStep, name: &'static str, switch: OnOff) = Some((step, name, switch));
        motion(kind: MotionKind, moves: Moves, certainty: Certainty) = Some(MotionEffect { kind, moves, certainty });
        axis_words(axis_words: AxisWords) = axis_words;
        unmodelled(reason: &'static str) = Some(reason);
        simplifies(what: Simplification, holds: Holds) = Some((what, holds));
        coordinates(coordinates: CoordinateEffect) = coordinates;
        flushes(under: Flushes) = under;
        refused(states: RefusedIn) = states;
        mode(mode: Mode, switch: OnOff) = Some((mode, switch));
        default_of(group: u32) = Some(group);
    }
}

macro_rules! functions {
    ($($first:literal $(..=$last:literal)? ($source:expr) $($column:ident($($value:expr),+))*;)+) => {
        &[$(GFunction::new(functions!(@range $first $(, $last)?), $source)$(.$column($($value),+))*),+]
    };
    (@range $one:literal) => { ($one, $one) };
    (@range $first:literal, $last:literal) => { ($first, $last) };
}

/// PM/206089483 and its neighbours: block ends, feedforward, gain, weights of dynamics, insertion of chamfers and
/// roundings, override, contouring modes, threads, measuring, software limits.
const MANUAL: &str = "PM/206089483";

/// Descriptions of commands in the vendor's editor for NC programs (vscode-isg-cnc), and examples of the manual.
const EDITOR: &str = "vscode-isg-cnc";

const PROBED: &str = "a measuring motion ends where the probe triggers";

/// What `#HSC ON [OPMODE 2]` does not have (TF5200 Diagnosis, page 264715659).
const IN_FAST_SPLINE: RefusedIn = &[(ChannelState::FastSpline, 120_433)];

/// Rounding by polynomials (TF5200 Diagnosis, pages 264715659, 264519819).
const ROUNDING: RefusedIn = &[
    (ChannelState::FastSpline, 120_433),
    (ChannelState::ProgrammedSpline, 120_255),
];

/// Measuring (TF5200 Diagnosis, pages 250645643, 264715659).
const MEASURING: RefusedIn = &[
    (ChannelState::CutterRadius, 20049),
    (ChannelState::FastSpline, 120_433),
];

/// The functions, in the order of their numbers.
static FUNCTIONS: &[GFunction] = {
    use AxisWords::{Measuring, Other, Reference};
    use BlockGroup as One;
    use Certainty::{Certain, Possible};
    use ChainStep::{Coordinates, Path};
    use ChannelState::{CutterRadius, FastSpline, LeavingRadius};
    use CoordinateEffect::{NotKnown, Unfollowed};
    use Flushes::{Both, Radius};
    use GAction::{
        Call, Dwell, Mirror, RestAtEnd, Rotate, RunAtFullSpeed, SetCuttingSpeed, SetRadius,
        SetReference, SetSpindleSpeed, SwitchManual, SwitchSpline, WaitForOperator, WeighRapid,
    };
    use Mode::{FixedCentre, LeavesWithMotion};
    use MotionKind::{Feed, Homing, Unknown};
    use Moves::{Words, WordsInSpace, WordsOrAll};
    use OnOff::{Off, On};
    use Simplification::{
        AccelerationWeight, Contouring, CornerDeceleration, FeedRamp, LateDeceleration, RampWeight,
        ToolFeed, VelocityWeight,
    };
    functions! {
        0..=3 ("R2.45") group(Group::Motion) default_of(0);
        4 (MANUAL) action(Dwell) axis_words(Other) default_of(0) refused(&[(FastSpline, 120_435)]);
        5 (MANUAL);
        8 (MANUAL);
        9 (MANUAL) one_of(One::Deceleration);
        10 ("PM/206473227") simplifies(ToolFeed, Holds::Off);
        11 ("PM/206473227") simplifies(ToolFeed, Holds::On);
        12 (MANUAL) simplifies(CornerDeceleration, Holds::Off);
        13 (MANUAL) simplifies(CornerDeceleration, Holds::On);
        17..=19 ("R2.45") group(Group::Plane) default_of(4) refused(&[(CutterRadius, 20133)]);
        20 ("PM/206266379") action(Mirror) one_of(One::Mirror) chain(Coordinates, "G21", Off);
        21..=23 ("PM/206266379") action(Mirror) one_of(One::Mirror) chain(Coordinates, "G21", On);
        25..=26 (MANUAL) one_of(One::Transition) default_of(6);
        28 (MANUAL);
        33 (MANUAL) motion(Feed, Words, Certain) unmodelled("G33 follows a spindle") refused(IN_FAST_SPLINE);
        40..=42 ("R2.45") group(Group::CutterRadius);
        43..=44 (EDITOR) coordinates(Unfollowed);
        51..=52 (EDITOR) one_of(One::Diameter) coordinates(Unfollowed) default_of(8);
        53..=59 ("R2.45") group(Group::Offset);
        60 (MANUAL) action(RestAtEnd) one_of(One::ExactStop);
        61 ("PM/206307595") simplifies(Contouring, Holds::Once) one_of(One::ExactStop) refused(ROUNDING);
        63 (MANUAL) motion(Feed, Words, Certain) unmodelled("G63 follows a spindle");
        66 (EDITOR) coordinates(Unfollowed);
        68 ("PM/969743115") action(Rotate) chain(Coordinates, "#ROTATION", On) axis_words(Other);
        69 ("PM/969743115") action(Rotate) chain(Coordinates, "#ROTATION", Off);
        70..=71 ("R2.45") group(Group::Unit) default_of(12);
        74 ("PM/206138635") motion(Homing, Words, Certain) axis_words(AxisWords::Homing);
        80..=89 ("PM/206278923") action(Call);
        90..=91 ("R2.45") group(Group::Distance) default_of(14);
        92 ("PM/206145291") action(SetReference) axis_words(Reference);
        93..=94 ("R2.45") group(Group::Feed);
        95 ("R2.45") group(Group::Feed) refused(IN_FAST_SPLINE);
        96 (MANUAL) action(SetCuttingSpeed) one_of(One::SpindleSpeed) refused(IN_FAST_SPLINE);
        97 (MANUAL) action(SetSpindleSpeed) one_of(One::SpindleSpeed);
        98..=99 (MANUAL) axis_words(Other) refused(&[(ChannelState::Frame, 20663)]);
        100..=102 ("PM/206177803") motion(Feed, Words, Certain) axis_words(Measuring) unmodelled(PROBED) one_of(One::Measuring) refused(MEASURING);
        103..=105 (EDITOR) one_of(One::Measuring) coordinates(NotKnown);
        106 ("PM/206197003") motion(Feed, Words, Certain) axis_words(Measuring) unmodelled(PROBED) one_of(One::Measuring) refused(MEASURING);
        107 (MANUAL) one_of(One::Measuring);
        108 ("PM/206197003") motion(Feed, Words, Certain) axis_words(Measuring) unmodelled(PROBED) one_of(One::Measuring) refused(MEASURING);
        109 (MANUAL);
        112 (MANUAL) axis_words(Other);
        115..=117 (MANUAL) one_of(One::LookAhead);
        120..=122 (MANUAL);
        127 ("PM/206573067") axis_words(Other) simplifies(VelocityWeight, Holds::On);
        128 ("PM/206573067") simplifies(VelocityWeight, Holds::On);
        129 ("PM/206578955") action(WeighRapid);
        130..=131 ("PM/206590731") axis_words(Other) simplifies(AccelerationWeight, Holds::On);
        132..=134 ("PM/206596619") axis_words(Other) simplifies(RampWeight, Holds::On);
        135 (MANUAL) axis_words(Other) default_of(21);
        136 (MANUAL) axis_words(Other);
        137 (MANUAL) axis_words(Other) default_of(21);
        138..=139 (MANUAL) one_of(One::RadiusSelection) default_of(22) mode(LeavesWithMotion, On);
        140..=141 (MANUAL) default_of(32);
        150 ("PM/207263627") action(SwitchSpline) chain(Path, "#SPLINE", Off) refused(&[(ChannelState::HighSpeed, 120_370)]);
        151 ("PM/207256971") action(SwitchSpline) chain(Path, "#SPLINE", On) refused(&[(ChannelState::HighSpeed, 120_370)]);
        159 ("R2.45") group(Group::Offset);
        160 (MANUAL);
        161..=162 ("R2.45") group(Group::CircleCentre) default_of(23);
        163 (MANUAL) action(SetRadius);
        164 (MANUAL) one_of(One::CentreCorrection) default_of(25) mode(FixedCentre, On);
        165 (MANUAL) one_of(One::CentreCorrection) default_of(25) mode(FixedCentre, Off);
        166 ("PM/206744331") action(RunAtFullSpeed);
        167 (MANUAL);
        180 (MANUAL);
        193 ("PM/206245643") simplifies(FeedRamp, Holds::Once);
        194 ("R2.45") group(Group::Feed);
        196 (MANUAL) one_of(One::SpindleSpeed);
        197 (MANUAL);
        200 ("PM/206639371") action(WaitForOperator) motion(Unknown, WordsOrAll, Possible) axis_words(Other) coordinates(Unfollowed) flushes(Both);
        201 ("PM/206633483") action(SwitchManual(On)) motion(Unknown, Words, Possible) axis_words(Other) coordinates(Unfollowed) flushes(Radius);
        202 (EDITOR) action(SwitchManual(Off)) axis_words(Other) coordinates(Unfollowed);
        230..=231 ("PM/206590731") axis_words(Other) simplifies(AccelerationWeight, Holds::On);
        233 ("PM/206596619") axis_words(Other) simplifies(RampWeight, Holds::On);
        234 (EDITOR) coordinates(Unfollowed);
        236 (MANUAL) default_of(22) mode(LeavesWithMotion, On);
        237..=239 (MANUAL) default_of(22) mode(LeavesWithMotion, Off);
        260 ("PM/206307595") simplifies(Contouring, Holds::Off) one_of(One::ExactStop);
        261 ("PM/206307595") simplifies(Contouring, Holds::On) one_of(One::ExactStop) refused(ROUNDING);
        270..=271 (EDITOR) coordinates(Unfollowed);
        280 (EDITOR) coordinates(Unfollowed);
        293 ("PM/206245643") simplifies(FeedRamp, Holds::Once);
        294 (EDITOR) coordinates(Unfollowed);
        296 (MANUAL);
        301..=302 (MANUAL) motion(Feed, Words, Certain) unmodelled("G301 and G302 insert a contour");
        303 (MANUAL) motion(Feed, WordsInSpace, Certain) unmodelled("G303 is an arc in space") refused(&[(CutterRadius, 22081), (LeavingRadius, 90193)]);
        310 ("PM/206197003") motion(Feed, Words, Certain) axis_words(Measuring) unmodelled(PROBED) refused(MEASURING);
        331..=332 (MANUAL) motion(Feed, Words, Certain);
        333..=334 (MANUAL) axis_words(Other);
        338..=339 (MANUAL) axis_words(Other);
        350 (EDITOR) coordinates(Unfollowed);
        351 (EDITOR) one_of(One::Mirror) axis_words(Other) coordinates(Unfollowed);
        359..=360 ("R2.45") group(Group::ExactStop);
        393 (EDITOR) coordinates(Unfollowed);
        800..=899 ("PM/206278923") action(Call);
        900 ("PM/206238219") simplifies(LateDeceleration, Holds::Off) one_of(One::Deceleration);
        901 ("PM/206238219") simplifies(LateDeceleration, Holds::On) one_of(One::Deceleration);
        905 (EDITOR) coordinates(Unfollowed);
    }
};

/// Upper end of the numbers, one past the highest.
const NUMBERS: usize = 906;

/// The place of the row of each number, from one on; zero where it has none.
#[allow(
    clippy::cast_possible_truncation,
    reason = "there are fewer than 255 rows"
)]
static PLACES: [u8; NUMBERS] = {
    let mut places = [0; NUMBERS];
    let mut at = 0;
    while at < FUNCTIONS.len() {
        let mut number = FUNCTIONS[at].first as usize;
        while number <= FUNCTIONS[at].last as usize {
            places[number] = at as u8 + 1;
            number += 1;
        }
        at += 1;
    }
    places
};

/// The group of each number.
static GROUPS: [Option<Group>; NUMBERS] = {
    let mut groups = [None; NUMBERS];
    let mut number = 0;
    while number < NUMBERS {
        if PLACES[number] > 0 {
            groups[number] = FUNCTIONS[PLACES[number] as usize - 1].group;
        }
        number += 1;
    }
    groups
};

impl Group {
    /// Returns the group of a G number; `None` for one that is not modal or not modelled.
    #[inline]
    pub fn of(number: u32) -> Option<Self> {
        GROUPS.get(number as usize).copied().flatten()
    }
}

impl GFunction {
    /// Returns the row of a number; `None` where none names it.
    pub(crate) fn of(number: u32) -> Option<&'static Self> {
        let place = usize::from(*PLACES.get(number as usize)?);
        FUNCTIONS.get(place.checked_sub(1)?)
    }

    /// Returns whether a function is an interpolation at the path feed: G01, G02, G03.
    #[inline]
    pub(crate) const fn is_feed_move(number: u32) -> bool {
        matches!(number, 1..=3)
    }

    /// Returns whether a function is a circular interpolation: G02, G03.
    #[inline]
    pub(crate) const fn is_arc(number: u32) -> bool {
        matches!(number, 2 | 3)
    }

    /// Returns the row of a number after G, which may be a fraction.
    pub(crate) fn of_value(number: f64) -> Option<&'static Self> {
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // compared below
        let whole = number as u32;
        let is_whole = f64::from(whole).total_cmp(&number).is_eq();
        Self::of(whole).filter(|_| is_whole)
    }

    /// Returns the row of a number whose function is known, and not only its group.
    pub(crate) fn known(number: u32) -> Option<&'static Self> {
        Self::of(number).filter(|row| row.coordinates != CoordinateEffect::NotKnown)
    }

    /// Returns the functions that may be the default of a group of a channel list (P-CHAN-00063).
    pub(crate) fn defaults_of(group: u32) -> impl Iterator<Item = u32> {
        let rows = FUNCTIONS.iter();
        let rows = rows.filter(move |row| row.default_of == Some(group));
        rows.flat_map(|row| row.first..=row.last)
    }

    /// Returns whether an axis word in its block is a number, so that an axis cannot only be named: the groups, block
    /// ends, G04 and G92.
    pub(crate) fn takes_numbers(&self) -> bool {
        self.group.is_some()
            || matches!(self.action, GAction::Dwell | GAction::SetReference)
            || matches!(
                self.one_of,
                Some(BlockGroup::ExactStop | BlockGroup::Deceleration)
            )
    }

    /// Returns whether it takes effect in a dry run, so that it cannot be declared harmless: those of the groups,
    /// mirroring and G92 (R2.45).
    pub(crate) fn is_followed(&self) -> bool {
        self.group.is_some() || matches!(self.action, GAction::Mirror | GAction::SetReference)
    }

    /// Returns whether its motion ends where a probe triggers.
    pub(crate) fn is_measuring(&self) -> bool {
        self.axis_words == AxisWords::Measuring
    }

    /// Whether it is about axes that the operator moves: G200, G201, G202.
    pub(crate) fn is_for_operator(&self) -> bool {
        matches!(
            self.action,
            GAction::WaitForOperator | GAction::SwitchManual(_)
        )
    }

    /// Whether the control refuses it in some states.
    pub(crate) fn is_refused_somewhere(&self) -> bool {
        !self.refused.is_empty() || self.flushes != Flushes::Never
    }

    /// Returns whether it is an implicit call.
    pub(crate) fn is_call(&self) -> bool {
        self.action == GAction::Call
    }
}

/// A group of G functions of which one is in force.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[non_exhaustive]
pub enum Group {
    /// G00 G01 G02 G03.
    Motion,
    /// G17 G18 G19.
    Plane,
    /// G70 inch, G71 metric.
    Unit,
    /// G90 absolute, G91 incremental.
    Distance,
    /// G93 G94 G95 G194.
    Feed,
    /// G53 to G59, G159.
    Offset,
    /// G40 G41 G42.
    CutterRadius,
    /// G161 absolute, G162 relative circle centre.
    CircleCentre,
    /// G360 exact stop, G359 none.
    ExactStop,
}

impl Group {
    pub(crate) const ALL: [Self; Self::COUNT] = [
        Self::Motion,
        Self::Plane,
        Self::Unit,
        Self::Distance,
        Self::Feed,
        Self::Offset,
        Self::CutterRadius,
        Self::CircleCentre,
        Self::ExactStop,
    ];

    /// Number of groups.
    pub(crate) const COUNT: usize = Self::ExactStop as usize + 1;
}

impl From<Vec<Group>> for GroupSet {
    fn from(groups: Vec<Group>) -> Self {
        groups.into_iter().collect()
    }
}

impl From<GroupSet> for Vec<Group> {
    fn from(set: GroupSet) -> Self {
        let groups = Group::ALL.into_iter();
        groups.filter(|&group| set.contains(group)).collect()
    }
}

/// A set of groups, a bit each; serialised as the list of them.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(into = "Vec<Group>", from = "Vec<Group>")]
pub(crate) struct GroupSet(u16);

impl GroupSet {
    pub(crate) fn contains(self, group: Group) -> bool {
        self.0 & 1 << group as u8 != 0
    }

    pub(crate) fn insert(&mut self, group: Group) {
        self.0 |= 1 << group as u8;
    }

    pub(crate) fn remove(&mut self, group: Group) {
        self.0 &= !(1 << group as u8);
    }
}

impl FromIterator<Group> for GroupSet {
    fn from_iter<I: IntoIterator<Item = Group>>(groups: I) -> Self {
        let mut set = Self::default();
        groups.into_iter().for_each(|group| set.insert(group));
        set
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_rows_are_in_order() {
        // R2.94
        for pair in FUNCTIONS.windows(2) {
            assert!(pair[0].last < pair[1].first, "G{}", pair[1].first);
        }
        let last = FUNCTIONS.last().expect("a row");
        assert_eq!(last.last as usize + 1, NUMBERS);
        assert!(FUNCTIONS.iter().all(|row| !row.source.is_empty()));
    }

    #[test]
    fn each_number_has_its_row() {
        // R2.45 R2.94
        assert_eq!(Group::of(194), Some(Group::Feed));
        assert_eq!(Group::of(4), None);
        assert!(GFunction::known(85).is_some_and(GFunction::is_call));
        assert!(GFunction::of(105).is_some() && GFunction::known(105).is_none());
        assert!(GFunction::of(7).is_none() && GFunction::of(100_000).is_none());
        let reference = GFunction::of_value(92.0).expect("G92");
        assert!(reference.is_followed() && reference.takes_numbers());
        assert!(GFunction::of_value(54.1).is_none() && GFunction::of_value(-1.0).is_none());
    }
}
