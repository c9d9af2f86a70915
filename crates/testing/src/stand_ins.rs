//! The machines of the tests.

use super::axis::{Axis, Coupling};
use super::control::Control;
use super::guide::{Guide, Presliding};
use super::machine::Machine;
use super::ramp::Ramp;

impl Presliding {
    /// Returns a bristle with a deflection in µm and usual damping.
    pub fn bristle(um: f64) -> Self {
        Self::Bristle {
            um,
            damping: 0.3,
            damped_to_mm_per_s: 2.0,
        }
    }
}

impl Axis {
    /// Returns a table of 900 kg on roller guides.
    pub fn table(presliding: Presliding) -> Self {
        Self {
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
}

impl Machine {
    /// Returns a machine of two tables, of which Y is heavier and has more friction.
    pub fn of_tables(name: &'static str, presliding: Presliding) -> Self {
        let x = Axis::table(presliding);
        let mut y = x.clone();
        y.mass_kg *= 1.2;
        y.guide.sliding_n *= 1.1;
        y.guide.sticking_n *= 1.1;
        Self {
            name,
            axes: [x, y],
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

    /// Returns a bristle and one mass: the structure of most plants.
    pub fn bristle() -> Self {
        Self::of_tables("bristle", Presliding::bristle(1.5))
    }

    /// Machines of different structures, from stiff to soft; the soft one comes last.
    pub fn stand_ins() -> Vec<Self> {
        let stiff = Self::of_tables("stiff bristle", Presliding::bristle(0.5));
        let springs = Presliding::Springs(vec![[0.5, 0.25], [1.5, 0.4], [5.0, 0.35]]);
        let springs = Self::of_tables("springs that slip one after another", springs);
        let softening = Presliding::Softening { um: 1.2 };
        let softening = Self::of_tables("softening spring (Dahl)", softening);
        let mut two = Self::of_tables("two masses", Presliding::bristle(1.2));
        for axis in &mut two.axes {
            axis.coupling = Some(Coupling {
                motor_part: 0.6,
                n_per_um: 150.0,
                damping: 0.08,
            });
        }
        let mut slow = Self {
            name: "slow loops, ripple, weight on Y",
            ..Self::bristle()
        };
        for axis in &mut slow.axes {
            axis.kv = 20.0;
            axis.bandwidth_hz = 28.0;
            axis.dead_cycles = 3;
            axis.cogging = (15.0, 10.0);
            axis.guide.asymmetry = 0.06;
        }
        slow.axes[1].weight_n = 250.0;
        let mut start = Self {
            name: "bristle, starts softly",
            ..Self::bristle()
        };
        start.control.ramp = Ramp {
            acceleration: 500.0,
            jerk: 5000.0,
        };
        let mut soft = Self::of_tables("soft bristle", Presliding::bristle(7.0));
        soft.axes[1].guide.presliding = Presliding::bristle(8.0);
        vec![stiff, springs, softening, two, slow, start, soft]
    }
}
