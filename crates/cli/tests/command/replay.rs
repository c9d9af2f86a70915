//! Recordings of a machine compared with the dry run (R15.20 to R15.22).

use std::fmt::Write as _;

use crate::folder::{Bench, json, one_line};
use serde_json::Value;

const PROGRAM: &str = "\
N10 G90 G1 X10 F1000
N20 X[COMP OFF FRICT]
N30 X20
/N40 X[COMP ON FRICT]
N50 X30
N60 X[COMP ON FRICT]
N70 X40
$IF V.E.A == 1
N80 X[COMP OFF FRICT]
N90 X45
$ENDIF
N100 X50
N110 M30
";

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
    /// Commands of a block act from right to left.
    backwards: bool,
    /// Skip level 1 is on.
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
    /// The recording of a program: each motion is three samples, each command none.
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

/// The exit status and the document.
fn replay(control: Control, program: &str, more: &[&str]) -> (Option<i32>, Value) {
    let bench = Bench::new(&[("m.nc", program)]);
    bench.write("states.csv", &control.record(program));
    let mut arguments = vec!["replay", "states.csv", "m.nc", "--format", "json"];
    arguments.extend(["--start", "X0,Y0,Z0"]);
    arguments.extend(more);
    let output = bench.call(&arguments);
    let text = String::from_utf8(output.stdout).expect("text");
    let error = String::from_utf8(output.stderr).expect("text");
    assert!(!text.is_empty(), "{error}");
    (output.status.code(), json(&text))
}

/// R15.20: a machine that does what the dry run says agrees, by lines and by positions, each change with its
/// time and line.
#[test]
fn a_machine_that_follows_the_dry_run_agrees() {
    for with_lines in [true, false] {
        let control = Control {
            with_lines,
            ..CONTROL
        };
        let (status, found) = replay(control, WITHOUT_CONDITIONS, &[]);
        assert_eq!(
            (status, &found["agrees"]),
            (Some(0), &Value::Bool(true)),
            "{found:#}"
        );
        assert_eq!(found["conditional"], false);
        assert_eq!(found["changes"], 3);
        let lines = found["axes"]["X"]["changes"].as_array().expect("changes");
        let lines: Vec<_> = lines.iter().map(|it| it["at"]["line"].as_u64()).collect();
        assert_eq!(lines, [Some(2), Some(4), Some(6)]);
        let first = &found["axes"]["X"]["changes"][0];
        assert_eq!(first["t"], 0.03);
        let by = if with_lines { "line" } else { "position" };
        assert_eq!(first["by"], by);
    }
}

/// R15.21: another order of the commands of a block is found at its line, with the reading that it depends
/// on.
#[test]
fn another_order_in_a_block_is_found() {
    let control = Control {
        backwards: true,
        ..CONTROL
    };
    let (status, found) = replay(control, WITHOUT_CONDITIONS, &[]);
    assert_eq!(status, Some(1), "{found:#}");
    let axis = &found["axes"]["X"];
    assert_eq!(axis["at"]["line"], 6);
    assert_eq!(
        (&axis["recorded"], &axis["dry_run"]),
        (&"active".into(), &"inactive".into())
    );
    assert_eq!(axis["rests_on"], json(r#"["R1.31"]"#));
}

/// R15.21: a machine that begins in another state, as after a reset that switches off, is found at the
/// start.
#[test]
fn another_state_at_the_start_is_found() {
    let control = Control {
        active: false,
        ..CONTROL
    };
    let (status, found) = replay(control, WITHOUT_CONDITIONS, &[]);
    assert_eq!(status, Some(1), "{found:#}");
    let axis = &found["axes"]["X"];
    assert_eq!(axis["at"], Value::Null);
    assert_eq!(axis["rests_on"], json(r#"["R1.28","R1.29"]"#));
}

/// R15.21: a block that the machine skipped, although the dry run was told otherwise, is found.
#[test]
fn a_skipped_block_is_found() {
    let control = Control {
        skips: true,
        ..CONTROL
    };
    let (status, found) = replay(control, PROGRAM, &["--skip", "none", "--set", "V.E.A=0"]);
    assert_eq!(status, Some(1), "{found:#}");
    let axis = &found["axes"]["X"];
    assert_eq!(axis["at"]["line"], 4, "{found:#}");
    assert_eq!(
        (&axis["recorded"], &axis["dry_run"]),
        (&"inactive".into(), &"active".into())
    );
    assert_eq!(axis["rests_on"], json(r#"["R2.90"]"#));
}

/// R15.21: a way that the machine did not take is found, even if only positions show it.
#[test]
fn another_way_is_found() {
    for with_lines in [true, false] {
        let control = Control {
            value: 1,
            with_lines,
            ..CONTROL
        };
        let (status, found) = replay(control, PROGRAM, &["--skip", "none", "--set", "V.E.A=0"]);
        assert_eq!(status, Some(1), "{found:#}");
        assert_eq!(found["axes"]["X"]["recorded"], "inactive", "{found:#}");
        assert_eq!(found["axes"]["X"]["dry_run"], "active");
    }
}

/// R15.21: conditions that only the machine knows are decided by the recording, and the verdict is then
/// conditional.
#[test]
fn the_recording_decides_conditions() {
    for (skips, value) in [(false, 0), (false, 1), (true, 0), (true, 1)] {
        let control = Control {
            skips,
            value,
            ..CONTROL
        };
        let (status, found) = replay(control, PROGRAM, &[]);
        assert_eq!(status, Some(0), "{found:#}");
        assert_eq!(found["conditional"], true);
        assert_eq!(found["ways"], json(r#"{"tried":4,"fitting":1}"#));
        let decided = found["decided"].as_array().expect("a list").iter();
        let mut decided: Vec<_> = decided
            .map(|it| (it["condition"].as_str(), it["holds"].as_bool()))
            .collect();
        decided.sort();
        let expected = [
            (Some("V.E.A == 1"), Some(value == 1)),
            (Some("skip level 1 is off"), Some(!skips)),
        ];
        assert_eq!(decided, expected);
    }
}

/// R15.21: no way fits a machine that does something else, and more than 64 ways are not tried.
#[test]
fn no_way_fits_or_too_many() {
    let control = Control {
        active: false,
        ..CONTROL
    };
    let (status, found) = replay(control, PROGRAM, &[]);
    assert_eq!(
        (status, &found["ways"]["fitting"]),
        (Some(1), &0.into()),
        "{found:#}"
    );
    let unknown = found["axes"]["X"]["unknown"].to_string();
    assert!(
        unknown.contains("V.E.A == 1") && unknown.contains("skip level 1"),
        "{unknown}"
    );
    let mut program = String::new();
    for at in 0..7 {
        writeln!(program, "$IF V.E.A{at} == 1\nX[COMP OFF FRICT]\n$ENDIF").expect("text");
    }
    program.push_str("G1 X10 F100\nM30\n");
    let (status, found) = replay(CONTROL, &program, &[]);
    assert_eq!(status, Some(1), "{found:#}");
    let untried = found["untried"].as_str().expect("a reason");
    assert!(
        untried.contains("128") && untried.contains("64"),
        "{untried}"
    );
}

/// R15.21: a dry run that ends with an error does not agree.
#[test]
fn a_dry_run_that_ends_early_does_not_agree() {
    let program = "N10 G1 X10 F1000\nN20 Z[COMP ON FRICT]\nN30 X20\nN40 M30\n";
    let bench = Bench::new(&[("m.nc", program)]);
    bench.write("states.csv", "t,line,active_X\n0,1,1\n0.1,3,1\n");
    let said = bench.stdout(&["replay", "states.csv", "m.nc"]);
    assert_eq!(
        bench.status(&["replay", "states.csv", "m.nc"]),
        Some(1),
        "{said}"
    );
    assert!(
        said.contains("the dry run ends early: P-ERR-70495 at m.nc:2"),
        "{said}"
    );
}

/// R15.21: nor does one that uses up its blocks.
#[test]
fn a_dry_run_without_an_end_does_not_agree() {
    let (status, found) = replay(CONTROL, WITHOUT_CONDITIONS, &["--max-blocks", "7"]);
    assert_eq!(status, Some(1), "{found:#}");
    assert_eq!(found["stopped"], "FC910 at m.nc:8");
}

/// R15.22: without a state there is nothing to compare; the object to record is named. The same applies to
/// times and to values that are not a state.
#[test]
fn a_recording_without_states_is_refused() {
    let bench = Bench::new(&[("m.nc", WITHOUT_CONDITIONS)]);
    for (recording, words) in [
        (
            "t,line\n0,1\n1,2\n",
            ["`frict_comp.f_is_active`", "0x120300:0x<axis>0221"],
        ),
        (
            "line,active_X\n1,1\n2,0\n",
            ["has no times", "name the channel of the times"],
        ),
        ("t,active_X\n0,1\n1,7\n", ["holds 7", "`active_X`"]),
        (
            "t,active_X\n0,1\n1,0\n0.5,1\n",
            ["do not rise", "after 1 s comes 0.5 s"],
        ),
    ] {
        bench.write("states.csv", recording);
        let output = bench.call(&["replay", "states.csv", "m.nc"]);
        assert_eq!(output.status.code(), Some(2));
        let said = String::from_utf8(output.stderr).expect("text");
        let said = one_line(&said);
        assert!(words.iter().all(|it| said.contains(it)), "{said}");
    }
}

/// R15.21: an agreement names what a recording cannot show: axes that it does not contain, and stretches
/// without samples.
#[test]
fn an_agreement_says_what_was_not_recorded() {
    let program =
        "X[COMP OFF FRICT] Y[COMP OFF FRICT]\nG1 X1 F100\nX[COMP ON FRICT] Y[COMP ON FRICT]\nM30\n";
    let bench = Bench::new(&[("m.nc", program)]);
    bench.write(
        "states.csv",
        "t,active_X\n0,1\n0.1,0\n0.2,0\n0.9,0\n1.0,1\n",
    );
    let said = bench.stdout(&["replay", "states.csv", "m.nc"]);
    for words in [
        "X: agrees (2 changes)",
        "Y: switched by the programs but not recorded, so not compared",
        "no samples for 0.700 s after 0.200 s: a change that is undone meanwhile is not seen",
    ] {
        assert!(said.contains(words), "{said}");
    }
    let found = json(&bench.stdout(&["replay", "states.csv", "m.nc", "--format", "json"]));
    assert_eq!(found["unrecorded"], json(r#"["Y"]"#));
    assert_eq!(found["gap"], json(r#"{"t":0.2,"seconds":0.7}"#));
}

/// R15.21: block numbers in the line column are named as such.
#[test]
fn block_numbers_that_stand_for_lines_are_named() {
    let bench = Bench::new(&[("m.nc", WITHOUT_CONDITIONS)]);
    bench.write(
        "states.csv",
        "t,line,active_X\n0,10,1\n0.1,30,0\n0.2,70,1\n0.3,70,0\n",
    );
    let said = bench.stdout(&["replay", "states.csv", "m.nc"]);
    assert!(
        said.contains("the program has no such lines, but has such block numbers"),
        "{said}"
    );
}

/// R15.20: an export of Scope is read by the object of the state and the number of the axis, or by the names
/// that options give.
#[test]
fn channels_are_named_by_options() {
    let bench = Bench::new(&[("m.nc", WITHOUT_CONDITIONS)]);
    let recording = CONTROL.record(WITHOUT_CONDITIONS);
    let renamed = recording.replace("t,line,active_X,pos_X", "t,Row,On,Way");
    bench.write("states.csv", &renamed);
    let mut arguments = vec!["replay", "states.csv", "m.nc"];
    assert_eq!(bench.status(&arguments), Some(2));
    arguments.extend(["--active", "X=On", "--line", "Row"]);
    assert_eq!(bench.status(&arguments), Some(0));
}

/// R15.20, R6.3: an actual position that is recognised counts as the column of the axis does.
#[test]
fn a_recognised_position_needs_no_option() {
    let bench = Bench::new(&[("m.nc", WITHOUT_CONDITIONS)]);
    let control = Control {
        with_lines: false,
        ..CONTROL
    };
    let recording = control.record(WITHOUT_CONDITIONS);
    let replayed = |head: &str| {
        bench.write("states.csv", &recording.replace("t,active_X,pos_X", head));
        bench.stdout(&["replay", "states.csv", "m.nc", "--format", "json"])
    };
    let named = replayed("t,active_X,pos_X");
    assert_eq!(replayed("t,active_X,X.ActPos [mm]"), named);
    assert_ne!(replayed("t,active_X,Way"), named);
}

/// R15.21: without lines and positions only the order is compared, and that is reported.
#[test]
fn what_is_compared_by_the_order_alone_is_said() {
    let states = "t,active_X\n0,1\n0.01,0\n0.02,1\n";
    let program = "N10 X[COMP OFF FRICT]\nN20 X[COMP ON FRICT]\nN30 M30\n";
    let bench = Bench::new(&[("states.csv", states), ("m.nc", program)]);
    let arguments = [
        "replay",
        "states.csv",
        "m.nc",
        "--enable",
        "X",
        "--isolated",
    ];
    let text = bench.stdout(&arguments);
    assert!(text.contains("X: agrees (2 changes)"), "{text}");
    assert!(
        text.contains("2 of 2 compared by the order alone"),
        "{text}"
    );
    let found = bench.stdout(&[&arguments[..], &["--format", "json"]].concat());
    assert!(
        found.contains("\"by\": \"order\"") || found.contains("\"by\":\"order\""),
        "{found}"
    );
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

/// Axes X and Y are enabled.
fn replayed(program: &str, recording: &str) -> (Option<i32>, Value) {
    let bench = Bench::new(&[("m.nc", program), ("states.csv", recording)]);
    let fixed = [
        "replay",
        "states.csv",
        "m.nc",
        "--enable",
        "X,Y",
        "--isolated",
        "--format",
        "json",
    ];
    let output = bench.call(&fixed);
    let text = String::from_utf8(output.stdout).expect("text");
    (output.status.code(), json(&text))
}

/// Five samples of each line, with the states of X and Y.
fn samples(lines: &[(u32, [u8; 2])]) -> String {
    let mut text = String::from("t,line,active_X,active_Y\n");
    for (at, (line, [x, y])) in lines.iter().flat_map(|line| [line; 5]).enumerate() {
        let time = f64::from(u32::try_from(at).expect("few samples")) * 0.001;
        writeln!(text, "{time:.3},{line},{x},{y}").expect("text");
    }
    text
}

const SWITCHED: &str =
    "%M\nX[COMP OFF FRICT]\nY[COMP ON FRICT]\nG1 X2 F500\nX[COMP ON FRICT]\nG1 X5\nM30\n";

/// R15.20: a sample in a block that switches is compared with the states before and after that block, at
/// the start and at the end, too.
#[test]
fn samples_within_a_block_that_switches_fit_either_side() {
    let (off, on) = ([0, 1], [1, 1]);
    for recorded in [
        vec![(2, off), (3, off), (4, off), (5, on), (6, on), (7, on)],
        vec![(2, on), (3, off), (4, off), (5, off), (6, on)],
        vec![(1, on), (2, off), (3, off), (4, off), (5, on)],
        // It begins in the middle, or ends in the block that switches.
        vec![(3, off), (4, off), (5, on), (6, on)],
        vec![(5, off), (6, on), (7, on)],
        vec![(5, on), (6, on), (7, on)],
        vec![(2, on), (3, off), (4, off), (5, off)],
    ] {
        let (status, found) = replayed(SWITCHED, &samples(&recorded));
        assert_eq!(status, Some(0), "{recorded:?} {found:#}");
    }
    for recorded in [
        vec![(3, on), (4, on), (5, on), (6, on)],
        vec![(2, off), (3, off), (4, on), (5, on)],
        vec![(2, off), (3, off), (4, off), (5, off), (6, off)],
        vec![(6, off), (7, off)],
        vec![(2, off), (3, off), (4, off)],
    ] {
        let (status, found) = replayed(SWITCHED, &samples(&recorded));
        assert_eq!(status, Some(1), "{recorded:?} {found:#}");
    }
}

/// R15.20: the same in blocks with several commands, in subprograms and in loops.
#[test]
fn a_recording_may_begin_in_a_called_program_or_in_a_loop() {
    let both =
        "X[COMP OFF FRICT] Y[COMP OFF FRICT]\nG1 X2 F500\nX[COMP ON FRICT] Y[COMP ON FRICT]\nM30\n";
    let recorded = [(1, [0, 1]), (2, [0, 0]), (3, [1, 0]), (4, [1, 1])];
    let (status, found) = replayed(both, &samples(&recorded));
    assert_eq!(status, Some(0), "{found:#}");
    let called = "%L S\nX[COMP OFF FRICT]\nG1 X2 Y0 F500\nM17\n%M\nLL S\nX[COMP ON FRICT]\nLL S\nX[COMP ON FRICT]\nM30\n";
    let recorded = [
        (2, [0, 1]),
        (3, [0, 1]),
        (7, [1, 1]),
        (2, [1, 1]),
        (3, [0, 1]),
        (9, [0, 1]),
    ];
    let (status, found) = replayed(called, &samples(&recorded));
    assert_eq!(status, Some(0), "{found:#}");
    let looped =
        "$FOR P1=1,4,1\nX[COMP OFF FRICT]\nG1 X2 Y0 F500\nX[COMP ON FRICT]\nG1 X5\n$ENDFOR\nM30\n";
    // It begins in the second of four passes.
    let pass = [(2, [0, 1]), (3, [0, 1]), (4, [1, 1]), (5, [1, 1])];
    let (status, found) = replayed(looped, &samples(&pass.repeat(3)));
    assert_eq!(status, Some(0), "{found:#}");
    let (status, found) = replayed(looped, &samples(&pass.repeat(5)));
    assert_eq!(status, Some(1), "{found:#}");
}
