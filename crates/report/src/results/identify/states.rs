//! Friction of one axis in several states as text and JSON (R16.6).

use std::fmt::Write as _;

use serde::Serialize;

use super::{IdentifyReport, push_identified, record};
use crate::document::{Document, Headline, Standing, Table};
use crate::pictures::friction_states;
use crate::wording::{to_json, visible_line};
use frictcomp::diagnostic::Rounded;
use frictcomp_recordings::identify::ComparedStates;

/// A spread above which one list does not suit all states.
const WIDE: f64 = 0.1;

/// Recordings of one axis in several states.
#[derive(Debug, Clone)]
pub struct StatesReport {
    /// The names of the states and the friction identified in each.
    pub states: Vec<(String, IdentifyReport)>,
    /// The index of the state that the list is for.
    pub working: usize,
    /// The states side by side.
    pub compared: ComparedStates,
}

impl StatesReport {
    /// Returns the name of the state that the list is for.
    pub fn working_name(&self) -> &str {
        self.states.get(self.working).map_or("", |it| &it.0)
    }

    /// Returns the verdict: the spread of the states, and the state for which the list is (R18.20).
    pub fn headline(&self) -> Headline {
        let findings = self.states.iter().flat_map(|(_, report)| report.findings());
        // Faults of a recording have the higher codes.
        let mut findings: Vec<_> = findings.collect();
        findings.sort_by_key(|it| std::cmp::Reverse(it.code));
        Headline::new(Standing::Plain, self.spread()).with_fault(findings)
    }

    /// Returns the spread of the states in a sentence.
    pub fn spread(&self) -> String {
        let working = visible_line(self.working_name());
        let Some((speed, spread)) = self
            .compared
            .widest()
            .and_then(|row| Some((row.speed, row.spread?)))
        else {
            return format!(
                "the states have no common speed: nothing is known of other states than `{working}`"
            );
        };
        let verdict = if spread > WIDE {
            format!("the list is for `{working}` alone")
        } else {
            format!(
                "less than {:.0} %, so the list of `{working}` serves all of them",
                WIDE * 100.0
            )
        };
        format!(
            "friction differs between the states by up to {:.1} %, at {speed:.3} mm/s: {verdict}",
            spread * 100.0
        )
    }
}

/// Returns the states side by side, then the one that the list is for.
pub fn document(report: &StatesReport) -> Document<'_> {
    let mut out = Document::new("Friction in several states", report.headline());
    out.figure(|| friction_states(report));
    out.push_str("\nfriction in each state, with its standard error\n\n");
    let names = report.states.iter().map(|(name, _)| visible_line(name));
    let table = names.fold(Table::of_numbers(["speed\nmm/s"]), Table::right);
    let mut table = table.right("spread");
    for row in &report.compared.rows {
        let frictions = row.frictions.iter().map(|friction| match friction {
            Some([value, error]) => format!("{} ± {error:.3}", Rounded(*value, 3)),
            None => "not recorded".to_owned(),
        });
        let spread = row.spread.map(|it| format!("{:.1} %", it * 100.0));
        let mut cells = vec![format!("{:.3}", row.speed)];
        cells.extend(frictions);
        cells.push(spread.unwrap_or_else(|| "-".to_owned()));
        table.cells(cells);
    }
    let mut cells = vec!["offset".to_owned()];
    let offsets = report.states.iter().map(|(_, it)| it.identified.offset);
    cells.extend(offsets.map(|offset| Rounded(offset, 3).to_string()));
    table.cells(cells);
    out.table(table);
    if let Some((name, working)) = report.states.get(report.working) {
        let name = visible_line(name);
        out.section(format!("Identified in the state {name}"));
        let _ = writeln!(out, "\nthe list is for `{name}`:\n{}", working.headline());
        push_identified(&mut out, working);
    }
    out
}

#[derive(Serialize)]
struct StatesDocument<'a, T> {
    schema: u32,
    headline: Headline,
    working: &'a str,
    spread: Option<f64>,
    speeds: Vec<SpeedStateRecord<'a>>,
    states: Vec<State<'a, T>>,
}

#[derive(Serialize)]
struct SpeedStateRecord<'a> {
    /// Velocity in µm/s or 0.001°/s.
    v: f64,
    frictions: &'a [Option<[f64; 2]>],
    spread: Option<f64>,
}

#[derive(Serialize)]
struct State<'a, T> {
    name: &'a str,
    file: &'a str,
    identified: T,
}

/// Returns the report as JSON; each state as `identify` gives it alone.
pub fn render_json(report: &StatesReport) -> String {
    let states = report.states.iter().map(|(name, found)| State {
        name,
        file: &found.name,
        identified: record(found),
    });
    let rows = report.compared.rows.iter().map(|row| SpeedStateRecord {
        v: row.speed * 1000.0,
        frictions: &row.frictions,
        spread: row.spread,
    });
    to_json(&StatesDocument {
        schema: 1,
        headline: report.headline(),
        working: report.working_name(),
        spread: report.compared.widest().and_then(|it| it.spread),
        speeds: rows.collect(),
        states: states.collect(),
    })
}
