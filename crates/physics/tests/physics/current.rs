//! Chapter 4: the additive current, rule by rule, against values computed by hand.

use frictcomp::comp::State;
use frictcomp::lists::{FrictionList, TablePoint};
use frictcomp_physics::current::{
    AdditiveCurrent, Below, Commanded, CommandedTrace, CyclesError, DeadBand, Delay, Followers,
    Reading, Resampling, Standstill, Start, Switched, TraceColumns, TraceOptions,
};

/// Returns a list with 12 drive units at rest, falling to 10 at 1000 µm/s, then held.
fn list() -> FrictionList {
    FrictionList {
        position_delay: 0,
        reversal_lookahead: 0,
        scaling_factor: 1000,
        delay_cycles: 0,
        max_points: 20,
        table: vec![
            TablePoint {
                input: 100.0,
                output: 12.0,
            },
            TablePoint {
                input: 1000.0,
                output: 10.0,
            },
        ],
    }
}

/// Returns positions in 0.1 µm of velocities in µm/s at 1 ms: 10 µm/s make 0.1 units per cycle.
fn positions(velocities: &[f64]) -> Vec<f64> {
    let mut x = 0.0;
    velocities
        .iter()
        .map(|v| {
            x += v * 0.01;
            x
        })
        .collect()
}

fn currents(list: &FrictionList, reading: Reading, velocities: &[f64]) -> Vec<f64> {
    let cycles = AdditiveCurrent::new(list, reading).trace(&positions(velocities), velocities);
    cycles.iter().map(|added| added.current_units).collect()
}

fn close(found: &[f64], expected: &[f64]) {
    assert_eq!(found.len(), expected.len());
    for (found, expected) in found.iter().zip(expected) {
        assert!((found - expected).abs() < 1e-9, "{found} is not {expected}");
    }
}

#[test]
fn the_current_has_the_sign_and_value_of_the_commanded_velocity() {
    // R4.1 R4.4 R4.7 R4.9
    let v = [550.0, 1000.0, 5000.0, 50.0, -550.0, 550.0];
    // Half way between the points: 11; at and above the last: 10; below the first: held.
    close(
        &currents(&list(), Reading::default(), &v),
        &[11.0, 10.0, 10.0, 12.0, -11.0, 11.0],
    );
    let origin = Reading {
        below: Below::Origin,
        ..Reading::default()
    };
    close(&currents(&list(), origin, &[50.0, 25.0]), &[6.0, 3.0]);
    let against = FrictionList {
        scaling_factor: -500,
        ..list()
    };
    close(
        &currents(&against, Reading::default(), &[1000.0, -1000.0]),
        &[-5.0, 5.0],
    );
}

#[test]
fn standstill_holds_the_value_or_adds_nothing() {
    // R4.6
    let v = [0.0, 1000.0, 0.0, 0.0, -1000.0, 0.0];
    // No direction before the first motion; at rest the first value of the list is held.
    close(
        &currents(&list(), Reading::default(), &v),
        &[0.0, 10.0, 12.0, 12.0, -10.0, -12.0],
    );
    let zero = Reading {
        standstill: Standstill::Zero,
        ..Reading::default()
    };
    close(
        &currents(&list(), zero, &v),
        &[0.0, 10.0, 0.0, 0.0, -10.0, 0.0],
    );
}

#[test]
fn the_current_decays_over_the_cycles_before_a_reversal() {
    // R4.2: with 4 cycles the weights are 3/4, 2/4, 1/4, 0, whatever the velocity does.
    let list = FrictionList {
        reversal_lookahead: 4,
        ..list()
    };
    let v = [
        1000.0, 1000.0, 1000.0, 1000.0, 1000.0, 0.0, -1000.0, -1000.0,
    ];
    // Cycle 5 is at standstill, its weight is 0; cycle 1 is 5 cycles before: not yet weighted.
    close(
        &currents(&list, Reading::default(), &v),
        &[10.0, 10.0, 7.5, 5.0, 2.5, 0.0, -10.0, -10.0],
    );
}

#[test]
fn slowing_down_without_a_reversal_is_not_weighted() {
    // R4.4
    let list = FrictionList {
        reversal_lookahead: 4,
        position_delay: 100,
        ..list()
    };
    let v = [1000.0; 30];
    let settled = currents(&list, Reading::default(), &v)[29];
    let mut slowed = v.to_vec();
    slowed.extend([500.0, 100.0, 0.0, 100.0, 1000.0]);
    let after = currents(&list, Reading::default(), &slowed);
    assert!((settled - 10.0).abs() < 1e-9);
    close(&after[30..], &[10.0 + 10.0 / 9.0, 12.0, 12.0, 12.0, 10.0]);
}

#[test]
fn the_current_builds_up_over_the_distance_after_a_reversal() {
    // R4.3: 1000 µm/s are 10 units of 0.1 µm per cycle; 40 units take four cycles.
    let list = FrictionList {
        position_delay: 40,
        ..list()
    };
    let v = [1000.0, 1000.0, 1000.0, 1000.0, 1000.0, -1000.0, -1000.0];
    // The first cycle has no position before it: the build-up begins where the axis is.
    close(
        &currents(&list, Reading::default(), &v),
        &[0.0, 2.5, 5.0, 7.5, 10.0, -2.5, -5.0],
    );
}

#[test]
fn overlapping_weights_take_the_smaller_one() {
    // R4.8: build-up 1/4, 2/4, 3/4, 1 meets decay 3/4, 2/4, 1/4, 0.
    let list = FrictionList {
        position_delay: 40,
        reversal_lookahead: 4,
        ..list()
    };
    let v = [-1000.0, -1000.0, 1000.0, 1000.0, 1000.0, 1000.0, -1000.0];
    let found = currents(&list, Reading::default(), &v);
    close(&found[2..6], &[2.5, 5.0, 2.5, 0.0]);
}

#[test]
fn delay_cycles_are_a_dead_time_on_the_whole_output() {
    // R4.5
    let delayed = FrictionList {
        delay_cycles: 2,
        ..list()
    };
    let v = [1000.0, 1000.0, 1000.0, -1000.0, -1000.0, -1000.0];
    close(
        &currents(&delayed, Reading::default(), &v),
        &[0.0, 0.0, 10.0, 10.0, 10.0, -10.0],
    );
    // Postponing only the build-up: two cycles of nothing after each turn, then at once.
    let reading = Reading {
        delay: Delay::Reversal,
        ..Reading::default()
    };
    close(
        &currents(&delayed, reading, &v),
        &[0.0, 0.0, 10.0, 0.0, 0.0, -10.0],
    );
}

#[test]
fn comp_off_empties_the_delay_line_and_comp_on_is_a_first_start() {
    // R4.10
    let list = FrictionList {
        delay_cycles: 1,
        position_delay: 20,
        ..list()
    };
    let mut current = AdditiveCurrent::new(&list, Reading::default());
    let step = |current: &mut AdditiveCurrent, at: u32| {
        current
            .step(f64::from(at) * 10.0, 1000.0, &[])
            .current_units
    };
    let on: Vec<f64> = (0..4).map(|at| step(&mut current, at)).collect();
    close(&on, &[0.0, 0.0, 5.0, 10.0]);
    current.switch(Switched::Off);
    close(&[step(&mut current, 4)], &[0.0]);
    current.switch(Switched::On);
    let again: Vec<f64> = (5..9).map(|at| step(&mut current, at)).collect();
    close(&again, &[0.0, 5.0, 10.0, 10.0]);
}

#[test]
fn the_drive_gets_whole_numbers_of_16_bit() {
    // R4.11
    let outputs = |scaling_factor, outs: [f64; 2]| {
        let mut list = FrictionList {
            scaling_factor,
            ..list()
        };
        list.table[0].output = outs[0];
        list.table[1].output = outs[1];
        let mut current = AdditiveCurrent::new(&list, Reading::default());
        let forth = current.step(1.0, 1000.0, &[]).output;
        let back = current.step(0.0, -1000.0, &[]).output;
        (forth, back, current.saturated())
    };
    assert_eq!(outputs(100, [0.0, 25.0]), (3, -3, 0));
    assert_eq!(outputs(1000, [0.0, 40_000.0]), (32_767, -32_768, 2));
    // The manual's sample: 3722 at 1 % are 37.22 drive units.
    assert_eq!(outputs(10, [0.0, 3722.0]), (37, -37, 0));
}

/// A reversal at a constant speed: cycles back and forth, and the result of each cycle.
struct Reversal {
    /// µm/s.
    speed: f64,
    forth: usize,
    /// Weight before, weight after, current.
    cycles: &'static [(f64, f64, f64)],
}

/// 0.1, 1 and 10 mm/s with `position_delay` 9, `reversal_lookahead` 2, `delay_cycles` 1 and the points
/// (0, 12), (1800, 10.5). A cycle of 1 ms covers 1, 10 and 100 units of 0.1 µm, so that the
/// build-up takes nine cycles, one and one. The list yields 12 - 0.1/1.2 = 11.9167 at 100 µm/s,
/// 12 - 1/1.2 = 11.1667 at 1000 µm/s and 10.5 at 10 000 µm/s; every current comes a cycle late.
const REVERSALS: [Reversal; 3] = [
    Reversal {
        speed: 100.0,
        forth: 13,
        cycles: &[
            (1.0, 0.0, 0.0),
            (1.0, 0.111_111_111, 0.0),
            (1.0, 0.222_222_222, 1.324_074_074),
            (1.0, 0.333_333_333, 2.648_148_148),
            (1.0, 0.444_444_444, 3.972_222_222),
            (1.0, 0.555_555_556, 5.296_296_296),
            (1.0, 0.666_666_667, 6.620_370_37),
            (1.0, 0.777_777_778, 7.944_444_444),
            (1.0, 0.888_888_889, 9.268_518_519),
            (1.0, 1.0, 10.592_592_593),
            (1.0, 1.0, 11.916_666_667),
            (0.5, 1.0, 11.916_666_667),
            (0.0, 1.0, 5.958_333_333),
            (1.0, 0.111_111_111, 0.0),
            (1.0, 0.222_222_222, -1.324_074_074),
            (1.0, 0.333_333_333, -2.648_148_148),
            (1.0, 0.444_444_444, -3.972_222_222),
            (1.0, 0.555_555_556, -5.296_296_296),
            (1.0, 0.666_666_667, -6.620_370_37),
            (1.0, 0.777_777_778, -7.944_444_444),
            (1.0, 0.888_888_889, -9.268_518_519),
            (1.0, 1.0, -10.592_592_593),
            (1.0, 1.0, -11.916_666_667),
            (1.0, 1.0, -11.916_666_667),
            (1.0, 1.0, -11.916_666_667),
        ],
    },
    Reversal {
        speed: 1000.0,
        forth: 5,
        cycles: &[
            (1.0, 0.0, 0.0),
            (1.0, 1.0, 0.0),
            (1.0, 1.0, 11.166_666_667),
            (0.5, 1.0, 11.166_666_667),
            (0.0, 1.0, 5.583_333_333),
            (1.0, 1.0, 0.0),
            (1.0, 1.0, -11.166_666_667),
            (1.0, 1.0, -11.166_666_667),
            (1.0, 1.0, -11.166_666_667),
            (1.0, 1.0, -11.166_666_667),
        ],
    },
    Reversal {
        speed: 10_000.0,
        forth: 4,
        cycles: &[
            (1.0, 0.0, 0.0),
            (1.0, 1.0, 0.0),
            (0.5, 1.0, 10.5),
            (0.0, 1.0, 5.25),
            (1.0, 1.0, 0.0),
            (1.0, 1.0, -10.5),
            (1.0, 1.0, -10.5),
            (1.0, 1.0, -10.5),
        ],
    },
];

#[test]
fn reversals_at_three_speeds_cycle_by_cycle() {
    // R4.1 R4.2 R4.3 R4.5
    let list = FrictionList {
        position_delay: 9,
        reversal_lookahead: 2,
        delay_cycles: 1,
        table: vec![
            TablePoint {
                input: 0.0,
                output: 12.0,
            },
            TablePoint {
                input: 1800.0,
                output: 10.5,
            },
        ],
        ..list()
    };
    for reversal in &REVERSALS {
        let speeds = |at| {
            if at < reversal.forth {
                reversal.speed
            } else {
                -reversal.speed
            }
        };
        let velocities: Vec<f64> = (0..reversal.cycles.len()).map(speeds).collect();
        let mut current = AdditiveCurrent::new(&list, Reading::default());
        let found = current.trace(&positions(&velocities), &velocities);
        for (at, (found, (before, after, current))) in found.iter().zip(reversal.cycles).enumerate()
        {
            let said = format!("cycle {at} at {} µm/s: {found:?}", reversal.speed);
            assert!((found.w_before - before).abs() < 1e-9, "{said}");
            assert!((found.w_after - after).abs() < 1e-9, "{said}");
            assert!((found.current_units - current).abs() < 1e-9, "{said}");
        }
    }
}

#[test]
fn a_trace_cycle_by_cycle_is_the_trace_as_a_whole() {
    // R4.2
    let list = FrictionList {
        reversal_lookahead: 3,
        position_delay: 25,
        delay_cycles: 2,
        ..list()
    };
    let velocities: Vec<f64> = (0..400)
        .map(|at| (f64::from(at) * 0.37).sin() * f64::from(at % 7) * 300.0)
        .collect();
    let positions = positions(&velocities);
    let whole = AdditiveCurrent::new(&list, Reading::default()).trace(&positions, &velocities);
    let mut single = AdditiveCurrent::new(&list, Reading::default());
    let mut followers = Followers::new(vec![AdditiveCurrent::new(&list, Reading::default())]);
    let mut followed = Vec::new();
    for (at, whole) in whole.iter().enumerate() {
        let later = &velocities[at + 1..velocities.len().min(at + 4)];
        assert_eq!(single.step(positions[at], velocities[at], later), *whole);
        let commanded = Commanded {
            position_units: positions[at],
            velocity_units: velocities[at],
            friction: State::Active,
        };
        followed.extend(followers.push([commanded]).map(|samples| samples[0].added));
    }
    while let Some(samples) = followers.pop() {
        followed.push(samples[0].added);
    }
    assert_eq!(followed, whole);
}

#[test]
fn every_start_builds_up_where_the_documents_are_read_so() {
    // R4.3
    let list = FrictionList {
        position_delay: 20,
        ..list()
    };
    // 10 units per cycle: half of the build-up, all of it; a stop, and on in the same direction.
    let v = [1000.0, 1000.0, 1000.0, 0.0, 0.0, 1000.0, 1000.0, -1000.0];
    let every: Reading = "start=every".parse().expect("a reading");
    assert_eq!(every.start, Start::Every);
    let standing = 12.0;
    let first = [0.0, 5.0, 10.0, standing, standing, 10.0, 10.0, -5.0];
    let again = [0.0, 5.0, 10.0, standing, standing, 5.0, 10.0, -5.0];
    close(&currents(&list, Reading::default(), &v), &first);
    close(&currents(&list, every, &v), &again);
    // A change of the speed is not a start.
    let slower = [1000.0, 1000.0, 1000.0, 1.0, 1000.0];
    let held = currents(&list, every, &slower);
    close(&held, &[0.0, 5.0, 10.0, 12.0, 10.0]);
}

/// Columns with times in ms and positions of 1 unit per ms.
fn columns(times_ms: &[f64]) -> TraceColumns {
    TraceColumns {
        times_s: Some(times_ms.iter().map(|time| time / 1000.0).collect()),
        positions: Some(times_ms.to_vec()),
        velocities: None,
        switched: vec![Switched::On; times_ms.len()],
    }
}

/// Returns the fault of times in ms, and its row.
fn refused(times_ms: &[f64], cycle_ms: Option<f64>) -> Option<String> {
    let options = TraceOptions::default().with_cycle_s(cycle_ms.map(|cycle| cycle / 1000.0));
    let trace = CommandedTrace::new(columns(times_ms), options);
    trace.err().map(|error| error.to_string())
}

#[test]
fn rows_are_cnc_cycles_within_a_hundredth() {
    // R4.5: what is counted in cycles has to be cycles.
    assert_eq!(refused(&[0.0, 1.0, 2.0, 3.0], None), None);
    assert_eq!(refused(&[0.0, 1.0, 2.009, 3.0], None), None);
    assert_eq!(refused(&[7.0, 7.25, 7.5], Some(0.25)), None);
    for (times, cycle, said) in [
        (
            &[0.0, 1.0, 2.02, 3.0][..],
            None,
            "row 3, at 0.00202 s, comes 1.02 ms after the row above; a CNC cycle has 1 ms",
        ),
        (
            &[0.0, 1.0, 2.0, 9.0, 10.0],
            None,
            "a gap of 7 ms before row 4, at 0.009 s; a CNC cycle has 1 ms",
        ),
        (
            &[0.0, 1.0, 2.0, 1.0, 2.0],
            None,
            "the time jumps back at row 4, from 0.002 to 0.001 s",
        ),
        (
            &[0.0, 1.0, 1.0, 2.0],
            None,
            "row 3 has the time of the row above, 0.001 s",
        ),
        (
            &[0.0, 2.0, 4.0],
            Some(1.0),
            "a gap of 2 ms before row 2, at 0.002 s; a CNC cycle has 1 ms",
        ),
        (
            &[0.0, 0.5, 1.0],
            Some(1.0),
            "row 2, at 0.0005 s, comes 0.5 ms after the row above; a CNC cycle has 1 ms",
        ),
        (
            &[0.0, f64::NAN],
            Some(1.0),
            "the time of row 2 is not a number",
        ),
    ] {
        assert_eq!(refused(times, cycle).as_deref(), Some(said));
    }
    let error = CommandedTrace::new(
        columns(&[0.0, 1.0]),
        TraceOptions::default().with_cycle_s(Some(0.0)),
    );
    assert!(matches!(error, Err(CyclesError::Cycle(_))));
}

/// Times in ms and positions of a trace that is resampled to cycles of 1 ms, and the remarks.
fn resampled(columns: TraceColumns) -> (Vec<[f64; 3]>, Vec<String>) {
    let options = TraceOptions::default()
        .with_cycle_s(Some(0.001))
        .with_resampling(Resampling::Done);
    let trace = CommandedTrace::new(columns, options).expect("a trace");
    let rows = trace.rows();
    let rows = rows.map(|row| [row.time_s * 1000.0, row.position, row.velocity]);
    let rounded = rows.map(|row| row.map(|value| (value * 1e6).round() / 1e6));
    (rounded.collect(), trace.remarks().to_vec())
}

#[test]
fn resampling_makes_cycles_of_any_rows() {
    // R4.5: 4 ms to 1 ms, on straight lines; 1 unit per ms is 100 µm/s.
    let (rows, said) = resampled(columns(&[0.0, 4.0, 8.0]));
    let expected: Vec<[f64; 3]> = (0..9)
        .map(|at| {
            [
                f64::from(at),
                f64::from(at),
                if at == 0 { 0.0 } else { 100.0 },
            ]
        })
        .collect();
    assert_eq!(rows, expected);
    assert_eq!(said, ["3 rows are resampled to 9 cycles of 1 ms"]);
    // A gap, a repeated row and a jump back.
    let (rows, said) = resampled(columns(&[0.0, 1.0, 2.0, 2.0, 1.5, 3.0, 7.0, 8.0]));
    assert_eq!(rows, expected);
    assert_eq!(
        said,
        [
            "8 rows are resampled to 9 cycles of 1 ms",
            "2 rows whose time is not after every time above are left out",
            "a gap of 4 ms before row 7 is bridged by a straight line",
        ]
    );
    // Rows that were cycles do not change, to the last bit.
    let times: Vec<f64> = (0..5000).map(|at| f64::from(at) * 1.0).collect();
    let mut own = columns(&times);
    own.positions = Some(times.iter().map(|time| (time * 0.37).sin()).collect());
    own.velocities = Some(times.iter().map(|time| time.sqrt()).collect());
    let plain = CommandedTrace::new(own.clone(), TraceOptions::default()).expect("a trace");
    let again = TraceOptions::default().with_resampling(Resampling::Done);
    let again = CommandedTrace::new(own, again).expect("a trace");
    assert!(plain.rows().eq(again.rows()));
    // Compensation switches with its row.
    let mut switching = columns(&[0.0, 2.0, 4.0]);
    switching.switched[1] = Switched::Off;
    let options = TraceOptions::default()
        .with_cycle_s(Some(0.001))
        .with_resampling(Resampling::Done);
    let trace = CommandedTrace::new(switching, options).expect("a trace");
    let states: Vec<Switched> = trace.rows().map(|row| row.switched).collect();
    let (on, off) = (Switched::On, Switched::Off);
    assert_eq!(states, [on, on, off, off, on]);
    // No trace needs more cycles than a day has.
    let options = TraceOptions::default()
        .with_cycle_s(Some(0.001))
        .with_resampling(Resampling::Done);
    let error = CommandedTrace::new(columns(&[0.0, 1e12]), options);
    assert!(matches!(error, Err(CyclesError::TooLong { .. })));
}

#[test]
fn toggling_around_zero_is_one_standstill() {
    // R4.6: without it each of these cycles would be a reversal.
    let velocities = [1000.0, 1000.0, -2.0, 2.0, -2.0, 2.0, 1000.0, 1000.0];
    let columns = || TraceColumns {
        times_s: None,
        positions: None,
        velocities: Some(velocities.to_vec()),
        switched: vec![Switched::On; velocities.len()],
    };
    let currents = |options: TraceOptions| {
        let trace = CommandedTrace::new(columns(), options).expect("a trace");
        let mut current = AdditiveCurrent::new(&list(), Reading::default());
        let added = trace.currents(&mut current);
        let currents: Vec<f64> = added.map(|(_, added)| added.current_units).collect();
        (currents, trace.remarks().to_vec(), current.at_rest())
    };
    let (found, said, at_rest) = currents(TraceOptions::default());
    close(&found, &[10.0, 10.0, 12.0, 12.0, 12.0, 12.0, 10.0, 10.0]);
    assert_eq!(
        said,
        ["1 stretch in which the velocity only toggles around zero, 3 cycles, count as standstill"]
    );
    assert_eq!(at_rest, 3);
    let off = TraceOptions::default().with_dead_band(DeadBand::Below(0.0));
    let (found, said, at_rest) = currents(off);
    close(&found, &[10.0, 10.0, -12.0, 12.0, -12.0, 12.0, 10.0, 10.0]);
    assert_eq!((said.len(), at_rest), (0, 0));
    let wide = TraceOptions::default().with_dead_band(DeadBand::Below(2000.0));
    close(&currents(wide).0, &[0.0; 8]);
}

#[test]
fn cycles_in_which_the_reading_of_standstill_matters_are_counted() {
    // R4.6: C11
    let v = [0.0, 1000.0, 0.0, 0.0, -1000.0, 0.0];
    for reading in ["standstill=hold", "standstill=zero"] {
        let reading: Reading = reading.parse().expect("a reading");
        let mut current = AdditiveCurrent::new(&list(), reading);
        current.trace(&positions(&v), &v);
        assert_eq!(current.at_rest(), 3, "{reading}");
        current.switch(Switched::Off);
        current.trace(&positions(&v), &v);
        assert_eq!(current.at_rest(), 3, "{reading}");
    }
}
