//! The path of the tool beside a contour (R11.30).

use std::collections::BTreeMap;
use std::f64::consts::TAU;
use std::fmt::Write as _;
use std::sync::Arc;

use frictcomp_physics::motion::{PlannerOptions, PositionFrame, ToolRadii};

use super::{MACHINE, Trace, assert_limits, trace, trace_of};

const AXES: [&str; 2] = ["X", "Y"];

fn followed(program: &str, radius: f64) -> Trace {
    let options = PlannerOptions::default().with_tool_radii(ToolRadii::Every(radius));
    trace_of(MACHINE, program, &AXES, options)
}

/// Returns the positions while some lines are executed.
fn places(trace: &Trace, lines: std::ops::RangeInclusive<u32>) -> Vec<[f64; 2]> {
    let cycles = trace.positions.iter().zip(&trace.lines);
    let within = cycles.filter(|(_, line)| lines.contains(line));
    within.map(|(place, _)| [place[0], place[1]]).collect()
}

/// Returns the distance of a place from a polyline.
fn distance(polyline: &[[f64; 2]], place: [f64; 2]) -> f64 {
    let each = polyline.windows(2).map(|ends| {
        let way = [ends[1][0] - ends[0][0], ends[1][1] - ends[0][1]];
        let gone = [place[0] - ends[0][0], place[1] - ends[0][1]];
        let square = way[0].powi(2) + way[1].powi(2);
        let share = ((gone[0] * way[0] + gone[1] * way[1]) / square).clamp(0.0, 1.0);
        (gone[0] - share * way[0]).hypot(gone[1] - share * way[1])
    });
    each.fold(f64::INFINITY, f64::min)
}

#[test]
fn each_d_word_has_its_radius() {
    // R11.30: one that is not given, not known, or only perhaps selected leaves the programmed contour, which is said.
    let radii = ToolRadii::OfData(Arc::new(BTreeMap::from([(1, 3.0), (2, 5.0)])));
    let options = PlannerOptions::default().with_tool_radii(radii);
    for (selected, expected, code) in [
        ("D1", 17.0, "FC907"),
        ("D1\nD2", 15.0, "FC907"),
        ("D9", 20.0, "FC904"),
        ("", 20.0, "FC904"),
        ("D2\nD=V.E.A", 20.0, "FC904"),
        ("D1\n$IF V.E.A == 1\nD2\n$ENDIF", 20.0, "FC904"),
    ] {
        let program =
            format!("{selected}\nG01 X0 Y0 F1000\nG41 X20\nG03 I-20\nG40 G01 X0\nX1\nM30");
        let trace = trace_of(MACHINE, &program, &AXES, options.clone());
        let line = u32::try_from(selected.lines().count().max(1)).expect("few") + 3;
        let circle = places(&trace, line..=line);
        assert!(circle.len() > 1000, "{selected}: {:?}", trace.messages);
        for [x, y] in circle {
            assert!((x.hypot(y) - expected).abs() < 1e-6, "{selected}: {x} {y}");
        }
        let said: Vec<&str> = trace.said.iter().map(|(code, _)| code.as_str()).collect();
        assert!(said.contains(&code), "{selected}: {said:?}");
    }
    let changed = "D1\nG01 X0 Y0 F1000\nG41 X20\nG03 I-20\nD2\nG01 Y10\nG40 X0\nM30";
    let trace = trace_of(MACHINE, changed, &AXES, options);
    let reason = "its radius here";
    assert!(
        trace.messages.iter().any(|it| it.contains(reason)),
        "{:?}",
        trace.messages
    );
}

#[test]
fn a_bore_is_driven_at_the_radius_of_the_tool_centre() {
    // R11.30
    for (side, radius) in [("G41", 15.0), ("G42", 25.0)] {
        let program = format!("G01 X0 Y0 F1000\n{side} X20\nG03 I-20\nG40 G01 X0\nX1\nM30");
        let trace = followed(&program, 5.0);
        assert!(
            trace.left_out.len() == 1,
            "only the first motion: {:?}",
            trace.said
        );
        let circle = places(&trace, 3..=3);
        assert!(circle.len() > 1000);
        for [x, y] in circle {
            assert!((x.hypot(y) - radius).abs() < 1e-6, "{side}: {x} {y}");
        }
        assert!((trace.end()[0] - 1.0).abs() < 1e-9 && trace.end()[1].abs() < 1e-9);
        assert_limits(MACHINE, &AXES, &trace);
        assert!(
            trace
                .causes
                .iter()
                .all(|cause| cause.frame == PositionFrame::Machine)
        );
        let said: Vec<&str> = trace.said.iter().map(|(code, _)| code.as_str()).collect();
        assert_eq!(said, ["FC906", "FC907"]);
    }
}

#[test]
fn blocks_that_go_on_smoothly_do_so_beside_the_contour() {
    // R11.30: two turns, and a line into an arc, at the feed of the program.
    let program =
        "G01 X0 Y0 F1000\nG41 X20\nY5\nG03 X-20 I-20\nG03 X20 I20\nX-20 I-20\nG01 Y-5\nG40 X0\nM30";
    let trace = followed(program, 5.0);
    let inside = trace.lines.iter().zip(&trace.path_velocities);
    let within = inside.filter(|(line, _)| (5..=5).contains(*line));
    let slowest = within.map(|it| *it.1).fold(f64::INFINITY, f64::min);
    assert!(slowest > 0.99 * 1000.0 / 60.0, "{slowest}");
    assert_limits(MACHINE, &AXES, &trace);
}

#[test]
fn without_a_radius_the_programmed_contour_is_followed_and_that_is_said() {
    // R11.30
    let trace = trace("G01 X0 Y0 F1000\nG41 X20\nG03 I-20\nG40 G01 X0\nM30", &AXES);
    for [x, y] in places(&trace, 3..=3) {
        assert!((x.hypot(y) - 20.0).abs() < 1e-6);
    }
    assert!(
        trace
            .messages
            .iter()
            .any(|it| it.contains("programmed contour"))
    );
    let frames = trace.causes.iter().map(|cause| cause.frame);
    assert_eq!(frames.max(), Some(PositionFrame::Contour));
}

#[test]
fn the_tool_keeps_its_radius_from_every_contour() {
    // R11.30: polygons with inner and outer corners, tangential arcs between lines, in short and long blocks,
    // against the distance from the programmed contour.
    let square = [
        [0.0, 0.0],
        [40.0, 0.0],
        [40.0, 30.0],
        [0.0, 30.0],
        [0.0, 0.0],
    ];
    let star: Vec<[f64; 2]> = (0..=10)
        .map(|at| {
            let radius = if at % 2 == 0 { 60.0 } else { 30.0 };
            let angle = f64::from(at) / 10.0 * TAU;
            [radius * angle.cos(), radius * angle.sin()]
        })
        .collect();
    let fine: Vec<[f64; 2]> = (0..=720)
        .map(|at| {
            let angle = f64::from(at) / 720.0 * TAU;
            let radius = 50.0 + 4.0 * (3.0 * angle).sin();
            [radius * angle.cos(), radius * angle.sin()]
        })
        .collect();
    for corners in [square.to_vec(), star, fine] {
        // It begins and ends within a block, so that each corner is passed.
        let middle: Vec<f64> = (0..2)
            .map(|axis| f64::midpoint(corners[0][axis], corners[1][axis]))
            .collect();
        let middle = [middle[0], middle[1]];
        let contour = [&[middle], &corners[1..], &[middle]].concat();
        for side in ["G41", "G42"] {
            let mut program = String::from("G00 X200 Y200\nG01 F1500\n");
            let [x, y] = contour[0];
            let _ = writeln!(program, "{side} X{x} Y{y}");
            for [x, y] in &contour[1..] {
                let _ = writeln!(program, "X{x} Y{y}");
            }
            program += "G40 X200 Y200\nM30";
            let trace = followed(&program, 2.5);
            let last = 3 + u32::try_from(contour.len()).expect("few") - 1;
            let path = places(&trace, 4..=last);
            let rounded: Vec<f64> = path.iter().map(|it| distance(&contour, *it)).collect();
            let nearest = rounded.iter().copied().fold(f64::INFINITY, f64::min);
            let farthest = rounded.iter().copied().fold(0.0, f64::max);
            assert!(nearest > 2.5 - 1e-6, "{side}: {nearest}");
            // Straight blocks are extended around outer corners up to 90°.
            assert!(farthest < 2.5 * 2_f64.sqrt() + 1e-6, "{side}: {farthest}");
            assert_eq!(trace.left_out.len(), 1, "{:?}", trace.said);
            assert_limits(MACHINE, &AXES, &trace);
        }
    }
}

#[test]
fn lines_and_arcs_meet_beside_their_corners() {
    // R11.30: a slot of two lines and two arcs, whose decimals leave slight kinks, and a D whose arc meets
    // its line at an inner and an outer corner.
    let slot = "G01 X20 Y10.0004\nX40\nG02 X40 Y-10 J-10\nG01 X0\nG02 X0 Y10.0004 J10\nG01 X20";
    let shape = "G01 X0 Y0\nY20\nG02 X0 Y-20 J-20\nG01 Y0";
    for (contour, radius, lines) in [(slot, 3.0, 4..=8_u32), (shape, 3.0, 4..=6)] {
        for side in ["G41", "G42"] {
            let contour = contour.replacen("G01", &format!("G01 {side}"), 1);
            let program = format!("G00 X-70 Y60\nF1000\n{contour}\nG40 G01 X-70 Y60\nM30");
            let trace = followed(&program, radius);
            assert_eq!(trace.left_out.len(), 1, "{side}: {:?}", trace.said);
            assert_limits(MACHINE, &AXES, &trace);
            let path = places(&trace, lines.clone());
            let off = path.iter().map(|&[x, y]| {
                let from_slot = {
                    let beyond = (x - x.clamp(0.0, 40.0)).hypot(y);
                    (beyond - 10.0).abs()
                };
                let from_shape = {
                    let line = distance(&[[0.0, -20.0], [0.0, 20.0]], [x, y]);
                    let arc = if x >= 0.0 {
                        (x.hypot(y) - 20.0).abs()
                    } else {
                        line
                    };
                    line.min(arc)
                };
                if lines.end() == &8 {
                    from_slot
                } else {
                    from_shape
                }
            });
            let off: Vec<f64> = off.collect();
            let nearest = off.iter().copied().fold(f64::INFINITY, f64::min);
            assert!(nearest > radius - 1e-3, "{side}: {nearest}");
        }
    }
}

#[test]
fn a_motion_across_the_plane_and_a_dwell_keep_the_tool_beside_the_contour() {
    // R11.30
    let program = "G01 X0 Y0 Z0 F1000\nG41 X20 Y0\nY20\nZ-5\nG04 0.1\nY40\nZ5\nG40 X0\nM30";
    let trace = followed(program, 5.0);
    for [x, y] in places(&trace, 4..=4) {
        assert!(
            (x - 15.0).abs() < 1e-9 && (y - 20.0).abs() < 1e-9,
            "{x} {y}"
        );
    }
    for [x, _] in places(&trace, 6..=7) {
        assert!((x - 15.0).abs() < 1e-9);
    }
    assert_eq!(trace.end(), [0.0, 40.0]);
}

#[test]
fn what_the_tool_cannot_follow_is_left_out_and_said() {
    // R11.30
    let slot = "G01 X0 Y0 F1000\nG41 X0 Y1\nX10\nY5\nX0\nG40 Y20\nM30";
    let side = "G01 X0 Y0 F1000\nG41 X20\nY10\nG42 Y20\nX40\nG40 X0\nM30";
    let plane = "G01 X0 Y0 Z0 F1000\nG41 X20\nY10\nG18 Z5\nX40\nG40 X0\nM30";
    let arc = "G01 X0 Y0 F1000\nG41 X20\nY10\nG03 X14 Y10 I-3\nG01 Y0\nG40 X0\nM30";
    for (program, reason) in [
        (slot, "the tool does not fit into the contour here"),
        (arc, "the arc is not larger than the tool"),
        (side, "changes its side, its plane or its radius"),
        (plane, "changes its side, its plane or its radius"),
    ] {
        let trace = followed(program, 4.0);
        assert!(
            trace.messages.iter().any(|it| it.contains(reason)),
            "{:?}",
            trace.messages
        );
    }
}

#[test]
fn an_origin_of_the_machine_leaves_paths_as_they_are() {
    // R11.30
    for origin in ["#PSET[X10]", "#SHIFT[X1]", "M123"] {
        let program = format!("G01 X0 Y0 F1000\n{origin}\nX0 Y0\nX10\nX20\nM30");
        let trace = trace(&program, &AXES);
        let frames = trace.causes.iter().map(|cause| cause.frame);
        assert_eq!(frames.max(), Some(PositionFrame::Shifted), "{origin}");
    }
    let turned = trace(
        "G01 X0 Y0 F1000\n#ROTATION ON [ANGLE 30]\nM123\nX0 Y0\nX10\nM30",
        &AXES,
    );
    let frames = turned.causes.iter().map(|cause| cause.frame);
    assert_eq!(frames.max(), Some(PositionFrame::Programmed));
}
