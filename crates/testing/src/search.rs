//! The best lists for a machine that are known: a search on the machine itself, which no command can do.

use super::glitches::true_glitches;
use super::list::ValueList;
use super::machine::Machine;
use super::program::Program;

/// The speeds in µm/s about which currents are raised and lowered, and the part of a decade that each reaches.
const BANDS: [f64; 5] = [300.0, 1000.0, 4000.0, 15_000.0, 60_000.0];
const DECADES: f64 = 0.35;

/// Changes of a list.
const KNOBS: usize = BANDS.len() + 4;

impl Machine {
    /// Returns the largest glitches of X and Y in µm over some programs of circles with these lists.
    pub fn left_um(
        &self,
        (programs, start): (&[Program], [f64; 2]),
        lists: [Option<&ValueList>; 2],
    ) -> [f64; 2] {
        let mut left = [0.0_f64; 2];
        for program in programs {
            let glitches = true_glitches(&self.run(program, start, lists));
            left = [0, 1].map(|axis| left[axis].max(glitches.of_axis(axis)));
        }
        left
    }

    /// Returns the remaining glitches of the best lists that a search from these lists finds: whatever leaves less is
    /// kept, in steps that become finer.
    pub fn best_um(&self, circles: (&[Program], [f64; 2]), from: [ValueList; 2]) -> [f64; 2] {
        const STEPS: [f64; 4] = [1.0, 0.5, 0.25, 0.12];
        let mut best = from;
        let mut left = self.left_um(circles, best.each_ref().map(Some));
        for step in STEPS {
            for (knob, sign) in (0..KNOBS).flat_map(|knob| [(knob, 1.0), (knob, -1.0)]) {
                let tried = best.each_ref().map(|list| list.turned(knob, sign * step));
                let found = self.left_um(circles, tried.each_ref().map(Some));
                for (axis, tried) in tried.into_iter().enumerate() {
                    if found[axis] < left[axis] {
                        (best[axis], left[axis]) = (tried, found[axis]);
                    }
                }
            }
        }
        left
    }
}

impl ValueList {
    /// Returns the list with one of its properties changed.
    fn turned(&self, knob: usize, by: f64) -> Self {
        let mut list = self.clone();
        match knob.checked_sub(BANDS.len()) {
            None => {
                for [speed, current] in &mut list.points {
                    let decades = (speed.max(1.0) / BANDS[knob]).log10() / DECADES;
                    *current *= 1.0 + 0.15 * by * (-decades * decades).exp();
                }
            }
            Some(0) => list.factor *= 1.0 + 0.06 * by,
            Some(1) => list.build_up *= 1.0 + 0.4 * by,
            Some(2) => list.lookahead = moved(list.lookahead, 3.0 * by),
            Some(_) => list.late = moved(list.late, 2.0 * by),
        }
        list
    }
}

/// Returns a number of cycles, moved by at least one.
fn moved(cycles: usize, by: f64) -> usize {
    let by = by.signum() * by.abs().round().max(1.0);
    (cycles as f64 + by).max(0.0) as usize
}
