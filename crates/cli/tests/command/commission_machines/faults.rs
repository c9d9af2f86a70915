//! Wrong recordings of either stage (R16.12 to R16.18).

use frictcomp_testing::{Machine, Recorder, ValueList};

use super::site::{Columns, Site};

/// The lists that are loaded on X and Y.
type Loaded = [Option<ValueList>; 2];

/// Recordings of a stage with a fault, over good ones of the same programs.
pub(crate) struct Fault {
    pub(crate) name: &'static str,
    /// The round: 1 without compensation, 2 with the provisional lists.
    pub(crate) round: usize,
    /// A part of the names of the programs that are recorded again.
    programs: &'static str,
    lists: fn([ValueList; 2]) -> Loaded,
    machine: fn(&mut Machine),
    recorder: fn(&mut Recorder),
    /// The text of a program as it is driven.
    driven: fn(String) -> String,
    /// A change of the rows.
    rows: Option<fn(&mut Columns)>,
    /// Words of the command, one of which names the fault.
    words: &'static [&'static str],
}

impl Fault {
    /// Returns the words with which a command names the fault.
    pub(crate) fn named(&self, said: &str) -> Option<&'static str> {
        self.words.iter().copied().find(|it| said.contains(it))
    }

    const fn on(name: &'static str, words: &'static [&'static str]) -> Self {
        Self {
            name,
            round: 2,
            programs: "circle",
            lists: |lists| lists.map(Some),
            machine: |_| {},
            recorder: |_| {},
            driven: |text| text,
            rows: None,
            words,
        }
    }

    const fn off(name: &'static str, words: &'static [&'static str]) -> Self {
        Self {
            round: 1,
            lists: |_| [None, None],
            ..Self::on(name, words)
        }
    }

    const fn friction(name: &'static str, words: &'static [&'static str]) -> Self {
        Self {
            programs: "friction-X",
            ..Self::off(name, words)
        }
    }

    /// Records the programs with the fault.
    pub(crate) fn record(&self, site: &Site) {
        let [x, y] = (self.lists)(site.loaded(2));
        let mut machine = site.machine.clone();
        (self.machine)(&mut machine);
        for (seed, program) in (300..).zip(site.programs(self.round, self.programs)) {
            let mut recorder = Recorder {
                seed,
                ..Recorder::default()
            };
            (self.recorder)(&mut recorder);
            let text = (self.driven)(site.text(&program));
            let run = Site::drive(&machine, &text, [x.as_ref(), y.as_ref()]);
            site.put(&program, &run, (&recorder, self.rows));
        }
    }
}

fn times(lists: [ValueList; 2], [x, y]: [f64; 2]) -> Loaded {
    let [of_x, of_y] = lists;
    [Some(of_x.times(x)), Some(of_y.times(y))]
}

fn with_friction(machine: &mut Machine, factor: f64) {
    machine.axes = machine.axes.clone().map(|it| it.with_friction(factor));
}

const NOT_ON: &[&str] = &["hardly differ", "was on", "are those of", "more than the"];
const ALREADY: &[&str] = &["already compensated", "hardly differ", "more than the"];
const ENDS: &[&str] = &["ends early", "one direction is missing", "not a full turn"];
const AVERAGED: &[&str] = &["are averages over", "follows its command after"];
const APART: &[&str] = &["recorded at different times", "follows its command after"];
const MIXED: &[&str] = &["mixed", "exchanged", "another axis"];
const STEPS: &[&str] = &["where it reverses"];
const ROWS: &[&str] = &["rows are missing", "without a sample"];

/// Faults of recordings of either stage.
pub(crate) fn of_recordings() -> Vec<Fault> {
    let mut all = of_circles_on();
    all.extend(of_circles_off());
    all.extend(of_friction());
    all
}

/// Returns the faults in which other lists are on than the stated ones.
pub(crate) fn of_lists_on() -> Vec<Fault> {
    vec![
        Fault {
            lists: |_| [None, None],
            ..Fault::on("no list", NOT_ON)
        },
        Fault {
            lists: |it| times(it, [0.1; 2]),
            ..Fault::on("a tenth of the lists", NOT_ON)
        },
        Fault {
            lists: |it| times(it, [0.5; 2]),
            ..Fault::on("half of the lists", NOT_ON)
        },
        Fault {
            lists: |[x, _]| [Some(x), None],
            ..Fault::on(
                "the list of X only",
                &["hardly differ on Y", "list of Y was on"],
            )
        },
        Fault {
            lists: |it| times(it, [1.0, 0.1]),
            ..Fault::on(
                "a tenth of the list of Y",
                &["hardly differ on Y", "list of Y was on"],
            )
        },
        Fault {
            lists: |_| [None, None],
            machine: |it| with_friction(it, 0.93),
            ..Fault::on("no list, 7 % less friction", NOT_ON)
        },
        Fault {
            lists: |_| [None, None],
            machine: |it| with_friction(it, 0.7),
            ..Fault::on("no list, another machine with 30 % less friction", NOT_ON)
        },
        Fault {
            lists: |it| times(it, [2.0; 2]),
            ..Fault::on("the lists twice as strong", NOT_ON)
        },
    ]
}

/// Lists that are on in stage 1, or another friction there.
pub(crate) fn of_lists_off() -> Vec<Fault> {
    vec![
        Fault {
            lists: |it| times(it, [0.5; 2]),
            driven: |text| text.replace("[COMP OFF", "[COMP ON"),
            ..Fault::off("half of the lists on in stage 1", ALREADY)
        },
        Fault {
            lists: |it| it.map(Some),
            driven: |text| text.replace("[COMP OFF", "[COMP ON"),
            ..Fault::off("the lists on in stage 1", ALREADY)
        },
        Fault {
            lists: |[_, y]| [None, Some(y)],
            driven: |text| text.replace("[COMP OFF", "[COMP ON"),
            ..Fault::off("the list of Y on in stage 1", ALREADY)
        },
        Fault {
            machine: |it| with_friction(it, 1.3),
            ..Fault::off(
                "another machine with 30 % more friction",
                &["have more friction"],
            )
        },
    ]
}

/// Returns the faults that spoil circles with compensation off as well as on.
fn of_circles(of: fn(&'static str, &'static [&'static str]) -> Fault) -> Vec<Fault> {
    vec![
        Fault {
            recorder: |it| it.is_commanded = true,
            ..of("commanded as actual positions", &["commanded ones"])
        },
        Fault {
            recorder: |it| it.averaged = 20,
            ..of("positions averaged over 20 ms", AVERAGED)
        },
        Fault {
            recorder: |it| it.averaged = 60,
            ..of("positions averaged over 60 ms", AVERAGED)
        },
        Fault {
            recorder: |it| it.y_late = 3,
            ..of("Y recorded 3 ms after X", APART)
        },
        Fault {
            recorder: |it| it.y_factor = 1.003,
            ..of("Y scaled by 0.3 %", &["longer"])
        },
        Fault {
            recorder: |it| it.missing = vec![[0.3, 0.305], [0.7, 0.705]],
            ..of("half a percent of the rows missing at two places", ROWS)
        },
        Fault {
            recorder: |it| it.missing = vec![[0.85, 1.0]],
            ..of("the last 15 % missing", ENDS)
        },
        Fault {
            rows: Some(|it| it.swap(3, 7)),
            ..of("actual positions of X and Y exchanged", MIXED)
        },
        Fault {
            driven: |text| text.replace("F2400", "F1600").replace("F3600", "F2400"),
            ..of("circles driven at the feeds of others", &["driven at"])
        },
        Fault {
            recorder: |it| it.every = 4,
            ..of("a row every 4 ms", &["a sample every"])
        },
        Fault {
            rows: Some(|it| [3, 7].into_iter().for_each(|column| it.hold(column, 8))),
            ..of("actual positions held for 8 ms", &["changes every"])
        },
        Fault {
            machine: |it| it.axes[0].backlash_um = 5.0,
            ..of("backlash of 5 µm on X", STEPS)
        },
    ]
}

fn of_circles_on() -> Vec<Fault> {
    let own = vec![
        Fault {
            recorder: |it| (it.is_commanded, it.noise_um) = (true, 0.8),
            ..Fault::on("the same with 0.8 µm of noise", &["commanded ones"])
        },
        Fault {
            rows: Some(|it| it.keep(|at, _| at % 1000 != 0)),
            ..Fault::on("every thousandth row missing", ROWS)
        },
        Fault {
            recorder: |it| it.missing = vec![[0.5, 1.0]],
            ..Fault::on("clockwise circles missing", ENDS)
        },
        Fault {
            rows: Some(|it| (1..5).for_each(|column| it.swap(column, column + 4))),
            ..Fault::on("all columns of X and Y exchanged", MIXED)
        },
        Fault {
            rows: Some(|it| (1..4).for_each(|column| it.times(column, -1.0))),
            ..Fault::on("X counts the other way", &["counts the other way"])
        },
        Fault {
            rows: Some(|it| {
                it.times(3, 0.001);
                it.times(7, 0.001);
            }),
            ..Fault::on("actual positions in m, said to be mm", &["unit", "radius"])
        },
        Fault {
            rows: Some(|it| (1..5).for_each(|column| it.copy(column, column + 4))),
            ..Fault::on("the columns of X also as those of Y", &["not on a circle"])
        },
        Fault {
            machine: |it| it.control.part = 0.9,
            ..Fault::on("driven at 90 %", &["driven at"])
        },
        Fault {
            rows: Some(|it| {
                it.plus(1, 5.0);
                it.plus(3, 5.0);
            }),
            ..Fault::on("another place", &["another place"])
        },
        Fault {
            rows: Some(|it| it.times(4, -1.0)),
            ..Fault::on("torque of X with the other sign", NOT_ON)
        },
    ];
    of_circles(Fault::on).into_iter().chain(own).collect()
}

fn of_circles_off() -> Vec<Fault> {
    let own = vec![
        Fault {
            rows: Some(|it| [3, 7].into_iter().for_each(|column| it.delay(column, 3))),
            ..Fault::off("both axes recorded 3 ms late", APART)
        },
        Fault {
            machine: |it| with_friction(it, 1.2),
            ..Fault::off(
                "circles of a cold machine, 20 % more friction",
                &["have more friction"],
            )
        },
    ];
    of_circles(Fault::off).into_iter().chain(own).collect()
}

fn of_friction() -> Vec<Fault> {
    vec![
        Fault {
            recorder: |it| it.clipped_units = 160.0,
            ..Fault::friction("torque clipped at the fastest speeds", &["clipped"])
        },
        Fault {
            recorder: |it| it.missing = vec![[0.5, 0.51]],
            ..Fault::friction("one percent of the rows missing", ROWS)
        },
        Fault {
            recorder: |it| it.missing = vec![[0.6, 0.7]],
            ..Fault::friction("ten percent of the rows missing", &["are missing"])
        },
        Fault {
            recorder: |it| it.missing = vec![[0.7, 1.0]],
            ..Fault::friction("the last 30 % missing", &["ends early"])
        },
        Fault {
            rows: Some(|it| it.swap(4, 8)),
            ..Fault::friction("torque of X and Y exchanged", &["torque"])
        },
        Fault {
            recorder: |it| it.torque_factor = 4.0,
            ..Fault::friction("torque in N", &["differ by"])
        },
        Fault {
            recorder: |it| it.torque_factor = -1.0,
            ..Fault::friction(
                "torque with the other sign",
                &["sign", "negative", "differ by"],
            )
        },
        Fault {
            machine: |it| with_friction(it, 0.7),
            ..Fault::friction("another machine with 30 % less friction", &["differ by"])
        },
        Fault {
            machine: |it| with_friction(it, 1.2),
            ..Fault::friction("a cold machine, 20 % more friction", &["differ by"])
        },
        Fault {
            rows: Some(|it| it.keep(|_, row| row[2] >= 0.0)),
            ..Fault::friction("the way back missing", &["direction", "missing"])
        },
        Fault {
            rows: Some(|it| it.times(2, 60.0)),
            ..Fault::friction(
                "velocities in mm/min, said to be mm/s",
                &["speeds are not", "driven at", "unit"],
            )
        },
        Fault {
            machine: |it| it.control.part = 0.8,
            ..Fault::friction("driven at 80 %", &["driven at 80"])
        },
    ]
}
