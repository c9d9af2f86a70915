//! The control's checks of a friction value list (chapter 3.4), and values that it accepts although they are implausible
//! (FC139).

use super::friction::{Field, FrictionDraft, FrictionList, TablePoint};
use super::line::{Given, Number, Written};
use super::parameter::{AxisType, Parameter};
use crate::comp::CncBuild;
use crate::diagnostic::{Code, Diagnostic, ReadableNumber, Severity};

/// Number of messages after which the rest of a broken table is not checked.
const MAX_DIAGNOSTICS: usize = 50;

/// Facts that the checks depend on, in addition to the list.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Conditions {
    /// The kernel version, if it is known.
    pub build: Option<CncBuild>,
    /// The type of the axis.
    pub axis_type: AxisType,
    /// The feed in mm/min of the circle that FC136 is based on.
    pub feed_mm_min: f64,
}

impl Default for Conditions {
    fn default() -> Self {
        Self {
            build: None,
            axis_type: AxisType::Linear,
            feed_mm_min: 1000.0,
        }
    }
}

/// The control's reaction to a list.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum Verdict {
    /// List without friction parameters.
    Absent,
    /// Mode 0.
    Off,
    /// A check failed; the code of the first one.
    Rejected(Code),
    /// List that works.
    Accepted(FrictionList),
}

/// A checked friction value list.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct FrictionReading {
    /// The control's reaction.
    pub verdict: Verdict,
    /// The table size that is reserved, P-COMP-00062.
    pub max_points: u32,
    /// Every parameter with its value and origin.
    pub parameters: Vec<Parameter>,
    /// Messages of the checks.
    pub diagnostics: Vec<Diagnostic>,
}

impl FrictionDraft {
    /// Checks the parameters as the control does when it loads the list (R3.20 to R3.29), and their plausibility.
    /// Checks that need the axis list are made when the axis is assembled.
    pub fn check(&self, conditions: &Conditions) -> FrictionReading {
        let mut check = Check {
            draft: self,
            conditions,
            diagnostics: Vec::new(),
        };
        let verdict = if self.is_empty() {
            Verdict::Absent
        } else {
            check.verdict()
        };
        FrictionReading {
            verdict,
            max_points: self.max_points(),
            parameters: self.parameters(conditions.axis_type),
            diagnostics: check.diagnostics,
        }
    }
}

struct Check<'a> {
    draft: &'a FrictionDraft,
    conditions: &'a Conditions,
    diagnostics: Vec<Diagnostic>,
}

impl Check<'_> {
    fn verdict(&mut self) -> Verdict {
        let list = self.values();
        let mut errors = self.diagnostics.iter_mut();
        let rejected = errors.find(|diagnostic| diagnostic.severity == Severity::Error);
        let rejected = rejected.map(|first| {
            let consequence = "the list is rejected, so friction compensation has no effect";
            first.advice.push(consequence.into());
            first.code
        });
        match (rejected, list) {
            (Some(first), _) => Verdict::Rejected(first),
            (None, Some((3, list))) => {
                self.check_first_point(&list);
                self.check_drive_range(&list);
                let found = doubts(self.draft, &list.table, self.conditions.axis_type);
                self.diagnostics.extend(found);
                Verdict::Accepted(list)
            }
            (None, _) => Verdict::Off,
        }
    }

    fn has(&self, code: Code) -> bool {
        self.diagnostics
            .iter()
            .any(|diagnostic| diagnostic.code == code)
    }

    /// Returns the mode and the values if every scalar is a number of its type; an invalid point is reported as an
    /// error.
    fn values(&mut self) -> Option<(u16, FrictionList)> {
        let mode = self.scalar(Field::Mode);
        let max_points = self.scalar(Field::MaxPoints);
        let entries = self.scalar(Field::TableEntries);
        let position_delay = self.scalar(Field::PositionDelay);
        let reversal_lookahead = self.scalar(Field::ReversalLookahead);
        let scaling_factor = self.scalar(Field::ScalingFactor);
        let delay_cycles = self.scalar(Field::DelayCycles);
        let entries: Option<u16> = entries;
        if let (Some(entries), Some(_)) = (entries, max_points) {
            self.check_size(entries);
        }
        self.check_mode(mode, entries);
        let is_empty = mode == Some(3) && self.has(Code::PErr110592);
        let table = if is_empty {
            Vec::new()
        } else {
            self.table(entries)
        };
        let _: Option<u32> = max_points;
        Some((
            mode?,
            FrictionList {
                position_delay: position_delay?,
                reversal_lookahead: reversal_lookahead?,
                scaling_factor: scaling_factor?,
                delay_cycles: delay_cycles?,
                max_points: self.draft.max_points(),
                table,
            },
        ))
    }

    /// Returns the value of a parameter or its default; `None` after FC130 (R3.24). Reports FC132 for a value outside
    /// the documented range (R3.25).
    fn scalar<T: TryFrom<i64>>(&mut self, field: Field) -> Option<T> {
        let Some(given) = self.draft.get(field) else {
            return T::try_from(field.default()).ok();
        };
        let range = field.type_range();
        let value = match given.value.number {
            Some(Number::Integer(value)) if range.contains(&value) || field.floors(value) => value,
            _ => {
                let why = match given.value.number {
                    Some(Number::Integer(value)) if field.is_end_of_open(value) => {
                        "an end of the open interval of the manual, which is outside".to_owned()
                    }
                    _ => format!(
                        "which is not a permitted value of type {}",
                        field.type_name()
                    ),
                };
                let diagnostic = Diagnostic::new(
                    Code::Fc130,
                    given.place(),
                    format!(
                        "`frict_comp.{}` is {}, {why}",
                        field.name(),
                        quoted(&given.value.text),
                    ),
                )
                .with_help(format!(
                    "write a whole number from {} to {}",
                    range.start(),
                    range.end()
                ));
                self.diagnostics.push(diagnostic);
                return None;
            }
        };
        if let Some(documented) = field.documented_range()
            && !documented.contains(&value)
        {
            let diagnostic = Diagnostic::new(
                Code::Fc132,
                given.place(),
                format!(
                    "`frict_comp.{}` is {value}; the documented range is {} to {}",
                    field.name(),
                    documented.start(),
                    documented.end()
                ),
            )
            .with_help(if field.floors(value) {
                "a negative value counts as 0"
            } else {
                "the value is used as given"
            });
            self.diagnostics.push(diagnostic);
        }
        T::try_from(if field.floors(value) { 0 } else { value }).ok()
    }

    /// Returns the used points that are numbers, after all checks of the table.
    fn table(&mut self, entries: Option<u16>) -> Vec<TablePoint> {
        if let Some(entries) = entries {
            self.check_count(u32::from(entries));
        }
        let points = self.points(entries.map_or(u32::MAX, u32::from));
        self.check_ascending(&points);
        points.into_iter().map(|(_, point)| point).collect()
    }

    /// Checks that the table fits into the reserved size (R3.23); `≤` (reading C6).
    fn check_size(&mut self, entries: u16) {
        let max_points = self.draft.max_points();
        let Some(given) = self.draft.get(Field::TableEntries) else {
            return;
        };
        if u32::from(entries) <= max_points {
            return;
        }
        let message = format!(
            "`frict_comp.table_entries` is {entries}, but `frict_comp.max_points` is {max_points}"
        );
        let diagnostic = Diagnostic::new(Code::Fc131, given.place(), message);
        self.diagnostics
            .push(match self.draft.get(Field::MaxPoints) {
                Some(max) => diagnostic.with_label(max.place(), "the reserved size"),
                None => diagnostic.with_help(format!(
                    "20 is the default; set `frict_comp.max_points` to {entries} or more"
                )),
            });
    }

    /// Checks that the mode is 0 or 3 (R3.21, reading C8), and that mode 3 has points.
    fn check_mode(&mut self, mode: Option<u16>, entries: Option<u16>) {
        let Some(given) = self.draft.get(Field::Mode) else {
            return;
        };
        let diagnostic = match (mode, entries) {
            (Some(3), Some(0)) => Diagnostic::new(
                Code::PErr110592,
                given.place(),
                "`frict_comp.mode` is 3, but `frict_comp.table_entries` is 0: there are no values",
            )
            .with_help("set `frict_comp.table_entries` to the number of points in the table"),
            (Some(0 | 3) | None, _) => return,
            (Some(mode), _) => Diagnostic::new(
                Code::PErr110592,
                given.place(),
                format!("`frict_comp.mode` is {mode}; the control knows only the modes 0 and 3"),
            )
            .with_help("3 is friction compensation by an additive current, 0 is off"),
        };
        self.diagnostics.push(diagnostic);
    }

    /// Checks that there are exactly as many points as are used (R3.26).
    fn check_count(&mut self, entries: u32) {
        let surplus = self.draft.table.range(entries..).next();
        if let Some((index, point)) = surplus
            && !self.has(Code::PErr110592)
            && let Some(given) = point.input.as_ref().or(point.output.as_ref())
        {
            let message = format!(
                "`frict_comp.table[{index}]` is not used: `frict_comp.table_entries` is {entries}"
            );
            self.diagnostics
                .push(Diagnostic::new(Code::Fc134, given.place(), message));
        }
        // A number of entries that exceeds the reserved size is itself wrong, and already reported.
        let number = self.draft.get(Field::TableEntries);
        let Some(given) = number.filter(|_| !self.has(Code::Fc131)) else {
            return;
        };
        let mut missing = (0..entries).filter(|index| !self.draft.table.contains_key(index));
        let Some(first) = missing.next() else {
            return;
        };
        let lacks = match missing.count() {
            0 => "is missing".to_owned(),
            more => format!("and {more} more are missing"),
        };
        let message = format!(
            "`frict_comp.table_entries` is {entries}, but `frict_comp.table[{first}]` {lacks}"
        );
        self.diagnostics
            .push(Diagnostic::new(Code::Fc133, given.place(), message));
    }

    /// Returns the points below an index whose values are numbers of their type (R3.24).
    fn points(&mut self, end: u32) -> Vec<(u32, TablePoint)> {
        let mut points = Vec::new();
        for (&index, point) in self.draft.table.range(..end) {
            let input = self.point_value(point.input.as_ref(), index, "in");
            let output = self.point_value(point.output.as_ref(), index, "out");
            if let (Some(input), Some(output)) = (input, output) {
                points.push((index, TablePoint { input, output }));
            } else if self.diagnostics.len() > MAX_DIAGNOSTICS {
                break;
            }
        }
        points
    }

    /// Returns one value of a point, 0 if it is missing; `None` after FC130 (R3.24).
    fn point_value(
        &mut self,
        given: Option<&Given<Written>>,
        index: u32,
        name: &str,
    ) -> Option<f64> {
        let Some(given) = given else {
            return Some(0.0);
        };
        let reals = self.conditions.build.map(CncBuild::reads_real_points);
        let whole = i64::from(i32::MIN) + 1..i64::from(i32::MAX);
        match given.value.number {
            Some(number @ Number::Real(_)) if reals != Some(false) => return Some(number.to_f64()),
            Some(number @ Number::Integer(value)) if whole.contains(&value) => {
                return Some(number.to_f64());
            }
            Some(number @ Number::Integer(_)) if reals == Some(true) => {
                return Some(number.to_f64());
            }
            _ => {}
        }
        let types = if reals == Some(false) {
            "SGN32"
        } else {
            "SGN32 or REAL64"
        };
        let mut diagnostic = Diagnostic::new(
            Code::Fc130,
            given.place(),
            format!(
                "`frict_comp.table[{index}].{name}` is {}, which is not a permitted value of type {types}",
                quoted(&given.value.text)
            ),
        );
        if let (Some(build), Some(Number::Real(_))) = (self.conditions.build, given.value.number) {
            diagnostic = diagnostic.with_help(format!(
                "fractions are accepted since V3.1.3132.0 and V4.29.0; this machine has {build}"
            ));
        }
        self.diagnostics.push(diagnostic);
        None
    }

    /// Checks that velocities are not negative and strictly ascending (R3.20, readings C4, C5).
    fn check_ascending(&mut self, points: &[(u32, TablePoint)]) {
        let mut before: Option<f64> = None;
        for &(index, TablePoint { input, .. }) in points {
            let why = match before {
                _ if input < 0.0 => Some("but velocities must not be negative".to_owned()),
                Some(before) if input <= before => Some(format!(
                    "which is not above the {before} of the previous point"
                )),
                _ => None,
            };
            before = Some(input);
            let written = self.draft.table.get(&index);
            let given = written.and_then(|w| w.input.as_ref().or(w.output.as_ref()));
            let (Some(why), Some(given)) = (why, given) else {
                continue;
            };
            if self.diagnostics.len() > MAX_DIAGNOSTICS {
                break;
            }
            let message = format!("`frict_comp.table[{index}].in` is {input}, {why}");
            self.diagnostics.push(
                Diagnostic::new(Code::PErr110591, given.place(), message).with_help(
                    "write the points with ascending velocities, starting at 0 or above",
                ),
            );
        }
    }

    /// Reports R3.28: with a first point (0, 0) the axis has no current until it reaches the second one. On a circle an
    /// axis leaves its reversal with a = v²/r; chapter 4.3 sets r = 100 mm and the limit of 10 ms.
    fn check_first_point(&mut self, list: &FrictionList) {
        const RADIUS_MM: f64 = 100.0;
        const LIMIT_MS: f64 = 10.0;
        let [first, second, ..] = list.table[..] else {
            return;
        };
        let zero = first.input.abs() < f64::EPSILON && first.output.abs() < f64::EPSILON;
        let second_given = self.draft.table.get(&1).and_then(|p| p.input.as_ref());
        let Some(given) = second_given.filter(|_| zero) else {
            return;
        };
        if self.conditions.axis_type != AxisType::Linear {
            return;
        }
        let feed = self.conditions.feed_mm_min;
        let velocity = feed / 60.0;
        let acceleration = velocity * velocity / RADIUS_MM * 1000.0;
        let time_ms = second.input / acceleration * 1000.0;
        if time_ms > LIMIT_MS {
            self.diagnostics.push(
                Diagnostic::new(
                    Code::Fc136,
                    given.place(),
                    format!(
                        "the current comes too late after reversals: the first point is (0, 0), and \
                         the axis needs {time_ms:.0} ms to reach the second at {} \u{b5}m/s on a \
                         circle of {RADIUS_MM} mm radius at {feed} mm/min",
                        second.input
                    ),
                )
                .with_help(
                    "give the first point the current of slow motion, \
                     `frict_comp.position_delay` shapes the build-up",
                ),
            );
        }
    }

    /// Checks the values against the torque object of the drive, which has 16 bits (R3.29).
    fn check_drive_range(&mut self, list: &FrictionList) {
        let scaled = |point: &TablePoint| point.output * f64::from(list.scaling_factor) / 1000.0;
        let largest = (0_u32..)
            .zip(&list.table)
            .map(|(index, point)| (index, scaled(point)))
            .max_by(|(_, a), (_, b)| a.abs().total_cmp(&b.abs()));
        if let Some((index, current)) = largest
            && current.abs() > f64::from(i16::MAX)
            && let Some(given) = self.draft.table.get(&index).and_then(|p| p.output.as_ref())
        {
            self.diagnostics.push(
                Diagnostic::new(
                    Code::Fc137,
                    given.place(),
                    format!(
                        "`frict_comp.table[{index}].out` gives {current} after scaling, a 16-bit \
                         torque object holds at most 32767"
                    ),
                )
                .with_help("the drive gets the limit instead"),
            );
        }
    }
}

/// Returns the text in backquotes, or words for an empty one.
fn quoted(text: &str) -> String {
    if text.is_empty() {
        "empty".to_owned()
    } else {
        format!("`{text}`")
    }
}

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
        nothing_added(draft, points).or_else(|| small_scaling(draft, points)),
        slow(draft, points).filter(|_| axis_type == AxisType::Linear),
        signs(draft, points).or_else(|| jump(draft, points)),
    ];
    checks.into_iter().flatten().collect()
}

/// Reports a list that adds nothing: a template that was not filled in, or a scaling factor of 0 (R3.31).
fn nothing_added(draft: &FrictionDraft, points: &[TablePoint]) -> Option<Diagnostic> {
    let factor = draft.get(Field::ScalingFactor);
    let factor = factor.filter(|given| given.value.number == Some(Number::Integer(0)));
    let is_empty = points.iter().all(|point| point.output == 0.0);
    let (place, cause) = match factor {
        Some(given) => (given.place(), "`frict_comp.scaling_factor` is 0"),
        None if is_empty => {
            let mut outputs = draft.table.values().filter_map(|it| it.output.as_ref());
            let first = outputs.next().map(Given::place);
            let place = first.or_else(|| Some(draft.anchor()?.place()))?;
            (place, "all outputs of the table are 0")
        }
        None => return None,
    };
    let message = format!("{cause}: the control adds nothing, although compensation is active");
    Some(
        Diagnostic::new(Code::Fc139, place, message)
            .with_help("fill in the friction of the axis, `frict_comp.mode` 0 is off"),
    )
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

/// Returns FC139 at an output of the table.
fn said(draft: &FrictionDraft, index: u32, message: String) -> Option<Diagnostic> {
    let place = draft.table.get(&index)?.output.as_ref()?.place();
    Some(
        Diagnostic::new(Code::Fc139, place, message)
            .with_help("compare the points with the measured friction"),
    )
}
