//! R5.1: the influences that make F the velocity of the path: units, the spindle, weights and overrides.

use frictcomp::interpreter::Simplification;
use frictcomp::lists::FeedUnit;
use frictcomp::machine::Machine;
use frictcomp_physics::motion::PlannerOptions;

use super::{MACHINE, Trace, assert_limits, follow, trace};

/// Returns the highest speed of X in mm/min.
fn top(program: &str) -> String {
    let trace = trace(program, &["X"]);
    round(trace.top_speed(0))
}

/// Returns a speed in mm/min.
fn round(speed: f64) -> String {
    ((speed * 60.0 * 1e6).round() / 1e6).to_string()
}

/// Returns a program on a machine with settings of the channel list.
fn channel(program: &str, say: impl FnOnce(&mut Machine)) -> Trace {
    let mut machine = Machine::from_toml(MACHINE).expect("a machine");
    say(&mut machine);
    follow(machine, program, (&["X"], &[]), PlannerOptions::default())
}

#[test]
fn the_channel_list_says_the_unit_of_f() {
    // R5.1: P-CHAN-00108, 0.1 is m/min, 100 is mm/min.
    let program = "G01 X0 F2\nX50\nM30";
    let unit = |unit| channel(program, |machine| machine.channel.feed_unit = unit);
    assert_eq!(
        round(unit(FeedUnit::MillimetresPerMinute).top_speed(0)),
        "2"
    );
    assert_eq!(round(unit(FeedUnit::MetresPerMinute).top_speed(0)), "2000");
    let unknown = unit(FeedUnit::Unknown);
    assert_eq!(unknown.positions.len(), 0);
    assert_eq!(unknown.said[1], ("FC903".to_owned(), 2));
    assert!(unknown.messages[1].contains("the unit of F is not known"));
    // The meaning of G70 for m/min is not documented; G93 counts seconds all the same.
    let metres = |program: &str| {
        channel(program, |machine| {
            machine.channel.feed_unit = FeedUnit::MetresPerMinute;
        })
    };
    assert_eq!(metres("G70 G01 X0 F2\nX5\nM30").positions.len(), 0);
    let timed = metres("G01 X0 F2\nG93 F2 X10\nM30");
    assert!((2.0..2.1).contains(&timed.seconds()), "{}", timed.seconds());
}

#[test]
fn the_channel_list_says_what_holds_at_program_start() {
    // R5.1 R2.45: P-CHAN-00099, P-CHAN-00063, P-CHAN-00054
    let found = channel("G01 X0\nX50\nM30", |machine| {
        machine.channel.feed_mm_per_min = Some(1500.0);
    });
    assert_eq!(round(found.top_speed(0)), "1500");
    let found = channel("X0 F600\nX50\nX10\nM30", |machine| {
        machine.channel.functions = vec![1, 91];
    });
    assert_eq!(found.positions.len(), 0, "with G91 no position is known");
    let found = channel("G90 X0 F600\nX4\nM30", |machine| {
        machine.channel.functions = vec![1, 70];
    });
    assert_eq!(
        (found.end(), round(found.top_speed(0))),
        (&[101.6][..], "12000".to_owned())
    );
    let found = channel("G01 X0 F600\nX1\nM30", |machine| {
        machine.channel.inch = true;
    });
    assert_eq!(
        found.positions.len(),
        0,
        "what G71 is then is not documented"
    );
    let found = channel("G71 G01 X0 F600\nX1\nM30", |machine| {
        machine.channel.inch = true;
    });
    assert_eq!(found.end(), [1.0]);
}

#[test]
fn feeds_are_inches_with_g70() {
    // R5.1: 20 inch/min are 508 mm/min.
    let inches = trace("G70 G01 X0 F20\nX2\nM30", &["X"]);
    assert_eq!(
        (inches.end(), round(inches.top_speed(0))),
        (&[50.8][..], "508".to_owned())
    );
    // The unit is that of the block with F.
    assert_eq!(top("G70 G01 X0 F20\nG71 X60\nM30"), "508");
    assert_eq!(top("G01 X0 F600\nG70 X2\nM30"), "600");
    // Degrees are not lengths.
    let rotary = trace("G70 G01 C0 F600\nC50\nM30", &["C"]);
    assert!((rotary.top_speed(0) - 10.0).abs() < 1e-9);
    assert_eq!(top("G70 G95 S500 M3 G01 X0 F0.02\nX2\nM30"), "254");
}

#[test]
fn g95_follows_the_main_spindle() {
    // R5.1: 1.5 mm/rev at 1200 1/min are 1800 mm/min (PM/208081931).
    assert_eq!(top("M3 S1200\nG95 F1.5 G01 X0\nX50\nM30"), "1800");
    assert_eq!(top("G95 F1.5 G01 X0 S1000 M4\nX50 S2000\nM30"), "3000");
    assert_eq!(top("S[REV1200 M3]\nG95 F0.5 G01 X0\nX50\nM30"), "600");
    assert_eq!(
        top("P1=800\nS[REV=P1 M3]\nG95 F0.5 G01 X0\nX50\nM30"),
        "400"
    );
    // F of another mode does not apply (PM/206602507).
    assert_eq!(top("S1200 G95 F1.5 G01 X0\nG94 F700 X50\nM30"), "700");
    for (program, why) in [
        ("G95 F1.5 G01 X0\nX50\nM30", "needs the speed"),
        ("S1200 M3\nM5\nG95 F1.5 G01 X0\nX50\nM30", "that turns"),
        ("S1200 M3\nM19\nG95 F1.5 G01 X0\nX50\nM30", "that turns"),
        ("G96 S100 M3\nG95 F1.5 G01 X0\nX50\nM30", "the diameter"),
        (
            "S1200 M3\n#MAIN SPINDLE [S2]\nG95 F1.5 G01 X0\nX50\nM30",
            "needs the speed",
        ),
        (
            "S1200 M3\nS1[REV500 M3]\nG95 F1.5 G01 X0\nX50\nM30",
            "needs the speed",
        ),
        (
            "S1200\n$IF V.E.A == 1\nS600\n$ENDIF\nG95 F1.5 G01 X0\nX50\nM30",
            "needs the speed",
        ),
        (
            "SV.E.SPEED M3\nG95 F1.5 G01 X0\nX50\nM30",
            "needs the speed",
        ),
    ] {
        let found = trace(program, &["X"]);
        assert_eq!(found.positions.len(), 0, "{program}");
        let said = found.messages.join("\n");
        assert!(said.contains(why), "{program}: {said}");
    }
    // A spindle other than the main one has no effect if the list names them.
    let named = |program: &str| {
        channel(program, |machine| {
            machine.channel.main_spindle = vec!["S1".to_owned()];
        })
    };
    let found = named("S1[REV600 M3] S2[REV100]\nG95 F1 G01 X0\nX50\nM30");
    assert_eq!(round(found.top_speed(0)), "600");
    let found = named("S1=300 M3\nS2=100\nG95 F1 G01 X0\nX50\nM30");
    assert_eq!(round(found.top_speed(0)), "300");
}

#[test]
fn g194_weights_the_limits_of_the_axes() {
    // R5.1: 90 % of 12 000 mm/min (PM/206602507); Y is as fast as X, Z half as fast.
    assert_eq!(top("G194 F90 G01 X0\nX400\nM30"), "10800");
    let both = trace("G194 F50 G01 X0 Z0\nX200 Z200\nM30", &["X", "Z"]);
    assert_eq!(round(both.top_speed(1)), "3000");
    let circle = trace("G194 F10 G01 X0 Y0\nX50\nG03 I-50\nM30", &["X", "Y"]);
    assert_eq!(round(circle.top_speed(0)), "1200");
    // The F of G94 is kept apart.
    assert_eq!(top("F700\nG194 F5 G01 X0\nG94 X50\nM30"), "700");
}

#[test]
fn overrides_weight_feed_and_rapid_motions() {
    // R5.1: PM/207625099, 208662411, 206744331, 206578955
    assert_eq!(
        top("#OVERRIDE [FEED_FACT=122.765 RAPID_FACT=155.7]\nG01 X0 F1000\nX50\nM30"),
        "1227.65"
    );
    assert_eq!(
        top("#OVERRIDE [FEED_FACT=120 RAPID_FACT=75]\nG00 X0\nX500\nM30"),
        "9000"
    );
    // More than the axes' limit is not driven.
    assert_eq!(
        top("#OVERRIDE [RAPID_FACT=150]\nG00 X0\nX500\nM30"),
        "12000"
    );
    // Of several axes the least counts, times that of the path; G166 suppresses both.
    let both = "X[OVERRIDE FEED_FACT=20 RAPID_FACT=60]\nY[OVERRIDE FEED_FACT=30]\n\
                #OVERRIDE [FEED_FACT=50]\n";
    assert_eq!(top(&format!("{both}G01 X0 F1000\nX50\nM30")), "100");
    let speeds = |program: &str| {
        let trace = trace(program, &["X", "Y"]);
        (round(trace.top_speed(0)), round(trace.top_speed(1)))
    };
    assert_eq!(
        speeds(&format!("{both}G01 X0 Y0 F1000\nY50\nM30")),
        ("0".to_owned(), "150".to_owned())
    );
    assert_eq!(
        speeds(&format!("{both}G01 X0 Y0 F1000\nG166 X30 Y40\nM30")),
        ("600".to_owned(), "800".to_owned())
    );
    assert_eq!(top(&format!("{both}G00 X0\nX500\nM30")), "7200");
    assert_eq!(top("G129=70 G00 X0\nX500\nM30"), "8400");
    assert_eq!(top("G129 = 70\nG00 X0\nG166 X500\nM30"), "8400");
    // The same block may hold positions (PM/206578955).
    assert_eq!(top("G00 X0\nG129=50 X500\nM30"), "6000");
    // It ends with the program.
    for (program, codes) in [
        ("#OVERRIDE [FEED_FACT=V.E.A]\nG01 X0 F1000\nX50\nM30", 2),
        ("#OVERRIDE [FEED_FACT=300]\nG01 X0 F1000\nX50\nM30", 2),
        (
            "$IF V.E.A == 1\nX[OVERRIDE FEED_FACT=10]\n$ENDIF\nG01 X0 F1000\nX50\nM30",
            2,
        ),
    ] {
        let found = trace(program, &["X"]);
        assert_eq!(found.positions.len(), 0, "{program}");
        assert_eq!(found.said.len(), codes, "{program}: {:?}", found.said);
    }
}

#[test]
fn e_is_the_feed_at_the_end_of_the_block() {
    // R5.1: PM/206811147
    let trace = |program: &str| trace(program, &["X"]);
    let found = trace("G01 X0 F3000\nX50 E600\nX100\nM30");
    assert_limits(MACHINE, &["X"], &found);
    let next = found.lines.iter().position(|line| *line == 3).expect("it");
    let speed = found.path_velocities[next] * 60.0;
    assert!((600.0..660.0).contains(&speed), "{speed}");
    assert_eq!(round(found.top_speed(0)), "3000");
    // More than F is F; it applies to its block, and only with G94.
    let plain = trace("G01 X0 F3000\nX50\nX100\nM30");
    for program in [
        "G01 X0 F3000\nX50 E9000\nX100\nM30",
        "G01 X0 F3000 E100\nX50\nX100\nM30",
        "G01 X0 F3000\nX50\nX100 E100\nM30",
    ] {
        let cycles = trace(program).positions.len();
        assert_eq!(cycles, plain.positions.len(), "{program}");
    }
    assert!(found.seconds() > plain.seconds() + 0.01);
    assert_eq!(trace("G01 X0 F3000\nX50 EV.E.A\nX60\nM30").said.len(), 2);
}

#[test]
fn what_is_not_modelled_is_shown_per_block() {
    // R5.1: FC907 where it starts to apply, and in every cycle.
    let found = trace(
        "G01 X0 Y0 F1000\nG61 X10\nY10\nG261\nX20\nY20\nG260\nX30\nM30",
        &["X", "Y"],
    );
    let codes: Vec<u32> = found
        .said
        .iter()
        .filter(|(code, _)| code == "FC907")
        .map(|(_, line)| *line)
        .collect();
    assert_eq!(codes, [2, 5]);
    for (line, cause) in found.lines.iter().zip(&found.causes) {
        let rounds = cause
            .simplified
            .iter()
            .any(|it| it == Simplification::Contouring);
        assert_eq!(rounds, [2, 5, 6].contains(line), "line {line}");
    }
    for (words, once) in [
        ("#CONTOUR MODE ON [DEV PATH_DEV=1]", false),
        ("#HSC ON", false),
        ("#SLOPE [TYPE=STEP NO_OPT=0]", false),
        ("G131=50", false),
        ("G130 X50", false),
        ("G127 X50", false),
        ("G133=50", false),
        ("G901", false),
        ("G193", true),
        ("#FGROUP [X, Y]", false),
        ("X[DYNAMIC]", false),
        ("#GEO FEED ADAPT ON", false),
    ] {
        let between = if once { " " } else { "\n" };
        let program = format!("G01 X0 F1000\n{words}{between}X10\nX20\nM30");
        let found = trace(&program, &["X"]);
        let said = found.said.iter().filter(|(code, _)| code == "FC907");
        assert_eq!(said.count(), 1, "{words}: {:?}", found.said);
        assert_eq!(found.end(), [20.0], "{words}");
    }
    // Modelled functions, and those that only set parameters, are not reported.
    for words in [
        "#CONTOUR MODE [DEV PATH_DEV=1]",
        "#SLOPE [TYPE=STEP]",
        "G900",
        "G08",
        "G09",
        "G12",
    ] {
        let found = trace(&format!("G01 X0 F1000\n{words}\nX10\nM30"), &["X"]);
        assert!(
            found.said.iter().all(|(code, _)| code != "FC907"),
            "{words}: {:?}",
            found.said
        );
    }
}

#[test]
fn an_axis_that_moved_by_itself_is_anywhere() {
    // R5.1 R2.50
    for words in ["X[INDP_ASYN POS=50 G90 FEED=1000]", "X[OSC ON]"] {
        let program = format!("G01 X0 F1000\nX10\n{words}\nX20\nX30\nM30");
        let found = trace(&program, &["X"]);
        assert_eq!(found.begins.len(), 2, "{words}");
        assert_eq!(found.left_out.len(), 2, "{words}: {:?}", found.left_out);
        let branch = format!("G01 X0 F1000\nX10\n$IF V.E.A\n{words}\n$ENDIF\nX20\nX30\nM30");
        assert_eq!(trace(&branch, &["X"]).begins.len(), 2, "{words}");
    }
}

#[test]
fn an_axis_that_follows_another_one_is_anywhere() {
    // R5.1 R2.50
    let couple = "#SET AX LINK [1, Y=X]\n#ENABLE AX LINK [1]";
    let program =
        format!("G01 X0 Y0 F1000\nX10 Y10\n{couple}\nX20\n#DISABLE AX LINK [1]\nX30\nY0\nY5\nM30");
    let found = trace(&program, &["X", "Y"]);
    let lines: Vec<u32> = found.left_out.iter().map(|(line, _)| *line).collect();
    assert_eq!(lines, [1, 5, 7, 8], "{:?}", found.said);
    let of_x = trace(&program, &["X"]);
    let lines: Vec<u32> = of_x.left_out.iter().map(|(line, _)| *line).collect();
    assert_eq!(lines, [1, 8]);
    assert!(
        of_x.said.contains(&("FC907".to_owned(), 5)),
        "{:?}",
        of_x.said
    );
    let coupled = of_x.lines.iter().zip(&of_x.causes);
    for (line, cause) in coupled {
        assert_eq!(!cause.simplified.is_empty(), *line == 5, "line {line}");
    }
}

#[test]
fn a_spindle_is_no_axis_of_the_path() {
    // R5.1
    let machine = format!("{MACHINE}\n[[axis]]\nname = \"S\"\ntype = \"S\"\n");
    let machine = Machine::from_toml(&machine).expect("a machine");
    let program = "G01 X0 F1000 S500 M3\nX10\nX20 S1000\nM30";
    let found = follow(machine, program, (&["X"], &[]), PlannerOptions::default());
    assert_eq!((found.begins.len(), found.end()), (1, &[20.0][..]));
}
