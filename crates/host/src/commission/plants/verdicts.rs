//! The plant of each round, and what the recordings show about it.

use super::fitting::{Driven, RoundCircles, common_feeds, driven_in, has};
use super::fitting::{FittedAxis, Fitting, NoPlant, recorded_list};
use crate::disk::read_text;
use crate::error::HostError;
use crate::outputs::OutputFiles;
use frictcomp_recordings::commission::{
    ComparedGlitch, MissedPrediction, PlantFound, PlantVerdict, Plants, RecordedGlitch, Stage,
    against_plant,
};
use frictcomp_recordings::value_lists::tuned_on;

impl Fitting<'_> {
    /// Returns a plant for each round whose circles are recorded, fitted to those of all rounds up to it, and lists
    /// that are tuned on the last one.
    pub(crate) fn plants(&self, outputs: &mut OutputFiles) -> Result<Plants, HostError> {
        let [off, on] = [Stage::Off, Stage::On].map(|stage| self.driven(stage));
        let mut plants = Plants {
            is_wanted: true,
            ..Plants::default()
        };
        let axes = match self.axes() {
            Ok(axes) => axes,
            Err(reason) => {
                plants.lacking.push(reason);
                return Ok(plants);
            }
        };
        let off: Vec<Driven<'_>> = off.into_iter().flat_map(|it| it.circles).collect();
        let rounds: Vec<RoundCircles<'_>> =
            on.into_iter().filter(|it| !it.circles.is_empty()).collect();
        if rounds.is_empty() {
            let reason = "no circle is recorded with compensation on";
            plants.lacking.push(reason.to_owned());
        }
        for last in 0..rounds.len() {
            plants.lacking.clear();
            match self.plant_of_round(&axes, &off, rounds.split_at(last + 1), outputs) {
                Ok(verdict) => plants.verdicts.push(verdict),
                Err(NoPlant::Lacking(reason)) => plants.lacking.push(reason),
                Err(NoPlant::Failed(error)) => return Err(error),
            }
        }
        Ok(plants)
    }

    /// Returns the plant of the last one of some rounds, judged by them and by later ones whose lists were tuned on it.
    fn plant_of_round(
        &self,
        axes: &[FittedAxis<'_>],
        off: &[Driven<'_>],
        (fitted_to, later): (&[RoundCircles<'_>], &[RoundCircles<'_>]),
        outputs: &mut OutputFiles,
    ) -> Result<PlantVerdict, NoPlant> {
        let Some(last) = fitted_to.last() else {
            return Err(NoPlant::Lacking("no circle is recorded".to_owned()));
        };
        let feeds = common_feeds(off, last);
        let against = against_plant(&feeds);
        if !against.is_empty() {
            return Err(NoPlant::Lacking(against.join("; ")));
        }
        let recorded = (off, &feeds[..]);
        let mut found = self.fitted((axes, &feeds), off, fitted_to, outputs)?;
        self.predict(&mut found, axes, recorded, [None, None])?;
        let mut held_out = glitches(axes, off, [None, None], &found.held_out);
        for round in fitted_to {
            self.predict(&mut found, axes, recorded, round.lists())?;
            let on = glitches(axes, &round.circles, round.shas(), &found.held_out);
            held_out.extend(on);
        }
        let mut compared = found.compared(held_out);
        let [worse, mut retired] = missed(&compared);
        let mut rejected = found.against_fit();
        rejected.extend(worse);
        if rejected.is_empty() && retired.is_empty() && later.is_empty() {
            self.tuned(&mut found, axes, recorded, last, outputs)?;
        }
        for round in later {
            if !is_tuned_on(round, &found)? {
                continue;
            }
            self.predict(&mut found, axes, recorded, round.lists())?;
            let tried = glitches(axes, &round.circles, round.shas(), &feeds);
            let tried = found.compared(tried);
            let [worse, better] = missed(&tried);
            rejected.extend(worse);
            retired.extend(better);
            compared.extend(tried);
        }
        Ok(PlantVerdict {
            found,
            compared,
            rejected,
            retired,
            base: self.base.clone(),
        })
    }

    /// Returns the usable circles of each plan of a stage.
    fn driven(&self, stage: Stage) -> Vec<RoundCircles<'_>> {
        let plans = self.commissioning.plans.iter().enumerate();
        let of_stage = plans.filter(|(_, it)| it.plan.stage == stage);
        of_stage
            .map(|(at, plan)| RoundCircles {
                number: at + 1,
                plan,
                circles: driven_in(plan, self.results),
            })
            .collect()
    }
}

/// Returns the recorded glitches that are worse than predicted, and those that are better.
fn missed(compared: &[ComparedGlitch]) -> [Vec<String>; 2] {
    let mut found = [Vec::new(), Vec::new()];
    for missed in compared.iter().filter_map(ComparedGlitch::missed) {
        match missed {
            MissedPrediction::Worse(words) => found[0].push(words),
            MissedPrediction::Better(words) => found[1].push(words),
        }
    }
    found
}

/// Returns whether a list of a round was tuned on a plant.
fn is_tuned_on(round: &RoundCircles<'_>, found: &PlantFound) -> Result<bool, NoPlant> {
    for used in round.lists().into_iter().flatten() {
        let text = read_text(&recorded_list(used)?)?;
        if tuned_on(&text) == Some(found.key.as_str()) {
            return Ok(true);
        }
    }
    Ok(false)
}

/// Returns the recorded glitches of each axis at feeds.
fn glitches(
    axes: &[FittedAxis<'_>],
    circles: &[Driven<'_>],
    lists: [Option<&str>; 2],
    feeds: &[f64],
) -> Vec<RecordedGlitch> {
    let at_feeds = circles.iter().filter(|it| has(feeds, it.circles.feed));
    let each = at_feeds.flat_map(|driven| {
        let heights = driven.circles.heights_um.unwrap_or_default();
        axes.iter()
            .zip(heights)
            .zip(lists)
            .map(|((axis, (um, error_um)), list)| RecordedGlitch {
                axis: axis.name.to_owned(),
                feed: driven.circles.feed,
                list: list.map(str::to_owned),
                um,
                error_um,
            })
    });
    each.collect()
}
