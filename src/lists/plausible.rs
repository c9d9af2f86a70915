//! Values that the control accepts although they are implausible (FC139).

use super::friction::TablePoint;
use super::friction::{Field, FrictionDraft};
use super::parameter::AxisType;
use super::value::Number;
use crate::diagnostic::{Code, Diagnostic, ReadableNumber, Severity};

/// A linear axis whose fastest point is slower than 1 mm/s most likely has velocities in mm/s.
const SLOW_TABLE: f64 = 1000.0;

/// A smaller scaling factor reduces the outputs to less than a tenth.
const SMALL_SCALING: i64 = 100;

/// Returns remarks on points that are probably unintended.
pub(super) fn doubts(
    draft: &FrictionDraft,
    points: &[TablePoint],
    axis_type: AxisType,
) -> Vec<Diagnostic> {
    let checks = [
        small_scaling(draft, points),
        slow(draft, points).filter(|_| axis_type == AxisType::Linear),
        signs(draft, points).or_else(|| jump(draft, points)),
    ];
    checks.into_iter().flatten().collect()
}

/// Reports a scaling factor that reduces the outputs to almost nothing, such as 10 in the manual's sample (C13). It may
/// be intended, because it gives a table of integers a finer resolution.
fn small_scaling(draft: &FrictionDraft, points: &[TablePoint]) -> Option<Diagnostic> {
    let given = draft.get(Field::ScalingFactor)?;
    let Some(Number::Integer(factor)) = given.value.number else {
        return None;
    };
    if factor.saturating_abs() >= SMALL_SCALING {
        return None;
    }
    let largest = points.iter().map(|point| point.output);
    let largest = largest.max_by(|one, other| one.abs().total_cmp(&other.abs()))?;
    let scale = Number::Integer(factor).to_f64();
    let message = format!(
        "`frict_comp.scaling_factor` is {factor}, which is {} %: the largest output, {largest}, \
         reaches the drive as {}",
        ReadableNumber(scale / 10.0),
        ReadableNumber(largest * scale / 1000.0)
    );
    let mut said = Diagnostic::new(Code::Fc139, given.place(), message)
        .with_help("the unit is 0.1 %: 1000 sends the outputs as they are");
    said.severity = Severity::Info;
    Some(said)
}

/// Reports a table of velocities in mm/s instead of \u{b5}m/s.
fn slow(draft: &FrictionDraft, points: &[TablePoint]) -> Option<Diagnostic> {
    // A single point is a constant, whatever its velocity.
    let (index, last) = (0_u32..).zip(points).skip(1).last()?;
    let fastest = last.input;
    if !(fastest > 0.0 && fastest < SLOW_TABLE) {
        return None;
    }
    let place = draft.table.get(&index)?.input.as_ref()?.place();
    let message = format!(
        "the table ends at {fastest} \u{b5}m/s, so that all of it lies below 1 mm/s: velocities are \
         in \u{b5}m/s"
    );
    Some(
        Diagnostic::new(Code::Fc139, place, message)
            .with_help("if these are mm/s, multiply them by 1000"),
    )
}

/// Reports outputs of both signs: the current would push at one speed and brake at another.
fn signs(draft: &FrictionDraft, points: &[TablePoint]) -> Option<Diagnostic> {
    let mut outputs = (0..).zip(points).filter(|(_, point)| point.output != 0.0);
    let (_, first) = outputs.next()?;
    let is_negative = |point: &TablePoint| point.output.is_sign_negative();
    let (index, other) = outputs.find(|(_, point)| is_negative(point) != is_negative(first))?;
    let message = format!(
        "`frict_comp.table[{index}].out` is {}, of the other sign than the {} before: friction has \
         one sign at all velocities",
        other.output, first.output
    );
    said(draft, index, message)
}

/// Reports outputs that drop to less than half from one point to the next and rise as sharply further on, or the
/// reverse. Friction may fall and rise over several points, and a table may begin at 0.
fn jump(draft: &FrictionDraft, points: &[TablePoint]) -> Option<Diagnostic> {
    let (mut valley, mut peak) = (None, None);
    for (index, pair) in (1..).zip(points.windows(2)) {
        let [from, to] = [pair[0].output.abs(), pair[1].output.abs()];
        let (is_fall, is_rise) = (to < 0.5 * from, from < 0.5 * to);
        let found = match (valley, peak) {
            (Some(at), _) if is_rise => Some((at, "less than half")),
            (_, Some(at)) if is_fall => Some((at, "more than twice")),
            _ => None,
        };
        if let Some((index, what)) = found {
            let output = points.get(index as usize)?.output;
            let message = format!(
                "`frict_comp.table[{index}].out` is {output}, {what} the outputs before and after it"
            );
            return said(draft, index, message);
        }
        if is_fall {
            valley.get_or_insert(index);
        }
        if is_rise && from > 0.0 {
            peak.get_or_insert(index);
        }
    }
    None
}

/// Returns FC139 at an output.
fn said(draft: &FrictionDraft, index: u32, message: String) -> Option<Diagnostic> {
    let place = draft.table.get(&index)?.output.as_ref()?.place();
    Some(
        Diagnostic::new(Code::Fc139, place, message)
            .with_help("compare the points with the measured friction"),
    )
}
