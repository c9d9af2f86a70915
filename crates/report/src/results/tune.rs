//! The result of a tuning as text and JSON.

use std::fmt::Write as _;

use frictcomp::lists::{FrictionList, TablePoint};
use frictcomp_physics::circle::{
    Candidate, FeedResult, Method, RemainingGlitch, Robust, Task, Tuned, TunedAxis,
};
use frictcomp_physics::stiction::StictionParameters;
use frictcomp_recordings::value_lists::{TunedFor, tuned_range};
use serde::Serialize;

use super::circle::stiction_line;
use crate::assumptions::{not_modelled, not_modelled_line};
use crate::document::{Document, Headline, Standing, Table};
use crate::pictures::tuning;
use crate::wording::{last_part, to_json, visible_line};

/// A tuned plant.
#[derive(Debug, Clone)]
pub struct TuneReport {
    /// The name of the plant.
    pub plant: String,
    /// The name of the friction model.
    pub model: &'static str,
    /// The reading of the documents, in words.
    pub reading: String,
    /// Properties of a machine that the simulation leaves out.
    pub not_modelled: Vec<&'static str>,
    /// The result.
    pub tuned: Tuned,
}

impl TuneReport {
    /// Creates the report on a task with its result.
    pub fn new(task: &Task, tuned: Tuned) -> Self {
        Self {
            plant: task.plant.name.clone(),
            model: task.model.as_str(),
            reading: task.reading.to_string(),
            not_modelled: not_modelled([&task.plant.x, &task.plant.y]),
            tuned,
        }
    }

    /// Returns the origin of the list of an axis.
    pub fn list_of<'a>(&'a self, axis: &'a TunedAxis) -> TunedFor<'a> {
        TunedFor {
            plant: &self.plant,
            model: self.model,
            tuned: &self.tuned,
            axis,
        }
    }
}

/// Returns the checks between the circles, and on machines that deviate from the plant (R5.29).
fn checked(tuned: &Tuned) -> String {
    let largest = |of: fn(&RemainingGlitch) -> f64| tuned.check.iter().map(of).fold(0.0, f64::max);
    let worst = tuned
        .check
        .iter()
        .max_by(|one, other| one.glitch_on_um.total_cmp(&other.glitch_on_um));
    let mut out = format!(
        "checked at {} and 4 places of the reversal in the CNC cycle: at most {:.3} \u{b5}m, at {:.2} \
         mm/s\u{b2}\nthe contact half as stiff {:.3}, twice as stiff {:.3}, friction \u{b1}10 % between the \
         directions {:.3} \u{b5}m\n",
        match tuned.check.len() {
            1 => "1 acceleration".to_owned(),
            count => format!("{count} accelerations"),
        },
        worst.map_or(0.0, |it| it.glitch_on_um),
        worst.map_or(0.0, |it| it.acceleration_mm_per_s2),
        largest(|it| it.glitch_half_stiff_um),
        largest(|it| it.glitch_double_stiff_um),
        largest(|it| it.glitch_uneven_um),
    );
    if let Some(robust) = &tuned.robust {
        let Robust {
            is_taken,
            plain_um,
            robust_um,
        } = robust;
        let _ = if *is_taken {
            writeln!(
                out,
                "robust: over all of these at most {robust_um:.3} \u{b5}m, {plain_um:.3} with the list for the plant alone"
            )
        } else {
            writeln!(
                out,
                "robust: a list for all of these leaves {robust_um:.3} \u{b5}m in place of {plain_um:.3}, not 5 % less \
                 or too much on the plant itself; the list is the one for the plant alone"
            )
        };
    }
    out
}

impl TuneReport {
    /// Returns the verdict with the name of the plant.
    fn verdict(&self) -> String {
        format!("plant {}: {}", visible_line(&self.plant), self.headline())
    }

    /// Returns the verdict: the largest glitch that is left, and that without compensation (R18.20).
    pub fn headline(&self) -> Headline {
        let feeds = self.tuned.feeds.iter();
        let [least, most] = feeds.fold([f64::INFINITY, 0.0], |[least, most]: [f64; 2], it| {
            [least.min(it.feed_mm_per_min), most.max(it.feed_mm_per_min)]
        });
        let feeds = self.tuned.feeds.iter().map(|it| it.glitch_off_um);
        let (on, off) = (self.tuned.worst_um(), feeds.fold(0.0, f64::max));
        let standing = if on < off {
            Standing::Plain
        } else {
            Standing::Bad
        };
        let range = if least < most {
            format!("from {least:.0} to {most:.0} mm/min")
        } else {
            format!("at {most:.0} mm/min")
        };
        Headline::new(
            standing,
            format!("largest glitch {on:.1} µm {range} ({off:.1} µm without compensation)"),
        )
    }
}

/// Returns the parameters and the glitches before and after, of each plant.
pub fn document(reports: &[TuneReport]) -> Document<'_> {
    let mut out = Document::new(title(reports), headline(reports));
    out.figure(move || tuning(reports));
    for (at, report) in reports.iter().enumerate() {
        let of_plant = match reports {
            [_] => String::new(),
            _ => format!(" of plant {}", last_part(&report.plant)),
        };
        if at > 0 {
            out.section(format!("Parameters{of_plant}"));
            let _ = writeln!(out, "\n{}", report.verdict());
        }
        push_tuned(&mut out, report, &of_plant);
    }
    out
}

/// Returns the title of the picture and of the page.
pub(crate) fn title(reports: &[TuneReport]) -> String {
    match reports {
        [one] => format!(
            "Glitch before and after tuning, plant {}",
            last_part(&one.plant)
        ),
        _ => "Glitch before and after tuning".to_owned(),
    }
}

/// Returns the verdict on the first plant, with its name if there are several.
fn headline(reports: &[TuneReport]) -> Headline {
    match reports {
        [] => Headline::default(),
        [one] => one.headline(),
        [first, ..] => Headline::new(first.headline().standing, first.verdict()),
    }
}

fn push_tuned(out: &mut Document<'_>, report: &TuneReport, of_plant: &str) {
    let [x, y] = &report.tuned.axes;
    if x == y {
        parameters(out, "", x);
    } else {
        parameters(out, "X: ", x);
        parameters(out, "Y: ", y);
    }
    out.folded(format!("Conditions{of_plant}"));
    let _ = writeln!(
        out,
        "plant {}, friction {}, {} {} tried\nreading: {}\n{}; beyond that the glitch is not known\n{}{}",
        visible_line(&report.plant),
        report.model,
        report.tuned.trials,
        if report.tuned.is_stiction() {
            "sets of parameters"
        } else {
            "lists"
        },
        report.reading,
        tuned_range(&report.tuned),
        checked(&report.tuned),
        not_modelled_line(&report.not_modelled)
    );
    out.section(format!("Glitches{of_plant}"));
    let headings = [
        "v\u{b2}/R mm/s\u{b2}",
        "feed mm/min",
        "radius mm",
        "glitch \u{b5}m off",
        "on",
        "friction -20 %",
        "friction +20 %",
    ];
    let mut table = Table::of_numbers(headings);
    let mut rows: Vec<&FeedResult> = report.tuned.feeds.iter().collect();
    rows.sort_by(|one, other| {
        let by = |it: &FeedResult| it.acceleration_mm_per_s2;
        by(one).total_cmp(&by(other))
    });
    for row in rows {
        table.row(&[
            &format_args!("{:.3}", row.acceleration_mm_per_s2),
            &short(row.feed_mm_per_min),
            &short(row.radius_mm),
            &format_args!("{:.1}", row.glitch_off_um),
            &format_args!("{:.1}", row.glitch_on_um),
            &format_args!("{:.1}", row.glitch_friction_minus20_um),
            &format_args!("{:.1}", row.glitch_friction_plus20_um),
        ]);
    }
    out.push_str("\n");
    out.table(table);
}

/// Returns a feed or a radius with a decimal, if it has one.
fn short(value: f64) -> f64 {
    (value * 10.0).round() / 10.0
}

fn parameters(out: &mut Document<'_>, axis: &str, tuned: &TunedAxis) {
    let line = match &tuned.compensation {
        Some(Method::Current(list)) => list_line(list, tuned),
        Some(Method::Stiction(stiction)) => stiction_line(stiction),
        None => "no compensation".to_owned(),
    };
    let _ = writeln!(out, "{axis}{line}");
}

fn list_line(list: &FrictionList, tuned: &TunedAxis) -> String {
    let table = if tuned.is_shaped {
        "shaped below 1 mm/s"
    } else {
        "the friction curve"
    };
    format!(
        "position_delay {}, reversal_lookahead {}, delay_cycles {}, scaling_factor {}, table: {table}",
        list.position_delay, list.reversal_lookahead, list.delay_cycles, list.scaling_factor
    )
}

#[derive(Serialize)]
struct TuneDocument<'a> {
    schema: u32,
    #[serde(flatten)]
    first: PlantRecord<'a>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    compared: Vec<PlantRecord<'a>>,
}

#[derive(Serialize)]
struct PlantRecord<'a> {
    plant: &'a str,
    headline: Headline,
    model: &'static str,
    reading: &'a str,
    not_modelled: &'a [&'static str],
    trials: usize,
    /// The parameters of X.
    parameters: Option<TunedParameters>,
    axes: AxisRecords,
    tuned_for: Accelerations,
    feeds: &'a [FeedResult],
    check: &'a [RemainingGlitch],
    #[serde(skip_serializing_if = "Option::is_none")]
    robust: Option<Robust>,
    glitch_max: f64,
}

/// The result for each axis.
#[derive(Serialize)]
struct AxisRecords {
    #[serde(rename = "X")]
    x: AxisTuningRecord,
    #[serde(rename = "Y")]
    y: AxisTuningRecord,
}

#[derive(Serialize)]
struct AxisTuningRecord {
    /// `null` for an axis without compensation.
    parameters: Option<TunedParameters>,
    is_shaped: bool,
    /// Pairs of velocity and output; absent if there is no value list.
    #[serde(skip_serializing_if = "Option::is_none")]
    table: Option<Vec<[f64; 2]>>,
}

/// Parameters of a value list, or of stiction compensation.
#[derive(Serialize)]
#[serde(untagged)]
enum TunedParameters {
    List(Candidate),
    Stiction(StictionParameters),
}

impl TunedParameters {
    fn of(axis: &TunedAxis) -> Option<Self> {
        Some(match axis.compensation.as_ref()? {
            Method::Current(list) => Self::List(Candidate::of(list)),
            Method::Stiction(stiction) => Self::Stiction(*stiction),
        })
    }
}

/// The range of v²/R in mm/s².
#[derive(Serialize)]
struct Accelerations {
    acceleration_min: f64,
    acceleration_max: f64,
}

impl AxisTuningRecord {
    fn of(axis: &TunedAxis) -> Self {
        let pair = |point: &TablePoint| [point.input, point.output];
        Self {
            parameters: TunedParameters::of(axis),
            is_shaped: axis.is_shaped,
            table: axis
                .list()
                .map(|list| list.table.iter().map(pair).collect()),
        }
    }
}

impl<'a> PlantRecord<'a> {
    fn of(report: &'a TuneReport) -> Self {
        let [acceleration_min, acceleration_max] = report.tuned.accelerations();
        let [x, y] = &report.tuned.axes;
        Self {
            plant: &report.plant,
            headline: report.headline(),
            model: report.model,
            reading: &report.reading,
            not_modelled: &report.not_modelled,
            trials: report.tuned.trials,
            parameters: TunedParameters::of(x),
            axes: AxisRecords {
                x: AxisTuningRecord::of(x),
                y: AxisTuningRecord::of(y),
            },
            tuned_for: Accelerations {
                acceleration_min,
                acceleration_max,
            },
            glitch_max: report.tuned.worst_um(),
            feeds: &report.tuned.feeds,
            check: &report.tuned.check,
            robust: report.tuned.robust,
        }
    }
}

/// Returns the report as JSON; glitches in µm, feeds in mm/min, radii in mm. The first plant is at the top, the others
/// are under `compared`.
pub fn render_json(reports: &[TuneReport]) -> String {
    let Some((first, others)) = reports.split_first() else {
        return String::new();
    };
    let document = TuneDocument {
        schema: 1,
        first: PlantRecord::of(first),
        compared: others.iter().map(PlantRecord::of).collect(),
    };
    to_json(&document)
}
