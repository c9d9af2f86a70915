//! The circular test as a magnified circle (R5.23).

use std::f64::consts::TAU;

use crate::circle::Profile;
use crate::report::circle::{CircleReport, Subject};
use crate::report::svg::{PolarChart, PolarSeries};

/// Points of a path in the picture.
const POINTS: usize = 7200;

/// The paths of a circular test, compensation off and on in one picture.
pub fn circle(report: &CircleReport) -> PolarChart {
    let mut series = Vec::new();
    let mut told = Vec::new();
    for side in &report.sides {
        for (direction, profile) in side.side.paths.iter() {
            series.push(PolarSeries {
                name: match side.name {
                    "off" | "on" => format!("compensation {}, {}", side.name, direction.name()),
                    name => format!("{name}, {}", direction.name()),
                },
                points: outline(profile),
            });
        }
        let glitch = side.side.figures.glitch_max();
        told.push(format!("{}: largest glitch {glitch:.1} µm", side.name));
    }
    let (title, radius) = match &report.subject {
        Subject::Simulated { test, .. } => (
            format!(
                "Circular test, diameter {} mm, {} mm/min",
                2.0 * test.circle.radius,
                test.circle.feed
            ),
            test.circle.radius,
        ),
        Subject::Recorded(recording) => {
            let fitted = recording.circles.first().map(|circle| circle.radius);
            let radius = recording.radius.or(fitted).unwrap_or_default();
            (
                format!("Recorded circle, diameter {:.3} mm", 2.0 * radius),
                radius,
            )
        }
    };
    PolarChart {
        description: format!(
            "Radial deviation from the circle, magnified, over the angle. {}.",
            told.join("; ")
        ),
        title,
        axes: ["X".to_owned(), "Y".to_owned()],
        radius,
        series,
    }
}

/// Angles in rad and deviations in µm of a closed path.
fn outline(profile: &Profile) -> Vec<[f64; 2]> {
    let points = profile.outline(POINTS).into_iter();
    let mut points: Vec<[f64; 2]> = points
        .map(|(angle, deviation)| [angle, deviation * 1e6])
        .collect();
    if let Some(&[angle, deviation]) = points.first() {
        points.push([angle + TAU, deviation]);
    }
    points
}
