//! Recorded glitches off and on, each axis, each direction, each feed for itself (R16.12).

use serde::{Deserialize, Serialize};

use super::request::MeasuredAxis;
use super::results::RecordingResult;
use frictcomp_physics::circle::{Direction, GlitchOrder, MeasuredGlitch};

/// Recorded glitches at a feed with compensation off and on: in µm, or 0.001° of a rotary axis.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct BeforeAfter {
    /// The planned feed in mm/min or °/min.
    pub feed: f64,
    /// The feed that was driven.
    pub driven: f64,
    /// The largest glitch with compensation off.
    pub off: f64,
    /// The largest glitch with compensation on.
    pub on: f64,
    /// Each axis in each direction.
    pub places: Vec<PlaceCompared>,
}

/// The recorded glitch of an axis in a direction of travel with compensation off and on.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct PlaceCompared {
    /// Name of the axis.
    pub axis: String,
    /// The direction of travel on a circle.
    pub direction: Option<String>,
    /// The glitch with compensation off.
    pub off: MeasuredGlitch,
    /// The glitch with compensation on.
    pub on: MeasuredGlitch,
}

impl PlaceCompared {
    /// Returns whether compensation leaves clearly less than is left without it.
    pub fn shows_an_effect(&self) -> bool {
        const LEAST: f64 = 0.05;
        self.on.um < self.off.um * (1.0 - LEAST)
            && self.on.compared_with(&self.off) == GlitchOrder::Smaller
    }

    /// Returns whether what compensation leaves cannot be told from noise, or from the resolution of positions
    /// (R16.14).
    pub(super) fn leaves_only_noise(&self) -> bool {
        const ERRORS: f64 = 2.0;
        const RESOLUTION: f64 = 0.1;
        self.on.um < (ERRORS * self.on.error_um).max(RESOLUTION)
    }

    /// Returns whether compensation leaves at most a part of the glitch without it.
    pub(super) fn leaves_at_most(&self, part: f64) -> bool {
        self.on.um < self.off.um * part
    }

    /// Returns the axis with its direction, for a sentence.
    pub(super) fn name(&self) -> String {
        match &self.direction {
            Some(direction) => format!("{} {direction}", self.axis),
            None => self.axis.clone(),
        }
    }

    /// Returns whether another one is that of the same axis and direction.
    pub(super) fn is_as(&self, other: &Self) -> bool {
        self.axis == other.axis && self.direction == other.direction
    }
}

impl BeforeAfter {
    /// Returns the axis and direction of another feed, here.
    pub(super) fn at(&self, other: &PlaceCompared) -> Option<&PlaceCompared> {
        self.places.iter().find(|it| it.is_as(other))
    }

    /// Returns the places of an axis.
    pub(super) fn of_axis(&self, axis: &str) -> impl Iterator<Item = &PlaceCompared> {
        self.places.iter().filter(move |it| it.axis == axis)
    }

    fn of(feed: f64, driven: f64, places: Vec<PlaceCompared>) -> Self {
        let largest = |of: fn(&PlaceCompared) -> f64| places.iter().map(of).fold(0.0, f64::max);
        Self {
            feed,
            driven,
            off: largest(|it| it.off.um),
            on: largest(|it| it.on.um),
            places,
        }
    }
}

/// Returns the glitch of a place in one of several recordings: the smallest without, the largest with compensation.
fn taken(
    recordings: &[&AtFeed],
    place: GlitchPlace,
    is_taken: impl Fn(f64, f64) -> bool,
) -> Option<MeasuredGlitch> {
    let all = recordings.iter().flat_map(|it| &it.glitches);
    let of_place = all.filter(|it| it.0 == place).map(|it| it.1);
    of_place.reduce(|one, other| {
        if is_taken(other.um, one.um) {
            other
        } else {
            one
        }
    })
}

/// Returns the feeds that were recorded with compensation off and on, and with no reasons against the recordings,
/// slowest first. Programs are recognised by their numbers. Of several recordings those count that were driven at the
/// feed of the program, otherwise those next to it; of those the smallest glitch without and the largest with
/// compensation, for each axis and direction.
pub(super) fn before_after(
    results: &[RecordingResult],
    axes: &[MeasuredAxis],
    (is_off, is_on): (impl Fn(u16) -> bool, impl Fn(u16) -> bool),
) -> Vec<BeforeAfter> {
    let recorded = |is_so: &dyn Fn(u16) -> bool| {
        let used = results.iter().filter(|it| it.found.against().is_empty());
        let used = used.filter(|it| it.program.is_some_and(is_so));
        let shown = used.flat_map(|it| it.found.reversals());
        shown.filter(AtFeed::is_near).collect::<Vec<AtFeed>>()
    };
    let [off, on] = [recorded(&is_off), recorded(&is_on)];
    let mut feeds: Vec<f64> = off.iter().map(|it| it.feed).collect();
    feeds.sort_by(f64::total_cmp);
    feeds.dedup();
    let at = |feed: f64| {
        let of_feed = off.iter().filter(|it| it.feed.total_cmp(&feed).is_eq());
        let has_on = |off: &&AtFeed| on.iter().any(|it| off.is_driven_as(it));
        let of_feed: Vec<&AtFeed> = of_feed.filter(has_on).collect();
        let besides = of_feed.iter().map(|it| it.beside());
        let least = besides.min_by(f64::total_cmp)?;
        let nearest = of_feed
            .into_iter()
            .filter(|it| it.beside().total_cmp(&least).is_eq());
        let nearest: Vec<&AtFeed> = nearest.collect();
        let first = nearest.first()?;
        let with = on
            .iter()
            .filter(|on| nearest.iter().any(|it| it.is_driven_as(on)));
        let with: Vec<&AtFeed> = with.collect();
        let places = first.glitches.iter().filter_map(|(place, _)| {
            Some(PlaceCompared {
                axis: axes.get(place.0)?.name.clone(),
                direction: place.1.map(|it| it.as_str().to_owned()),
                off: taken(&nearest, *place, |other, one| other < one)?,
                on: taken(&with, *place, |other, one| other > one)?,
            })
        });
        Some(BeforeAfter::of(feed, first.driven, places.collect()))
    };
    feeds.into_iter().filter_map(at).collect()
}

/// Part within which a measured speed is the planned one.
pub(super) const ON_FEED: f64 = 0.02;

/// Part within which the driven feeds of two compared recordings differ: v²/R by 5 %.
const SAME_FEED: f64 = 0.025;

/// A recording represents its planned feed if it was driven at no less than this part of it …
const SLOWEST: f64 = 0.8;

/// … and at no more than this.
const FASTEST: f64 = 1.25;

/// The glitches of a recording at a feed.
#[derive(Debug, Clone)]
pub(super) struct AtFeed {
    /// The planned feed.
    pub(super) feed: f64,
    pub(super) driven: f64,
    /// The glitch of each axis, by its place in the plan, in each direction of travel, if it has one.
    pub(super) glitches: Vec<(GlitchPlace, MeasuredGlitch)>,
}

/// An axis, by its place in the plan, and the direction of travel on a circle.
pub(super) type GlitchPlace = (usize, Option<Direction>);

impl AtFeed {
    pub(super) fn is_near(&self) -> bool {
        (SLOWEST..=FASTEST).contains(&(self.driven / self.feed))
    }

    /// Returns the deviation from the planned feed as a part of it; 0 within 2 %.
    pub(super) fn beside(&self) -> f64 {
        let part = (self.driven / self.feed - 1.0).abs();
        if part <= ON_FEED { 0.0 } else { part }
    }

    /// Returns whether another recording of the planned feed was driven at about the same feed.
    pub(super) fn is_driven_as(&self, other: &Self) -> bool {
        self.feed.total_cmp(&other.feed).is_eq()
            && (other.driven / self.driven - 1.0).abs() < SAME_FEED
    }
}
