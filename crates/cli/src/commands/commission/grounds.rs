//! The basis of the results besides the recordings: files, and the user's statements (R16.5).

use std::path::{Path, PathBuf};

use super::plan::plan_name;
use super::run_args::CommissionRunArgs;
use crate::args::ByAxis;
use crate::output::{Failure, shown};
use frictcomp_host::sha256_of;
use frictcomp_physics::simulation::Preset;
use frictcomp_recordings::commission::PlanFile;
use frictcomp_report::commission::InputFile;

impl CommissionRunArgs {
    /// Returns the plans, the lists of stage 2, the earlier ones, and the file of the plant.
    pub(super) fn inputs(&self, plans: &[PlanFile]) -> Result<Vec<InputFile>, Failure> {
        let rounds = (1..).take(plans.len() + 1);
        let paths = rounds.map(|round| self.folder.join(plan_name(round)));
        let mut read: Vec<(String, PathBuf)> = paths
            .filter(|path| path.exists())
            .map(|path| ("plan".to_owned(), path))
            .collect();
        let before = self.lists_before(plans)?.into_iter();
        read.extend(before.map(|(axis, path)| (format!("list of {axis} before"), path)));
        if let Some(name) = self
            .plant
            .as_ref()
            .filter(|it| it.parse::<Preset>().is_err())
        {
            read.push(("plant as it is known".to_owned(), PathBuf::from(name)));
        }
        let input = |(what, path): (String, PathBuf)| {
            let path: &Path = &path;
            Ok(InputFile {
                what,
                file: shown(path),
                sha256: sha256_of(path)?,
            })
        };
        let mut inputs = read
            .into_iter()
            .map(input)
            .collect::<Result<Vec<_>, Failure>>()?;
        // As they were at planning time; a list that changed since then is not accepted.
        inputs.extend(plans.iter().flat_map(|it| &it.lists).map(|it| InputFile {
            what: format!("list of {} on", it.axis),
            file: it.file.clone(),
            sha256: it.sha256.clone(),
        }));
        Ok(inputs)
    }

    /// Returns the earlier list of each axis of stage 2 for which one is given.
    pub(super) fn lists_before(
        &self,
        plans: &[PlanFile],
    ) -> Result<Vec<(String, PathBuf)>, Failure> {
        let axes = plans.last().into_iter().flat_map(|it| &it.lists);
        let axes: Vec<&str> = axes.map(|it| it.axis.as_str()).collect();
        if axes.is_empty() && !self.before.is_empty() {
            return Err(
                Failure::new("`--before` is given, and stage 2 has no list yet")
                    .with_help("leave it out until stage 2 is planned"),
            );
        }
        let lists = ByAxis {
            option: "--before",
            given: &self.before,
            axes: &axes,
        };
        let mut before = Vec::new();
        for axis in &axes {
            let list = lists.list(axis)?;
            before.extend(list.map(|it| ((*axis).to_owned(), it.to_owned())));
        }
        Ok(before)
    }

    /// Returns the user's statements that no recording shows.
    pub(super) fn said(&self) -> Vec<String> {
        let mut said = self.reading.said();
        if let Some(plant) = &self.plant {
            said.push(format!(
                "moved mass, position loop and the force of a drive unit are those of {plant}"
            ));
        }
        said
    }
}
