//! What the commanded positions and the torque of recorded circles show besides the path (R16.13, R16.14, R16.18).

use std::path::Path;

use super::channels::ReadingArgs;
use crate::machine::value_list;
use frictcomp_host::{FileRegistry, read_axis, read_motion, sha256_of};
use frictcomp_recordings::commission::{
    CirclesFound, FollowedPosition, recorded_apart, share_of_torque,
};
use frictcomp_report::commission::PlanFile;

impl ReadingArgs {
    /// Refuses commanded positions that were recorded as actual ones, names axes that were recorded apart, and takes
    /// the share of each list in the torque. What was not recorded shows nothing.
    pub(super) fn look_closer(
        &self,
        path: &Path,
        plan: &PlanFile,
        (found, registry): (&mut CirclesFound, &FileRegistry),
    ) {
        let cycle = self.cycle.seconds().ok().flatten();
        let mut followed = Vec::new();
        for (at, axis) in plan.plan.axes.iter().take(2).enumerate() {
            let channels = self.followed(&axis.name);
            let with_torque = read_axis(path, &channels, cycle);
            let has_torque = with_torque.is_ok();
            let Ok(recording) = with_torque.or_else(|_| read_motion(path, &channels, cycle)) else {
                continue;
            };
            if let Some(position) = FollowedPosition::of(&recording, 0.0) {
                let copied = position.is_commanded(recording.track.step_s);
                found
                    .against
                    .extend(copied.map(|it| format!("{}: {it}", axis.name)));
                found.followed[at] = Some(position);
                followed.push((axis.name.as_str(), position));
            }
            let used = plan.lists.iter().find(|it| it.axis == axis.name);
            let Some(used) = used.filter(|_| has_torque) else {
                continue;
            };
            let list = Path::new(&used.file);
            if sha256_of(list).is_ok_and(|it| it == used.sha256)
                && let Ok(list) = value_list(list, registry)
            {
                found.shares[at] =
                    share_of_torque(&recording, self.kind.torque_kind, (&list, cycle));
            }
        }
        if let [(x, of_x), (y, of_y)] = followed[..] {
            found.notes.extend(recorded_apart([x, y], [of_x, of_y]));
        }
        let averaged = followed.iter().filter_map(|(axis, it)| {
            let over_ms = it.averaged_s? * 1000.0;
            Some(format!(
                "the positions of {axis} are averages over {over_ms:.0} ms, which hides what a reversal leaves"
            ))
        });
        found.notes.extend(averaged);
    }
}
