//! The contour compared with independent results: the circular test, and an independent simulation.

mod driven;
mod independent;
mod shape;

use std::f64::consts::TAU;
use std::fmt::Write as _;

use frictcomp::drive_interface::TorqueScale;
use frictcomp::lists::{FrictionList, TablePoint};
use frictcomp::machine::Machine;
use frictcomp_physics::circle::{
    Circle, CircularTest, Comparison, Direction, Figures, Method, PathFigures,
};
use frictcomp_physics::contour::PerRun;
use frictcomp_physics::current::Reading;
use frictcomp_physics::motion::Movement;
use frictcomp_physics::simulation::{FrictionModel, Plant, Preset, plant_list};

use driven::{Found, drive, drive_on};
use independent::{Compensation, Equations, Simulated, simulate};
use shape::{Line, Shape};

/// Axes whose jerk lets the path enter an arc at full feed.
const QUICK: &str = "\
[[axis]]
name = \"X\"
frict_comp = true
max_acceleration = 10.0
max_jerk = 5000.0
max_velocity = 30000
VALUE
[[axis]]
name = \"Y\"
frict_comp = true
max_acceleration = 10.0
max_jerk = 5000.0
max_velocity = 30000
VALUE
";

fn machine(value: &str) -> String {
    QUICK.replace("VALUE", value)
}

fn standing([x, y]: [f64; 2]) -> [(&'static str, f64); 2] {
    [("X", x), ("Y", y)]
}

/// A circle in either direction, as arcs or as chords.
#[derive(Debug, Clone, Copy)]
struct Round {
    radius: f64,
    feed: f64,
    sense: Direction,
    /// The chords of a turn, 0 for an arc.
    chords: u32,
}

impl Round {
    fn sign(self) -> f64 {
        if self.sense == Direction::Ccw {
            1.0
        } else {
            -1.0
        }
    }

    /// Returns a program of three turns from X+, after a tangent, and the lines of its second turn.
    fn program(self) -> (String, std::ops::RangeInclusive<u32>) {
        let Self {
            radius,
            feed,
            chords,
            ..
        } = self;
        let mut text = format!("G90 F{feed}\nG01 X{radius} Y0\n");
        if chords == 0 {
            let word = if self.sense == Direction::Ccw {
                "G03"
            } else {
                "G02"
            };
            let turn = format!("{word} X{radius} Y0 I-{radius} J0\n");
            text.push_str(&turn.repeat(3));
            let _ = writeln!(text, "G01 Y{}\nM30", 10.0 * self.sign());
            return (text, 4..=4);
        }
        for step in 1..=3 * chords {
            let angle = f64::from(step) / f64::from(chords) * TAU;
            let (x, y) = (radius * angle.cos(), self.sign() * radius * angle.sin());
            let _ = writeln!(text, "G01 X{x:.7} Y{y:.7}");
        }
        let _ = writeln!(text, "G01 Y{}\nM30", 10.0 * self.sign());
        (text, 3 + chords..=2 + 2 * chords)
    }

    /// Returns the sagitta of a chord: the program itself deviates by as much.
    fn bulge_um(self) -> f64 {
        match self.chords {
            0 => 0.0,
            chords => 1000.0 * self.radius * (1.0 - (TAU / f64::from(chords) / 2.0).cos()),
        }
    }

    fn start(self) -> [f64; 2] {
        [self.radius, -15.0 * self.sign()]
    }

    fn reference(self, plant: &Plant) -> Comparison {
        let test = CircularTest {
            circle: Circle {
                radius_mm: self.radius,
                feed_mm_per_min: self.feed,
                ..Circle::default()
            },
            plant: plant.clone(),
            model: FrictionModel::default(),
            compensation: [&plant.x, &plant.y]
                .map(|drive| Some(Method::Current(plant_list(drive)))),
            reading: Reading::default(),
        };
        test.compare().expect("a circle")
    }
}

/// Returns `F_min` and `F_max` of one direction.
fn extremes(figures: Option<&PathFigures>) -> [f64; 2] {
    let figures = figures.expect("a path");
    [figures.f_min_um, figures.f_max_um].map(|it| it.expect("a commanded radius"))
}

#[test]
fn a_circle_gives_f_max_and_f_min_of_the_circular_test() {
    // R11.3, R5.21
    let mut backlash = Preset::Mid.plant();
    backlash.x.backlash_m = 4e-6;
    let [stiff, mid, soft] = Preset::ALL.map(Preset::plant);
    let cases = [
        (&stiff, 25.0, 3000.0, Direction::Ccw, 0),
        (&stiff, 100.0, 12000.0, Direction::Cw, 0),
        (&mid, 10.0, 1000.0, Direction::Cw, 0),
        (&mid, 40.0, 6000.0, Direction::Ccw, 0),
        (&soft, 25.0, 2000.0, Direction::Cw, 0),
        (&backlash, 25.0, 3000.0, Direction::Ccw, 0),
        (&mid, 25.0, 3000.0, Direction::Cw, 1440),
        (&soft, 50.0, 5000.0, Direction::Ccw, 2880),
    ];
    for (plant, radius, feed, sense, chords) in cases {
        let round = Round {
            radius,
            feed,
            sense,
            chords,
        };
        let (program, second) = round.program();
        let found = drive(
            &machine(""),
            plant,
            (&program, &standing(round.start())),
            Found::default(),
        )
        .over(second);
        let reference = round.reference(plant);
        let of = |figures: &Figures| {
            let path = if sense == Direction::Ccw {
                &figures.ccw
            } else {
                &figures.cw
            };
            extremes(path.as_ref())
        };
        // The place of a reversal within its CNC cycle affects what the compensation leaves.
        for (what, found, known, um) in [
            ("off", found.0.all_off, of(&reference.off.figures), 0.01),
            ("on", found.0.all_on, of(&reference.on.figures), 0.1),
        ] {
            for (found, known) in found.into_iter().zip(known) {
                let tolerance = 0.02 * known.abs() + um + round.bulge_um();
                assert!(
                    (found - known).abs() <= tolerance,
                    "{} {round:?} {what}: {found} of {known}",
                    plant.name
                );
            }
        }
    }
}

/// Returns the compensation that fits the friction of the equations, as a value list of the machine and for the
/// simulation.
fn list(equations: &Equations) -> (String, FrictionList) {
    let inputs = [
        0.0, 500.0, 1000.0, 2000.0, 4000.0, 8000.0, 16_000.0, 40_000.0, 100_000.0, 200_000.0,
    ];
    let table = inputs.map(|input| TablePoint {
        input,
        output: (equations.units_at(input * 1e-6) * 100.0).round() / 100.0,
    });
    let rows: Vec<String> = table
        .iter()
        .map(|point| format!("[{}, {}]", point.input, point.output))
        .collect();
    let value = format!(
        "value = {{ mode = 3, table_entries = 10, position_delay = 9, reversal_lookahead = 2, delay_cycles = 1, table = [{}] }}",
        rows.join(", ")
    );
    let list = FrictionList {
        position_delay: 9,
        reversal_lookahead: 2,
        scaling_factor: 1000,
        delay_cycles: 1,
        max_points: 20,
        table: table.to_vec(),
    };
    (value, list)
}

/// The permitted difference between two figures: a share, and some µm.
#[derive(Debug, Clone, Copy)]
struct Tolerance(f64, f64);

impl Tolerance {
    fn check(self, what: &str, (found, known): (f64, f64)) {
        let Self(share, um) = self;
        let is_near = (found - known).abs() <= share * known.abs() + um;
        assert!(is_near, "{what}: {found} of {known}");
    }
}

/// Compares every judged line, and every reversal in one.
fn compare(shape: &Shape, preset: Preset, (steps, tolerance): (u32, Tolerance)) {
    let plant = preset.plant();
    let equations = Equations {
        stiffness: preset.stiffness_n_per_m(),
        unit: 5.0,
        steps,
    };
    let (value, list) = list(&equations);
    let found = drive(
        &machine(&value),
        &plant,
        (&shape.program(), &standing(shape.start)),
        Found::settled(),
    );
    for compensation in [
        Compensation::Programmed,
        Compensation::On,
        Compensation::Off,
    ] {
        let simulated = simulate(shape, (&equations, &list), compensation);
        for line in shape.judged() {
            let pairs = run(found.lines[&line].0, compensation);
            for (found, known) in pairs.into_iter().zip(simulated.lines[&line]) {
                tolerance.check(&format!("line {line} {compensation:?}"), (found, known));
            }
        }
        reversals_agree(&found, &simulated, shape);
    }
}

fn run<T>(runs: PerRun<T>, compensation: Compensation) -> T {
    match compensation {
        Compensation::Programmed => runs.programmed,
        Compensation::On => runs.all_on,
        Compensation::Off => runs.all_off,
    }
}

fn reversals_agree(found: &Found, simulated: &Simulated, shape: &Shape) {
    let judged = shape.judged();
    let found = found.reversals.iter();
    let found: Vec<_> = found.filter(|it| judged.contains(&it.line)).collect();
    assert_eq!(found.len(), simulated.reversals.len(), "{found:?}");
    assert!(found.len() >= 4);
    for (found, known) in found.into_iter().zip(&simulated.reversals) {
        let axis = ["X", "Y"][known.axis];
        assert_eq!((found.line, found.axis.as_str()), (known.line, axis));
        assert_eq!(found.movement, Movement::Feed);
    }
}

/// Returns a square of 40 mm with corners of 5 mm, twice around, from a tangent.
fn square() -> Shape {
    let mut shape = Shape::new([-30.0, -20.0], 3000.0);
    shape.line([15.0, -20.0], false);
    for turn in 0..2 {
        let judged = turn > 0;
        shape.arc([15.0, -15.0], 90.0, judged);
        shape.line([20.0, 15.0], judged);
        shape.arc([15.0, 15.0], 90.0, judged);
        shape.line([-15.0, 20.0], judged);
        shape.arc([-15.0, 15.0], 90.0, judged);
        shape.line([-20.0, -15.0], judged);
        shape.arc([-15.0, -15.0], 90.0, judged);
        shape.line([15.0, -20.0], judged);
    }
    shape.line([45.0, -20.0], false);
    shape
}

/// Returns a pocket of 60 by 40 mm with two round islands; compensation of X is off at the second one, and of Y in the
/// pocket.
fn pocket() -> Shape {
    let mut shape = Shape::new([0.0, -10.0], 3000.0);
    shape.lines.push(Line::Command("Y[COMP OFF FRICT]"));
    shape.line([0.0, -12.0], false);
    shape.arc([8.0, -12.0], 90.0, false);
    for turn in 0..2 {
        let judged = turn > 0;
        shape.line([22.0, -20.0], judged);
        shape.arc([22.0, -12.0], 90.0, judged);
        shape.line([30.0, 12.0], judged);
        shape.arc([22.0, 12.0], 90.0, judged);
        shape.line([-22.0, 20.0], judged);
        shape.arc([-22.0, 12.0], 90.0, judged);
        shape.line([-30.0, -12.0], judged);
        shape.arc([-22.0, -12.0], 90.0, judged);
        shape.line([8.0, -20.0], judged);
    }
    shape.line([14.0, -20.0], false);
    shape.lines.push(Line::Dwell(0.3));
    shape.lines.push(Line::Command("Y[COMP ON FRICT]"));
    for (centre, radius, words) in [
        ([-12.0, 0.0], 6.0, "X[COMP OFF FRICT]"),
        ([12.0, 2.0], 9.0, "X[COMP ON FRICT]"),
    ] {
        // The entry is a diagonal, so that both axes carry the friction of their motion.
        let diagonal = 0.5_f64.sqrt();
        let on = [centre[0] - radius * diagonal, centre[1] + radius * diagonal];
        shape.lines.push(Line::Rapid {
            to: [on[0] - 10.0, on[1] - 10.0],
        });
        shape.lines.push(Line::Dwell(0.3));
        shape.line(on, false);
        for turn in 0..2 {
            shape.arc(centre, -180.0, turn > 0);
            shape.arc(centre, -180.0, turn > 0);
        }
        shape.line([on[0] + 10.0, on[1] + 10.0], false);
        shape.lines.push(Line::Dwell(0.3));
        shape.lines.push(Line::Command(words));
    }
    shape
}

/// Number of steps and tolerance with the steps of the rules: only the motion in time and the measuring differ, so
/// reversals are elsewhere in the CNC cycle, which affects what the compensation leaves.
const SAME_STEPS: (u32, Tolerance) = (2, Tolerance(0.01, 0.25));

/// Number of steps and tolerance with smaller steps by a factor of thirty, which show how much those of 62.5 µs matter.
const SMALL_STEPS: (u32, Tolerance) = (64, Tolerance(0.08, 1.0));

#[test]
fn a_square_with_rounded_corners_is_as_a_simulation_of_its_own() {
    // R11.2, R11.3
    compare(&square(), Preset::Mid, SAME_STEPS);
    compare(&square(), Preset::Mid, SMALL_STEPS);
}

#[test]
fn a_pocket_with_islands_is_as_a_simulation_of_its_own() {
    // R11.2, R11.3, R11.4
    compare(&pocket(), Preset::Stiff, SAME_STEPS);
    compare(&pocket(), Preset::Stiff, SMALL_STEPS);
}

#[test]
fn a_reversal_after_a_corner_is_measured_on_the_way_out_of_it() {
    // R11.2: the overshoot of X has Z as its normal; Z itself has no component normal to the path.
    let machine = machine("") + "[[axis]]\nname = \"Z\"\n";
    let program = "G90 F6000\nG01 Z5\nG01 X60\nG01 Z-5\nG01 X20\nG01 Z5\nM30\n";
    let plant = Preset::Stiff.plant();
    let start = ["X", "Y", "Z"].map(|axis| (axis, 0.0));
    let found = drive(&machine, &plant, (program, &start), Found::default());
    let reversals: Vec<_> = found.reversals.iter().collect();
    let lines: Vec<u32> = reversals.iter().map(|it| it.line).collect();
    assert_eq!(lines, [4, 5, 6]);
    let [_, overshoot] = found.lines[&4].0.all_off;
    assert!(overshoot > 10.0, "{overshoot}");
    for reversal in reversals.into_iter().filter(|it| it.axis == "Z") {
        assert!(reversal.glitch_um.all_off < 0.01, "{reversal:?}");
    }
}

#[test]
fn a_glitch_is_that_of_the_circular_test() {
    // R11.26: the same circle, plant and list, as an arc and in space.
    for (preset, radius, feed) in [
        (Preset::Stiff, 100.0, 2000.0),
        (Preset::Mid, 50.0, 3000.0),
        (Preset::Soft, 100.0, 5000.0),
    ] {
        let plant = preset.plant();
        let round = Round {
            radius,
            feed,
            sense: Direction::Ccw,
            chords: 0,
        };
        let (program, second) = round.program();
        let start = standing(round.start());
        let found = drive(&machine(""), &plant, (&program, &start), Found::default());
        let reference = round.reference(&plant);
        let largest = |figures: &Figures, axis: usize| {
            let path = figures.ccw.as_ref().expect("a path");
            let shape = path.shape.as_ref().expect("glitches");
            let glitch = [axis, axis + 2].map(|at| shape.glitches[at].height_um);
            glitch[0].max(glitch[1])
        };
        for (axis, name) in ["X", "Y"].into_iter().enumerate() {
            let of_axis = found.reversals.iter();
            let of_axis = of_axis.filter(|it| it.axis == name && second.contains(&it.line));
            let glitches: Vec<_> = of_axis.collect();
            assert!(glitches.len() >= 2, "{found:?}");
            assert!(glitches.iter().all(|it| it.has_figure()), "{glitches:?}");
            let most = |of: fn(&PerRun<f64>) -> f64| {
                let each = glitches.iter().map(|it| of(&it.glitch_um));
                each.fold(0.0, f64::max)
            };
            let off = (most(|it| it.all_off), largest(&reference.off.figures, axis));
            let on = (most(|it| it.all_on), largest(&reference.on.figures, axis));
            let what = format!("{} {round:?} {name}", plant.name);
            Tolerance(0.05, 0.0).check(&format!("{what} off"), off);
            Tolerance(0.05, 0.1).check(&format!("{what} on"), on);
        }
    }
}

#[test]
fn a_deviation_is_the_same_in_any_plane() {
    // R11.27: the same circle in XY and in ZX, with the same drive for all axes.
    let mut plant = Preset::Stiff.plant();
    plant.y = plant.x.clone();
    let machine = machine("")
        + "[[axis]]\nname = \"Z\"\nfrict_comp = true\nmax_acceleration = 10.0\nmax_jerk = 5000.0\nmax_velocity = 30000\n";
    let largest = |program: &str| {
        let start = [("X", 10.0), ("Y", 0.0), ("Z", 0.0)];
        let found = drive(&machine, &plant, (program, &start), Found::default());
        found.largest_um
    };
    let flat = largest("G17 G90 G01 X11 Y0 F1500\nG03 X11 Y0 I-11 J0\nM30\n");
    let upright = largest("G18 G90 G01 X11 Z0 F1500\nG02 X11 Z0 I-11 K0\nM30\n");
    assert!(flat > 3.0, "{flat}");
    Tolerance(0.01, 0.0).check("in ZX", (upright, flat));
}

#[test]
fn the_list_reaches_the_drive_as_the_control_scales_it() {
    // R7.8, R11.25: 14 units of a list that is scaled by 10 are 700 N, and by 0 nothing.
    let round = Round {
        radius: 25.0,
        feed: 3000.0,
        sense: Direction::Ccw,
        chords: 0,
    };
    let (program, second_turn) = round.program();
    let glitch = |output: f64, numerator: u32, denominator: u32| {
        let list = format!(
            "value = {{ mode = 3, table_entries = 2, table = [[0, {output}], [200000, {output}]] }}"
        );
        let of_x = QUICK.replacen("VALUE", &list, 1).replace("VALUE", "");
        let mut machine = Machine::from_toml(&of_x).expect("a machine");
        machine.axes[0].torque_scale = TorqueScale {
            numerator,
            denominator,
        };
        let start = standing(round.start());
        let plant = Preset::Mid.plant();
        let found = drive_on(machine, &plant, (&program, &start), Found::default());
        let of_x = found.reversals.iter();
        let of_x = of_x.filter(|it| it.axis == "X" && second_turn.contains(&it.line));
        of_x.map(|it| it.glitch_um).next_back().expect("a reversal")
    };
    let (whole, scaled) = (glitch(140.0, 1, 1), glitch(14.0, 10, 1));
    assert!(
        (whole.all_on - scaled.all_on).abs() < 0.01,
        "{whole:?} {scaled:?}"
    );
    let none = glitch(140.0, 1, 0);
    assert!((none.all_on - none.all_off).abs() < 0.1, "{none:?}");
    assert!(whole.all_on < none.all_on / 2.0, "{whole:?} {none:?}");
}
