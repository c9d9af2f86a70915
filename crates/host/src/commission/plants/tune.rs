//! The predictions of fitted plants, and the lists that are tuned on them.

use std::path::PathBuf;

use super::fit::plant_of;
use super::fitting::{Driven, RoundCircles, has};
use super::fitting::{FittedAxis, Fitting, NoPlant};
use crate::disk::{read_text, sha256_of_data, sha256_of_text};
use crate::error::HostError;
use crate::outputs::OutputFiles;
use crate::simulations::tune;
use frictcomp::lists::{FrictionList, Points};
use frictcomp::text::shown_path;
use frictcomp_physics::circle::{PlaneAxis, Ranges, Shaping, Task, TuningAim, predicted_height_um};
use frictcomp_physics::current::Reading;
use frictcomp_physics::simulation::FrictionModel;
use frictcomp_recordings::commission::{
    MOST_CURRENT, PlantFound, PredictedGlitch, TunedList, ValueListUsed,
};

use frictcomp_recordings::value_lists::{TunedFrom, render_tuned_on_plant};

/// The circles recorded off, and the feeds recorded both off and on.
pub(super) type RecordedFeeds<'a> = (&'a [Driven<'a>], &'a [f64]);

impl Fitting<'_> {
    /// Adds the predicted glitches at recorded feeds with the lists of both axes, or without.
    pub(super) fn predict(
        &self,
        found: &mut PlantFound,
        axes: &[FittedAxis<'_>],
        recorded: RecordedFeeds<'_>,
        lists: [Option<&ValueListUsed>; 2],
    ) -> Result<(), NoPlant> {
        for (axis, used) in axes.iter().zip(lists) {
            let sha256 = used.map(|it| it.sha256.as_str());
            let is_known = |feed: &f64| found.predicted(axis.name, *feed, sha256).is_some();
            if recorded.1.iter().all(is_known) {
                continue;
            }
            let list = used.map(|it| self.list(it)).transpose()?;
            self.predict_axis(found, axis, recorded, (sha256, list.as_ref()))?;
        }
        Ok(())
    }

    /// Adds the predicted glitches of an axis, and returns the largest one in µm.
    fn predict_axis(
        &self,
        found: &mut PlantFound,
        axis: &FittedAxis<'_>,
        (off, feeds): RecordedFeeds<'_>,
        (sha256, list): (Option<&str>, Option<&FrictionList>),
    ) -> Result<f64, NoPlant> {
        let plant = plant_of(found)?;
        let drive = match axis.plane {
            PlaneAxis::X => &plant.x,
            _ => &plant.y,
        };
        let mut worst: f64 = 0.0;
        for driven in off.iter().filter(|it| has(feeds, it.circles.feed)) {
            let circle = self.circle(driven);
            let drive = (axis.plane, drive);
            let predicted_um = predicted_height_um(drive, circle, list, Reading::default())?;
            worst = worst.max(predicted_um);
            found.glitches.push(PredictedGlitch {
                axis: axis.name.to_owned(),
                feed: driven.circles.feed,
                list: sha256.map(str::to_owned),
                predicted_um,
            });
        }
        Ok(worst)
    }

    /// Tunes a list for each axis at the feeds of the fit, and judges it at those that were held out; lists of an
    /// earlier run stay.
    pub(super) fn tuned(
        &self,
        found: &mut PlantFound,
        axes: &[FittedAxis<'_>],
        recorded: RecordedFeeds<'_>,
        round: &RoundCircles<'_>,
        outputs: &mut OutputFiles,
    ) -> Result<(), NoPlant> {
        if found.held_out.is_empty() || self.has_lists(found) {
            return Ok(());
        }
        let task = self.task(found, recorded.0)?;
        let tuned = tune(&task, self.watch)?;
        found.lists.clear();
        let old = round.shas();
        for ((axis, tuned), old) in axes.iter().zip(&tuned.axes).zip(old) {
            let Some(list) = tuned.list() else { continue };
            let list = axis.friction.bounded(list);
            let from = TunedFrom {
                axis: axis.name,
                plant: &found.key,
                feeds: &found.fitted_feeds,
                held_out: &found.held_out,
            };
            let text = render_tuned_on_plant(&list, from, self.commissioning.build);
            let sha256 = sha256_of_text(&text);
            let name = format!("{}-tuned", axis.name);
            let path = self.commissioning.write_list(&name, &text, outputs)?;
            let on = (Some(sha256.as_str()), Some(&list));
            let predicted_um = self.predict_axis(found, axis, recorded, on)?;
            let mut against = found.fails_held_out(axis.name, &sha256, old);
            against.extend(old.and_then(|old| found.no_gain(axis.name, &sha256, old)));
            let strongest = axis.friction.strongest(&list);
            if let Some((speed, part)) = strongest.filter(|it| it.1 > MOST_CURRENT) {
                against.push(format!(
                    "at {speed:.3} mm/s it adds {part:.2} times the measured friction; the limit is {MOST_CURRENT}"
                ));
            }
            found.lists.push(TunedList {
                axis: axis.name.to_owned(),
                file: shown_path(&path),
                sha256,
                tuned_with: self.tuned_with(),
                predicted_um,
                against,
            });
        }
        Ok(())
    }

    /// Returns whether the lists of a plant exist, tuned with the same options.
    fn has_lists(&self, found: &PlantFound) -> bool {
        let is_there = |it: &TunedList| {
            let text = read_text(&PathBuf::from(&it.file));
            it.tuned_with == self.tuned_with()
                && text.is_ok_and(|text| sha256_of_text(&text) == it.sha256)
        };
        !found.lists.is_empty() && found.lists.iter().all(is_there)
    }

    /// Returns the options that affect how lists are tuned.
    fn tuned_with(&self) -> String {
        let shaping = self.commissioning.shaping == Shaping::Allowed;
        let build = self.commissioning.build.map(|it| it.to_string());
        sha256_of_data(&(shaping, build))
    }

    /// Returns the tuning task for the circles of the fit on the fitted plant.
    fn task(&self, found: &PlantFound, off: &[Driven<'_>]) -> Result<Task, HostError> {
        let fitted = |it: &&Driven<'_>| has(&found.fitted_feeds, it.circles.feed);
        let circles = off.iter().filter(fitted).map(|it| self.circle(it));
        Ok(Task {
            plant: plant_of(found)?,
            model: FrictionModel::default(),
            circles: circles.collect(),
            ranges: Ranges::default(),
            reading: Reading::default(),
            points: Points::of_build(self.commissioning.build),
            shaping: self.commissioning.shaping,
            aim: if found.is_determined() {
                TuningAim::Plant
            } else {
                TuningAim::Robust
            },
        })
    }
}
