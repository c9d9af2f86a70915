//! Evidence in the commanded positions and the torque of recordings besides the path (R16.13, R16.14, R16.18).

use std::path::Path;

use super::reading::CommissionReader;
use crate::disk::{Disk, FileRegistry, sha256_of};
use crate::error::HostError;
use crate::machines::read_value_list;
use crate::recordings::{read_axis, read_motion};
use frictcomp_recordings::commission::{
    CirclesFound, FollowedPosition, Plan, PlanFile, RecordingResult, ShareOfList, Stage,
    ValueListUsed, recorded_apart, torque_of_list,
};

impl CommissionReader<'_> {
    /// Refuses commanded positions that were recorded as actual ones, and names axes that were recorded apart. What was
    /// not recorded shows nothing.
    pub(super) fn look_closer(&self, path: &Path, plan: &Plan, found: &mut CirclesFound) {
        let cycle = self.channels.cycle_s;
        let mut followed = Vec::new();
        for (at, axis) in plan.axes.iter().take(2).enumerate() {
            let channels = self.channels.followed(&axis.name);
            let recording = read_axis(path, &channels, cycle, &Disk::default());
            let Ok(recording) = recording.or_else(|_| read_motion(path, &channels, cycle)) else {
                continue;
            };
            if let Some(position) = FollowedPosition::of(&recording, 0.0) {
                let copied = position.is_commanded(recording.track.step_s);
                let against = copied.into_iter().chain(position.is_held());
                found
                    .against
                    .extend(against.map(|it| format!("{}: {it}", axis.name)));
                found.followed[at] = Some(position);
                followed.push((axis.name.as_str(), position));
            }
        }
        if let [(x, of_x), (y, of_y)] = followed[..] {
            found.notes.extend(recorded_apart([x, y], [of_x, of_y]));
        }
    }

    /// Takes the share of the list of each round in the torque of its recordings, and in that of stage 1.
    ///
    /// # Errors
    /// A list cannot be read.
    pub fn take_shares(
        &self,
        folder: &Path,
        plans: &[PlanFile],
        (results, registry): (&mut [RecordingResult], &FileRegistry),
    ) -> Result<(), HostError> {
        let rounds = plans.iter().filter(|it| it.plan.stage == Stage::On);
        for used in rounds.clone().flat_map(|it| &it.lists) {
            let is_own = |it: &PlanFile| it.plan.stage == Stage::Off || it.lists.contains(used);
            for result in &mut *results {
                let own = PlanFile::of(plans, result.program).filter(|it| is_own(it));
                if own.is_some() && result.found.is_used() {
                    self.take_share(folder, used, (result, registry))?;
                }
            }
        }
        Ok(())
    }

    /// Takes the share of a list in the torque of a recording, if it is not known yet.
    fn take_share(
        &self,
        folder: &Path,
        used: &ValueListUsed,
        (result, registry): (&mut RecordingResult, &FileRegistry),
    ) -> Result<(), HostError> {
        let is_same = |it: &ShareOfList| it.axis == used.axis && it.list == used.sha256;
        let path = folder.join("recordings").join(&result.file);
        let Some(shown) = result.found.compensation_mut() else {
            return Ok(());
        };
        let list = Path::new(&used.file);
        let is_there = sha256_of(list).is_ok_and(|it| it == used.sha256);
        if shown.shares.iter().any(is_same) || !is_there {
            return Ok(());
        }
        let (cycle, kind) = (self.channels.cycle_s, self.channels.torque_kind);
        let channels = self.channels.followed(&used.axis);
        let recording = read_axis(&path, &channels, cycle, &Disk::default()).ok();
        let list = read_value_list(list, registry, &Disk::default())?.list;
        shown.shares.push(ShareOfList {
            axis: used.axis.clone(),
            list: used.sha256.clone(),
            torque: recording.and_then(|it| torque_of_list(&it, kind, (&list, cycle))),
        });
        Ok(())
    }
}
