//! Defaults that do not lie: axes that nothing describes, and parts that are cut without compensation (chapter 18).

use std::ops::ControlFlow;

use frictcomp::diagnostic::Diagnostic;
use frictcomp::machine::{Configuration, ListFiles, Machine, NoList};
use frictcomp::session::{
    Causes, NoFiles, Options, Program, SavedState, Session, SessionOptions, StopPolicy,
};
use frictcomp::text::SourceFile;
use frictcomp::timeline::{Record, Sink};

/// X is described, of Y nothing is known but its name, Z has no friction compensation.
const MACHINE: &str = "[[axis]]\nname = \"X\"\nenable = true\n[[axis]]\nname = \"Y\"\n[[axis]]\nname = \"Z\"\nfrict_comp = false\n";

/// The messages of a session, in their order.
#[derive(Default)]
struct Said(Vec<Diagnostic>);

impl Sink for Said {
    fn record(&mut self, record: &Record<'_>) -> ControlFlow<()> {
        self.0
            .extend(record.diagnostics().map(|it| it.diagnostic().clone()));
        ControlFlow::Continue(())
    }
}

impl Said {
    /// Severity, code and start of each message of a code.
    fn of(&self, code: &str) -> Vec<String> {
        let said = self.0.iter().filter(|it| it.code.as_str() == code);
        said.map(|it| format!("{} {}", it.severity.as_str(), it.place.start()))
            .collect()
    }

    fn help(&self) -> String {
        let help: Vec<String> = self.0.iter().flat_map(Diagnostic::help).collect();
        help.join("\n")
    }
}

fn session(toml: &str) -> Session {
    let machine = Machine::from_toml(toml).expect("a machine");
    let options = SessionOptions::from(Options::default().with_stop(StopPolicy::KeepGoing));
    Session::new(machine, options)
}

fn run(session: &mut Session, programs: &[&str]) -> Said {
    let mut said = Said::default();
    for text in programs {
        said = Said::default();
        let source = SourceFile::new("a.nc", *text);
        let _ = session.program("a.nc", Program::Whole(source), &mut NoFiles, &mut said);
    }
    said
}

/// The messages of the last program of a session.
fn last(programs: &[&str]) -> Said {
    run(&mut session(MACHINE), programs)
}

#[test]
fn an_axis_that_is_only_named_is_not_described() {
    // R18.2
    let said = last(&["Y[COMP OFF FRICT]\r\nG1 Y5 F100\r\nY[COMP OFF_ALL]\r\nM30\r\n"]);
    assert_eq!(said.of("FC408"), ["warning 1:1"]);
    assert!(
        said.help()
            .contains("(frictcomp.toml, line 5, only names it)"),
        "{}",
        said.help()
    );
    let said = last(&["Y[COMP ON FRICT]\nM30\n"]);
    assert_eq!(said.of("P-ERR-70495"), ["error 1:1"]);
    assert!(said.help().contains("nothing describes axis `Y`"));
    // Once in a session, though other programs switch the axis as well.
    let other = "Y[COMP OFF FRICT]\nM30\n";
    assert!(last(&[other, other]).of("FC408").is_empty());
    // A comment silences its own block only.
    let said =
        last(&["Y[COMP OFF FRICT] ; frictcomp: allow FC408\nG1 Y1 F9\nY[COMP OFF_ALL]\nM30\n"]);
    assert_eq!(said.of("FC408"), ["warning 3:1"]);
}

#[test]
fn what_is_said_about_an_axis_describes_it() {
    // R18.2 R1.20
    for (described, keys) in [
        (true, "frict_comp = false"),
        (true, "frict_comp = true"),
        (true, "enable = true"),
        (true, "type = \"S\""),
        (true, "compensations = [\"FRICT\"]"),
        (false, "enable = false"),
        (false, "type = \"R\"\nnumber = 4"),
        (false, "compensations = [\"LEAD\"]"),
        (false, "max_velocity = 9000"),
    ] {
        let toml = format!("[[axis]]\nname = \"C\"\n{keys}\n");
        let machine = Machine::from_toml(&toml).expect("a machine");
        assert_eq!(machine.axes[0].is_described(), described, "{keys}");
    }
    let machine = Machine::enabled(["X"]);
    let described = machine.axes.iter().filter(|axis| axis.is_described());
    let names: Vec<_> = described.map(|axis| axis.name.as_str()).collect();
    assert_eq!(names, ["X"]);
}

/// Lists by their paths.
struct Lists(Vec<(&'static str, &'static str)>);

impl ListFiles for Lists {
    fn read(&mut self, path: &str) -> Result<SourceFile, NoList> {
        let found = self.0.iter().find(|(name, _)| *name == path);
        let found = found.ok_or(NoList::Missing)?;
        Ok(SourceFile::new(found.0, found.1))
    }

    fn above(&self, _: &str) -> Option<String> {
        None
    }
}

#[test]
fn a_list_that_was_read_and_lacks_the_key_says_0() {
    // R18.2: a list that is missing says nothing.
    let x = "kopf.achs_nr 1\nkopf.log_achs_name X\nEnde";
    let bad = "kopf.achs_nr 1\nkopf.log_achs_name X\nlr_param.frict_comp yes\nEnde";
    let channel = "gruppe[0].achse[0].bezeichnung X\ngruppe[0].achse[0].log_achs_nr 1\ngruppe[0].achse[1].bezeichnung Y\ngruppe[0].achse[1].log_achs_nr 2\nEnde";
    let startup = "sda_mds[0] c.lis\nachs_mds[0] x.lis\nEnde";
    let described = |lists: Vec<(&'static str, &'static str)>| {
        let file = SourceFile::new("hochlauf.lis", startup);
        let found = Configuration::from_startup(file, &mut Lists(lists));
        let axes = found.machine.axes.iter().filter(|axis| axis.is_described());
        axes.map(|axis| axis.name.clone()).collect::<Vec<_>>()
    };
    assert_eq!(
        described(vec![("c.lis", channel), ("x.lis", x)]),
        ["X", "Y"]
    );
    assert_eq!(described(vec![("c.lis", channel), ("x.lis", bad)]), ["Y"]);
    assert!(described(vec![("c.lis", channel)]).is_empty());
}

#[test]
fn one_message_for_each_axis_of_a_call() {
    // R18.2
    let mut causes = Causes::default();
    for name in ["a.nc", "b.nc"] {
        let text = "Y[COMP OFF FRICT]\nG1 Y1 F100\nM30\n";
        let machine = Machine::from_toml(MACHINE).expect("a machine");
        let options = SessionOptions::default();
        causes.add(frictcomp::check(
            SourceFile::new(name, text),
            machine,
            options,
            &mut NoFiles,
        ));
    }
    let said: Vec<_> = causes
        .diagnostics()
        .iter()
        .map(|it| it.code.as_str())
        .collect();
    assert_eq!(said, ["FC408"]);
    assert_eq!(&*causes.diagnostics()[0].place.file, "a.nc");
}

#[test]
fn switching_what_is_not_described_is_not_known() {
    // R18.2 R2.98
    let unknown = |text: &str| {
        let mut session = session(MACHINE);
        run(&mut session, &[text]);
        session
            .unknown()
            .map(|(axis, _)| axis.to_owned())
            .collect::<Vec<_>>()
    };
    assert_eq!(unknown("Y[COMP OFF FRICT]\nM30\n"), ["Y"]);
    assert_eq!(unknown("Y[COMP ON FRICT]\nM30\n"), ["Y"]);
    assert!(unknown("G1 Y5 F100\nM30\n").is_empty());
    assert!(unknown("Z[COMP OFF FRICT]\nM30\n").is_empty());
}

#[test]
fn a_verdict_names_the_line_that_assumes_the_axis() {
    // R18.2
    let said = last(&["X[COMP OFF FRICT]\nG1 X5 F100\nM30\n"]);
    assert_eq!(said.of("FC401"), ["warning 1:1"]);
    let help = said.help();
    assert!(
        help.contains("assuming `enable = true`, frictcomp.toml:3"),
        "{help}"
    );
}

#[test]
fn off_without_p_axis_00522_is_a_belief() {
    // R18.3
    for (text, expected) in [
        ("Z[COMP OFF FRICT]\nM30\n", &["info 1:1"][..]),
        ("Z [ comp OFF_ALL ]\nM30\n", &["info 1:1"]),
        ("Z[COMP OFF LEAD FRICT]\nM30\n", &["info 1:1"]),
        ("Z[COMP OFF LEAD]\nM30\n", &[]),
        ("X[COMP OFF FRICT]\nX[COMP ON FRICT]\nM30\n", &[]),
        ("X[COMP ON FRICT]\nM30\n", &[]),
    ] {
        assert_eq!(last(&[text]).of("FC402"), expected, "{text}");
    }
    let help = last(&["Z[COMP OFF FRICT]\nM30\n"]).help();
    assert!(
        help.contains("of axis `Z` is 0 (frictcomp.toml:8)"),
        "{help}"
    );
}

const LEAVER: &str = "X[COMP OFF FRICT]\nM30\n";

#[test]
fn a_part_that_is_cut_without_compensation_is_a_warning() {
    // R18.4
    for (text, expected) in [
        ("G1 X5 F100\nM30\n", &["warning 1:4"][..]),
        ("G2 X10 I5 F100\nM30\n", &["warning 1:4"]),
        ("G0 X0\nM30\n", &["info 1:4"]),
        ("X0\nM30\n", &["info 1:1"]),
        // The feed move counts, though a rapid motion comes first, and only once.
        ("G0 X0\nG1 X5 F100\nG1 X9\nM30\n", &["warning 2:4"]),
        ("G74 X1\nG0 X3\nG1 X5 F100\nM30\n", &["warning 3:4"]),
        ("G74 X1\nM30\n", &["info 1:5"]),
        // In a subprogram, a loop and a macro.
        (
            "%L S\nG1 X5 F100\nM17\n%M\nG0 X0\nLL S\nM30\n",
            &["warning 2:4"],
        ),
        (
            "G0 X0\n$FOR P1=1,3,1\nG1 X=P1 F100\n$ENDFOR\nM30\n",
            &["warning 3:4"],
        ),
        // A command of the program comes first, or before the feed move.
        ("X[COMP ON FRICT]\nG1 X5 F100\nM30\n", &[]),
        ("X[COMP OFF FRICT]\nG1 X5 F100\nM30\n", &[]),
        ("G0 X0\nX[COMP ON FRICT]\nG1 X5 F100\nM30\n", &["info 1:4"]),
        // Another axis moves.
        ("G1 Z5 F100\nM30\n", &[]),
        // A coupled axis, and one in a turned frame, is cut as the path is.
        ("#GANTRY ON [X,Z]\nG1 Z5 F100\nM30\n", &["warning 2:4"]),
        ("#GANTRY ON [X,Z]\nG0 Z5\nM30\n", &["info 2:4"]),
        // What only may be has its condition.
        ("$IF V.E.A\nG1 X1 F100\n$ENDIF\nM30\n", &["info 2:4"]),
        (
            "$IF V.E.A\nX[COMP ON FRICT]\n$ENDIF\nG1 X1 F100\nM30\n",
            &["info 4:4"],
        ),
        ("G0 X0\n$IF V.E.A\nG1 X1 F100\n$ENDIF\nM30\n", &["info 3:4"]),
        (
            "$IF V.E.A\nG1 X1 F100\n$ENDIF\nG1 X2 F100\nM30\n",
            &["warning 4:4"],
        ),
        (
            "$IF V.E.A\nG1 X1 F100\n$ELSE\nG1 X2 F100\n$ENDIF\nM30\n",
            &["warning 2:4"],
        ),
    ] {
        let said = last(&[LEAVER, text]);
        assert_eq!(said.of("FC403"), expected, "{text}");
    }
    // An earlier program that only may leave it so.
    let perhaps = "$IF V.E.A\nX[COMP OFF FRICT]\n$ENDIF\nM30\n";
    assert_eq!(
        last(&[perhaps, "G1 X1 F100\nM30\n"]).of("FC403"),
        ["info 1:4"]
    );
    assert!(last(&["G1 X1 F100\nM30\n"]).of("FC403").is_empty());
}

#[test]
fn a_shift_over_a_state_file_counts_what_it_cuts() {
    // R18.4
    let mut first = session(MACHINE);
    run(&mut first, &[LEAVER]);
    let text = serde_json::to_string(&first.save()).expect("JSON");
    let saved: SavedState = serde_json::from_str(&text).expect("a state");
    let machine = Machine::from_toml(MACHINE).expect("a machine");
    let resumed = Session::resume(machine, SessionOptions::default(), saved);
    let (mut second, _) = resumed.expect("the same machine");
    let said = run(&mut second, &["G0 X0 Z0\nG2 X10 I5 F100\nM30\n"]);
    assert_eq!(said.of("FC403"), ["warning 2:4"]);
    let warnings = second
        .counts()
        .get(&frictcomp::diagnostic::Severity::Warning);
    assert_eq!(warnings, Some(&1));
}

#[test]
fn severities_of_the_user_apply_to_it() {
    // R18.4 R9.28
    let severity = |level: &str, text: &str| {
        let toml = format!("{MACHINE}[lint]\nFC403 = \"{level}\"\n");
        let file = SourceFile::new("frictcomp.toml", toml.as_str());
        let read = Configuration::from_toml(file, &mut frictcomp::machine::NoLists).expect("read");
        let options = SessionOptions::default().with_levels(read.levels);
        run(&mut Session::new(read.machine, options), &[LEAVER, text]).of("FC403")
    };
    let cut = "G1 X5 F100 ; (part)\nM30\n";
    assert_eq!(severity("error", cut), ["error 1:4"]);
    assert_eq!(severity("info", cut), ["info 1:4"]);
    assert!(severity("off", cut).is_empty());
    assert_eq!(severity("error", "G0 X5\nM30\n"), ["info 1:4"]);
    let allowed = "G1 X5 F100 ; frictcomp: allow FC403 warm-up\nM30\n";
    assert!(last(&[LEAVER, allowed]).of("FC403").is_empty());
}
