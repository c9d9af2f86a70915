//! The places at which the contour of one version of a program deviates more than that of the
//! other.

use super::alignment::align;
use super::comparison::Which;
use crate::contour::{
    BlockDeviation, BlockDeviations, ContourObstacle, ContourReport, Deviations, WorstPlace,
};

/// The contour of one version.
#[derive(Debug, Clone)]
pub struct VersionContour {
    blocks: Vec<BlockDeviation>,
    deviations: Deviations,
    obstacles: Vec<ContourObstacle>,
}

impl From<(ContourReport, BlockDeviations)> for VersionContour {
    fn from((contour, blocks): (ContourReport, BlockDeviations)) -> Self {
        Self {
            deviations: contour.deviations.programmed,
            blocks: blocks.into_blocks(),
            obstacles: contour.obstacles,
        }
    }
}

/// A block that deviates more somewhere on its path.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct BlockChange {
    /// The block of the new version.
    pub block: BlockDeviation,
    /// Place and deviation there.
    pub new: WorstPlace,
    /// The line in the old version and its deviation there in µm, if that version has the block.
    pub old: Option<(u32, f64)>,
}

impl BlockChange {
    /// Returns the additional deviation of the new version there, in µm.
    pub fn more_um(&self) -> f64 {
        self.new.deviation_um - self.old.map_or(0.0, |(_, um)| um)
    }

    /// Finds the place of a block with the largest deviation beyond that of the old version.
    fn of(old: Option<&BlockDeviation>, new: &BlockDeviation) -> Option<Self> {
        let mut stretches = new.stretches.iter().enumerate();
        let first = stretches.next()?;
        let of = |(at, place): (usize, &WorstPlace)| Self {
            block: new.clone(),
            new: *place,
            old: old.map(|old| (old.line, before(old, (new, at)))),
        };
        let more = |(at, place): (usize, &WorstPlace)| {
            let before = old.map_or(0.0, |old| before(old, (new, at)));
            place.deviation_um - before
        };
        let worst = stretches.fold(first, |worst, next| {
            if more(next) > more(worst) {
                next
            } else {
                worst
            }
        });
        Some(of(worst))
    }
}

/// Returns the deviation of the old version at a stretch of a block, or next to it. If the block
/// has the same length in both versions, so have its stretches.
fn before(old: &BlockDeviation, (new, at): (&BlockDeviation, usize)) -> f64 {
    #[allow(clippy::float_cmp)] // powers of two
    let is_as_long = old.stretch_mm == new.stretch_mm;
    if !is_as_long {
        return old.max_um();
    }
    let near = old.stretches.iter().skip(at.saturating_sub(1));
    let near = near.take(if at == 0 { 2 } else { 3 });
    near.map(|it| it.deviation_um).fold(0.0, f64::max)
}

frictcomp::words! {
    /// Result of a comparison of contours.
    #[derive(Debug, Clone, Copy, PartialEq, Eq)]
    #[cfg_attr(not(feature = "unstable"), non_exhaustive)]
    pub enum ContourAgreement {
        /// No block of the new version deviates more than the tolerance allows.
        NoMore = "no-more",
        /// A block of the new version deviates more.
        More = "more",
        /// A contour is not known as a whole, whatever exceeds it in the known part.
        NotComparable = "not-comparable",
    }
}

/// The contours of two versions side by side.
#[derive(Debug, Clone)]
pub struct ContourComparison {
    deviations: [Deviations; 2],
    obstacles: [Vec<ContourObstacle>; 2],
    more: Vec<BlockChange>,
    less: usize,
    tolerance_um: f64,
}

impl ContourComparison {
    /// Compares two contours, stretch by stretch of each block: a peak is not hidden by another one
    /// that both versions have. Differences within the tolerance do not count.
    pub fn new(old: VersionContour, new: VersionContour, tolerance_um: f64) -> Self {
        let mut more = Vec::new();
        let mut less = 0;
        for pair in align(&old.blocks, &new.blocks) {
            let (before, Some(now)) = pair else {
                continue;
            };
            let before = before.map(|at| &old.blocks[at]);
            let now = &new.blocks[now];
            let change = BlockChange::of(before, now);
            let change = change.filter(|change| change.more_um() > tolerance_um);
            let gain = before.map_or(0.0, BlockDeviation::max_um) - now.max_um();
            less += usize::from(change.is_none() && gain > tolerance_um);
            more.extend(change);
        }
        more.sort_by(|one, other| other.more_um().total_cmp(&one.more_um()));
        Self {
            deviations: [old.deviations, new.deviations],
            obstacles: [old.obstacles, new.obstacles],
            more,
            less,
            tolerance_um,
        }
    }

    /// Returns the deviations of a version from its path.
    pub fn deviations(&self, which: Which) -> &Deviations {
        match which {
            Which::Old => &self.deviations[0],
            Which::New => &self.deviations[1],
        }
    }

    /// Returns the blocks of the new version that deviate more, those with the largest difference first.
    pub fn more(&self) -> &[BlockChange] {
        &self.more
    }

    /// Returns the number of blocks of the new version that deviate less.
    pub fn less(&self) -> usize {
        self.less
    }

    /// Returns the permitted additional deviation of a block in µm.
    pub fn tolerance_um(&self) -> f64 {
        self.tolerance_um
    }

    /// Returns the obstacles to a comparison of the whole contours. Two versions that both cut nothing are alike.
    pub fn obstacles(&self) -> impl Iterator<Item = (Which, ContourObstacle)> {
        let cuts_nothing = |all: &Vec<_>| all.contains(&ContourObstacle::NothingCut);
        let neither_cuts = self.obstacles.iter().all(cuts_nothing);
        let both = [Which::Old, Which::New].into_iter().zip(&self.obstacles);
        both.flat_map(|(which, all)| all.iter().map(move |obstacle| (which, obstacle.clone())))
            .filter(move |(_, it)| !(neither_cuts && *it == ContourObstacle::NothingCut))
    }

    /// Returns the result of the comparison.
    pub fn agreement(&self) -> ContourAgreement {
        if self.obstacles().next().is_some() {
            ContourAgreement::NotComparable
        } else if self.more.is_empty() {
            ContourAgreement::NoMore
        } else {
            ContourAgreement::More
        }
    }
}
