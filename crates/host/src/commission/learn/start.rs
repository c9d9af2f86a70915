//! The start of learning: the measured friction, and the lists of the first round.

use std::path::Path;

use super::Learning;
use super::folder::LearningFolder;
use crate::commission::CommissionError;
use crate::disk::{read_text, sha256_of};
use crate::error::HostError;
use crate::outputs::OutputFiles;
use frictcomp::text::shown_path;
use frictcomp_physics::circle::{PlaneAxis, TooMuchCurrent};
use frictcomp_recordings::commission::{MOST_CURRENT, MeasuredFriction, ValueListUsed};

impl Learning<'_> {
    /// Begins in the folder: copies the lists of the first round into it, each within the limit set by the friction.
    pub(super) fn begin(&self, outputs: &mut OutputFiles) -> Result<LearningFolder, HostError> {
        let Some(first) = &self.first else {
            return Err(CommissionError::NotBegun(self.folder.to_owned()).into());
        };
        let [x, y] = first.friction;
        let friction = [
            self.measured(PlaneAxis::X, x)?,
            self.measured(PlaneAxis::Y, y)?,
        ];
        for (path, friction) in first.lists.into_iter().zip(&friction) {
            let list = self.list(path)?;
            TooMuchCurrent::check(&list, &friction.list, MOST_CURRENT).map_err(|reason| {
                let path = path.to_owned();
                CommissionError::FirstList { path, reason }
            })?;
        }
        let [x, y] = first.lists;
        let mut folder = LearningFolder::new(self.folder, friction);
        folder.add_round(&[read_text(x)?, read_text(y)?], [None; 2], outputs)?;
        Ok(folder)
    }

    /// Returns the measured friction of an axis.
    fn measured(&self, axis: PlaneAxis, path: &Path) -> Result<MeasuredFriction, HostError> {
        let list = self.list(path)?;
        let is_positive = list.table.iter().all(|it| it.output > 0.0) && list.scaling_factor > 0;
        if list.table.is_empty() || !is_positive {
            return Err(CommissionError::NotFriction(path.to_owned()).into());
        }
        Ok(MeasuredFriction {
            from: ValueListUsed {
                axis: axis.as_str().to_owned(),
                file: shown_path(path),
                sha256: sha256_of(path)?,
            },
            list,
        })
    }
}
