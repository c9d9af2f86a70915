//! The deviations of the axes from the path of each block.

use std::collections::HashMap;
use std::sync::Arc;

use super::program::{ContourPoint, ContourSink};
use super::reversals::{ContourReversal, GlitchFigure};
use crate::motion::Movement;
use frictcomp::timeline::Row;

/// Maximum number of stretches of a block: on a longer block they are longer.
const MOST_STRETCHES: usize = 64;

/// Reversals of a block that are kept one by one.
const MOST_REVERSALS: usize = 8;

/// A block that moves axes, and their deviation from its path while it is cut.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct BlockDeviation {
    /// Path of the file, as it is shown.
    pub file: Arc<str>,
    /// The line of the block, from 1.
    pub line: u32,
    /// The block number, if it is known.
    pub number: Option<i64>,
    /// The first source line of the block, without blanks around it.
    pub text: String,
    /// The worst place of each stretch of its path; none if it is never cut: a rapid motion, or
    /// one that is left out.
    pub stretches: Vec<WorstPlace>,
    /// Length of the stretches, in mm.
    pub stretch_mm: f64,
    /// The axes that reverse while it is cut, in the order of the path.
    pub reversals: Vec<BlockReversal>,
    /// Number of its further reversals, and the largest glitch of those that have a figure, in µm.
    pub more_reversals: (u64, Option<f64>),
}

/// A reversal while a block is cut.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct BlockReversal {
    /// Name of the axis.
    pub axis: String,
    /// The glitch as programmed in µm; 0 if it has no figure.
    pub glitch_um: f64,
    /// Basis of the glitch.
    pub figure: GlitchFigure,
}

/// Place of the largest deviation of a block.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct WorstPlace {
    /// The deviation to either side in µm.
    pub deviation_um: f64,
    /// Commanded position of the axes of the plane, in mm.
    pub place: [f64; 2],
}

impl WorstPlace {
    fn worse(self, other: Self) -> Self {
        if other.deviation_um > self.deviation_um {
            other
        } else {
            self
        }
    }
}

impl BlockDeviation {
    /// Returns the largest deviation in µm, 0 if the block is never cut.
    pub fn max_um(&self) -> f64 {
        let stretches = self.stretches.iter().map(|it| it.deviation_um);
        stretches.fold(0.0, f64::max)
    }

    /// Takes a deviation after a distance in mm along the path of the block.
    fn push(&mut self, gone_mm: f64, found: WorstPlace) {
        while gone_mm >= self.stretch_mm * as_float(MOST_STRETCHES) {
            self.stretch_mm *= 2.0;
            let pairs = self.stretches.chunks(2);
            let joined = pairs.map(|pair| match pair {
                [one, other] => one.worse(*other),
                _ => pair[0],
            });
            self.stretches = joined.collect();
        }
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // below 64
        let at = (gone_mm / self.stretch_mm) as usize;
        if let Some(stretch) = self.stretches.get_mut(at) {
            *stretch = stretch.worse(found);
        } else {
            // Stretches passed within a cycle have the deviation that was found after it.
            self.stretches.resize(at + 1, found);
        }
    }
}

#[allow(clippy::cast_precision_loss)] // below 2^52
fn as_float(count: usize) -> f64 {
    count as f64
}

/// Keeps the deviation of the axes from the path of each block, in the order in which the blocks are
/// first executed. A block that is executed several times has the worst of all.
#[derive(Debug, Clone, Default)]
pub struct BlockDeviations {
    blocks: Vec<BlockDeviation>,
    /// Indices of the blocks of each file, by line.
    known: HashMap<Arc<str>, HashMap<u32, usize>>,
    cut: Cut,
}

/// The block that is cut.
#[derive(Debug, Clone, Default)]
struct Cut {
    /// Number in the run.
    seq: u64,
    /// Index in the list.
    at: Option<usize>,
    /// Distance covered, in mm.
    gone_mm: f64,
    place: [f64; 2],
}

impl BlockDeviations {
    /// Returns the blocks.
    pub fn into_blocks(self) -> Vec<BlockDeviation> {
        self.blocks
    }

    fn find(&self, file: &str, line: u32) -> Option<usize> {
        self.known.get(file)?.get(&line).copied()
    }
}

impl ContourSink for BlockDeviations {
    fn block(&mut self, row: &Row<'_>) {
        if self.find(row.file, row.line).is_some() {
            return;
        }
        let file = match self.known.get_key_value(row.file) {
            Some((file, _)) => Arc::clone(file),
            None => Arc::from(row.file),
        };
        let lines = self.known.entry(Arc::clone(&file)).or_default();
        lines.insert(row.line, self.blocks.len());
        let text = row.text.lines().next().unwrap_or_default();
        self.blocks.push(BlockDeviation {
            file,
            line: row.line,
            number: row.number,
            text: text.trim().to_owned(),
            stretches: Vec::new(),
            stretch_mm: 1.0,
            reversals: Vec::new(),
            more_reversals: (0, None),
        });
    }

    fn point(&mut self, point: &ContourPoint<'_>) {
        let cause = point.cause;
        let place = [point.positions[0], point.positions[1]];
        if self.cut.seq != cause.seq {
            self.cut = Cut {
                seq: cause.seq,
                at: self.find(&cause.file, cause.line),
                gone_mm: 0.0,
                place,
            };
        }
        let cut = &mut self.cut;
        cut.gone_mm += (place[0] - cut.place[0]).hypot(place[1] - cut.place[1]);
        cut.place = place;
        let block = cut.at.and_then(|at| self.blocks.get_mut(at));
        if let Some(block) = block.filter(|_| point.counts) {
            let deviation_um = point.space_um.programmed;
            block.push(
                cut.gone_mm,
                WorstPlace {
                    deviation_um,
                    place,
                },
            );
        }
    }

    fn reversal(&mut self, reversal: &ContourReversal) {
        let at = self.find(&reversal.file, reversal.line);
        let block = at.and_then(|at| self.blocks.get_mut(at));
        let Some(block) = block.filter(|_| reversal.movement != Movement::Rapid) else {
            return;
        };
        let glitch_um = reversal.glitch_um.programmed;
        if block.reversals.len() < MOST_REVERSALS {
            block.reversals.push(BlockReversal {
                axis: reversal.axis.clone(),
                glitch_um,
                figure: reversal.figure,
            });
        } else {
            let (count, largest) = &mut block.more_reversals;
            *count += 1;
            if reversal.has_figure() {
                *largest = Some(largest.map_or(glitch_um, |largest| largest.max(glitch_um)));
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_long_block_has_no_more_stretches_but_longer_ones() {
        // R9.83
        let mut block = BlockDeviation {
            file: "a.nc".into(),
            line: 1,
            number: None,
            text: String::new(),
            stretches: Vec::new(),
            stretch_mm: 1.0,
            reversals: Vec::new(),
            more_reversals: (0, None),
        };
        for gone in 0..1000 {
            let found = WorstPlace {
                deviation_um: if gone == 700 { 9.0 } else { 1.0 },
                place: [f64::from(gone), 0.0],
            };
            block.push(f64::from(gone), found);
        }
        assert!(block.stretches.len() <= MOST_STRETCHES);
        assert!(block.stretch_mm > 1.0);
        let worst = block.stretches.iter().filter(|it| it.deviation_um > 1.0);
        assert_eq!(worst.map(|it| it.place[0]).collect::<Vec<_>>(), [700.0]);
    }
}
