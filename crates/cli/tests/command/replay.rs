//! Recordings of a machine compared with the dry run (R15.20 to R15.22).

use std::fmt::Write as _;

use crate::folder::Bench;

const WITHOUT_CONDITIONS: &str = "\
N10 G90 G1 X10 F1000
N20 X[COMP OFF FRICT]
N30 X20
N40 X[COMP ON FRICT]
N50 X30
N60 X[COMP ON FRICT] X[COMP OFF FRICT] (not X[comp off frict] #MACHINE DATA)
N70 X40
N80 M30
";

/// A control that follows the lines of a program one after the other, and its differences.
#[derive(Clone, Copy)]
#[allow(clippy::struct_excessive_bools)] // each is a separate difference
struct Control {
    /// The state at the start.
    active: bool,
    /// Whether commands of a block act from right to left.
    backwards: bool,
    /// Whether skip level 1 is on.
    skips: bool,
    /// `V.E.A`.
    value: i32,
    /// Whether the lines are recorded.
    with_lines: bool,
}

const CONTROL: Control = Control {
    active: true,
    backwards: false,
    skips: false,
    value: 0,
    with_lines: true,
};

impl Control {
    /// Returns the recording of a program: each motion is three samples, each command none.
    fn record(self, program: &str) -> String {
        let mut text = String::from(if self.with_lines {
            "t,line,active_X,pos_X\n"
        } else {
            "t,active_X,pos_X\n"
        });
        let (mut active, mut position, mut samples, mut passing) = (self.active, 0.0, 0, false);
        for (at, line) in program.lines().enumerate() {
            let holds = format!("V.E.A == {}", self.value);
            match line {
                _ if line.starts_with("$IF") => passing = !line.contains(&holds),
                _ if line.starts_with("$ENDIF") => passing = false,
                _ if passing || (self.skips && line.starts_with('/')) => {}
                _ if line.contains("COMP") => {
                    let mut commands: Vec<&str> = line.split("COMP ").skip(1).collect();
                    if self.backwards {
                        commands.reverse();
                    }
                    active = commands.last().is_some_and(|it| it.starts_with("ON"));
                }
                _ => {
                    let to = line.split('X').nth(1).and_then(|it| it.split(' ').next());
                    let to: f64 = to.and_then(|it| it.parse().ok()).unwrap_or(position);
                    for part in 1..=3 {
                        let now = position + (to - position) * f64::from(part) / 3.0;
                        write!(text, "{:.3},", f64::from(samples) * 0.01).expect("text");
                        if self.with_lines {
                            write!(text, "{},", at + 1).expect("text");
                        }
                        writeln!(text, "{},{now:.3}", i32::from(active)).expect("text");
                        samples += 1;
                    }
                    position = to;
                }
            }
        }
        text
    }
}

/// R15.21: the page has the verdict, each recorded state over the time, and each change with its line; it names
/// what contradicts an agreement.
#[test]
fn the_page_says_what_the_text_says() {
    let bench = Bench::new(&[("m.nc", WITHOUT_CONDITIONS)]);
    let page = |control: Control| {
        bench.write("states.csv", &control.record(WITHOUT_CONDITIONS));
        let _ = bench.call(&["replay", "states.csv", "m.nc", "--html", "replay.html"]);
        let page = bench.read("replay.html");
        let options = roxmltree::ParsingOptions {
            allow_dtd: true,
            ..roxmltree::ParsingOptions::default()
        };
        roxmltree::Document::parse_with_options(&page, options).expect("well-formed");
        page
    };
    let agrees = page(CONTROL);
    for words in [
        "states.csv compared with the dry run",
        "X: agrees (3 changes)",
        "m.nc:2",
        "inactive from ",
    ] {
        assert!(agrees.contains(words), "{words}: {agrees}");
    }
    let against = ", dry run ";
    assert!(!agrees.contains(against));
    let backwards = Control {
        backwards: true,
        ..CONTROL
    };
    let differs = page(backwards);
    for words in ["X: disagrees after", "rests on R1.31", against] {
        assert!(differs.contains(words), "{words}: {differs}");
    }
    // An output never replaces an input.
    let refused = bench.status(&["replay", "states.csv", "m.nc", "--html", "states.csv"]);
    assert_eq!(refused, Some(2));
    assert!(bench.read("states.csv").starts_with("t,"));
}
