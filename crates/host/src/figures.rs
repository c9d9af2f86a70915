//! Figures with a tolerance in a text that was agreed on.

use std::ops::Range;

use similar::{Algorithm, DiffOp, capture_diff_slices};

/// Text after a figure.
const UNIT: &str = " µm";

/// The text of today, in which each line stays as it was agreed on if only its figures changed, and
/// none by more than the tolerance. A line is the same one if it is the same but for its figures.
pub(super) fn diff_with_tolerance(before: &str, now: String, tolerance_um: f64) -> String {
    if tolerance_um <= 0.0 || before == now {
        return now;
    }
    let lines = [before, &now].map(|text| text.lines().collect::<Vec<_>>());
    let [old, new] = &lines;
    let skeletons = [old, new].map(|lines| lines.iter().map(|line| skeleton(line)).collect());
    let [old_skeletons, new_skeletons]: &[Vec<String>; 2] = &skeletons;
    let mut out = String::with_capacity(now.len());
    for operation in capture_diff_slices(Algorithm::Myers, old_skeletons, new_skeletons) {
        let (before, after) = (operation.old_range(), operation.new_range());
        let is_same = matches!(operation, DiffOp::Equal { .. });
        for (at, line) in new[after].iter().enumerate() {
            let agreed = is_same.then(|| old[before.start + at]);
            let agreed = agreed.filter(|agreed| are_near(agreed, line, tolerance_um));
            out.push_str(agreed.unwrap_or(line));
            out.push('\n');
        }
    }
    out
}

/// Returns the ranges of the figures of a line.
fn figures(line: &str) -> impl Iterator<Item = Range<usize>> {
    let ends = line.match_indices(UNIT).map(|(end, _)| end);
    ends.filter_map(|end| {
        let start = line[..end].rfind(' ').map_or(0, |blank| blank + 1);
        line[start..end].parse::<f64>().ok()?;
        Some(start..end)
    })
}

/// A line without its figures, and without the blanks that line them up.
fn skeleton(line: &str) -> String {
    let mut rest = String::with_capacity(line.len());
    let mut done = 0;
    for figure in figures(line) {
        rest.push_str(&line[done..figure.start]);
        rest.push('#');
        done = figure.end;
    }
    rest.push_str(&line[done..]);
    rest.split_whitespace().collect::<Vec<_>>().join(" ")
}

fn are_near(one: &str, other: &str, tolerance_um: f64) -> bool {
    let values = |line: &str| -> Vec<f64> {
        let figures = figures(line).filter_map(|figure| line[figure].parse().ok());
        figures.collect()
    };
    let (one, other) = (values(one), values(other));
    let mut pairs = one.iter().zip(&other);
    // Figures are rounded, and so is their difference.
    pairs.all(|(one, other)| (one - other).abs() <= tolerance_um + 1e-9)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_figures_have_a_tolerance() {
        // R9.84
        let agreed = "max  9.8 µm\n  1.0 µm  N10 X10.5\n  2.0 µm  N20 X1\n";
        let of = |now: &str| diff_with_tolerance(agreed, now.to_owned(), 0.5);
        let near = "max 10.2 µm\n  1.4 µm  N10 X10.5\n  2.0 µm  N20 X1\n";
        assert_eq!(of(near), agreed);
        // A coordinate is no figure; the other lines stay as they were agreed on.
        let moved = "max 10.2 µm\n  1.4 µm  N10 X10.7\n  2.5 µm  N20 X1\n";
        assert_eq!(
            of(moved),
            "max  9.8 µm\n  1.4 µm  N10 X10.7\n  2.0 µm  N20 X1\n"
        );
        let worse = "max 10.4 µm\n  1.0 µm  N10 X10.5\n  2.0 µm  N20 X1\n";
        assert_eq!(of(worse), worse);
        assert_eq!(of("other\n"), "other\n");
    }
}
