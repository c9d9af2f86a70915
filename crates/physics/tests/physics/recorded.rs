//! Chapter 5.3: circles recorded on a machine, cut to the circle itself, their figures and advice.

use std::f64::consts::{PI, TAU};

use crate::recorder::{Noise, Recorder, backlash, friction};
use frictcomp_physics::circle::{
    CommandedCircle, Crossing, Direction, Figures, Finding, FoundAt, PathCentre, PathFigures,
    PathShape, PlaneAxis, RecordedCircle, RecordedError, RecordedTrace, Recording, diagnose,
};

/// Points of a circle of 50 mm around (3, -7) with a radial deviation in µm over the angle.
fn synthetic(direction: Direction, deviation: impl Fn(f64) -> f64) -> Vec<[f64; 2]> {
    (0..=14_400)
        .map(|point| {
            let angle = direction.sign() * f64::from(point) / 14_400.0 * TAU + 0.4;
            let radius = 50.0 + deviation(angle.rem_euclid(TAU)) / 1000.0;
            [3.0 + radius * angle.cos(), -7.0 + radius * angle.sin()]
        })
        .collect()
}

/// Returns the only circle of a recording.
fn circle(points: Vec<[f64; 2]>, radius: Option<f64>) -> Result<RecordedCircle, RecordedError> {
    let mut found = RecordedCircle::find(&RecordedTrace::of_points(points), radius)?;
    assert_eq!(found.len(), 1, "one direction");
    Ok(found.remove(0))
}

fn of_radius(radius_mm: Option<f64>) -> CommandedCircle {
    CommandedCircle {
        radius_mm,
        ..CommandedCircle::default()
    }
}

fn recording(ccw: impl Fn(f64) -> f64, cw: impl Fn(f64) -> f64, radius: Option<f64>) -> Recording {
    let circles = [
        circle(synthetic(Direction::Ccw, ccw), radius).expect("a circle"),
        circle(synthetic(Direction::Cw, cw), radius).expect("a circle"),
    ];
    Recording::new(circles.into(), of_radius(radius), PathCentre::Common).expect("both directions")
}

/// Returns the figures of both directions of a trace.
fn both(trace: &RecordedTrace) -> Figures {
    let circles = RecordedCircle::find(trace, None).expect("circles");
    assert_eq!(circles.len(), 2, "both directions");
    let recording = Recording::new(circles, CommandedCircle::default(), PathCentre::Common);
    recording.expect("circles about one centre").side.figures
}

fn shape(path: Option<&PathFigures>) -> &PathShape {
    path.and_then(|path| path.shape.as_ref()).expect("a shape")
}

/// Axes with their findings.
fn of_axes(figures: &Figures) -> Vec<(PlaneAxis, Finding)> {
    let advice = diagnose(figures, None).into_iter();
    let found = advice.filter_map(|it| match it.place {
        FoundAt::Axis(axis) => Some((axis, it.finding)),
        _ => None,
    });
    found.collect()
}

/// Returns the findings at all crossings, each once.
fn of_crossings(figures: &Figures) -> Vec<Finding> {
    let advice = diagnose(figures, None).into_iter();
    let mut found: Vec<Finding> = advice
        .filter(|it| matches!(it.place, FoundAt::Crossing(_)))
        .map(|it| it.finding)
        .collect();
    found.sort_unstable();
    found.dedup();
    found
}

/// Returns the findings in the path as a whole.
fn of_whole(figures: &Figures) -> Vec<Finding> {
    let advice = diagnose(figures, None).into_iter();
    advice
        .filter(|it| it.place == FoundAt::Whole)
        .map(|it| it.finding)
        .collect()
}

fn close(found: f64, expected: f64, tolerance: f64) {
    let difference = (found - expected).abs();
    assert!(difference <= tolerance, "{found} is not {expected}");
}

#[test]
fn figures_of_known_circles_are_exact() {
    // R5.21: three lobes of ±4 µm one way and ±2 µm the other, 6 µm too large.
    let recording = recording(
        |angle| 6.0 + 4.0 * (3.0 * angle).cos(),
        |angle| 6.0 + 2.0 * (3.0 * angle).cos(),
        Some(50.0),
    );
    let figures = &recording.side.figures;
    let ccw = figures.ccw.as_ref().expect("ccw");
    let close = |found: f64, expected: f64| close(found, expected, 2e-3);
    close(ccw.g_mz_um, 8.0);
    close(ccw.g_lsc_um, 8.0);
    close(ccw.f_max_um.expect("Fmax"), 10.0);
    close(ccw.f_min_um.expect("Fmin"), 2.0);
    close(ccw.d_um.expect("D"), 6.0);
    let cw = figures.cw.as_ref().expect("cw");
    close(cw.g_mz_um, 4.0);
    close(figures.g_b_um.expect("G(b)"), 8.0);
    // 4 cos - 2 cos: 2 µm apart.
    close(figures.h_um.expect("H"), 2.0);
    close(figures.d_um.expect("D"), 6.0);
    for circle in &recording.circles {
        close(1000.0 * (circle.centre_mm[0] - 3.0), 0.0);
        close(1000.0 * (circle.centre_mm[1] + 7.0), 0.0);
    }
}

#[test]
fn the_minimum_zone_is_smaller_than_that_about_least_squares() {
    // R5.21: one bump of 9 µm and 20°. The least-squares centre follows its whole area; the
    // minimum zone is not wider, and not narrower than the bump less what a shift can remove.
    let bump = |angle: f64| {
        let way = (angle - 1.0).abs().min(TAU - (angle - 1.0).abs());
        9.0 * (1.0 - way / (10.0 * PI / 180.0)).max(0.0)
    };
    let path = recording(bump, bump, None).side.figures.ccw.expect("ccw");
    assert!(path.g_mz_um <= path.g_lsc_um + 1e-9, "{path:?}");
    assert!((4.5..=9.0).contains(&path.g_mz_um), "{path:?}");
    // Against every centre of a fine grid the minimum zone is the narrowest.
    let points = synthetic(Direction::Ccw, bump);
    for (i, j) in (-20..=20).flat_map(|i| (-20..=20).map(move |j| (i, j))) {
        let centre = [3.0 + f64::from(i) * 5e-4, -7.0 + f64::from(j) * 5e-4];
        let radius = |point: &[f64; 2]| (point[0] - centre[0]).hypot(point[1] - centre[1]);
        let most = points.iter().map(radius).fold(f64::MIN, f64::max);
        let least = points.iter().map(radius).fold(f64::MAX, f64::min);
        assert!(1000.0 * (most - least) >= path.g_mz_um - 1e-3, "{centre:?}");
    }
    // F and D need the commanded radius.
    assert_eq!((path.f_max_um, path.d_um), (None, None));
}

#[test]
fn both_directions_are_compared_about_one_centre() {
    // R5.21: the same circle, 5 µm apart in X. About the mean centre each path is 2.5 µm off.
    let shifted = |direction: Direction, by: f64| {
        let points = synthetic(direction, |_| 0.0);
        points.into_iter().map(|[x, y]| [x + by, y]).collect()
    };
    let circles: Vec<RecordedCircle> = [
        circle(shifted(Direction::Ccw, 0.0), None).expect("a circle"),
        circle(shifted(Direction::Cw, 0.005), None).expect("a circle"),
    ]
    .into();
    let figures = |centre| {
        let recording = Recording::new(circles.clone(), CommandedCircle::default(), centre);
        recording.expect("both directions").side.figures
    };
    let common = figures(PathCentre::Common);
    close(common.centre_distance_um.expect("a distance"), 5.0, 2e-3);
    close(common.h_um.expect("H"), 5.0, 2e-3);
    close(common.g_b_um.expect("G(b)"), 5.0, 2e-3);
    let own = figures(PathCentre::Own);
    close(own.h_um.expect("H"), 0.0, 2e-3);
    close(own.g_b_um.expect("G(b)"), 0.0, 2e-3);
    close(own.centre_distance_um.expect("a distance"), 5.0, 2e-3);
}

#[test]
fn the_glitch_is_that_of_its_window() {
    // R5.22: 5 µm outwards 3° after Y+, 2 µm inwards 24° after X-, outside the window and its sides.
    let spike = |angle: f64, at: f64, height: f64| {
        height * (1.0 - (angle - at.to_radians()).abs() / 0.01).max(0.0)
    };
    let path = |angle: f64| spike(angle, 93.0, 5.0) - spike(angle, 204.0, 2.0);
    let figures = recording(path, |_| 0.0, None).side.figures;
    let glitches = &shape(figures.ccw.as_ref()).glitches;
    assert_eq!(glitches[1].crossing, Crossing::YPlus);
    close(glitches[1].height_um, 5.0, 0.1);
    close(glitches[1].outward_um, 5.0, 0.1);
    close(glitches[0].height_um, 0.0, 0.1);
    close(glitches[2].height_um, 0.0, 0.1);
}

#[test]
fn an_ellipse_or_a_shifted_centre_is_no_glitch() {
    // R5.22: less than 1 % of its size, at slow and at fast feeds.
    for feed in [500.0, 3000.0, 7000.0] {
        for phase in [0.0, 0.4, PI / 4.0, 1.3] {
            let recorder = Recorder {
                feed,
                ..Recorder::new(50.0)
            };
            let ellipse = |_: Direction, angle: f64| 50.0 * (2.0 * angle + phase).cos();
            let trace = recorder.turns(Direction::Ccw, 1.0, &ellipse).trace();
            let found = RecordedCircle::find(&trace, None).expect("a circle");
            let recording = Recording::new(found, CommandedCircle::default(), PathCentre::Common);
            let figures = recording.expect("one circle").side.figures;
            let most = figures.glitch_max_um().expect("a glitch");
            assert!(most < 1.0, "{feed} {phase}: {most}");
            assert!(of_crossings(&figures).is_empty(), "{feed} {phase}");
            assert!(of_axes(&figures).is_empty(), "{feed} {phase}");
        }
    }
}

#[test]
fn backlash_is_told_for_each_axis_and_is_no_ellipse() {
    // R5.24: 8 µm on X and 2 µm on Y, both directions.
    let shape_of = |direction, angle| backlash([8.0, 2.0], direction, angle);
    let trace = Recorder::new(50.0)
        .turns(Direction::Ccw, 1.3, &shape_of)
        .standstill(0.5)
        .turns(Direction::Cw, 1.3, &shape_of)
        .trace();
    let figures = both(&trace);
    let expected = [
        (PlaneAxis::X, Finding::Backlash),
        (PlaneAxis::Y, Finding::Backlash),
    ];
    assert_eq!(of_axes(&figures), expected);
    assert_eq!(of_whole(&figures), []);
    assert_eq!(of_crossings(&figures), []);
    for path in [&figures.ccw, &figures.cw] {
        let axes = &shape(path.as_ref()).axes;
        close(axes[0].step_um, 8.0, 0.1);
        close(axes[1].step_um, 2.0, 0.1);
    }
}

#[test]
fn over_compensated_backlash_is_told() {
    // R5.24
    let shape_of = |direction, angle| backlash([-5.0, 0.0], direction, angle);
    let trace = Recorder::new(100.0)
        .turns(Direction::Ccw, 1.1, &shape_of)
        .turns(Direction::Cw, 1.1, &shape_of)
        .trace();
    let figures = both(&trace);
    let expected = [(PlaneAxis::X, Finding::OvercompensatedBacklash)];
    assert_eq!(of_axes(&figures), expected);
    assert_eq!(of_whole(&figures), []);
    close(shape(figures.ccw.as_ref()).axes[0].step_um, -5.0, 0.1);
}

#[test]
fn friction_with_backlash_names_both() {
    // R5.24: peaks of 10 µm that decay, and a step of 5 µm that stays.
    for width_deg in [1.0, 2.0, 3.0] {
        let shape_of = |direction, angle| {
            backlash([5.0; 2], direction, angle) + friction(10.0, width_deg, direction, angle)
        };
        let trace = Recorder {
            noise: Noise::of_um(0.02),
            ..Recorder::new(100.0)
        }
        .turns(Direction::Ccw, 1.2, &shape_of)
        .turns(Direction::Cw, 1.2, &shape_of)
        .trace();
        let figures = both(&trace);
        assert_eq!(of_crossings(&figures), [Finding::Friction], "{width_deg}");
        let expected = [
            (PlaneAxis::X, Finding::Backlash),
            (PlaneAxis::Y, Finding::Backlash),
        ];
        assert_eq!(of_axes(&figures), expected, "{width_deg}");
        let axes = &shape(figures.ccw.as_ref()).axes;
        close(axes[0].step_um, 5.0, 0.4);
        close(axes[0].peak_um, 10.0, 0.6);
    }
}

#[test]
fn ellipses_are_told_apart() {
    // R5.24
    let found = |ccw: f64, cw: f64| {
        let recording = recording(
            move |angle| ccw * (2.0 * angle).sin(),
            move |angle| cw * (2.0 * angle).sin(),
            None,
        );
        of_whole(&recording.side.figures)
    };
    assert_eq!(found(5.0, -5.0), [Finding::GainMismatch]);
    assert_eq!(found(5.0, 5.0), [Finding::Squareness]);
    let scale = recording(
        |angle| 5.0 * (2.0 * angle).cos(),
        |angle| 5.0 * (2.0 * angle).cos(),
        None,
    );
    assert_eq!(of_whole(&scale.side.figures), [Finding::ScaleMismatch]);
}

#[test]
fn lead_in_and_lead_out_are_cut_away() {
    // R5.26: exactly one turn between a path to the circle and one from it, of every form.
    let peaks = |direction, angle| friction(12.0, 2.0, direction, angle);
    for start_deg in [0.0, 37.0, 180.0, 275.0] {
        for direction in Direction::ALL {
            for lead in [
                Recorder::radial as fn(Recorder, Direction) -> Recorder,
                Recorder::tangential,
                Recorder::arc,
            ] {
                let recorder = Recorder {
                    start_deg,
                    centre: [812.4, -1395.0],
                    ..Recorder::new(60.0)
                };
                let recorder = recorder.lead_in(lead, direction);
                let recorder = recorder.turns(direction, 1.0, &peaks);
                let trace = recorder.lead_out(lead, direction).trace();
                let found = RecordedCircle::find(&trace, Some(60.0)).expect("a circle");
                let [circle] = &found[..] else {
                    panic!("one direction: {found:?}");
                };
                assert_eq!(circle.direction, direction);
                close(circle.centre_mm[0], 812.4, 1e-3);
                close(circle.centre_mm[1], -1395.0, 1e-3);
                let recording = Recording::new(found, of_radius(Some(60.0)), PathCentre::Common);
                let figures = recording.expect("one circle").side.figures;
                let path = figures.get(direction).expect("a path");
                let what = format!("{start_deg} {direction}: {path:?}");
                close(path.g_lsc_um, 12.0, 2.5);
                assert_eq!(of_crossings(&figures), [Finding::Friction], "{what}");
                assert!(of_axes(&figures).is_empty(), "{what}");
            }
        }
    }
}

#[test]
fn noise_and_more_than_a_turn_make_no_difference() {
    // R5.26: 1.25 turns with 20 nm of noise, a path to the circle and one from it.
    for turns in [1.0, 1.02, 1.25, 2.0, 3.7] {
        let recorder = Recorder {
            noise: Noise::of_um(0.02),
            start_deg: 110.0,
            ..Recorder::new(100.0)
        };
        let trace = recorder
            .lead_in(Recorder::tangential, Direction::Ccw)
            .turns(Direction::Ccw, turns, &|_, _| 0.0)
            .lead_out(Recorder::tangential, Direction::Ccw)
            .standstill(1.0)
            .trace();
        let found = RecordedCircle::find(&trace, None).expect("a circle");
        let recording = Recording::new(found, CommandedCircle::default(), PathCentre::Common);
        let figures = recording.expect("one circle").side.figures;
        let path = figures.ccw.as_ref().expect("a path");
        assert!(path.g_mz_um < 0.25, "{turns}: {path:?}");
        assert!(diagnose(&figures, None).is_empty(), "{turns}");
    }
}

#[test]
fn repeated_rows_count_once() {
    // R5.26: every row three times, as from a recorder that is faster than the control.
    let peaks = |direction, angle| friction(9.0, 2.0, direction, angle);
    let once = Recorder::new(50.0)
        .turns(Direction::Cw, 1.1, &peaks)
        .trace();
    let thrice = |rows: &[f64]| rows.iter().flat_map(|&it| [it; 3]).collect::<Vec<_>>();
    let repeated = RecordedTrace {
        points_mm: once.points_mm.iter().flat_map(|&it| [it; 3]).collect(),
        times_s: thrice(&once.times_s),
    };
    let of = |trace| {
        let found = RecordedCircle::find(trace, None).expect("a circle");
        let recording = Recording::new(found, CommandedCircle::default(), PathCentre::Common);
        recording.expect("one circle")
    };
    let (single, three) = (of(&once), of(&repeated));
    assert_eq!(single.side.figures, three.side.figures);
    assert_eq!(single.circles[0].left_out.repeated, 0);
    let rows = once.points_mm.len();
    assert_eq!(three.circles[0].left_out.repeated, 2 * rows);
}

#[test]
fn recordings_as_machines_make_them_are_read() {
    // R5.26: an encoder of 0.1 to 1 µm, 1 to 10 kHz, any start, both directions in one file with
    // standstill between, a centre far from zero.
    let peaks = |direction, angle| friction(15.0, 1.5, direction, angle);
    for (rate, quantum_um, start_deg) in [
        (1000.0, 0.1, 0.0),
        (1000.0, 1.0, 90.0),
        (4000.0, 0.5, 213.0),
        (10_000.0, 0.01, 359.0),
    ] {
        let recorder = Recorder {
            rate,
            quantum_um,
            start_deg,
            feed: 3000.0,
            centre: [-4210.377, 988.1],
            noise: Noise::of_um(0.03),
            ..Recorder::new(80.0)
        };
        let trace = recorder
            .standstill(2.0)
            .lead_in(Recorder::arc, Direction::Ccw)
            .turns(Direction::Ccw, 2.1, &peaks)
            .lead_out(Recorder::arc, Direction::Ccw)
            .standstill(1.5)
            .lead_in(Recorder::arc, Direction::Cw)
            .turns(Direction::Cw, 2.1, &peaks)
            .lead_out(Recorder::arc, Direction::Cw)
            .trace();
        let circles = RecordedCircle::find(&trace, Some(80.0)).expect("circles");
        for circle in &circles {
            let feed = circle.feed_mm_per_min().expect("times");
            close(feed, 3000.0, 30.0);
            close(circle.left_out.along_deg, 756.0, 30.0);
        }
        let figures = both(&trace);
        let most = figures.glitch_max_um().expect("a glitch");
        close(most, 15.0, 0.5 + 2.0 * quantum_um);
        assert_eq!(of_crossings(&figures), [Finding::Friction], "{rate}");
        assert_eq!(of_axes(&figures), [], "{rate}");
        assert_eq!(of_whole(&figures), [], "{rate}");
    }
}

/// R5.22, R5.26: what is missing where an axis reverses could be a glitch; between two crossings it is bridged.
#[test]
fn a_gap_at_a_crossing_is_no_all_clear() {
    let without = |from: f64, to: f64| {
        let all = synthetic(Direction::Ccw, |_| 0.0).into_iter();
        let angle = |point: &[f64; 2]| (point[1] + 7.0).atan2(point[0] - 3.0).to_degrees();
        all.filter(|point| !(from..to).contains(&angle(point)))
            .collect::<Vec<_>>()
    };
    assert!(circle(without(40.0, 44.0), None).is_ok());
    for crossing in [-90.0, 0.0, 90.0] {
        let found = circle(without(crossing - 1.0, crossing + 3.0), None);
        assert!(
            matches!(found, Err(RecordedError::Gaps(_))),
            "{crossing}: {found:?}"
        );
    }
}

/// R5.26: a feed that the times deny is refused.
#[test]
fn a_feed_is_that_of_the_times() {
    let mut trace = RecordedTrace::of_points(synthetic(Direction::Ccw, |_| 0.0));
    trace.times_s = (0..trace.points_mm.len())
        .map(|at| 0.001 * at as f64)
        .collect();
    let circles = RecordedCircle::find(&trace, None).expect("a circle");
    let driven = circles[0].feed_mm_per_min().expect("a feed");
    let at = |feed: f64| {
        let commanded = CommandedCircle {
            feed_mm_per_min: Some(feed),
            ..CommandedCircle::default()
        };
        Recording::new(circles.clone(), commanded, PathCentre::Common)
    };
    assert!(at(driven * 1.05).is_ok());
    assert!(matches!(at(driven * 2.0), Err(RecordedError::Feed { .. })));
}

/// R5.26: both directions are compared at one feed.
#[test]
fn directions_at_different_feeds_are_not_compared() {
    let of = |direction: Direction, step_s: f64| {
        let mut trace = RecordedTrace::of_points(synthetic(direction, |_| 0.0));
        let points = 0..trace.points_mm.len();
        trace.times_s = points.map(|at| step_s * at as f64).collect();
        RecordedCircle::find(&trace, None).expect("a circle")
    };
    let both = |step_s: f64| {
        let circles = [of(Direction::Ccw, 0.001), of(Direction::Cw, step_s)].concat();
        Recording::new(circles, CommandedCircle::default(), PathCentre::Common)
    };
    assert!(both(0.001).is_ok());
    assert!(matches!(both(0.003), Err(RecordedError::OtherFeeds(_))));
}

/// R5.26: the best of several turns is evaluated, and a worse one is named; noise does not make a turn worse.
#[test]
fn a_worse_turn_is_named() {
    let of = |heights: [f64; 3]| {
        let recorder = Recorder {
            noise: Noise::of_um(0.5),
            ..Recorder::new(50.0)
        };
        let drive = |recorder: Recorder, height: f64| {
            recorder.turns(Direction::Cw, 1.0, &|direction, angle| {
                friction(height, 2.0, direction, angle)
            })
        };
        let trace = heights.into_iter().fold(recorder, drive).trace();
        let found = RecordedCircle::find(&trace, None).expect("a circle");
        found[0].whole_turns().expect("whole turns")
    };
    let even = of([6.0, 6.0, 6.0]);
    assert_eq!((even.count, even.worse), (3, None));
    assert_eq!(of([6.0, 6.0, 7.0]).worse, None, "less than a quarter more");
    for heights in [[6.0, 6.0, 12.0], [12.0, 6.0, 6.0]] {
        let worse = of(heights).worse.expect("a worse turn");
        close(worse.height_um, 12.0, 1.0);
        close(worse.evaluated_um, 6.0, 0.6);
        let words = worse.to_string();
        assert!(words.contains(" one turn cw leaves 1"), "{words}");
    }
}

/// R5.26: one turn, or two with ends of an eighth each, cannot be compared.
#[test]
fn fewer_turns_are_not_compared() {
    let peaks = |direction, angle| friction(6.0, 2.0, direction, angle);
    for (turns, count) in [(1.1, None), (1.3, None), (1.6, Some(2)), (2.2, Some(2))] {
        let recorder = Recorder::new(50.0).turns(Direction::Ccw, turns, &peaks);
        let found = RecordedCircle::find(&recorder.trace(), None).expect("a circle");
        let found = found[0].whole_turns().map(|it| it.count);
        assert_eq!(found, count, "{turns}");
    }
}

#[test]
fn a_fast_recording_has_no_figures_at_its_crossings() {
    // R5.22: radius 5 mm at 1000 mm/min turns 57° in 0.3 s.
    let fast = Recorder {
        feed: 1000.0,
        ..Recorder::new(5.0)
    };
    let peaks = |direction, angle| friction(9.0, 5.0, direction, angle);
    let trace = fast.turns(Direction::Ccw, 1.5, &peaks).trace();
    let figures = |trace: &RecordedTrace, feed_mm_per_min| {
        let found = RecordedCircle::find(trace, None).expect("a circle");
        let commanded = CommandedCircle {
            feed_mm_per_min,
            ..CommandedCircle::default()
        };
        let recording = Recording::new(found, commanded, PathCentre::Common);
        recording.expect("one circle").side.figures
    };
    let found = figures(&trace, None);
    assert_eq!(found.glitch_max_um(), None);
    assert!(diagnose(&found, None).is_empty());
    // Without times the feed is not known, unless it is given.
    let timeless = RecordedTrace::of_points(trace.points_mm.clone());
    assert!(figures(&timeless, None).glitch_max_um().is_some());
    assert!(figures(&timeless, Some(1000.0)).glitch_max_um().is_none());
    assert!(figures(&timeless, Some(500.0)).glitch_max_um().is_some());
}

#[test]
fn recordings_that_are_no_circle_are_refused() {
    // R5.20 R5.26
    let whole = synthetic(Direction::Cw, |_| 0.0);
    let refused = |points: &[[f64; 2]]| circle(points.to_vec(), None).expect_err("no circle");
    assert_eq!(refused(&whole[..40]), RecordedError::TooFew(40));
    assert_eq!(refused(&[[1.0, 1.0]; 100]), RecordedError::NoCircle);
    let line: Vec<_> = (0..200).map(|x| [f64::from(x), 2.0]).collect();
    assert_eq!(refused(&line), RecordedError::NoCircle);
    let part = refused(&whole[..9000]);
    assert!(
        matches!(part, RecordedError::NotATurn { covered_deg, .. } if (covered_deg - 225.0).abs() < 0.1),
        "{part}"
    );
    let mut holey = whole.clone();
    holey.drain(4000..5000);
    let gaps = refused(&holey);
    assert!(
        matches!(gaps, RecordedError::Gaps(missing) if (24.0..26.0).contains(&missing)),
        "{gaps}"
    );
    let one = circle(whole.clone(), None).expect("a circle");
    assert_eq!(one.direction, Direction::Cw);
    let twice = Recording::new(
        vec![one.clone(), one],
        CommandedCircle::default(),
        PathCentre::Common,
    );
    let twice = twice.expect_err("one direction");
    assert_eq!(twice, RecordedError::SameDirection(Direction::Cw));
    let wrong = circle(whole, Some(100.0)).expect_err("another radius");
    assert!(matches!(wrong, RecordedError::Radius { .. }));
}

#[test]
fn what_is_rounder_than_a_square_but_no_circle_is_refused() {
    // R5.26: with the values that were found.
    for deviation_um in [700.0, 3000.0] {
        let egg = synthetic(Direction::Ccw, |angle| deviation_um * (2.0 * angle).cos());
        let refused = circle(egg, None).expect_err("an egg");
        let RecordedError::NotRound {
            deviation_mm,
            radius_mm,
            centre_mm,
        } = refused
        else {
            panic!("{refused}");
        };
        close(deviation_mm, 2.0 * deviation_um / 1000.0, 0.1);
        close(radius_mm, 50.0, 1.0);
        close(centre_mm[0], 3.0, 1.0);
    }
    let apart = [Direction::Ccw, Direction::Cw].map(|direction| {
        let points = synthetic(direction, |_| 0.0).into_iter();
        let moved = points.map(|[x, y]| [x + direction.sign(), y]).collect();
        circle(moved, None).expect("a circle")
    });
    let of = |centre| Recording::new(apart.clone().into(), CommandedCircle::default(), centre);
    let refused = of(PathCentre::Common).expect_err("another zero point");
    assert!(
        matches!(refused, RecordedError::Apart { distance_mm } if (distance_mm - 2.0).abs() < 1e-3)
    );
    assert!(of(PathCentre::Own).is_ok());
}
