//! Evidence that a list was on in one stage, and no part of it in the other (R16.13).

use frictcomp::lists::FrictionList;
use frictcomp_physics::current::Reading;
use serde::{Deserialize, Serialize};

use super::plan::Plan;
use super::plant_found::PlantAxis;
use crate::identify::{AxisRecording, Predictor, Timing, TorqueKind, median, verify_followed};

/// Evidence of a recording on the compensation of its axes, besides the path.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct CompensationShown {
    /// The axes of which a channel says that compensation was as the program switches it.
    pub switched: Vec<String>,
    /// The shares of lists in the torque of axes.
    pub shares: Vec<ShareOfList>,
}

/// The share of the current of a list in a recorded torque.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct ShareOfList {
    /// Name of the axis.
    pub axis: String,
    /// The SHA-256 of the list.
    pub list: String,
    /// Evidence of its torque; `None` where it is not known to be the actual one.
    pub torque: Option<TorqueOfList>,
}

/// Evidence of a recorded torque on a list.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct TorqueOfList {
    /// The lower and the upper end of the share of its current (R6.22); `None` without a following error, or with too
    /// few reversals.
    pub share: Option<[f64; 2]>,
    /// The friction of steady motion as a part of the list, whether that was on or not.
    pub friction: f64,
}

/// Statement of the recordings of an axis on a state of its compensation.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) enum SwitchedAs {
    /// Recordings in that state.
    Shown,
    /// Recordings in another state, in words.
    Otherwise(String),
    /// Recordings without evidence, with what would give some.
    NotShown(String),
}

/// Signal in which friction shows in the recordings of a plan.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub enum Shows {
    /// Circles of two axes, recorded feed by feed.
    Contour,
    /// Following error after reversals of one axis, recorded once, to which no plant is fitted: motor side, not
    /// contour.
    FollowingError,
}

impl Shows {
    /// Returns what the programs of a plan show.
    pub fn of(plan: &Plan) -> Self {
        match plan.axes.len() {
            1 => Self::FollowingError,
            _ => Self::Contour,
        }
    }

    /// Returns the number of recordings that have to agree.
    fn fewest(self) -> usize {
        match self {
            Self::Contour => 2,
            Self::FollowingError => 1,
        }
    }
}

/// The recordings of an axis in both stages, and its fitted plant.
#[derive(Debug, Clone, Copy)]
pub(super) struct StagesOfAxis<'a> {
    /// Name of the axis.
    pub axis: &'a str,
    /// The SHA-256 of its list.
    pub list: &'a str,
    /// Evidence of the recordings of stage 1.
    pub off: &'a [&'a CompensationShown],
    /// Evidence of the recordings of the round.
    pub on: &'a [&'a CompensationShown],
    /// Signal in which friction shows in them.
    pub shows: Shows,
    /// The plant that was fitted to them.
    pub plant: Option<&'a PlantAxis>,
}

/// Returns the evidence of a recorded torque on a list; `None` where it is not known to be the actual one.
pub fn torque_of_list(
    recording: &AxisRecording,
    kind: Option<TorqueKind>,
    (list, cycle_s): (&FrictionList, Option<f64>),
) -> Option<TorqueOfList> {
    if recording.measured.stated(kind, None).kind != Some(TorqueKind::Actual) {
        return None;
    }
    let predictor = Predictor {
        list,
        reading: Reading::default(),
        cycle_s,
    };
    let verified = verify_followed(&recording.track, &recording.following_errors, &predictor);
    let verified = verified.ok()?;
    let share = match verified.timing {
        Timing::Open => None,
        Timing::Off(share)
        | Timing::Other(share)
        | Timing::Unclear(share)
        | Timing::On { share, .. } => Some([share.low, share.high]),
    };
    Some(TorqueOfList {
        share,
        friction: verified.scale,
    })
}

impl StagesOfAxis<'_> {
    /// Judges whether all of the list was on in the round: by the torque, otherwise by the fitted plant. A torque that
    /// holds less proves nothing where a plant does.
    pub(super) fn was_on(&self) -> SwitchedAs {
        if self.torque_shows_on() {
            return SwitchedAs::Shown;
        }
        if let Some(plant) = self.plant.filter(|it| it.share_on.is_some()) {
            return plant
                .not_on()
                .map_or(SwitchedAs::Shown, SwitchedAs::Otherwise);
        }
        let axis = self.axis;
        let less = self.agreed(&self.shares(self.on), |it| it[1] < WHOLE_BELOW);
        match less {
            Some([low, high]) => SwitchedAs::Otherwise(format!(
                "by its torque {low:.2} to {high:.2} of the list of {axis} was on: check which one was loaded, and its \
                 scaling"
            )),
            None => SwitchedAs::NotShown(format!(
                "neither torque nor positions show that the list of {axis} was on{}",
                self.what_would_show("", self.on)
            )),
        }
    }

    /// Judges whether no part of the list was on in stage 1: by a recorded state, by a torque that shows the list where
    /// it was on, or by the fitted plant.
    pub(super) fn was_off(&self) -> SwitchedAs {
        let axis = self.axis;
        if let Some(words) = self.plant.and_then(PlantAxis::other_friction_off) {
            return SwitchedAs::Otherwise(words);
        }
        if let Some(words) = self.other_friction() {
            return SwitchedAs::Otherwise(words);
        }
        let shares = self.shares(self.off);
        let is_part = |it: &[f64; 2]| it[0] > SHOWN && f64::midpoint(it[0], it[1]) > PART;
        if let Some([low, high]) = self.agreed(&shares, is_part) {
            return SwitchedAs::Otherwise(format!(
                "{axis} was already compensated in stage 1: its torque holds {low:.2} to {high:.2} of the list"
            ));
        }
        let is_switched = |it: &&CompensationShown| it.switched.iter().any(|it| it == axis);
        let is_recorded = !self.off.is_empty() && self.off.iter().all(is_switched);
        let is_other = |it: &[f64; 2]| it[0] > NONE || it[1] < -NONE;
        let by_torque = self.torque_shows_on()
            && shares.len() >= self.shows.fewest()
            && !shares.iter().any(is_other)
            && together(&shares).is_some_and(|[low, high]| low >= -NONE && high <= NONE);
        if is_recorded || by_torque || self.plant.is_some_and(PlantAxis::is_off_shown) {
            return SwitchedAs::Shown;
        }
        let share = self.plant.and_then(|it| it.share_off);
        if let Some(share) = share {
            return SwitchedAs::NotShown(format!(
                "the circles of {axis} off are those of {:.2} of its list ({:.2} to {:.2}), which does not show that no \
                 part of it was on in stage 1: record the actual torque, or the state of the compensation",
                share.value, share.low, share.high
            ));
        }
        SwitchedAs::NotShown(format!(
            "nothing shows that no part of a list of {axis} was on in stage 1{}",
            self.what_would_show("the state of the compensation, or ", self.off)
        ))
    }

    /// Returns whether the share of the torque is at least 0.7 often enough, and nowhere below 0.75 for certain.
    fn torque_shows_on(&self) -> bool {
        const LEAST: f64 = 0.7;
        let shares = self.shares(self.on);
        shares.iter().filter(|it| it[0] >= LEAST).count() >= self.shows.fewest()
            && shares.iter().all(|it| it[1] >= WHOLE_BELOW)
    }

    /// States that the torque of steady motion shows another friction in stage 1 than in the round, if it does.
    fn other_friction(&self) -> Option<String> {
        const ALIKE: f64 = 0.15;
        let friction = |recordings: &[&CompensationShown]| {
            let all: Vec<f64> = self.torques(recordings).map(|it| it.friction).collect();
            median(&all)
        };
        let (off, on) = friction(self.off).zip(friction(self.on))?;
        let part = off / on - 1.0;
        (part.abs() > ALIKE).then(|| {
            format!(
                "the recordings of {} off have {} friction than those on, by {:.0} %: another machine, or another \
                 state of it",
                self.axis,
                if part > 0.0 { "more" } else { "less" },
                part.abs() * 100.0
            )
        })
    }

    fn shares(&self, recordings: &[&CompensationShown]) -> Vec<[f64; 2]> {
        self.torques(recordings).filter_map(|it| it.share).collect()
    }

    fn torques<'a>(
        &'a self,
        recordings: &'a [&CompensationShown],
    ) -> impl Iterator<Item = TorqueOfList> + 'a {
        let shares = recordings.iter().flat_map(|it| &it.shares);
        let own = shares.filter(|it| it.axis == self.axis && it.list == self.list);
        own.filter_map(|it| it.torque)
    }

    /// Returns in words what the torque of recordings leaves open, and what to record, after other sources of evidence.
    fn what_would_show(&self, other: &str, recordings: &[&CompensationShown]) -> String {
        let or_a_plant = match self.shows {
            Shows::Contour => ", or name a plant to be fitted",
            Shows::FollowingError => "",
        };
        together(&self.shares(recordings)).map_or_else(
            || format!(": record {other}actual torque and commanded position{or_a_plant}"),
            |[low, high]| {
                format!(
                    " (by its torque {low:.2} to {high:.2} of it): record {other}more feeds, over a decade{or_a_plant}"
                )
            },
        )
    }

    /// Returns the range of the shares that show something, if they are enough and more than the others.
    fn agreed(&self, shares: &[[f64; 2]], shows: impl Fn(&[f64; 2]) -> bool) -> Option<[f64; 2]> {
        let agree: Vec<&[f64; 2]> = shares.iter().filter(|it| shows(it)).collect();
        let is_enough = agree.len() >= self.shows.fewest() && 2 * agree.len() > shares.len();
        is_enough.then(|| {
            agree
                .iter()
                .fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], it| {
                    [low.min(it[0]), high.max(it[1])]
                })
        })
    }
}

/// Returns the range of shares of several recordings together, each weighted by its own range.
fn together(shares: &[[f64; 2]]) -> Option<[f64; 2]> {
    /// The least half of a range: what the delays that all recordings share leave unknown.
    const LEAST: f64 = 0.02;
    let halves = shares
        .iter()
        .map(|[low, high]| (0.5 * (high - low)).max(LEAST));
    let weights: Vec<f64> = halves.map(|it| it.powi(-2)).collect();
    let sum: f64 = weights.iter().sum();
    let middles = shares.iter().map(|[low, high]| f64::midpoint(*low, *high));
    let middle = middles
        .zip(&weights)
        .map(|(it, weight)| it * weight)
        .sum::<f64>()
        / sum;
    let half = sum.powf(-0.5);
    middle.is_finite().then_some([middle - half, middle + half])
}

/// A share that ends below this is not that of a whole list.
const WHOLE_BELOW: f64 = 0.75;

/// A share of more than this …
pub(super) const PART: f64 = 0.15;

/// … that begins above this is a part of a list.
pub(super) const SHOWN: f64 = 0.05;

/// A share of a list within this of 0, on either side, counts as no part of it.
pub(super) const NONE: f64 = 0.25;

#[cfg(test)]
mod tests {
    use super::*;

    const LIST: &str = "0123";

    /// Returns the evidence of a recording with a share of the list in its torque, and a friction as a part of the
    /// list.
    fn shown(share: Option<[f64; 2]>, friction: f64) -> CompensationShown {
        CompensationShown {
            switched: Vec::new(),
            shares: vec![ShareOfList {
                axis: "X".to_owned(),
                list: LIST.to_owned(),
                torque: Some(TorqueOfList { share, friction }),
            }],
        }
    }

    /// Returns the states of an axis in a round and in stage 1, whose recordings show these.
    fn states(off: &[CompensationShown], on: &[CompensationShown]) -> [SwitchedAs; 2] {
        let [off, on] = [off, on].map(|it| it.iter().collect::<Vec<_>>());
        let stages = StagesOfAxis {
            axis: "X",
            list: LIST,
            off: &off,
            on: &on,
            shows: Shows::Contour,
            plant: None,
        };
        [stages.was_on(), stages.was_off()]
    }

    fn is_named(state: &SwitchedAs, words: &str) -> bool {
        matches!(state, SwitchedAs::Otherwise(it) if it.contains(words))
    }

    #[test]
    fn torque_that_shows_the_list_shows_that_none_was_on_before() {
        // R16.13
        let of = |low: f64, high: f64| shown(Some([low, high]), 1.0);
        let whole = [of(0.8, 1.1), of(0.72, 1.0), of(0.2, 1.3)];
        let none = [of(-0.02, 0.05), of(-0.1, 0.1), of(-0.6, 0.7)];
        assert_eq!(
            states(&none, &whole),
            [SwitchedAs::Shown, SwitchedAs::Shown]
        );
        let half = [of(0.4, 0.6), of(0.45, 0.55), of(-0.6, 1.7)];
        let [on, off] = states(&half, &half);
        assert!(is_named(&on, "of the list of X was on"), "{on:?}");
        assert!(
            is_named(&off, "X was already compensated in stage 1"),
            "{off:?}"
        );
        // A tenth of a list: what is on is not known where the torque cannot show it.
        let wide = [of(-0.5, 1.5), of(-0.4, 1.2)];
        for state in states(&none, &wide)
            .iter()
            .chain(&states(&wide, &whole)[1..])
        {
            assert!(matches!(state, SwitchedAs::NotShown(_)), "{state:?}");
        }
    }

    #[test]
    fn without_torque_a_recorded_state_shows_stage_1_and_no_list() {
        // R16.13
        let unknown = || shown(None, 1.0);
        let switched = || CompensationShown {
            switched: vec!["X".to_owned()],
            ..CompensationShown::default()
        };
        let none = [CompensationShown::default()];
        for (off, is_shown) in [
            (vec![switched(), switched()], true),
            (vec![switched(), unknown()], false),
            (vec![], false),
        ] {
            let [on, off] = states(&off, &none);
            assert!(matches!(on, SwitchedAs::NotShown(_)), "{on:?}");
            assert_eq!(off == SwitchedAs::Shown, is_shown, "{off:?}");
        }
    }

    #[test]
    fn friction_of_steady_motion_tells_another_machine() {
        // R16.13
        let of = |friction: f64| [shown(Some([-0.1, 0.1]), friction), shown(None, friction)];
        for (off, on, words) in [
            (1.3, 1.0, "have more friction than those on, by 30 %"),
            (1.0, 1.3, "have less friction than those on, by 23 %"),
        ] {
            let [_, state] = states(&of(off), &of(on));
            assert!(is_named(&state, words), "{state:?}");
        }
        let [_, state] = states(&of(1.1), &of(1.0));
        assert!(matches!(state, SwitchedAs::NotShown(_)), "{state:?}");
    }
}
