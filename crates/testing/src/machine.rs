//! A machine of two axes, and what it does in a program.

use super::axis::Axis;
use super::control::{Commanded, Control};
use super::list::ValueList;
use super::program::Program;

/// A machine of two axes.
#[derive(Debug, Clone)]
pub struct Machine {
    /// Name in tables.
    pub name: &'static str,
    /// X and Y.
    pub axes: [Axis; 2],
    /// Control.
    pub control: Control,
}

/// Record of a machine in a program.
#[derive(Debug, Clone)]
pub struct Run {
    /// The commanded values.
    pub commanded: Commanded,
    /// The place of each load in mm at the beginning of each cycle.
    pub load_mm: [Vec<f64>; 2],
    /// The place of each motor.
    pub motor_mm: [Vec<f64>; 2],
    /// The force of each motor in drive units.
    pub units: [Vec<f64>; 2],
    /// The cycle in s.
    pub cycle_s: f64,
}

impl Machine {
    /// Executes a program from a place in mm with the lists that are loaded, each of which acts where the program
    /// has compensation on.
    pub fn run(&self, program: &Program, start: [f64; 2], lists: [Option<&ValueList>; 2]) -> Run {
        let commanded = self.control.run(program, start);
        let cycle_s = self.control.cycle_s;
        let followed = [0, 1].map(|axis| {
            let (places, velocities) = (&commanded.places[axis], &commanded.velocities[axis]);
            let added = lists[axis].map_or_else(Vec::new, |list| {
                list.currents(places, velocities, &commanded.is_on[axis])
            });
            self.axes[axis].follow(places, &added, cycle_s)
        });
        let [x, y] = followed;
        Run {
            commanded,
            load_mm: [x.load_mm, y.load_mm],
            motor_mm: [x.motor_mm, y.motor_mm],
            units: [x.units, y.units],
            cycle_s,
        }
    }
}
