//! The recordings of a commissioning, evaluated: lists, plants, rounds, and what is missing (R16.2, R16.9).

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use super::error::CommissionError;
use super::plants::Fitting;
use super::reading::CommissionReader;
use crate::disk::{Disk, FileRegistry, Replaces, read_text, sha256_of, sha256_of_text};
use crate::error::HostError;
use crate::machines::{find_plant, read_value_list};
use crate::outputs::OutputFiles;
use crate::watch::Watch;
use crate::workers::memory_for_simulation;
use frictcomp::comp::CncBuild;
use frictcomp::lists::FrictionList;
use frictcomp::text::shown_path;
use frictcomp_physics::circle::Shaping;
use frictcomp_physics::simulation::Preset;
use frictcomp_recordings::commission::{
    AxisVerdict, FrictionFound, InputFile, MOST_CURRENT, MeasuredAxis, PlanFile, PlantFound,
    Plants, RecordedRound, RecordingResult, Results, ResultsReport, Round, Stage, refuse_strangers,
    source_of,
};
use frictcomp_recordings::value_lists::{DRIVE_UNITS, IdentifiedFrom, render_identified, tuned_on};

/// The file of the results.
const RESULTS: &str = "results.json";

/// Returns the file name of the plan of a round.
pub(super) fn plan_name(round: u16) -> String {
    format!("plan-{round}.json")
}

/// Reads the plans in the folder of a commissioning: of stage 1, if it exists, and of each round of stage 2.
///
/// # Errors
/// There is none, or one cannot be read.
pub fn read_plans(folder: &Path, registry: &FileRegistry) -> Result<Vec<PlanFile>, HostError> {
    let mut plans = Vec::new();
    for round in 1.. {
        let path = folder.join(plan_name(round));
        if !path.exists() && round > 1 {
            break;
        }
        if !path.exists() {
            continue;
        }
        registry.reads("plan", &path);
        let plan: PlanFile = serde_json::from_str(&read_text(&path)?).map_err(|reason| {
            CommissionError::NotAPlan {
                path: path.clone(),
                reason: reason.to_string(),
            }
        })?;
        if plan.schema != PlanFile::SCHEMA {
            return Err(CommissionError::PlanForm {
                path,
                found: plan.schema,
            }
            .into());
        }
        plans.push(plan);
    }
    if plans.is_empty() {
        return Err(CommissionError::NoPlan(folder.to_owned()).into());
    }
    Ok(plans)
}

/// Returns the axes of plans and the other motors of gantries, each once.
pub fn motors_of(plans: &[PlanFile]) -> Vec<&str> {
    let mut motors: Vec<&str> = Vec::new();
    for axis in plans.iter().flat_map(|it| &it.plan.axes) {
        for motor in std::iter::once(&axis.name).chain(&axis.followers) {
            if !motors.contains(&motor.as_str()) {
                motors.push(motor);
            }
        }
    }
    motors
}

/// A commissioning in a folder, and how its recordings are evaluated.
#[derive(Debug, Clone)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct Commissioning<'a> {
    /// The folder.
    pub folder: &'a Path,
    /// Plans.
    pub plans: &'a [PlanFile],
    /// Recordings.
    pub recordings: &'a [PathBuf],
    /// The reader of the recordings.
    pub reader: CommissionReader<'a>,
    /// The plant as known beforehand, a preset or a file; without one none is fitted.
    pub plant: Option<&'a str>,
    /// Permission to shape tuned lists below 1 mm/s.
    pub shaping: Shaping,
    /// The build for which lists are written, if it is known.
    pub build: Option<CncBuild>,
    /// Lists before the commissioning, with their axes.
    pub before: &'a [(String, PathBuf)],
    /// Statements of the user that no recording shows.
    pub said: Vec<String>,
    /// The files that are read.
    pub registry: &'a FileRegistry,
}

impl Commissioning<'_> {
    /// Evaluates the recordings: writes a provisional list of each axis whose friction is known, fits plants, tunes lists
    /// on them, and judges the lists of each round. What an earlier run found in the same recordings is kept.
    ///
    /// # Errors
    /// A file cannot be read or written, or the memory does not suffice for simulations.
    pub fn evaluate(
        &self,
        outputs: &mut OutputFiles,
        watch: &Watch,
    ) -> Result<ResultsReport, HostError> {
        let known = known(&self.folder.join(RESULTS));
        let (mut results, kept) =
            self.reader
                .results((self.plans, self.recordings), &known.recordings, watch)?;
        self.reader
            .take_shares(self.folder, self.plans, (&mut results, self.registry))?;
        // The evidence of one recording on another is determined anew each time.
        let read = results.clone();
        refuse_strangers(&mut results);
        let axes = self.lists(&results, outputs)?;
        let fitted = self.plants((&results, &known.plants), outputs, watch)?;
        let rounds = self.rounds(&results, &fitted)?;
        let content = Results {
            schema: Results::SCHEMA,
            recordings: read,
            plants: fitted.found().cloned().collect(),
        };
        let path = self.folder.join(RESULTS);
        outputs
            .create(RESULTS, &path, Replaces::Results)?
            .json(&content)?;
        Ok(ResultsReport {
            inputs: self.inputs()?,
            said: self.said.clone(),
            plans: self.plans.to_vec(),
            results,
            kept,
            axes,
            fitted,
            rounds,
        })
    }

    /// Writes a provisional list for each axis of stage 1 whose friction was recorded and that has no reason against it.
    fn lists(
        &self,
        results: &[RecordingResult],
        outputs: &mut OutputFiles,
    ) -> Result<Vec<AxisVerdict>, HostError> {
        let first = self.plans.iter().filter(|it| it.plan.stage == Stage::Off);
        let mut verdicts = Vec::new();
        for axis in first.flat_map(|it| &it.plan.axes) {
            let (source, notes) = source_of(axis, self.plans, results);
            let mut verdict = AxisVerdict {
                axis: axis.name.clone(),
                list: None,
                from: None,
                notes,
            };
            if let Some((result, found)) = source {
                let text = self.list_text(axis, result, found);
                let name = format!("{}-provisional", axis.name);
                let path = self.write_list(&name, &text, outputs)?;
                verdict.list = Some(shown_path(&path));
                verdict.from = Some(result.file.clone());
            }
            verdicts.push(verdict);
        }
        Ok(verdicts)
    }

    /// Returns the text of the list of an axis.
    fn list_text(
        &self,
        axis: &MeasuredAxis,
        result: &RecordingResult,
        found: &FrictionFound,
    ) -> String {
        let mut remarks = vec![
            "Provisional: for stage 2 of the commissioning, until recorded circles confirm it"
                .to_owned(),
            format!("SHA-256 of the recording: {}", result.sha256),
        ];
        remarks.extend_from_slice(&found.notes);
        let made = IdentifiedFrom {
            axis: Some(&axis.name),
            from: &result.file,
            unit: DRIVE_UNITS,
            faults: &remarks,
        };
        render_identified(&found.list(), made, self.build)
    }

    /// Writes a list under a name derived from its content, so that no list replaces another one.
    pub(super) fn write_list(
        &self,
        name: &str,
        text: &str,
        outputs: &mut OutputFiles,
    ) -> Result<PathBuf, HostError> {
        let sum = sha256_of_text(text);
        let name = format!("{name}-{}.lis", sum.get(..8).unwrap_or(&sum));
        let path = self.folder.join("lists").join(name);
        if read_text(&path).is_ok_and(|there| there == text) {
            return Ok(path);
        }
        let mut file = outputs.create_in_folder("the value list", &path, Replaces::Lists)?;
        file.bytes(text.as_bytes())?;
        Ok(path)
    }

    /// Returns the values of a list.
    pub(super) fn list(&self, path: &Path) -> Result<FrictionList, HostError> {
        Ok(read_value_list(path, self.registry, &Disk::default())?.list)
    }

    /// Returns the plants of all rounds, if the one known beforehand is given.
    fn plants(
        &self,
        (results, known): (&[RecordingResult], &[PlantFound]),
        outputs: &mut OutputFiles,
        watch: &Watch,
    ) -> Result<Plants, HostError> {
        let Some(name) = self.plant else {
            return Ok(Plants::default());
        };
        memory_for_simulation()?;
        let fitting = Fitting {
            commissioning: self,
            base: &find_plant(name, self.registry)?,
            results,
            known,
            watch,
        };
        fitting.plants(outputs)
    }

    /// Returns the rounds of stage 2, each judged by its own recordings and by the lists accepted before it.
    fn rounds(
        &self,
        results: &[RecordingResult],
        fitted: &Plants,
    ) -> Result<Vec<Round>, HostError> {
        let mut rounds: Vec<Round> = Vec::new();
        let second = self.plans.iter().filter(|it| it.plan.stage == Stage::On);
        for (number, plan) in (2..).zip(second) {
            let round = RecordedRound {
                number,
                plan,
                plans: self.plans,
                results,
            };
            let judged = round.judged(&rounds, fitted, || {
                Ok::<_, HostError>([
                    self.lists_against(plan, results)?,
                    plants_against(plan, fitted)?,
                ])
            });
            rounds.push(judged?);
        }
        Ok(rounds)
    }

    /// Returns the lists of a round that differ from the recorded ones, or add too much.
    fn lists_against(
        &self,
        plan: &PlanFile,
        results: &[RecordingResult],
    ) -> Result<Vec<String>, HostError> {
        let mut against = Vec::new();
        for used in &plan.lists {
            let path = PathBuf::from(&used.file);
            if !path.exists() || sha256_of(&path)? != used.sha256 {
                against.push(format!(
                    "the list of {} that was recorded is no longer `{}`",
                    used.axis, used.file
                ));
                continue;
            }
            let list = self.list(&path)?;
            let mut planned = plan.plan.axes.iter();
            let axis = planned.find(|it| it.name == used.axis);
            let Some((_, friction)) = axis.and_then(|axis| source_of(axis, self.plans, results).0)
            else {
                against.push(format!(
                    "the friction of {} is not known, so its current cannot be compared",
                    used.axis
                ));
                continue;
            };
            let strongest = friction.strongest(&list);
            if let Some((speed, part)) = strongest.filter(|it| it.1 > MOST_CURRENT) {
                against.push(format!(
                    "at {speed:.3} mm/s the list of {} adds {part:.2} times the measured friction; the limit is {MOST_CURRENT}",
                    used.axis
                ));
            }
        }
        Ok(against)
    }

    /// Returns the plans, the lists of stage 2, the earlier ones, and the file of the plant.
    fn inputs(&self) -> Result<Vec<InputFile>, HostError> {
        let rounds = (1..).take(self.plans.len() + 1);
        let paths = rounds.map(|round| self.folder.join(plan_name(round)));
        let plans = paths.filter(|path| path.exists());
        let mut read: Vec<(String, PathBuf)> =
            plans.map(|path| ("plan".to_owned(), path)).collect();
        let before = self.before.iter();
        read.extend(before.map(|(axis, path)| (format!("list of {axis} before"), path.clone())));
        if let Some(name) = self.plant.filter(|it| it.parse::<Preset>().is_err()) {
            read.push(("plant as it is known".to_owned(), PathBuf::from(name)));
        }
        let input = |(what, path): (String, PathBuf)| {
            Ok(InputFile {
                what,
                file: shown_path(&path),
                sha256: sha256_of(&path)?,
            })
        };
        let inputs = read.into_iter().map(input);
        let mut inputs = inputs.collect::<Result<Vec<_>, HostError>>()?;
        // As they were at planning time; a list that changed since then is not accepted.
        inputs.extend(
            self.plans
                .iter()
                .flat_map(|it| &it.lists)
                .map(|it| InputFile {
                    what: format!("list of {} on", it.axis),
                    file: it.file.clone(),
                    sha256: it.sha256.clone(),
                }),
        );
        Ok(inputs)
    }
}

/// Returns the results of an earlier run; none if they do not exist or this version does not understand them.
fn known(path: &Path) -> Results {
    let text = read_text(path).ok();
    let read = text.and_then(|text| serde_json::from_str::<Results>(&text).ok());
    read.filter(|it| it.schema == Results::SCHEMA)
        .unwrap_or_default()
}

/// Returns what the recordings show about the plants on which the lists of a round were tuned.
fn plants_against(plan: &PlanFile, fitted: &Plants) -> Result<Vec<String>, HostError> {
    let mut keys = BTreeSet::new();
    for used in &plan.lists {
        let path = PathBuf::from(&used.file);
        if path.exists() {
            keys.extend(tuned_on(&read_text(&path)?).map(str::to_owned));
        }
    }
    Ok(keys.iter().flat_map(|key| fitted.against(key)).collect())
}
