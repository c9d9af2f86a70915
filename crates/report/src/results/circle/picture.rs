//! The circular test as a magnified circle (R5.23).

use std::f64::consts::TAU;

use super::{CircleReport, Subject};
use crate::svg::PolarStroke;
use crate::svg::{PolarChart, PolarPanel, PolarSeries};
use crate::wording::{last_part, visible_line};
use frictcomp_physics::circle::{Direction, RadialProfile, UM_PER_M};

/// Points of a path in the picture.
const POINTS: usize = 7200;

/// Returns the paths of a circular test, compensation off and on in one circle at one magnification, and the deviation
/// left with compensation in an inset that magnifies it as far as it needs (R5.30).
pub fn picture(report: &CircleReport) -> PolarChart {
    let mut panels = Vec::new();
    let mut told = Vec::new();
    for side in &report.sides {
        let name = match side.name {
            "off" | "on" => format!("compensation {}", side.name),
            name => name.to_owned(),
        };
        let paths = &side.side.paths;
        let dashes = match paths.get(Direction::Cw) {
            Some(_) => " (clockwise in fine dashes)",
            None => "",
        };
        let series = paths.iter().map(|(direction, profile)| PolarSeries {
            name: format!("{name}{dashes}"),
            look: match side.name {
                "on" => 0,
                "off" => 1,
                _ => 2,
            },
            stroke: match direction {
                Direction::Cw => PolarStroke::Fine,
                _ => PolarStroke::Full,
            },
            points: outline(profile),
        });
        let glitch = match side.side.figures.glitch_max_um() {
            Some(glitch) => format!("largest glitch {glitch:.1} \u{b5}m"),
            None => "too fast for glitches".to_owned(),
        };
        told.push(format!("{name}: {glitch}"));
        panels.push(PolarPanel {
            label: format!("{name}, {glitch}"),
            series: series.collect(),
        });
    }
    if let [off, on] = &mut panels[..] {
        off.label.clone_from(&told[0]);
        off.series.extend(on.series.iter().cloned());
        on.label = told[1].replacen("compensation ", "", 1) + ", magnified";
    }
    PolarChart {
        description: format!(
            "Radial deviation from the circle, magnified, over the angle. {}.",
            told.join("; ")
        ),
        title: title(report),
        axes: ["X".to_owned(), "Y".to_owned()],
        radius: report.driven().0,
        panels,
    }
}

/// Returns the title of the picture and of the page.
pub(super) fn title(report: &CircleReport) -> String {
    let (radius, _) = report.driven();
    match &report.subject {
        Subject::Simulated { test, .. } => format!(
            "Circular test, plant {}, diameter {} mm, {} mm/min",
            visible_line(last_part(&test.plant.name)),
            2.0 * radius,
            test.circle.feed_mm_per_min
        ),
        Subject::Recorded(_) => format!("Recorded circle, diameter {:.3} mm", 2.0 * radius),
    }
}

/// Angles in rad and deviations in µm of a closed path.
fn outline(profile: &RadialProfile) -> Vec<[f64; 2]> {
    let points = profile.outline(POINTS).into_iter();
    let mut points: Vec<[f64; 2]> = points
        .map(|(angle, deviation)| [angle, deviation * UM_PER_M])
        .collect();
    if let Some(&[angle, deviation]) = points.first() {
        points.push([angle + TAU, deviation]);
    }
    points
}
