//! The report of a circular test.

use std::io::{self, Write};

use maud::{Markup, html};

use super::page::{Page, PagePart};
use super::parts::{figure, text_table, with_code};
use crate::circle::{CircleReport, Subject, advice_lines, conditions, table};
use crate::pictures::{circle, value_curve};
use crate::report_text::CaptionedTable;
use crate::svg::Frame;
use frictcomp::lists::{AxisType, FrictionList};
use frictcomp::machine::AcceptedList;
use frictcomp_physics::circle::Method;

const PICTURE: PagePart = PagePart::new("picture", "Circle");
const FIGURES: PagePart = PagePart::new("figures", "Figures");
const ADVICE: PagePart = PagePart::new("advice", "What the shapes suggest");
const CURVES: PagePart = PagePart::new("curves", "Value lists");
const CONDITIONS: PagePart = PagePart::new("conditions", "Conditions");

/// Writes the report of a circular test as one page.
///
/// # Errors
/// Those of `out`.
pub fn render_circle(report: &CircleReport, out: &mut dyn Write) -> io::Result<()> {
    let chart = circle(report);
    let told = conditions(report);
    let lists = lists(report);
    let mut parts = vec![PICTURE, FIGURES, ADVICE, CONDITIONS];
    if !lists.is_empty() {
        parts.insert(3, CURVES);
    }
    let mut page = Page::open(out, &chart.title, &report.headline(), &parts)?;
    page.part(PICTURE, &figure(chart.render(Frame::Inside("circle"))))?;
    let figures = CaptionedTable {
        caption: Some("Figures of ISO 230-4 and glitches at reversals"),
        table: &table(report),
    };
    page.part(FIGURES, &text_table(figures))?;
    page.part(ADVICE, &advice(report))?;
    if !lists.is_empty() {
        page.part(CURVES, &curves(&lists))?;
    }
    page.part(
        CONDITIONS,
        &html! { @for line in &told { p { (with_code(line)) } } },
    )?;
    page.close()
}

fn advice(report: &CircleReport) -> Markup {
    let sides = report.sides.iter();
    let lines: Vec<String> = sides.flat_map(|side| advice_lines(report, side)).collect();
    html! {
        @if lines.is_empty() {
            p { "The shapes suggest nothing." }
        } @else {
            ul { @for line in &lines { li { (line) } } }
        }
    }
}

fn curves(lists: &[AcceptedList]) -> Markup {
    html! {
        @for (number, list) in lists.iter().enumerate() {
            @let name = format!("curve{number}");
            (figure(value_curve(list).render(Frame::Inside(&name))))
        }
    }
}

/// The value lists of the axes, one if both have the same.
fn lists(report: &CircleReport) -> Vec<AcceptedList> {
    let Subject::Simulated { test, .. } = &report.subject else {
        return Vec::new();
    };
    let accepted = |axis: &str, list: &FrictionList| AcceptedList {
        axis: axis.to_owned(),
        axis_type: AxisType::Linear,
        list: list.clone(),
    };
    let lists = test.compensation.each_ref();
    let [Some(x), Some(y)] = lists.map(|it| it.as_ref().and_then(Method::list)) else {
        return Vec::new();
    };
    if x == y {
        vec![accepted("X and Y", x)]
    } else {
        vec![accepted("X", x), accepted("Y", y)]
    }
}
