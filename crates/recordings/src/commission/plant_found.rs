//! The plant that was fitted to recorded circles, its predictions, and the reasons against it (R16.3, R16.9).

use serde::{Deserialize, Serialize};

use super::switched::{NONE, PART, SHOWN};
use crate::identify::Fit;
use frictcomp_physics::circle::{Extent, FittedDrive};
use frictcomp_physics::simulation::DriveParameters;

/// Minimum number of feeds that a plant is fitted to.
const FITTED_FEEDS: usize = 4;

/// Minimum ratio of the fastest of them to the slowest: a decade, less the tolerance of the driven feed.
const DECADE: f64 = 9.8;

/// Number of feeds of which one is held out.
const HELD_OUT: usize = 3;

/// A prediction may miss the recording by this part of it …
const MISSED: f64 = 0.25;

/// … or by this, in µm …
const MISSED_UM: f64 = 0.5;

/// … or by this many standard errors of the recording.
const MISSED_ERRORS: f64 = 3.0;

/// Predictions that differ by less than this in µm are the same.
const SAME_UM: f64 = 0.1;

/// Part that a list may leave to be a gain.
const GAIN: f64 = 0.95;

/// A plant with the results based on it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct PlantFound {
    /// The SHA-256 of all that it was fitted to.
    pub key: String,
    /// The last round of stage 2 whose circles it was fitted to.
    pub round: usize,
    /// The axes of the plan.
    #[serde(rename = "predicted_axes")]
    pub axes: Vec<PlantAxis>,
    /// The feeds in mm/min that it was fitted to.
    pub fitted_feeds: Vec<f64>,
    /// Recorded feeds that neither the fit nor the tuning has seen.
    pub held_out: Vec<f64>,
    /// The glitch of each axis at each recorded feed.
    #[serde(rename = "predicted_glitches")]
    pub glitches: Vec<PredictedGlitch>,
    /// The tuned lists, once there are any.
    pub lists: Vec<TunedList>,
    /// The plant file.
    #[serde(rename = "predicted_plant")]
    pub toml: String,
}

/// The fitted parameters of an axis.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct PlantAxis {
    /// Name of the axis.
    pub axis: String,
    /// Stiffness of the contact in N/m.
    pub contact: Extent,
    /// Kp in N·s/m.
    pub speed_gain: Extent,
    /// Coulomb friction in N.
    pub coulomb: Extent,
    /// Delay of the loop in s.
    pub delay: Extent,
    /// Damping of the contact in N·s/m.
    pub damping: Extent,
    /// Travel in m by which the load lags behind the motor after a reversal.
    pub lost: Extent,
    /// The share of the list of the last round that explains its circles.
    pub share_on: Option<Extent>,
    /// The share of that list that explains the circles off.
    pub share_off: Option<Extent>,
    /// The root mean square of the recorded deviations that is left, in µm.
    pub left: f64,
    /// Number of recorded reversals.
    pub reversals: usize,
    /// Number of simulated ones.
    pub simulations: usize,
}

/// A predicted glitch.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct PredictedGlitch {
    /// Name of the axis.
    pub axis: String,
    /// The planned feed in mm/min.
    pub feed: f64,
    /// The SHA-256 of the list that is on.
    pub list: Option<String>,
    /// The glitch in µm.
    #[serde(rename = "predicted_glitch")]
    pub predicted_um: f64,
}

/// A recorded glitch for comparison with a prediction.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct RecordedGlitch {
    /// Name of the axis.
    pub axis: String,
    /// The planned feed in mm/min.
    pub feed: f64,
    /// The SHA-256 of the list that was on.
    pub list: Option<String>,
    /// The glitch in µm.
    #[serde(rename = "recorded_glitch")]
    pub um: f64,
    /// Standard error.
    #[serde(rename = "recorded_error")]
    pub error_um: f64,
}

/// A recorded glitch at a feed that neither the fit nor the tuning has seen, or with a list that was tuned on the
/// plant, with its prediction.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[non_exhaustive]
pub struct ComparedGlitch {
    /// The recorded glitch.
    #[serde(flatten)]
    pub recorded: RecordedGlitch,
    /// The predicted one in µm.
    #[serde(rename = "predicted_glitch")]
    pub predicted_um: f64,
}

/// A list that was tuned on the plant.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct TunedList {
    /// Name of the axis.
    pub axis: String,
    /// The file, as it is shown.
    pub file: String,
    /// The SHA-256 of its bytes.
    pub sha256: String,
    /// The SHA-256 of the options with which it was tuned.
    pub tuned_with: String,
    /// The largest predicted glitch in µm over all recorded feeds.
    #[serde(rename = "predicted_glitch")]
    pub predicted_um: f64,
    /// Reasons why it is not to be recorded.
    pub against: Vec<String>,
}

impl PlantAxis {
    /// Returns the parameters of a fitted drive.
    pub fn of(axis: &str, fitted: &FittedDrive) -> Self {
        Self {
            axis: axis.to_owned(),
            contact: fitted.contact,
            speed_gain: fitted.speed_gain,
            coulomb: fitted.coulomb,
            delay: fitted.delay_s,
            damping: fitted.damping,
            lost: fitted.lost_m,
            share_on: fitted.shares.map(|it| it.on),
            share_off: fitted.shares.map(|it| it.off),
            left: fitted.left_um,
            reversals: fitted.reversals,
            simulations: fitted.simulations,
        }
    }

    /// States that the friction in the circles off is not that of constant speeds, if they show it: a list was already
    /// on, or it is another machine or state (R16.13).
    pub fn other_friction_off(&self) -> Option<String> {
        let share = self.share_off.filter(|it| it.value.abs() > PART)?;
        let told = format!("{:.2} to {:.2}", share.low, share.high);
        if share.low > SHOWN {
            return Some(format!(
                "{} was already compensated in stage 1: its circles off are those of {:.2} of the list ({told})",
                self.axis, share.value
            ));
        }
        (share.high < -SHOWN).then(|| {
            format!(
                "the circles of {} off have more friction than its constant speeds, by {:.2} of the list ({told}): \
                 another machine, or a colder one",
                self.axis, -share.value
            )
        })
    }

    /// Returns whether its circles show that no list was on in stage 1: the range of the share is about 0 (R16.13).
    pub(super) fn is_off_shown(&self) -> bool {
        self.share_off
            .is_some_and(|it| it.low >= -NONE && it.high <= NONE)
    }

    /// States that not all of the list of the last round was on, if its circles do not show it (R16.13).
    pub fn not_on(&self) -> Option<String> {
        const RANGE: std::ops::RangeInclusive<f64> = 0.75..=1.25;
        let share = self.share_on?;
        (!(RANGE.contains(&share.low) && RANGE.contains(&share.high))).then(|| {
            format!(
                "the circles of {} are those of {:.2} of its list ({:.2} to {:.2}): nothing shows that all of it was on",
                self.axis, share.value, share.low, share.high
            )
        })
    }

    /// Names a parameter that ends at the bound of its search. Damping is left out: it is hardly ever determined.
    fn at_a_bound(&self) -> Option<String> {
        let found = [
            ("the contact", self.contact),
            ("Kp", self.speed_gain),
            ("Fc", self.coulomb),
            ("the delay", self.delay),
        ];
        let bound = found.into_iter().find(|(_, it)| it.at_bound);
        bound.map(|(name, _)| {
            format!(
                "{name} of {} ends at the bound of its search: mass, loops or friction are not those of this machine, \
                 or the recordings are of two states of it",
                self.axis
            )
        })
    }
}

/// A prediction that a recording misses.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub enum MissedPrediction {
    /// Larger glitch than predicted: evidence against plant and list.
    Worse(String),
    /// Smaller glitch than predicted: evidence against the plant only (R16.16).
    Better(String),
}

impl ComparedGlitch {
    /// States how far the recording misses the prediction, if it does.
    pub fn missed(&self) -> Option<MissedPrediction> {
        let (recorded, predicted) = (&self.recorded, self.predicted_um);
        let most = MISSED_UM
            .max(MISSED * recorded.um)
            .max(MISSED_ERRORS * recorded.error_um);
        if (predicted - recorded.um).abs() <= most {
            return None;
        }
        let words = format!(
            "at F{} {predicted:.1} µm were predicted for {} {}, and {:.1} µm are recorded",
            recorded.feed,
            recorded.axis,
            recorded.state(),
            recorded.um
        );
        Some(if recorded.um > predicted {
            MissedPrediction::Worse(words)
        } else {
            MissedPrediction::Better(words)
        })
    }
}

impl RecordedGlitch {
    /// Returns the state of a list as a word.
    pub fn state(&self) -> &'static str {
        if self.list.is_some() { "on" } else { "off" }
    }
}

impl PlantFound {
    /// Returns whether the stiffness of each contact is determined.
    pub fn is_determined(&self) -> bool {
        self.axes.iter().all(|it| it.contact.is_determined())
    }

    /// Returns all recorded feeds in mm/min, slowest first.
    pub fn feeds(&self) -> Vec<f64> {
        let mut feeds = [&self.fitted_feeds[..], &self.held_out].concat();
        feeds.sort_by(f64::total_cmp);
        feeds
    }

    /// Returns whether neither the fit nor the tuning has seen a feed.
    pub fn is_held_out(&self, feed: f64) -> bool {
        self.held_out.iter().any(|it| it.total_cmp(&feed).is_eq())
    }

    /// Returns the glitch of an axis that is predicted at a feed with a list.
    pub fn predicted(&self, axis: &str, feed: f64, list: Option<&str>) -> Option<f64> {
        let found = self.glitches.iter().find(|it| {
            it.axis == axis && it.feed.total_cmp(&feed).is_eq() && it.list.as_deref() == list
        });
        found.map(|it| it.predicted_um)
    }

    /// Reasons against the fit itself.
    pub fn against_fit(&self) -> Vec<String> {
        let bounds = self.axes.iter().filter_map(PlantAxis::at_a_bound);
        let already = self.axes.iter().filter_map(PlantAxis::other_friction_off);
        bounds.chain(already).collect()
    }

    /// Returns the recorded glitches with their predictions.
    pub fn compared(&self, recorded: Vec<RecordedGlitch>) -> Vec<ComparedGlitch> {
        let compared = recorded.into_iter().filter_map(|recorded| {
            let list = recorded.list.as_deref();
            let predicted_um = self.predicted(&recorded.axis, recorded.feed, list)?;
            Some(ComparedGlitch {
                recorded,
                predicted_um,
            })
        });
        compared.collect()
    }

    /// Returns the largest predicted glitch of an axis with a list over all recorded feeds; `None` without a
    /// prediction.
    pub fn largest(&self, axis: &str, list: &str) -> Option<f64> {
        let feeds = self.feeds().into_iter();
        let predicted = feeds.filter_map(|feed| self.predicted(axis, feed, Some(list)));
        predicted.max_by(f64::total_cmp)
    }

    /// States that a list is predicted to leave hardly less than the old one, if so.
    pub fn no_gain(&self, axis: &str, list: &str, old: &str) -> Option<String> {
        let new_um = self.largest(axis, list)?;
        let old_um = self.largest(axis, old)?;
        (new_um > GAIN * old_um).then(|| {
            format!(
                "at most {new_um:.1} µm are predicted, and {old_um:.1} µm with the list that was recorded last: it is \
                 no gain"
            )
        })
    }

    /// Returns the held-out feeds at which a list is predicted to leave more than is left without a list, or with the
    /// old one.
    pub fn fails_held_out(&self, axis: &str, list: &str, old: Option<&str>) -> Vec<String> {
        let mut against = Vec::new();
        for &feed in &self.held_out {
            let Some(new_um) = self.predicted(axis, feed, Some(list)) else {
                continue;
            };
            let off = Some((None, "without a list"));
            let on = old.map(|old| (Some(old), "with the old list"));
            let worse = off.into_iter().chain(on).find_map(|(list, what)| {
                let before = self.predicted(axis, feed, list)?;
                (new_um > before + SAME_UM).then_some((before, what))
            });
            if let Some((before, what)) = worse {
                against.push(format!(
                    "at F{feed}, which was held out, {new_um:.1} µm are predicted, more than {before:.1} µm {what}"
                ));
            }
        }
        against
    }
}

/// Divides recorded feeds, slowest first, into those of the fit and those that are held out: one of three, never
/// the slowest or the fastest, and never so many that too few are left to fit.
pub fn held_out(feeds: &[f64]) -> (Vec<f64>, Vec<f64>) {
    let most = feeds.len().saturating_sub(FITTED_FEEDS);
    let count = most.min(feeds.len().div_ceil(HELD_OUT));
    let is_out = |at: usize| (1..=count).any(|it| at == it * feeds.len() / (count + 1));
    let each = feeds.iter().enumerate();
    let (out, fitted): (Vec<_>, Vec<_>) = each.partition(|(at, _)| is_out(*at));
    let of = |feeds: Vec<(usize, &f64)>| feeds.into_iter().map(|it| *it.1).collect();
    (of(fitted), of(out))
}

/// Reasons why no plant is fitted to circles at these feeds, slowest first, recorded off and on.
pub fn against_plant(feeds: &[f64]) -> Vec<String> {
    let mut against = Vec::new();
    if feeds.len() < FITTED_FEEDS {
        against.push(format!(
            "{} feeds are recorded both off and on, and {FITTED_FEEDS} are needed",
            feeds.len()
        ));
    }
    if let [slowest, .., fastest] = feeds
        && fastest / slowest < DECADE
    {
        against.push(format!(
            "the fastest recorded feed is {:.1} times the slowest; a decade is needed",
            fastest / slowest
        ));
    }
    against
}

/// Returns the drive of a plant with the friction that `identify` found, in drive units.
pub fn with_friction(drive: &DriveParameters, fit: &Fit) -> DriveParameters {
    const MM_PER_M: f64 = 1000.0;
    let mut drive = drive.clone();
    let force = drive.force_per_unit_n.abs();
    let friction = &mut drive.friction;
    friction.coulomb_n = fit.coulomb.abs() * force;
    friction.breakaway_n = fit.breakaway.abs() * force;
    friction.viscous_n_s_per_m = fit.viscous.abs() * force * MM_PER_M;
    friction.stribeck_velocity_m_per_s = fit.stribeck / MM_PER_M;
    friction.shape = fit.shape;
    drive
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn inner_feeds_are_held_out_and_four_are_left() {
        // R16.2
        let feeds = |count: usize| -> Vec<f64> { (1u32..).take(count).map(f64::from).collect() };
        for (count, expected) in [
            (4, vec![]),
            (5, vec![3.0]),
            (6, vec![3.0, 5.0]),
            (9, vec![3.0, 5.0, 7.0]),
        ] {
            let (fitted, out) = held_out(&feeds(count));
            assert_eq!(out, expected, "{count}");
            assert_eq!(fitted.len() + out.len(), count);
            assert_eq!(
                (fitted[0], fitted[fitted.len() - 1]),
                (1.0, feeds(count)[count - 1])
            );
        }
    }

    fn plant(predicted_um: f64) -> PlantFound {
        PlantFound {
            key: String::new(),
            round: 2,
            axes: Vec::new(),
            fitted_feeds: Vec::new(),
            held_out: vec![1000.0],
            glitches: vec![PredictedGlitch {
                axis: "X".to_owned(),
                feed: 1000.0,
                list: None,
                predicted_um,
            }],
            lists: Vec::new(),
            toml: String::new(),
        }
    }

    #[test]
    fn a_prediction_misses_by_a_quarter_and_half_a_um() {
        // R16.9, R16.15, R16.16
        let missed = |predicted: f64, um: f64, error_um: f64| {
            let recorded = RecordedGlitch {
                axis: "X".to_owned(),
                feed: 1000.0,
                list: None,
                um,
                error_um,
            };
            match plant(predicted).compared(vec![recorded])[0].missed() {
                None => 0,
                Some(MissedPrediction::Worse(_)) => 1,
                Some(MissedPrediction::Better(_)) => -1,
            }
        };
        assert_eq!([1.4, 1.6, 0.4].map(|it| missed(it, 1.0, 0.0)), [0, -1, 1]);
        assert_eq!(
            [12.4, 12.6, 7.4].map(|it| missed(it, 10.0, 0.0)),
            [0, -1, 1]
        );
        assert_eq!(
            [12.6, 7.4].map(|it| missed(it, 10.0, 1.0)),
            [0, 0],
            "three errors"
        );
    }

    #[test]
    fn a_value_at_the_bound_of_its_search_speaks_against_the_plant() {
        // R16.9: also if other selections of the reversals give the range a width.
        let extent = |at_bound| Extent {
            value: 2.0,
            low: 1.8,
            high: 2.1,
            at_bound,
        };
        let axis = |bounds: [bool; 5]| PlantAxis {
            axis: "X".to_owned(),
            contact: extent(bounds[0]),
            speed_gain: extent(bounds[1]),
            coulomb: extent(bounds[2]),
            delay: extent(bounds[3]),
            damping: extent(bounds[4]),
            lost: extent(false),
            share_on: None,
            share_off: None,
            left: 0.1,
            reversals: 40,
            simulations: 900,
        };
        let against = |bounds| {
            let mut found = plant(1.0);
            found.axes = vec![axis([false; 5]), axis(bounds)];
            found.against_fit()
        };
        assert!(against([false, false, false, false, true]).is_empty());
        for (at, name) in ["the contact of X", "Kp of X", "Fc of X", "the delay of X"]
            .into_iter()
            .enumerate()
        {
            let against = against(std::array::from_fn(|it| it == at));
            assert!(
                against.len() == 1 && against[0].starts_with(name),
                "{against:?}"
            );
        }
    }

    #[test]
    fn few_or_close_feeds_make_no_plant() {
        // R16.3
        assert!(against_plant(&[500.0, 1300.0, 2000.0, 4990.0]).is_empty());
        let against = against_plant(&[2000.0, 3000.0, 5000.0]);
        assert!(against[0].contains("3 feeds are recorded"), "{against:?}");
        assert!(against[1].contains("2.5 times"), "{against:?}");
    }
}
