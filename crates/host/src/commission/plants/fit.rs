//! Plants that are fitted to the circles of rounds, and their files.

use std::ops::ControlFlow;

use super::fitting::{Driven, RoundCircles, has};
use super::fitting::{FittedAxis, Fitting, NoPlant};
use crate::commission::CommissionError;
use crate::disk::{Replaces, read_text, sha256_of_data};
use crate::error::HostError;
use crate::outputs::OutputFiles;
use crate::workers::{in_order, processors};
use frictcomp::text::SourceFile;
use frictcomp_physics::circle::{DriveFit, FittedDrive, ObservedCircle, PlaneAxis};
use frictcomp_physics::current::Reading;
use frictcomp_physics::simulation::Plant;
use frictcomp_recordings::commission::{PlantAxis, PlantFound, Stage, held_out};

impl Fitting<'_> {
    /// Returns the plant of rounds: as found by an earlier run, or fitted now.
    pub(super) fn fitted(
        &self,
        (axes, feeds): (&[FittedAxis<'_>], &[f64]),
        off: &[Driven<'_>],
        rounds: &[RoundCircles<'_>],
        outputs: &mut OutputFiles,
    ) -> Result<PlantFound, NoPlant> {
        let key = self.key(axes, off, rounds);
        if let Some(known) = self.known.iter().find(|it| it.key == key) {
            self.write_plant(known, outputs)?;
            return Ok(known.clone());
        }
        let (fitted_feeds, held_out) = held_out(feeds);
        let observed = self.observed(&fitted_feeds, off, rounds)?;
        let fits = axes.iter().zip(observed).map(|(axis, circles)| DriveFit {
            axis: axis.plane,
            drive: axis.drive.clone(),
            reading: Reading::default(),
            circles,
        });
        let fits: Vec<DriveFit> = fits.collect();
        let mut fitted = Vec::new();
        in_order(fits.iter(), processors(), DriveFit::fit, |found| {
            fitted.push(found);
            ControlFlow::Continue(())
        });
        let fitted = fitted.into_iter().collect::<Result<Vec<_>, _>>()?;
        let round = rounds.last().map_or(1, |it| it.number);
        let toml = self.text(&fitted, (round, &key))?;
        let each = axes.iter().zip(&fitted);
        let found = PlantFound {
            key,
            round,
            axes: each
                .map(|(axis, it)| PlantAxis::of(axis.name, it))
                .collect(),
            fitted_feeds,
            held_out,
            glitches: Vec::new(),
            lists: Vec::new(),
            toml,
        };
        self.write_plant(&found, outputs)?;
        Ok(found)
    }

    /// Returns the SHA-256 of everything to which a plant is fitted.
    fn key(
        &self,
        axes: &[FittedAxis<'_>],
        off: &[Driven<'_>],
        rounds: &[RoundCircles<'_>],
    ) -> String {
        let reading = self.commissioning.reader.channels;
        let first = self
            .commissioning
            .plans
            .iter()
            .filter(|it| it.plan.stage == Stage::Off);
        let channels = first.map(|it| reading.of_circles(&it.plan));
        let channels: Vec<_> = channels.collect();
        let cycle = reading.cycle_s;
        let frictions: Vec<_> = axes.iter().map(|it| &it.drive).collect();
        let sums = |circles: &[Driven<'_>]| {
            let sums = circles.iter().map(|it| it.result.sha256.clone());
            sums.collect::<Vec<_>>()
        };
        let on = rounds.iter().map(|it| (it.shas(), sums(&it.circles)));
        let on: Vec<_> = on.collect();
        let off = sums(off);
        sha256_of_data(&(channels, cycle, frictions, off, on))
    }

    /// Returns the recorded reversals of each axis at the feeds of the fit.
    fn observed(
        &self,
        feeds: &[f64],
        off: &[Driven<'_>],
        rounds: &[RoundCircles<'_>],
    ) -> Result<[Vec<ObservedCircle>; 2], NoPlant> {
        let mut observed = [Vec::new(), Vec::new()];
        let lists = rounds.iter().map(|round| {
            let [x, y] = round
                .lists()
                .map(|it| it.map(|it| self.list(it)).transpose());
            Ok::<_, NoPlant>([x?, y?])
        });
        let lists = lists.collect::<Result<Vec<_>, _>>()?;
        let on = rounds
            .iter()
            .zip(&lists)
            .map(|(round, lists)| (&round.circles[..], lists));
        let without = [None, None];
        let last = lists.len();
        let questioned = lists.last().unwrap_or(&without);
        for (number, (circles, lists)) in std::iter::once((off, &without)).chain(on).enumerate() {
            for driven in circles.iter().filter(|it| has(feeds, it.circles.feed)) {
                let path = self
                    .commissioning
                    .folder
                    .join("recordings")
                    .join(&driven.result.file);
                let turns = self
                    .commissioning
                    .reader
                    .turns(&path, driven.plan, driven.radius);
                let turns = turns?;
                let circle = self.circle(driven);
                for (at, plane) in PlaneAxis::ALL.into_iter().enumerate() {
                    let of_axis = ObservedCircle::of(plane, (circle, lists[at].clone()), &turns);
                    observed[at].extend(of_axis.map(|mut it| {
                        it.may_be_on = questioned[at].clone().filter(|_| number == 0);
                        it.is_doubted = number == last && it.list.is_some();
                        it
                    }));
                }
            }
        }
        Ok(observed)
    }

    /// Returns the text of the plant file.
    fn text(&self, fitted: &[FittedDrive], (round, key): (usize, &str)) -> Result<String, NoPlant> {
        let [x, y] = fitted else {
            return Err(NoPlant::Lacking("a plant has two axes".to_owned()));
        };
        let plant = Plant {
            name: "fitted".to_owned(),
            x: x.drive.clone(),
            y: y.drive.clone(),
        };
        Ok(plant.to_toml(&[
            format!("Fitted to recorded circles off and on up to round {round}; mass, Kv and k_I are those of {}", self.base.name),
            format!("SHA-256 of what it was fitted to: {key}"),
        ]))
    }

    /// Writes the plant file, under a name derived from its content.
    fn write_plant(&self, found: &PlantFound, outputs: &mut OutputFiles) -> Result<(), HostError> {
        let sum = found.key.get(..8).unwrap_or(&found.key);
        let name = format!("round-{}-{sum}.toml", found.round);
        let path = self.commissioning.folder.join("plants").join(name);
        if read_text(&path).is_ok_and(|there| there == found.toml) {
            return Ok(());
        }
        let mut file = outputs.create_in_folder("the fitted plant", &path, Replaces::Results)?;
        file.bytes(found.toml.as_bytes())
    }
}

/// Returns the fitted plant.
pub(super) fn plant_of(found: &PlantFound) -> Result<Plant, HostError> {
    let source = SourceFile::new("fitted".to_owned(), found.toml.clone());
    let plant = Plant::from_toml(source);
    Ok(plant.map_err(|error| CommissionError::FittedPlant(error.to_string()))?)
}
