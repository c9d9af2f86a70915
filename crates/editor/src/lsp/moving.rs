//! The motion of the axes of a block and their reversals (R12.3).

use std::f64::consts::{FRAC_PI_2, PI};
use std::ops::ControlFlow;

use super::analysis::options;
use super::documents::OpenDocument;
use super::view::RequestView;
use frictcomp::interpreter::{CircularArc, Motion, Motions, PathForm, SAME_PLACE, Travel};
use frictcomp::text::shown_path;
use frictcomp::timeline::{Record, Row, Sink};
use frictcomp_host::{
    Axes, FileRegistry, Input, MachineOptions, Machines, Naming, SingleRun, run_alone,
};

/// Angles that differ by less are the same.
const TOLERANCE: f64 = 1e-9;

/// Motion of an axis in a block, over all passes.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct AxisMoves {
    /// Name of the axis.
    pub(super) axis: String,
    /// Number of motions.
    pub(super) times: u64,
    /// Number of reversals at the beginning of the block or in it.
    pub(super) reversals: u64,
    /// Whether the motion has an unknown target.
    pub(super) is_unsure: bool,
}

/// Returns the motion of the axes in the block that starts on a line, from 1; for this the program runs
/// once more.
pub(super) fn moves(view: &RequestView, document: &OpenDocument, line: u32) -> Vec<AxisMoves> {
    let disk = view.documents.disk();
    let input = Input::Open(document.open_text());
    let unheard = FileRegistry::default();
    let mut machines = Machines::new(MachineOptions::default(), &unheard).on_disk(&disk);
    let Ok(loaded) = machines.for_folder(input.folder()) else {
        return Vec::new();
    };
    let mut options = options(&loaded, view.client.settings.max_blocks);
    options.run = options.run.with_motions(Motions::Taken);
    let alone = SingleRun {
        options,
        naming: Naming::AsGiven,
        axes: Axes::AsTheyOccur,
    };
    let mut sink = Moves {
        view,
        line,
        file: shown_path(&document.path),
        directions: vec![Direction::None; loaded.machine.axes.len()],
        found: Vec::new(),
    };
    // An error that keeps the program from running is reported by its check.
    let _ = run_alone(&input, &loaded, alone, &mut sink);
    sink.found
}

/// Direction of the last motion of an axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Direction {
    /// Nowhere yet.
    None,
    Up,
    Down,
    Unknown,
}

struct Moves<'a> {
    view: &'a RequestView,
    line: u32,
    file: String,
    directions: Vec<Direction>,
    found: Vec<AxisMoves>,
}

impl Sink for Moves<'_> {
    fn record(&mut self, record: &Record<'_>) -> ControlFlow<()> {
        if self.view.cancel.is_set() {
            return ControlFlow::Break(());
        }
        if let Record::Block(row) = record
            && let Some(Motion::Travel(travel)) = row.motion
        {
            self.travel(row, travel);
        }
        ControlFlow::Continue(())
    }
}

impl Moves<'_> {
    fn travel(&mut self, row: &Row<'_>, travel: &Travel) {
        let is_here = row.line == self.line && row.file == self.file;
        for axis in &travel.axes {
            let at = axis.get();
            let ends = (travel.from.get(at), travel.to.get(at));
            let known = match (ends, travel.form) {
                (_, PathForm::Unknown(_)) => None,
                ((Some(Some(from)), Some(Some(to))), _) => Some((*from, *to)),
                _ => None,
            };
            let directions = match (known, travel.form) {
                (None, _) => vec![Direction::Unknown],
                (Some(_), PathForm::Arc(arc)) if arc.axes.contains(axis) => {
                    along_arc(travel, arc, usize::from(arc.axes[1] == *axis))
                }
                (Some((from, to)), _) => straight(from, to).into_iter().collect(),
            };
            let Some(before) = self.directions.get_mut(at) else {
                continue;
            };
            let mut turns = 0;
            for direction in &directions {
                let turned = matches!(
                    (*before, direction),
                    (Direction::Up, Direction::Down) | (Direction::Down, Direction::Up)
                );
                turns += u64::from(turned);
                *before = *direction;
            }
            if is_here && !directions.is_empty() {
                let name = row.state.name(*axis);
                let is_unsure = directions.contains(&Direction::Unknown);
                self.note(name, turns, is_unsure.then_some(()));
            }
        }
    }

    fn note(&mut self, axis: &str, turns: u64, unsure: Option<()>) {
        let at = self.found.iter().position(|known| known.axis == axis);
        let at = at.unwrap_or_else(|| {
            self.found.push(AxisMoves {
                axis: axis.to_owned(),
                times: 0,
                reversals: 0,
                is_unsure: false,
            });
            self.found.len() - 1
        });
        let moves = &mut self.found[at];
        moves.times += 1;
        moves.reversals += turns;
        moves.is_unsure |= unsure.is_some();
    }
}

/// Returns the direction of an axis on a straight line; none for an axis at rest.
fn straight(from: f64, to: f64) -> Option<Direction> {
    match to.partial_cmp(&from)? {
        std::cmp::Ordering::Greater => Some(Direction::Up),
        std::cmp::Ordering::Less => Some(Direction::Down),
        std::cmp::Ordering::Equal => None,
    }
}

/// Returns the directions of an axis of the plane on an arc, one after the other: it reverses where
/// the arc is farthest from the centre along it.
fn along_arc(travel: &Travel, arc: CircularArc, which: usize) -> Vec<Direction> {
    let ends = |places: &[Option<f64>]| -> Option<[f64; 2]> {
        let place = |axis: frictcomp::comp::AxisIndex| places.get(axis.get()).copied().flatten();
        Some([place(arc.axes[0])?, place(arc.axes[1])?])
    };
    let (Some(from), Some(to)) = (ends(&travel.from), ends(&travel.to)) else {
        return vec![Direction::Unknown];
    };
    let Ok(shape) = arc.between([from, to]) else {
        return vec![Direction::Unknown];
    };
    let sense = shape.sweep.signum();
    // The angle in the direction of the arc, from the point where the axis reverses: for the first axis
    // on the axis itself, for the second a quarter circle later. It reverses at each half circle.
    let (offset, slope) = match which {
        0 => (0.0, 1.0),
        _ => (FRAC_PI_2, sense),
    };
    let begin = sense * shape.start - offset;
    let end = begin + shape.sweep.abs();
    let mut directions = Vec::new();
    let mut at = begin;
    while end - at > TOLERANCE {
        let turn = (((at + TOLERANCE) / PI).floor() + 1.0) * PI;
        let next = turn.min(end);
        let way = shape.radius * (next.cos() - at.cos()).abs();
        if way < SAME_PLACE {
            at = next;
            continue;
        }
        // The derivative of the coordinate, up to the radius.
        let grows = -f64::midpoint(at, next).sin() * slope > 0.0;
        directions.push(if grows {
            Direction::Up
        } else {
            Direction::Down
        });
        at = next;
    }
    directions
}

#[cfg(test)]
mod tests {
    use super::*;
    use frictcomp::comp::AxisIndex;
    use frictcomp::interpreter::{Centre, Turn};

    /// Returns the directions of both axes on an arc around the origin.
    fn arc(turn: Turn, from: [f64; 2], to: [f64; 2]) -> [Vec<Direction>; 2] {
        let axes = [AxisIndex::new(0), AxisIndex::new(1)];
        let arc = CircularArc {
            axes,
            turn,
            centre: Centre::Point([0.0, 0.0]),
        };
        let travel = Travel {
            form: PathForm::Arc(arc),
            axes: axes.to_vec(),
            from: from.map(Some).to_vec(),
            to: to.map(Some).to_vec(),
            feed: frictcomp::interpreter::PathFeed::PerMinute(100.0),
            end: frictcomp::interpreter::BlockEnd::Through,
            slope: None,
            end_feed_per_min: None,
            simplified: frictcomp::interpreter::Simplifications::default(),
            contouring: None,
            tool: None,
        };
        [0, 1].map(|which| along_arc(&travel, arc, which))
    }

    #[test]
    fn an_axis_turns_round_where_the_arc_does() {
        // R12.3
        use Direction::{Down, Up};
        use Turn::{Clockwise, CounterClockwise};
        let (east, north, west, south) = ([5.0, 0.0], [0.0, 5.0], [-5.0, 0.0], [0.0, -5.0]);
        let quarter = arc(CounterClockwise, east, north);
        assert_eq!(quarter, [vec![Down], vec![Up]]);
        assert_eq!(arc(Clockwise, north, east), [vec![Up], vec![Down]]);
        assert_eq!(
            arc(CounterClockwise, east, west),
            [vec![Down], vec![Up, Down]]
        );
        assert_eq!(arc(Clockwise, east, west), [vec![Down], vec![Down, Up]]);
        assert_eq!(arc(Clockwise, south, north), [vec![Down, Up], vec![Up]]);
        assert_eq!(
            arc(CounterClockwise, east, east),
            [vec![Down, Up], vec![Up, Down, Up]]
        );
        assert_eq!(
            arc(Clockwise, north, north),
            [vec![Up, Down, Up], vec![Down, Up]]
        );
    }

    #[test]
    fn an_arc_has_the_tolerance_of_the_contour() {
        // R12.3
        let of = |centre, to: [f64; 2]| {
            let arc = CircularArc {
                axes: [AxisIndex::new(0), AxisIndex::new(1)],
                turn: Turn::CounterClockwise,
                centre,
            };
            let travel = Travel {
                form: PathForm::Arc(arc),
                axes: arc.axes.to_vec(),
                from: vec![Some(5.0), Some(0.0)],
                to: to.map(Some).to_vec(),
                feed: frictcomp::interpreter::PathFeed::PerMinute(100.0),
                end: frictcomp::interpreter::BlockEnd::Through,
                slope: None,
                end_feed_per_min: None,
                simplified: frictcomp::interpreter::Simplifications::default(),
                contouring: None,
                tool: None,
            };
            along_arc(&travel, arc, 0)
        };
        // Rounding made the radius too small for the ends.
        assert_eq!(of(Centre::Radius(4.999), [-5.0, 0.0]), [Direction::Down]);
        assert_eq!(of(Centre::Radius(3.0), [-5.0, 0.0]), [Direction::Unknown]);
        assert_eq!(
            of(Centre::Point([0.001, 0.0]), [0.0, 5.0]),
            [Direction::Down]
        );
        assert_eq!(
            of(Centre::Point([3.0, 0.0]), [0.0, 5.0]),
            [Direction::Unknown]
        );
    }
}
