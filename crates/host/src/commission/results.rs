//! Results of all recordings of a commissioning; those of an earlier run are not read again.

use std::path::PathBuf;

use super::reading::CommissionReader;
use crate::disk::{sha256_of, sha256_of_data};
use crate::error::HostError;
use crate::watch::{Done, Watch};
use frictcomp_recordings::commission::{Plan, PlanFile, RecordingOutcome, RecordingResult};

impl CommissionReader<'_> {
    /// Reads the recordings that have changed since an earlier run; returns the results of all, and the number of
    /// those that were known.
    ///
    /// # Errors
    /// A file cannot be read.
    pub fn results(
        &self,
        (plans, paths): (&[PlanFile], &[PathBuf]),
        known: &[RecordingResult],
        watch: &Watch,
    ) -> Result<(Vec<RecordingResult>, usize), HostError> {
        let of_plans: Vec<&Plan> = plans.iter().map(|it| &it.plan).collect();
        let mut kept = 0;
        let mut results = Vec::new();
        for path in paths {
            watch.show(|| Done::Runs {
                of: "recordings",
                done: results.len(),
                all: paths.len(),
            });
            let sha256 = sha256_of(path)?;
            let file = path.file_name().map(|it| it.to_string_lossy().into_owned());
            let file = file.unwrap_or_default();
            let same = |it: &&RecordingResult| {
                it.file == file
                    && it.sha256 == sha256
                    && it.read_with == self.read_with(plans, it.program)
            };
            if let Some(result) = known.iter().find(same) {
                kept += 1;
                results.push(result.clone());
                continue;
            }
            let (program, mut found) = self.read(path, &of_plans);
            if let (RecordingOutcome::Circles(circles), Some(plan)) =
                (&mut found, PlanFile::of(plans, program))
            {
                self.look_closer(path, &plan.plan, circles);
            }
            results.push(RecordingResult {
                file,
                sha256,
                read_with: self.read_with(plans, program),
                program,
                found,
            });
        }
        Ok((results, kept))
    }

    /// Returns the SHA-256 of everything that affects how a recording is read, except the recording itself: version,
    /// channels and the plan of its program, or all plans if its program is not known.
    fn read_with(&self, plans: &[PlanFile], program: Option<u16>) -> String {
        let plans = plans
            .iter()
            .filter(|plan| program.is_none_or(|number| plan.has(number)));
        let plans: Vec<&Plan> = plans.map(|it| &it.plan).collect();
        sha256_of_data(&(env!("CARGO_PKG_VERSION"), self.channels, plans))
    }
}
