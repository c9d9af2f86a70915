//! The plant from recorded circles, on machines that the fit does not see (R16.3).

use frictcomp_physics::circle::{
    Circle, DriveFit, FittedDrive, ObservedCircle, PlaneAxis, RecordedCircle, RecordedTrace,
};
use frictcomp_physics::current::Reading;
use frictcomp_physics::simulation::{DriveParameters, plant_list};
use frictcomp_testing::PresetMachine;

const FEEDS: [f64; 4] = [500.0, 800.0, 2000.0, 5000.0];

/// Returns the prior knowledge: the reference, with the friction that `identify` finds, to 2 %.
fn known(machine: &PresetMachine, axis: PlaneAxis) -> DriveParameters {
    let plant = machine.reference.plant();
    let (reference, own) = match axis {
        PlaneAxis::X => (plant.x, &machine.plant.x),
        _ => (plant.y, &machine.plant.y),
    };
    let mut drive = reference;
    drive.friction.coulomb_n = own.friction.coulomb_n * 1.01;
    drive.friction.breakaway_n = own.friction.breakaway_n * 0.99;
    drive.friction.viscous_n_s_per_m = own.friction.viscous_n_s_per_m * 1.01;
    drive
}

fn fitted(machine: &PresetMachine, axis: PlaneAxis, feeds: &[f64]) -> FittedDrive {
    let drive = known(machine, axis);
    let mut list = plant_list(&drive);
    (
        list.position_delay,
        list.reversal_lookahead,
        list.delay_cycles,
    ) = (0, 0, 0);
    let mut circles = Vec::new();
    for &feed in feeds {
        for list in [None, Some(&list)] {
            let rows = machine.recorded(feed, [list; 2], feed as u64 + u64::from(list.is_some()));
            let trace = RecordedTrace {
                points_mm: rows.iter().map(|it| [it[1], it[2]]).collect(),
                times_s: rows.iter().map(|it| it[0]).collect(),
            };
            let turns = RecordedCircle::find(&trace, Some(machine.radius_mm)).expect("circles");
            assert_eq!(turns.len(), 2);
            let circle = Circle {
                radius_mm: machine.radius_mm,
                feed_mm_per_min: feed,
                cycle_time_s: 0.001,
            };
            let observed = ObservedCircle::of(axis, (circle, list.cloned()), &turns);
            circles.push(observed.expect("glitches"));
        }
    }
    let fit = DriveFit {
        axis,
        drive,
        reading: Reading::default(),
        circles,
    };
    fit.fit().expect("a plant")
}

/// R16.3: contact, Kp and friction of a machine are found from circles off and on at four feeds over a decade, each
/// within its range, with fewer than 1000 simulated reversals; the best accuracy of the delay is 0.5 ms.
#[test]
fn the_plant_is_found_from_recorded_circles() {
    let machine = PresetMachine {
        radius_mm: 25.0,
        ..PresetMachine::half()
    };
    let feeds = FEEDS.map(|it| it / 2.0);
    let found = fitted(&machine, PlaneAxis::X, &feeds);
    let own = &machine.plant.x;
    for (what, extent, own, most) in [
        (
            "contact",
            found.contact,
            own.friction.stiffness_n_per_m,
            0.15,
        ),
        ("Kp", found.speed_gain, own.speed_gain_n_s_per_m, 0.07),
        ("Fc", found.coulomb, own.friction.coulomb_n, 0.05),
    ] {
        let part = extent.value / own;
        assert!((part - 1.0).abs() < most, "{what} {part}");
        let is_within = extent.low <= own * 1.01 && own * 0.99 <= extent.high;
        assert!(is_within, "{what} {extent:?} {own}");
    }
    assert!(found.contact.is_determined() && !found.damping.is_determined());
    let delay = found.delay_s;
    assert!(delay.low <= own.current_time_s && own.current_time_s <= delay.high);
    assert!(
        delay.high - delay.low >= 1e-3 - 1e-9 && found.simulations < 1000,
        "{found:?}"
    );
}

/// R16.3: the table of docs/reliability.md.
#[test]
#[ignore = "seconds per machine"]
#[allow(clippy::print_stdout, reason = "the table is its purpose")]
fn parameters_found_against_true() {
    for machine in PresetMachine::all() {
        for axis in PlaneAxis::ALL {
            let found = fitted(&machine, axis, &FEEDS);
            let own = match axis {
                PlaneAxis::X => &machine.plant.x,
                _ => &machine.plant.y,
            };
            print!(
                "{:7} {axis:?} {:.2} µm left, {} simulated",
                machine.name, found.left_um, found.simulations
            );
            for (name, extent, own) in [
                ("contact", found.contact, own.friction.stiffness_n_per_m),
                ("Kp", found.speed_gain, own.speed_gain_n_s_per_m),
                ("Fc", found.coulomb, own.friction.coulomb_n),
                ("damping", found.damping, own.friction.damping_n_s_per_m),
                ("delay", found.delay_s, own.current_time_s),
            ] {
                let [value, low, high] = [extent.value, extent.low, extent.high].map(|it| it / own);
                print!("  {name} {value:.2} ({low:.2} to {high:.2})");
                assert!(low < 1.01 && high > 0.99, "{} {name}", machine.name);
            }
            println!();
        }
    }
}
