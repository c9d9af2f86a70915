//! The friction of an axis over the dates of its recordings, as text and JSON (R16.6).

use std::fmt::Write as _;

use serde::Serialize;

use crate::document::{Document, Headline, Standing, Table};
use crate::pictures::friction_trend;
use crate::wording::{counted, to_json, visible_line};
use frictcomp_recordings::identify::{
    DatedFriction, FrictionChange, FrictionParameter, TrendReport,
};

/// Returns the verdict: the parameters that changed, and by how much the one that changed most.
pub fn headline(report: &TrendReport) -> Headline {
    let most = report
        .changes
        .iter()
        .max_by(|one, other| one.part.abs().total_cmp(&other.part.abs()));
    let text = match most {
        None => format!(
            "no parameter of these {} changed by more than 3 combined errors and 5 %",
            counted(report.dates.len(), "recording")
        ),
        Some(most) => {
            let is_changed = |it: &&FrictionParameter| {
                let mut changes = report.changes.iter();
                changes.any(|change| change.parameter == **it)
            };
            let changed = FrictionParameter::ALL.iter().filter(is_changed);
            let changed: Vec<&str> = changed.map(|it| it.as_str()).collect();
            let (name, by) = (most.parameter.as_str(), change_of(report, most));
            match &changed[..] {
                [.., _, _] => format!("{} changed; {name} most, by {by}", changed.join(", ")),
                _ => format!("{name} changed by {by}"),
            }
        }
    };
    Headline::new(Standing::Plain, text)
}

/// Returns the size of a change and its dates.
fn change_of(report: &TrendReport, change: &FrictionChange) -> String {
    let date = |at: usize| report.dates.get(at).map_or("?", |it| &it.date);
    let whole = match change.parameter {
        FrictionParameter::Offset => " of Fc",
        _ => "",
    };
    format!(
        "{:+.1} %{whole} between {} and {}",
        change.part * 100.0,
        date(change.from),
        date(change.to)
    )
}

/// Returns a row for each recording, then the changes, then the files left out.
pub fn document(report: &TrendReport) -> Document<'_> {
    let axis = report
        .axis
        .as_deref()
        .map(|it| format!(" of axis {}", visible_line(it)));
    let axis = axis.unwrap_or_default();
    let mut out = Document::new(format!("Friction{axis} over time"), headline(report));
    out.figure(|| friction_trend(report));
    let _ = writeln!(
        out,
        "\nfriction{axis} over {}, in {}, fv per mm/s\n",
        counted(report.dates.len(), "recording"),
        visible_line(&report.unit)
    );
    let names = FrictionParameter::ALL.iter().map(|it| it.as_str());
    let table = names.fold(Table::default().left("date"), Table::right);
    let mut table = table.left("recording");
    for dated in &report.dates {
        let levels = FrictionParameter::ALL.iter().map(|&parameter| {
            let level = dated.levels.get(parameter);
            let digits = if parameter == FrictionParameter::Viscous {
                4
            } else {
                2
            };
            format!("{:.digits$} ± {:.digits$}", level.value, level.error)
        });
        let mut cells = vec![dated.date.clone()];
        cells.extend(levels);
        cells.push(visible_line(&dated.file).into_owned());
        table.cells(cells);
    }
    out.table(table);
    out.push_str("\n");
    for change in &report.changes {
        let _ = writeln!(
            out,
            "{} changed by {}, {:.0} combined errors",
            change.parameter.as_str(),
            change_of(report, change),
            change.errors
        );
    }
    for (file, reason) in &report.left_out {
        let _ = writeln!(
            out,
            "left out: {}: {}",
            visible_line(file),
            visible_line(reason)
        );
    }
    out
}

#[derive(Serialize)]
struct TrendDocument<'a> {
    schema: u32,
    headline: Headline,
    axis: Option<&'a str>,
    unit: &'a str,
    dates: Vec<Dated<'a>>,
    changes: Vec<Changed<'a>>,
    left_out: Vec<LeftOutRecord<'a>>,
}

#[derive(Serialize)]
#[allow(non_snake_case)] // the names of the parameters as they are written
struct Dated<'a> {
    date: &'a str,
    file: &'a str,
    Fc: [f64; 2],
    Fs: [f64; 2],
    fv: [f64; 2],
    offset: [f64; 2],
}

#[derive(Serialize)]
struct Changed<'a> {
    parameter: &'static str,
    from: &'a str,
    to: &'a str,
    part: f64,
    errors: f64,
}

#[derive(Serialize)]
struct LeftOutRecord<'a> {
    file: &'a str,
    reason: &'a str,
}

/// Returns the report as JSON; each parameter with its standard error.
pub fn render_json(report: &TrendReport) -> String {
    let date = |at: usize| report.dates.get(at).map_or("", |it| &it.date);
    let parameters = |it: &DatedFriction| {
        FrictionParameter::ALL.map(|parameter| {
            let level = it.levels.get(parameter);
            [level.value, level.error]
        })
    };
    let dates = report.dates.iter().map(|it| {
        let [coulomb, breakaway, viscous, offset] = parameters(it);
        Dated {
            date: &it.date,
            file: &it.file,
            Fc: coulomb,
            Fs: breakaway,
            fv: viscous,
            offset,
        }
    });
    let changes = report.changes.iter().map(|it| Changed {
        parameter: it.parameter.as_str(),
        from: date(it.from),
        to: date(it.to),
        part: it.part,
        errors: it.errors,
    });
    to_json(&TrendDocument {
        schema: 1,
        headline: headline(report),
        axis: report.axis.as_deref(),
        unit: &report.unit,
        dates: dates.collect(),
        changes: changes.collect(),
        left_out: report
            .left_out
            .iter()
            .map(|(file, reason)| LeftOutRecord { file, reason })
            .collect(),
    })
}
