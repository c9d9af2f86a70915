//! The lines of an agreed contour: words, and figures in µm between them.

use std::fmt::{self, Write as _};
use std::ops::Range;

use similar::{Algorithm, DiffOp, capture_diff_slices};

/// Text after a figure.
const UNIT: &str = " µm";

/// An agreed contour. Its [`Display`](fmt::Display) is the text of the file (R9.84).
#[derive(Debug, Clone, Default)]
pub struct AgreedContour(Vec<AgreedLine>);

/// A line with its figures.
#[derive(Debug, Clone, Default)]
pub(super) struct AgreedLine {
    text: String,
    figures: Vec<Figure>,
}

/// A figure and its place in the text of its line.
#[derive(Debug, Clone)]
struct Figure {
    place: Range<usize>,
    um: f64,
}

impl AgreedContour {
    pub(super) fn push(&mut self, line: AgreedLine) {
        self.0.push(line);
    }

    /// Appends a line of words, with the figures that the words contain.
    pub(super) fn say(&mut self, words: &str) {
        self.push(AgreedLine::read(words));
    }

    /// Returns the current text if the text `before` was agreed on: a line with the same words, none of
    /// whose figures changed by more than the tolerance, stays as agreed.
    pub fn keeping(&self, before: &str, tolerance_um: f64) -> String {
        let now = self.to_string();
        if tolerance_um <= 0.0 || before == now {
            return now;
        }
        let before: Vec<AgreedLine> = before.lines().map(AgreedLine::read).collect();
        let words = |lines: &[AgreedLine]| lines.iter().map(AgreedLine::words).collect::<Vec<_>>();
        let (old, new) = (words(&before), words(&self.0));
        let mut kept = self.0.clone();
        for operation in capture_diff_slices(Algorithm::Myers, &old, &new) {
            if let DiffOp::Equal { .. } = operation {
                let pairs = operation.old_range().zip(operation.new_range());
                for (old, new) in pairs {
                    if before[old].is_near(&self.0[new], tolerance_um) {
                        kept[new] = before[old].clone();
                    }
                }
            }
        }
        Self(kept).to_string()
    }
}

impl fmt::Display for AgreedContour {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0
            .iter()
            .try_for_each(|line| writeln!(out, "{}", line.text))
    }
}

impl AgreedLine {
    pub(super) fn and(mut self, words: &str) -> Self {
        self.text.push_str(words);
        self
    }

    /// Appends a figure with its unit, in at least `width` columns.
    pub(super) fn figure(mut self, um: f64, width: usize) -> Self {
        let _ = write!(self.text, "{um:>width$.1}");
        let start = self.text.rfind(' ').map_or(0, |blank| blank + 1);
        self.figures.push(Figure {
            place: start..self.text.len(),
            // Values are compared as rounded in a file.
            um: (um * 10.0).round_ties_even() / 10.0,
        });
        self.and(UNIT)
    }

    /// Reads a line that was written before. The text of a block follows its figure and has no figures.
    fn read(text: &str) -> Self {
        let ends = text.match_indices(UNIT).map(|(end, _)| end);
        let figures = ends.filter_map(|end| {
            let start = text[..end].rfind(' ').map_or(0, |blank| blank + 1);
            let um = text[start..end].parse().ok()?;
            Some(Figure {
                place: start..end,
                um,
            })
        });
        let mut figures: Vec<Figure> = figures.collect();
        if let [first, ..] = &figures[..]
            && text[..first.place.start].trim().is_empty()
        {
            figures.truncate(1);
        }
        Self {
            text: text.to_owned(),
            figures,
        }
    }

    /// Returns the line without its figures, and without the blanks that align them.
    fn words(&self) -> String {
        let mut words = String::with_capacity(self.text.len());
        let mut done = 0;
        for figure in &self.figures {
            words.push_str(&self.text[done..figure.place.start]);
            words.push('#');
            done = figure.place.end;
        }
        words.push_str(&self.text[done..]);
        words.split_whitespace().collect::<Vec<_>>().join(" ")
    }

    /// Returns whether no figure differs by more than the tolerance, in tenths as written.
    fn is_near(&self, other: &Self, tolerance_um: f64) -> bool {
        let mut pairs = self.figures.iter().zip(&other.figures);
        pairs.all(|(one, other)| (one.um - other.um).abs() <= tolerance_um + 1e-9)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn contour(largest: f64, blocks: &[(f64, &str)]) -> AgreedContour {
        let mut contour = AgreedContour::default();
        contour.push(AgreedLine::default().and("max ").figure(largest, 4));
        for (um, text) in blocks {
            contour.push(AgreedLine::default().figure(*um, 5).and("  ").and(text));
        }
        contour
    }

    #[test]
    fn only_figures_have_a_tolerance() {
        // R9.84
        let blocks = [(1.0, "N10 X10.5 (gap 2.0 µm)"), (2.0, "N20 X1")];
        let agreed = contour(9.8, &blocks).to_string();
        assert_eq!(
            agreed,
            "max  9.8 µm\n  1.0 µm  N10 X10.5 (gap 2.0 µm)\n  2.0 µm  N20 X1\n"
        );
        let now = |largest, blocks: &[_]| contour(largest, blocks).keeping(&agreed, 0.5);
        let near = [(1.4, blocks[0].1), blocks[1]];
        assert_eq!(now(10.2, &near), agreed);
        // The text of a block is not a figure; the other lines stay as they were agreed on.
        for text in ["N10 X10.7 (gap 2.0 µm)", "N10 X10.5 (gap 2.2 µm)"] {
            assert_eq!(
                now(10.2, &[(1.4, text), (2.5, "N20 X1")]),
                format!("max  9.8 µm\n  1.4 µm  {text}\n  2.0 µm  N20 X1\n")
            );
        }
        let worse = contour(10.4, &blocks);
        assert_eq!(worse.keeping(&agreed, 0.5), worse.to_string());
        assert_eq!(contour(9.8, &[]).keeping("", 0.5), "max  9.8 µm\n");
    }
}
