//! The report of a circular test.

use std::io::{self, Write};

use super::page::{NUMBERS, Page, Part};
use crate::lists::AxisType;
use crate::machine::AcceptedList;
use crate::report::circle::{CircleReport, Subject, advice_lines, conditions, table};
use crate::report::pictures::{circle, value_curve};
use crate::report::svg::Frame;

const PICTURE: Part = Part {
    id: "picture",
    title: "Circle",
};
const FIGURES: Part = Part {
    id: "figures",
    title: "Figures",
};
const ADVICE: Part = Part {
    id: "advice",
    title: "What the shapes suggest",
};
const CURVES: Part = Part {
    id: "curves",
    title: "Value lists",
};
const CONDITIONS: Part = Part {
    id: "conditions",
    title: "Conditions",
};

/// Writes the report of a circular test as one page.
///
/// # Errors
/// Those of `out`.
pub fn render_circle(report: &CircleReport, out: &mut dyn Write) -> io::Result<()> {
    let chart = circle(report);
    let told = conditions(report);
    let lead = told.first().map(String::as_str).unwrap_or_default();
    let lists = lists(report);
    let mut parts = vec![PICTURE, FIGURES, ADVICE, CONDITIONS];
    if !lists.is_empty() {
        parts.insert(3, CURVES);
    }
    let mut page = Page::open(out, &chart.title, lead, &parts)?;
    page.part(PICTURE);
    page.figure(&chart.render(Frame::Inside("circle")));
    page.end_part()?;
    page.part(FIGURES);
    render_figures(&mut page, report);
    page.end_part()?;
    page.part(ADVICE);
    render_advice(&mut page, report);
    page.end_part()?;
    if !lists.is_empty() {
        page.part(CURVES);
        for (number, list) in lists.iter().enumerate() {
            let name = format!("curve{number}");
            page.figure(&value_curve(list).render(Frame::Inside(&name)));
        }
        page.end_part()?;
    }
    page.part(CONDITIONS);
    for line in &told {
        page.paragraph(line);
    }
    page.end_part()?;
    page.close()
}

fn render_figures(page: &mut Page<'_>, report: &CircleReport) {
    let table = table(report);
    let mut columns = vec!["figure"];
    let numbers: Vec<String> = table
        .columns
        .iter()
        .map(|name| format!("{NUMBERS}{name}"))
        .collect();
    columns.extend(numbers.iter().map(String::as_str));
    page.open_table(
        "Figures of ISO 230-4 and glitches at reversals, in µm",
        &columns,
    );
    for row in &table.rows {
        let values = row.values.iter();
        let cells: Vec<String> = values
            .map(|value| value.map(|value| format!("{value:.3}")).unwrap_or_default())
            .collect();
        page.row(&row.name, &cells);
    }
    page.close_table();
}

fn render_advice(page: &mut Page<'_>, report: &CircleReport) {
    let lines: Vec<String> = report.sides.iter().flat_map(advice_lines).collect();
    if lines.is_empty() {
        page.paragraph("The shapes suggest nothing.");
        return;
    }
    page.raw("<ul>\n");
    for line in lines {
        page.raw("<li>");
        page.text(&line);
        page.raw("</li>\n");
    }
    page.raw("</ul>\n");
}

/// The value lists of the axes, one where both have the same.
fn lists(report: &CircleReport) -> Vec<AcceptedList> {
    let Subject::Simulated { test, .. } = &report.subject else {
        return Vec::new();
    };
    let accepted = |axis: &str, list: &crate::lists::FrictionList| AcceptedList {
        axis: axis.to_owned(),
        axis_type: AxisType::Linear,
        list: list.clone(),
    };
    let [x, y] = &test.lists;
    if x == y {
        vec![accepted("X and Y", x)]
    } else {
        vec![accepted("X", x), accepted("Y", y)]
    }
}
