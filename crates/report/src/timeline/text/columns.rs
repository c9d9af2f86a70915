//! The columns of the axes: their positions and contents.

use unicode_width::UnicodeWidthStr;

use frictcomp::comp::{AxisIndex, Change, Kind, State};
use frictcomp::timeline::{Row, StateView};

use super::line::{BOLD, GUTTER, MARK, TextLine, style};

/// The column after the line number.
const LINE_END: usize = 6;

/// Minimum width of the block text before states become symbols.
const MIN_TEXT: usize = 24;

/// Minimum width of the block text next to symbols before the states move below their block.
const LEAST_TEXT: usize = 16;

/// Maximum width of the block text, so that a few axes are not far away from it.
const MAX_TEXT: usize = 72;

/// Returns the maximum width of the block text: six tenths of the width if that is less than [`MAX_TEXT`].
fn most_text(width: usize) -> usize {
    MAX_TEXT.min(width * 6 / 10)
}

/// Columns of the widest symbol with its mark.
const SYMBOL: usize = 4;

/// The form of a state.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
enum Words {
    /// `active`, `inactive`, …
    #[default]
    Full,
    /// `on`, `off`, …
    Short,
    /// `on`, `off`, … below the block, each with the name of its axis.
    Below,
}

/// One axis.
#[derive(Debug)]
struct AxisColumn {
    axis: AxisIndex,
    name: String,
    start: usize,
}

/// The columns of the listed axes.
#[derive(Debug, Default)]
pub(super) struct AxisColumns {
    words: Words,
    text: usize,
    width: usize,
    axes: Vec<AxisColumn>,
}

impl AxisColumns {
    /// Columns for the currently listed axes, within a width.
    pub(super) fn new(state: StateView<'_>, width: usize) -> Self {
        let room = width.saturating_sub(GUTTER);
        let widths: Vec<usize> = state
            .axes()
            .map(|(axis, name)| word_width(state, axis).max(name.width()))
            .collect();
        let full: usize = widths.iter().map(|width| width + 2).sum();
        if full + MIN_TEXT <= room {
            let text = (room - full).min(most_text(width));
            return Self::place(state, Words::Full, text, &widths);
        }
        let widths: Vec<usize> = state
            .axes()
            .map(|(_, name)| name.width().max(SYMBOL))
            .collect();
        let short: usize = widths.iter().map(|width| width + 1).sum::<usize>() + 1;
        let text = room.saturating_sub(short);
        if text < LEAST_TEXT {
            let below = Self::place(state, Words::Below, room, &widths);
            return Self { width, ..below };
        }
        let text = text.min(most_text(width).max(LEAST_TEXT));
        Self::place(state, Words::Short, text, &widths)
    }

    fn place(state: StateView<'_>, words: Words, text: usize, widths: &[usize]) -> Self {
        let gap = match words {
            Words::Full => 2,
            Words::Short | Words::Below => 1,
        };
        let mut start = GUTTER + text + 2;
        let mut columns = Vec::with_capacity(widths.len());
        for ((axis, name), width) in state.axes().zip(widths) {
            columns.push(AxisColumn {
                axis,
                name: name.to_owned(),
                start,
            });
            start += width + gap;
        }
        Self {
            words,
            text,
            width: 0,
            axes: columns,
        }
    }

    /// Returns the number of axes.
    pub(super) fn len(&self) -> usize {
        self.axes.len()
    }

    /// Returns the meaning of the symbols, if there are any.
    pub(super) fn legend(&self) -> Option<&'static str> {
        (self.words != Words::Full).then_some(
            "on active, off inactive, on! ineffective, - unconfigured, ? unknown, ◄ changed",
        )
    }

    /// Appends the names of the axes.
    pub(super) fn names(&self, line: &mut TextLine<'_>) {
        if self.words == Words::Below {
            return;
        }
        for column in &self.axes {
            line.go_to(column.start);
            line.styled(BOLD, &column.name);
        }
    }

    /// Appends the states.
    pub(super) fn states(&self, line: &mut TextLine<'_>, state: StateView<'_>, changes: &[Change]) {
        if self.words == Words::Below {
            line.next(GUTTER);
        }
        for column in &self.axes {
            let now = state.state(column.axis, Kind::Frict);
            self.go_to(column, line);
            let marked = changes
                .iter()
                .any(|change| change.axis == column.axis && change.kind == Kind::Frict);
            let word = match self.words {
                Words::Full => now.as_str(),
                Words::Short | Words::Below => symbol(now),
            };
            if !marked {
                line.styled(style(now), word);
                continue;
            }
            let mut mark = [0; 4];
            line.styled(style(now).bold(), word);
            if self.words == Words::Full {
                line.plain(" ");
            }
            line.styled(style(now).bold(), MARK.encode_utf8(&mut mark));
        }
    }

    /// Moves to the place of a state; one below its block is preceded by its axis.
    fn go_to(&self, column: &AxisColumn, line: &mut TextLine<'_>) {
        if self.words != Words::Below {
            line.go_to(column.start);
            return;
        }
        let needed = column.name.width() + 1 + SYMBOL;
        if line.column() > GUTTER {
            let next = GUTTER + (line.column() - GUTTER).next_multiple_of(needed + 1);
            if next + needed > self.width {
                line.next(GUTTER);
            } else {
                line.go_to(next);
            }
        }
        line.styled(BOLD, &column.name);
        line.plain(" ");
    }

    /// Appends the line of a block.
    pub(super) fn block(&self, mut line: TextLine<'_>, row: &Row<'_>) {
        let mut digits = itoa::Buffer::new();
        let number = digits.format(row.line);
        line.go_to(LINE_END.saturating_sub(number.len()));
        line.plain(number);
        let depth = usize::try_from(row.level.unwrap_or_default()).unwrap_or(usize::MAX);
        let indent = depth.saturating_mul(2).min(self.text / 2);
        line.go_to(GUTTER + indent);
        line.source(row.text, self.text - indent);
        // Below a block that changes nothing the states of the one before apply.
        if self.words != Words::Below || !row.changes.is_empty() {
            self.states(&mut line, row.state, row.changes);
        }
        line.end();
    }
}

/// Columns of the widest word that an axis may show, with the mark of a change.
fn word_width(state: StateView<'_>, axis: AxisIndex) -> usize {
    let parameterised = state.machine.axis(axis).parameterised();
    match state.state(axis, Kind::Frict) {
        // P-AXIS-00522 is fixed while the control runs: the word stays and has no mark.
        State::Unconfigured => State::Unconfigured.as_str().len(),
        now if parameterised.contains(Kind::Frict) && now != State::Ineffective => {
            State::Inactive.as_str().len() + 2
        }
        _ => State::Ineffective.as_str().len() + 2,
    }
}

fn symbol(state: State) -> &'static str {
    match state {
        State::Active => "on",
        State::Ineffective => "on!",
        State::Inactive => "off",
        State::Unconfigured => "-",
        State::Unknown => "?",
    }
}
