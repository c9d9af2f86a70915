//! The motions for questions that are answered by a recording.

use std::fmt::Write as _;

use super::control::AskedAxis;
use frictcomp::readings::Question;
use frictcomp_recordings::evidence::{LOOK_AHEAD_PARTS, WITH_MOTION_PARTS};

/// The usual feed in mm/min.
const FEED: f64 = 1000.0;

/// The shortest duration of a stroke, in minutes.
const STROKE_MIN: f64 = 0.01;

/// Number of strokes in which the axis reverses, since each has few cycles of decay.
const STROKES: usize = 5;

/// Returns the blocks of a question, and what they move. Each motion begins and ends at the present
/// position and goes in the positive direction only, no farther than the travel.
pub(super) fn motion(question: Question, axis: &AskedAxis) -> (String, String) {
    let travel = axis.travel;
    let (half, feed) = (travel / 2.0, FEED.min(travel / STROKE_MIN));
    // Short enough to take a few seconds at the slowest feeds.
    let [slow, slowest] = [0.1, 0.02].map(|most: f64| most.min(half));
    let mut blocks = NumberedBlocks::default();
    blocks.add(&format!("G91 G01 F{}", shown(feed)));
    match question {
        Question::WithMotion => {
            let [first, rest @ ..] = WITH_MOTION_PARTS;
            blocks.add("@[COMP OFF FRICT]");
            blocks.moves(travel * first);
            for (part, switched) in rest.into_iter().zip(["ON", "OFF", "ON"]) {
                blocks.add(&format!(
                    "@[COMP {switched} FRICT] @{}",
                    shown(travel * part)
                ));
            }
            blocks.moves(-travel);
        }
        Question::LookAhead => {
            let commands = [Some("OFF"), Some("ON"), None, Some("OFF"), Some("ON")];
            for (part, switched) in LOOK_AHEAD_PARTS.into_iter().zip(commands) {
                blocks.moves(travel * part);
                if let Some(switched) = switched {
                    blocks.add(&format!("@[COMP {switched} FRICT]"));
                }
            }
            blocks.moves(-travel);
        }
        Question::Start => {
            blocks.add("F6");
            for _ in 0..2 {
                blocks.moves(slow);
                blocks.waits();
            }
            blocks.moves(-2.0 * slow);
        }
        Question::Delay => {
            for part in [half, -half] {
                blocks.add(&format!("F{}", shown(feed)));
                blocks.moves(part);
                blocks.add(&format!("F{}", shown(feed / 5.0)));
                blocks.moves(part);
            }
        }
        Question::Decay => {
            for _ in 0..STROKES {
                blocks.moves(travel);
                blocks.moves(-travel);
            }
        }
        // Standstill, below
        _ => {
            blocks.moves(travel);
            blocks.waits();
            blocks.add("F1");
            blocks.moves(-slowest);
            blocks.waits();
            blocks.add(&format!("F{}", shown(feed)));
            blocks.moves(slowest - travel);
            blocks.waits();
        }
    }
    blocks.add("G90");
    let name = &axis.name;
    let moves = format!(
        "{name} by {travel} mm or degrees at most, in the positive direction from its present position, and back"
    );
    (blocks.text, moves)
}

/// Numbered blocks.
#[derive(Default)]
struct NumberedBlocks {
    text: String,
    count: u32,
}

impl NumberedBlocks {
    fn add(&mut self, block: &str) {
        self.count += 10;
        let _ = writeln!(self.text, "N{} {block}", self.count);
    }

    fn moves(&mut self, by: f64) {
        self.add(&format!("@{}", shown(by)));
    }

    fn waits(&mut self) {
        self.add("G04 1");
    }
}

/// Removes the rounding error of a product.
fn shown(value: f64) -> f64 {
    (value * 1e6).round() / 1e6
}
