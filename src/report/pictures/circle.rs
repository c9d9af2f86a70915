//! The circular test as a magnified circle (R5.23).

use std::f64::consts::TAU;

use crate::circle::{RadialProfile, UM_PER_M};
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
                    "off" | "on" => format!("compensation {}, {}", side.name, direction),
                    name => format!("{name}, {direction}"),
                },
                points: outline(profile),
            });
        }
        if let Some(glitch) = side.side.figures.glitch_max_um() {
            told.push(format!("{}: largest glitch {glitch:.1} µm", side.name));
        }
    }
    let (title, radius) = match &report.subject {
        Subject::Simulated { test, .. } => (
            format!(
                "Circular test, diameter {} mm, {} mm/min",
                2.0 * test.circle.radius_mm,
                test.circle.feed_mm_per_min
            ),
            test.circle.radius_mm,
        ),
        Subject::Recorded(recording) => {
            let fitted = recording.circles.first().map(|circle| circle.radius_mm);
            let radius = recording.commanded.radius_mm.or(fitted).unwrap_or_default();
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
