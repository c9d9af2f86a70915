//! Machines of the tests.

use frictcomp_testing::{Axis, Control, Coupling, Guide, Machine, Presliding, Ramp};

/// A table of 900 kg on roller guides.
pub(crate) fn table(presliding: Presliding) -> Axis {
    Axis {
        mass_kg: 900.0,
        coupling: None,
        guide: Guide {
            sliding_n: 420.0,
            sticking_n: 540.0,
            fading_mm_per_s: 4.0,
            viscous_n_s_per_mm: 3.0,
            presliding,
            asymmetry: 0.0,
        },
        kv: 30.0,
        forward: 1.0,
        bandwidth_hz: 42.0,
        reset_s: 0.013,
        current_loop_s: 0.0007,
        dead_cycles: 1,
        unit_n: 4.0,
        weight_n: 0.0,
        cogging: (0.0, 10.0),
        backlash_um: 0.0,
        most_n: 20_000.0,
    }
}

fn bristle_of(um: f64) -> Presliding {
    Presliding::Bristle {
        um,
        damping: 0.3,
        damped_to_mm_per_s: 2.0,
    }
}

fn machine(name: &'static str, axis: Axis) -> Machine {
    let mut y = axis.clone();
    y.mass_kg *= 1.2;
    y.guide.sliding_n *= 1.1;
    y.guide.sticking_n *= 1.1;
    Machine {
        name,
        axes: [axis, y],
        control: Control {
            ramp: Ramp {
                acceleration: 2000.0,
                jerk: 50_000.0,
            },
            cycle_s: 0.001,
            part: 1.0,
            phase_s: 0.0003,
        },
    }
}

/// A bristle, one mass: the structure of the plants of the command.
pub(crate) fn bristle() -> Machine {
    machine("bristle", table(bristle_of(1.5)))
}

/// The machines of the table in the documents.
pub(crate) fn all() -> Vec<Machine> {
    let stiff = machine("stiff bristle", table(bristle_of(0.5)));
    let springs = machine(
        "springs that slip one after another",
        table(Presliding::Springs(vec![
            [0.5, 0.25],
            [1.5, 0.4],
            [5.0, 0.35],
        ])),
    );
    let softening = machine(
        "softening spring (Dahl)",
        table(Presliding::Softening { um: 1.2 }),
    );
    let mut two = machine("two masses", table(bristle_of(1.2)));
    for axis in &mut two.axes {
        axis.coupling = Some(Coupling {
            motor_part: 0.6,
            n_per_um: 150.0,
            damping: 0.08,
        });
    }
    let mut slow = machine("slow loops, rough, weight on Y", table(bristle_of(1.5)));
    for axis in &mut slow.axes {
        axis.kv = 20.0;
        axis.bandwidth_hz = 28.0;
        axis.dead_cycles = 3;
        axis.cogging = (15.0, 10.0);
        axis.guide.asymmetry = 0.06;
    }
    slow.axes[1].weight_n = 250.0;
    let mut start = bristle();
    start.name = "bristle, starts softly";
    start.control.ramp = Ramp {
        acceleration: 500.0,
        jerk: 5000.0,
    };
    let mut soft = machine("soft bristle", table(bristle_of(7.0)));
    soft.axes[1].guide.presliding = bristle_of(8.0);
    vec![stiff, springs, softening, two, slow, start, soft]
}
