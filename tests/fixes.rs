//! Fixes: their changes, their places in the text, and that safe ones change nothing else.

mod support;

use std::collections::BTreeMap;
use std::fs;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};

use frictcomp::diagnostic::{Code, Diagnostic, Fix, Fixed, Safety, Severity};
use frictcomp::machine::{
    Configuration, ListFiles, Machine, NoList, NoLists, check_configuration, check_list,
};
use frictcomp::session::{
    NoFiles, Options, Program, Session, SessionOptions, StopPolicy, allow_here,
};
use frictcomp::text::SourceFile;
use frictcomp::timeline::{Record, Sink};

use support::MACHINE;

/// The messages of a run, and the state of friction compensation after each block.
#[derive(Default)]
struct Run {
    said: Vec<Diagnostic>,
    states: Vec<String>,
}

impl Sink for Run {
    fn record(&mut self, record: &Record<'_>) -> ControlFlow<()> {
        match record {
            Record::Block(row) => {
                self.said.extend(row.diagnostics.iter().cloned());
                let kind = frictcomp::comp::Kind::Frict;
                let states = row
                    .state
                    .axes()
                    .map(|(axis, _)| row.state.state(axis, kind).as_str());
                self.states.push(states.collect::<Vec<_>>().join(" "));
            }
            Record::End(end) => self
                .said
                .extend(end.notes.iter().map(|note| note.diagnostic.clone())),
            _ => {}
        }
        ControlFlow::Continue(())
    }
}

fn run(programs: &[(&str, &str)]) -> Run {
    run_on(Machine::from_toml(MACHINE).expect("a machine"), programs)
}

fn run_on(machine: Machine, programs: &[(&str, &str)]) -> Run {
    let options = SessionOptions::from(Options::default().with_stop(StopPolicy::CheckAll));
    let mut session = Session::new(machine, options);
    let mut run = Run::default();
    for (name, text) in programs {
        let program = Program::Whole(SourceFile::new(*name, *text));
        run.said.clear();
        run.states.clear();
        let _ = session.program(name, program, &mut NoFiles, &mut run);
    }
    run
}

/// Returns the text after each single fix of a code, and whether the fix is safe.
fn mended(text: &str, code: &str) -> Vec<(String, Safety)> {
    let source = SourceFile::new("a.nc", text);
    let said = run(&[("a.nc", text)]).said;
    let fixes = said.iter().filter(|said| said.code.as_str() == code);
    let fixes = fixes.flat_map(|said| &said.fixes);
    fixes
        .map(|fix| (Fixed::new(&source, [fix]).text, fix.safety))
        .collect()
}

#[track_caller]
fn becomes(text: &str, code: &str, expected: &[(&str, Safety)]) {
    let expected: Vec<_> = expected
        .iter()
        .map(|(text, safety)| ((*text).to_owned(), *safety))
        .collect();
    assert_eq!(mended(text, code), expected);
}

#[test]
fn a_misspelt_keyword_becomes_the_near_one() {
    // R9.21
    use Safety::Unsafe;
    let cases = [
        (
            "N1 X[COMP ON FRIKT] Y[COMP OFF LEAD]\nM30",
            "FC202",
            "N1 X[COMP ON FRICT] Y[COMP OFF LEAD]\nM30",
        ),
        (
            "X[CMOP ON FRICT]\nM30",
            "P-ERR-21301",
            "X[COMP ON FRICT]\nM30",
        ),
        (
            "N5 #DISABLE AX LINKK [X]\nM30",
            "FC210",
            "N5 #DISABLE AX LINK [X]\nM30",
        ),
        (
            "P1=0\r\n$WHILLE P1 < 1\r\nP1=1\r\n$ENDWHILE\r\nM30",
            "FC207",
            "P1=0\r\n$WHILE P1 < 1\r\nP1=1\r\n$ENDWHILE\r\nM30",
        ),
        (
            "G0 X1 ; frictcomp: alow FC402\nM30",
            "FC491",
            "G0 X1 ; frictcomp: allow FC402\nM30",
        ),
        (
            "G0 X1 (\u{dc} frictcomp: allow FC4O2)\nM30",
            "FC491",
            "G0 X1 (\u{dc} frictcomp: allow FC402)\nM30",
        ),
    ];
    for (text, code, expected) in cases {
        becomes(text, code, &[(expected, Unsafe)]);
    }
}

#[test]
fn an_open_bracket_is_closed_after_the_command() {
    use Safety::Unsafe;
    becomes(
        "N1 X[COMP ON FRICT\nM30",
        "FC205",
        &[("N1 X[COMP ON FRICT]\nM30", Unsafe)],
    );
    becomes(
        "X[COMP OFF_ALL ; all\nM30",
        "FC205",
        &[("X[COMP OFF_ALL] ; all\nM30", Unsafe)],
    );
    becomes(
        "X[COMP ON FRICT Y10\nM30",
        "FC205",
        &[("X[COMP ON FRICT] Y10\nM30", Unsafe)],
    );
    becomes("X[COMP\nM30", "FC205", &[]);
    becomes("X[P1 + 2\nM30", "FC205", &[]);
}

#[test]
fn lower_case_becomes_upper_case_safely() {
    // R1.8
    becomes(
        "X[COMP on FRICT]\nM30",
        "FC404",
        &[("X[COMP ON FRICT]\nM30", Safety::Safe)],
    );
}

#[test]
fn a_kind_comes_home_in_a_block_before_the_program_end() {
    // R1.50
    use Safety::Unsafe;
    becomes(
        "X[COMP OFF FRICT]\r\nN20 M30 ; end\r\n",
        "FC401",
        &[(
            "X[COMP OFF FRICT]\r\nX[COMP ON FRICT]\r\nN20 M30 ; end\r\n",
            Unsafe,
        )],
    );
    becomes(
        "N1 G0 X1\nX[COMP OFF FRICT]\nM02",
        "FC407",
        &[("N1 G0 X1\nX[COMP OFF FRICT]\nX[COMP ON FRICT]\nM02", Unsafe)],
    );
    // The motion before the end would run in another state.
    becomes("X[COMP OFF FRICT]\nG0 Y1 M30", "FC401", &[]);
    becomes("X[COMP OFF FRICT]\n", "FC401", &[]);
}

#[test]
fn a_misspelt_local_subprogram_becomes_the_near_one() {
    // R2.13 R12.5
    use Safety::Unsafe;
    let subprogram = "%L BORE\nX[COMP ON FRICT]\nM17\n%MAIN\n";
    for (call, fixed) in [
        ("N10 LL BOER", "N10 LL BORE"),
        ("N10 LL \"BOER\" [@P1=2] X1", "N10 LL \"BORE\" [@P1=2] X1"),
    ] {
        let (text, expected) = (
            format!("{subprogram}{call}\nM30"),
            format!("{subprogram}{fixed}\nM30"),
        );
        becomes(&text, "FC320", &[(&expected, Unsafe)]);
    }
    // The code of a macro is not the text of the program.
    let text = format!("{subprogram}\"CALL\" = \"LL BOER\"\n\"CALL\"\nM30");
    becomes(&text, "FC320", &[]);
}

#[test]
fn a_comment_allows_a_message_where_it_is_said() {
    // R9.24 R12.5
    let of = |text: &str, code: &str| {
        let source = SourceFile::new("a.nc", text);
        let said = run(&[("a.nc", text)]).said;
        let said = said.iter().find(|said| said.code.as_str() == code);
        let said = said.unwrap_or_else(|| panic!("{text}: no {code}"));
        allow_here(said, &source).map(|fix| Fixed::new(&source, [&fix]).text)
    };
    for (text, code, expected) in [
        (
            "X[COMP OFF FRICT]\r\nN20 M30\r\n",
            "FC401",
            "X[COMP OFF FRICT] ; frictcomp: allow FC401\r\nN20 M30\r\n",
        ),
        (
            "X[COMP on FRICT] (home)  \nM30",
            "FC404",
            "X[COMP on FRICT] (home) ; frictcomp: allow FC404  \nM30",
        ),
        (
            "X[COMP on FRICT] ; frictcomp: allow FC402 known\nM30",
            "FC404",
            "X[COMP on FRICT] ; frictcomp: allow FC404 FC402 known\nM30",
        ),
        (
            "N1 X[COMP \\\n on \\\n FRICT]\nM30",
            "FC404",
            "; frictcomp: allow FC404\nN1 X[COMP \\\n on \\\n FRICT]\nM30",
        ),
        (
            "N1 X[COMP \\ ; more\n on \\ (still)\n FRICT]\nM30",
            "FC404",
            "; frictcomp: allow FC404\nN1 X[COMP \\ ; more\n on \\ (still)\n FRICT]\nM30",
        ),
        (
            "X[COMP on FRICT] ; C:\\\nM30",
            "FC404",
            "X[COMP on FRICT] ; C:\\ ; frictcomp: allow FC404\nM30",
        ),
    ] {
        assert_eq!(of(text, code).as_deref(), Some(expected), "{text}");
    }
    assert_eq!(of("Z[COMP ON FRICT]\nM30", "P-ERR-70495"), None);
    assert_eq!(of("G0 X1 ; frictcomp: allow FC402\nM30", "FC490"), None);
}

#[test]
fn what_is_fixed_is_not_said_again() {
    let texts = [
        "N1 X[COMP ON FRIKT]\nM30",
        "N1 X[COMP OFF FRICT]\nN2 Y[COMP OFF FRICT]\nM30",
        "N1 G0 X1\nN2 X[COMP OFF FRICT]\nM30",
        "X[COMP on FRICT]\nM30",
        "G0 X1 ; frictcomp: allow FC402\nM30",
    ];
    for text in texts {
        let source = SourceFile::new("a.nc", text);
        let said = run(&[("a.nc", text)]).said;
        let fixes: Vec<&Fix> = said.iter().filter_map(|said| said.fixes.first()).collect();
        assert!(!fixes.is_empty(), "{text}");
        let mended = Fixed::new(&source, fixes).text;
        assert_eq!(run(&[("a.nc", &mended)]).said, [], "{mended}");
    }
}

#[test]
fn an_axis_is_set_at_program_start() {
    // R1.52
    let first = ("a.nc", "X[COMP OFF FRICT]\nM30");
    let text = "%B\n(part 2)\nN10 G0 Y1\nN20 G1 X10 F100\nM30";
    let said = run(&[first, ("b.nc", text)]).said;
    let said: Vec<_> = said
        .iter()
        .filter(|said| said.code.as_str() == "FC403")
        .collect();
    let [said] = said[..] else {
        panic!("{said:?}");
    };
    let source = SourceFile::new("b.nc", text);
    let texts: Vec<_> = said
        .fixes
        .iter()
        .map(|fix| Fixed::new(&source, [fix]).text)
        .collect();
    let with =
        |way: &str| format!("%B\n(part 2)\nX[COMP {way} FRICT]\nN10 G0 Y1\nN20 G1 X10 F100\nM30");
    assert_eq!(texts, [with("ON"), with("OFF")]);
}

#[test]
fn a_comment_that_silences_nothing_goes() {
    // R9.24
    use Safety::Safe;
    becomes(
        "G0 X1 ; frictcomp: allow FC402\nM30",
        "FC490",
        &[("G0 X1\nM30", Safe)],
    );
    becomes(
        "G0 X1 (frictcomp: allow FC402) Y1\nM30",
        "FC490",
        &[("G0 X1 Y1\nM30", Safe)],
    );
    becomes("G0 X1 ; frictcomp: allow FC402 FC405\nM30", "FC490", &[]);
}

#[test]
fn a_key_of_a_list_becomes_the_near_one() {
    // R3.5
    let text = "kw.nbr 1\r\nfrict_comp.mode 3\r\nfrict_comp.postion_delay  5\r\nfrict_comp.table[0].in 0\r\nfrict_comp.table[0].out 1\r\nEnde\r\n";
    let source = SourceFile::new("x.lis", text);
    let report = check_list(source.clone(), None, &mut NoLists);
    let fixes: Vec<&Fix> = report
        .diagnostics
        .iter()
        .flat_map(|said| &said.fixes)
        .collect();
    let mended = Fixed::new(&source, fixes).text;
    assert_eq!(mended, text.replace("postion", "position"));
}

#[test]
fn a_key_of_the_configuration_becomes_the_near_one() {
    let cases = [
        (
            "[[axis]]\nname = \"X\"\nfrict_cmp = true\n",
            "frict_cmp",
            "frict_comp",
        ),
        ("[lint]\nFC402 = \"of\"\n", "\"of\"", "\"off\""),
        ("[lint]\n\"FC4O2\" = \"off\"\n", "FC4O2", "FC402"),
        (
            "[[axis]]\nname = \"X\"\nrequired = [\"FRIKT\"]\n",
            "FRIKT",
            "FRICT",
        ),
    ];
    for (text, found, near) in cases {
        let error = Machine::from_toml(text).expect_err("a mistake");
        let source = SourceFile::new("frictcomp.toml", text);
        let mut fixes = error.diagnostic.fixes.clone();
        for fix in &mut fixes {
            fix.place.file = source.name().clone();
        }
        assert_eq!(Fixed::new(&source, &fixes).text, text.replace(found, near));
    }
}

/// Lists by their paths.
struct Lists<'a>(Vec<(&'a str, &'a str)>);

impl ListFiles for Lists<'_> {
    fn read(&mut self, path: &str) -> Result<SourceFile, NoList> {
        let found = self.0.iter().find(|(name, _)| *name == path);
        let (name, text) = found.ok_or(NoList::Missing)?;
        Ok(SourceFile::new(*name, *text))
    }
}

const VALUES: &str = "kopf.achs_nr 1\nfrict_comp.mode 3\nfrict_comp.table_entries 1\n\
    frict_comp.table[0].in 0\nfrict_comp.table[0].out 12\nEnde\n";

/// Returns the machine of a start-up list with one axis and a list of defaults.
fn machine_of(axis: &str, default: &str) -> Configuration {
    let startup = "default_achs_mds d.lis\nachs_mds[0] x.lis\nachs_kw[0] v.lis\nEnde\n";
    let lists = vec![("d.lis", default), ("x.lis", axis), ("v.lis", VALUES)];
    Configuration::from_startup(SourceFile::new("h.lis", startup), &mut Lists(lists))
}

#[test]
fn a_list_sets_what_friction_compensation_needs() {
    // R12.5: P-AXIS-00522 in the axis list, with its line ends and columns.
    let head = "kopf.achs_nr          1\r\nkopf.log_achs_name    X\r\nkenngr.achs_typ 1\r\n";
    let cases = [
        (
            "lr_param.frict_comp   0   # \u{fc}ber\r\nEnde\r\n",
            "",
            "lr_param.frict_comp   1   # \u{fc}ber\r\nEnde\r\n",
        ),
        (
            "lr_param.frict_comp FALSE\r\nEnde",
            "",
            "lr_param.frict_comp TRUE\r\nEnde",
        ),
        (
            "lr_param.frict_comp 0\r\nlr_param.frict_comp 0x0",
            "",
            "lr_param.frict_comp 0\r\nlr_param.frict_comp 1",
        ),
        (
            "kopf.x                2 (two)\r\nEnde\r\n",
            "",
            "kopf.x                2 (two)\r\nlr_param.frict_comp   1\r\nEnde\r\n",
        ),
        ("a 2", "", "a 2\r\nlr_param.frict_comp 1"),
        // The list of defaults concerns all axes and is not changed.
        (
            "Ende",
            "lr_param.frict_comp 0\n",
            "lr_param.frict_comp 1\r\nEnde",
        ),
    ];
    for (rest, default, expected) in cases {
        let axis = format!("{head}{rest}");
        let machine = machine_of(&axis, &format!("{default}Ende\n")).machine;
        let program = [(
            "a.nc",
            "X[COMP ON FRICT]\nX[COMP OFF FRICT]\nX[COMP ON FRICT]\nM30",
        )];
        let said = run_on(machine, &program).said;
        let said = said
            .iter()
            .find(|said| said.code == Code::PErr70495)
            .expect("a refusal");
        let [fix] = &said.fixes[..] else {
            panic!("{said:?}");
        };
        assert_eq!((&*fix.place.file, fix.safety), ("x.lis", Safety::Unsafe));
        let list = SourceFile::new("x.lis", axis.as_str());
        let fixed = Fixed::new(&list, [fix]).text;
        assert_eq!(fixed, format!("{head}{expected}"));
        let mended = machine_of(&fixed, &format!("{default}Ende\n"));
        let after = run_on(mended.machine, &program).said;
        assert!(
            after.iter().all(|said| said.code != Code::PErr70495),
            "{after:?}"
        );
        let before = machine_of(&axis, &format!("{default}Ende\n")).diagnostics;
        let (was, is) = (counted(&before), counted(&mended.diagnostics));
        assert!(was.contains_key(&Code::Fc135), "{was:?}");
        assert!(!is.contains_key(&Code::Fc135), "{is:?}");
        let new = is.iter().find(|(code, times)| was.get(code) < Some(times));
        assert_eq!(new, None, "{rest}");
    }
}

#[test]
fn the_configuration_sets_what_it_has_set_to_false() {
    // R12.5
    let text = "[[axis]]\nname = \"X\"\nfrict_comp = false # not yet\n";
    let machine = Machine::from_toml(text).expect("a machine");
    let said = run_on(machine, &[("a.nc", "X[COMP ON FRICT]\nM30")]).said;
    let fixes = &said.first().expect("a refusal").fixes;
    let mended = Fixed::new(&SourceFile::new("frictcomp.toml", text), fixes);
    assert_eq!(mended.text, text.replace("false", "true"));
    // No list has an entry for the axis.
    let machine = Machine::from_toml("[[axis]]\nname = \"X\"\n").expect("a machine");
    let said = run_on(machine, &[("a.nc", "X[COMP ON FRICT]\nM30")]).said;
    assert!(said.first().expect("a refusal").fixes.is_empty());
}

#[test]
fn the_configuration_gets_an_axis_that_a_program_names() {
    // R12.5 R2.20: in the form in which the file lists the others, with its comments and line ends.
    let cases = [
        (
            "[[axis]]\nname = \"X\"",
            "[[axis]]\nname = \"X\"\n\n[[axis]]\nname = \"C\"",
        ),
        (
            "# mill\r\n[[axis]]\r\nname = \"X\" # first\r\n\r\n# what is checked\r\n[lint]\r\nFC402 = \"off\"\r\n",
            "# mill\r\n[[axis]]\r\nname = \"X\" # first\r\n\r\n[[axis]]\r\nname = \"C\"\r\n\r\n# what is checked\r\n[lint]\r\nFC402 = \"off\"\r\n",
        ),
        // Text that belongs to the last axis stays with it, wherever it is.
        (
            "[[axis]]\nname = \"X\"\n[axis.value]\nmode = 3\ntable = [\n  [0, 1], # slow\n  [9, 1],\n]\n# max_points = 20\n# not yet\n\n[lint]\n",
            "[[axis]]\nname = \"X\"\n[axis.value]\nmode = 3\ntable = [\n  [0, 1], # slow\n  [9, 1],\n]\n# max_points = 20\n# not yet\n\n[[axis]]\nname = \"C\"\n\n[lint]\n",
        ),
        (
            "[[axis]]\nname = \"X\"\n[lint]\n[axis.value]\n[variables]\n",
            "[[axis]]\nname = \"X\"\n[lint]\n[axis.value]\n\n[[axis]]\nname = \"C\"\n[variables]\n",
        ),
        (
            "[[axis]]\nname = \"X\"\n# of the lints\n[lint]\n",
            "[[axis]]\nname = \"X\"\n\n[[axis]]\nname = \"C\"\n# of the lints\n[lint]\n",
        ),
        (
            "[[axis]]\nname = \"X\"\n# the end",
            "[[axis]]\nname = \"X\"\n# the end\n\n[[axis]]\nname = \"C\"",
        ),
        (
            "axis = [{ name = \"X\" }]\n[lint]\n",
            "axis = [{ name = \"X\" }, { name = \"C\" }]\n[lint]\n",
        ),
        (
            "axis = [ {name = \"Y\"}, {name = \"X\"} , ] # two\n",
            "axis = [ {name = \"Y\"}, {name = \"X\"}, { name = \"C\" } , ] # two\n",
        ),
        (
            "axis = [\r\n\t{ name = \"Y\" },\r\n\t{ name = \"X\" }, # ] last, \r\n]\r\n",
            "axis = [\r\n\t{ name = \"Y\" },\r\n\t{ name = \"X\" }, # ] last, \r\n\t{ name = \"C\" },\r\n]\r\n",
        ),
        (
            "axis = [\n  { name = \"X\" } # last\n  , # end\n]\n",
            "axis = [\n  { name = \"X\" }, # last\n  { name = \"C\" }\n  , # end\n]\n",
        ),
    ];
    let program = [("a.nc", "C[COMP OFF LEAD]\nM30")];
    for (text, expected) in cases {
        let said = run_on(Machine::from_toml(text).expect(text), &program).said;
        let said = said.iter().find(|it| it.code == Code::PErr21947);
        let fixes = &said.expect("a refusal").fixes;
        let [fix] = &fixes[..] else {
            panic!("{text}: {fixes:?}");
        };
        assert_eq!(
            (&*fix.place.file, fix.safety),
            ("frictcomp.toml", Safety::Unsafe)
        );
        let mended = Fixed::new(&SourceFile::new("frictcomp.toml", text), [fix]).text;
        assert_eq!(mended, expected);
        let machine = Machine::from_toml(&mended).expect("a machine");
        let names = |machine: &Machine| -> Vec<String> {
            let axes = machine.axes.iter();
            axes.map(|axis| axis.name.clone()).collect()
        };
        let mut all = names(&Machine::from_toml(text).expect("a machine"));
        all.push("C".to_owned());
        assert_eq!(names(&machine), all);
        let after = run_on(machine, &program).said;
        assert!(
            after.iter().all(|it| it.code != Code::PErr21947),
            "{after:?}"
        );
    }
}

#[test]
fn an_axis_is_added_only_where_the_configuration_lists_them() {
    // R2.20: the first listed axis would end the assumption made without a list.
    let fixes = |machine: Machine, program: &str| {
        let said = run_on(machine, &[("a.nc", program)]).said;
        let said = said.into_iter().find(|it| it.code == Code::PErr21947);
        said.expect("a refusal").fixes
    };
    for text in ["", "axis = []", "[lint]\nFC402 = \"off\"\n"] {
        let machine = Machine::from_toml(text).expect("a machine");
        assert_eq!(fixes(machine, "X1[COMP ON FRICT]\nM30"), [], "{text}");
    }
    // The lists of the control name all axes: the control stops there.
    let lists = machine_of("kopf.achs_nr 1\nkopf.log_achs_name X\nEnde\n", "Ende\n");
    assert_eq!(fixes(lists.machine, "C[COMP ON FRICT]\nM30"), []);
    let startup = "default_achs_mds d.lis\nachs_mds[0] x.lis\nEnde\n";
    let x = "kopf.achs_nr 1\nkopf.log_achs_name X\nEnde\n";
    let lists = vec![("h.lis", startup), ("d.lis", "Ende\n"), ("x.lis", x)];
    let text = "[machine]\nstartup = \"h.lis\"\n[[axis]]\nname = \"X\"\nnumber = 1\n";
    let file = SourceFile::new("frictcomp.toml", text);
    let configured = Configuration::from_toml(file, &mut Lists(lists)).expect("a machine");
    assert_eq!(configured.machine.axes.len(), 1);
    assert_eq!(fixes(configured.machine, "C[COMP ON FRICT]\nM30"), []);
    // The probable intention comes first.
    let machine = Machine::from_toml("[[axis]]\nname = \"X1\"\n").expect("a machine");
    let texts: Vec<_> = fixes(machine, "x1[COMP ON FRICT]\nM30")
        .into_iter()
        .map(|fix| fix.text)
        .collect();
    assert_eq!(texts, ["X1"]);
    let machine = Machine::from_toml("[[axis]]\nname = \"X1\"\n").expect("a machine");
    let texts: Vec<_> = fixes(machine, "X2[COMP ON FRICT]\nM30")
        .into_iter()
        .map(|fix| fix.text)
        .collect();
    assert_eq!(texts, ["X1", "\n\n[[axis]]\nname = \"X2\""]);
}

/// Counts how often each code is reported.
fn counted(said: &[Diagnostic]) -> BTreeMap<Code, usize> {
    let mut counts = BTreeMap::new();
    for diagnostic in said {
        *counts.entry(diagnostic.code).or_default() += 1;
    }
    counts
}

#[test]
fn every_fix_takes_its_message_away_and_brings_no_other() {
    // R12.5, for every code that has a fix and every program with a mistake.
    let mut paths = Vec::new();
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    programs(&root.join("programs/err"), &mut paths);
    paths.sort();
    let mut fixed: BTreeMap<Code, usize> = BTreeMap::new();
    for path in paths {
        let Ok(text) = fs::read_to_string(&path) else {
            continue;
        };
        let before = run(&[("a.nc", &text)]).said;
        let source = SourceFile::new("a.nc", text.as_str());
        for said in &before {
            for fix in &said.fixes {
                let in_program = &*fix.place.file == "a.nc";
                let (mended, after) = if in_program {
                    let mended = Fixed::new(&source, [fix]).text;
                    let after = run(&[("a.nc", &mended)]).said;
                    (mended, after)
                } else {
                    let configuration = SourceFile::new("frictcomp.toml", MACHINE);
                    let mended = Fixed::new(&configuration, [fix]).text;
                    let machine = Machine::from_toml(&mended).expect("a machine");
                    (mended, run_on(machine, &[("a.nc", &text)]).said)
                };
                let (was, is) = (counted(&before), counted(&after));
                let shown = path.display();
                assert!(
                    is.get(&said.code) < was.get(&said.code),
                    "{shown}: {mended}"
                );
                for (code, times) in &is {
                    let more = *times > was.get(code).copied().unwrap_or_default();
                    // A command that now works may leave a state that nothing restores to its start-up state, and a
                    // comment that is now read may silence nothing. It is not yet specified whether an added axis has
                    // friction compensation.
                    let follows = fix.safety == Safety::Unsafe
                        && match code {
                            Code::Fc401 | Code::Fc490 => in_program,
                            // An axis that counts as compensated now may have no value list.
                            Code::Fc303 | Code::PErr70495 => !in_program,
                            _ => false,
                        };
                    assert!(!more || follows, "{shown}: {code} after {fix:?}\n{mended}");
                }
                *fixed.entry(said.code).or_default() += 1;
            }
        }
    }
    let codes: Vec<&str> = fixed.keys().map(|code| code.as_str()).collect();
    let expected = [
        "P-ERR-21301",
        "P-ERR-21947",
        "P-ERR-70495",
        "FC202",
        "FC205",
        "FC401",
        "FC404",
        "FC407",
        "FC414",
        "FC490",
        "FC491",
    ];
    assert_eq!(codes, expected);
}

/// Lists in a folder, one of them with a different text.
struct Folder<'a> {
    root: &'a Path,
    changed: Option<(&'a str, &'a str)>,
}

impl<'a> Folder<'a> {
    fn new(root: &'a Path, changed: Option<(&'a str, &'a str)>) -> Self {
        Self { root, changed }
    }
}

impl ListFiles for Folder<'_> {
    fn read(&mut self, path: &str) -> Result<SourceFile, NoList> {
        let changed = self.changed.filter(|(name, _)| *name == path);
        let text = match changed {
            Some((_, text)) => text.to_owned(),
            None => fs::read_to_string(self.root.join(path)).map_err(|_| NoList::Missing)?,
        };
        Ok(SourceFile::new(path, text))
    }
}

fn extension(name: &str) -> &str {
    name.rsplit('.').next().unwrap_or_default()
}

/// Returns the messages about a list or a configuration with all files that it names.
fn said_of(name: &str, mut files: Folder<'_>) -> Vec<Diagnostic> {
    let source = files.read(name).expect("a list");
    if extension(name) == "toml" {
        check_configuration(source, &mut files).diagnostics
    } else {
        check_list(source, None, &mut files).diagnostics
    }
}

#[test]
fn every_fix_of_a_list_takes_its_message_away_and_brings_no_other() {
    // R12.5, for every list with a mistake.
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("programs/machines/err");
    let names = fs::read_dir(&root).expect("lists").map(|entry| {
        let name = entry.expect("an entry").file_name();
        name.into_string().expect("a name")
    });
    let is_list = |name: &String| ["lis", "toml"].contains(&extension(name));
    let mut names: Vec<String> = names.filter(is_list).collect();
    names.sort();
    let mut fixed = BTreeMap::new();
    for name in names {
        let before = said_of(&name, Folder::new(&root, None));
        for said in &before {
            for fix in &said.fixes {
                let file = &*fix.place.file;
                let source = Folder::new(&root, None)
                    .read(file)
                    .expect("the list of the fix");
                let mended = Fixed::new(&source, [fix]);
                assert_eq!(mended.applied, 1, "{name}: {fix:?}");
                let after = said_of(&name, Folder::new(&root, Some((file, &mended.text))));
                let (was, is) = (counted(&before), counted(&after));
                assert!(is.get(&said.code) < was.get(&said.code), "{name}: {fix:?}");
                // A configuration that is now read may raise further messages.
                let follows =
                    |code: &Code| said.code == Code::Fc110 && code.severity() != Severity::Error;
                let new = is
                    .iter()
                    .find(|(code, times)| was.get(code) < Some(times) && !follows(code));
                assert_eq!(new, None, "{name}: {fix:?}");
                *fixed.entry(said.code.as_str()).or_insert(0) += 1;
            }
        }
    }
    let codes: Vec<&str> = fixed.into_keys().collect();
    assert_eq!(codes, ["FC110", "FC122"]);
}

fn programs(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).expect("a folder") {
        let path = entry.expect("an entry").path();
        if path.is_dir() {
            programs(&path, found);
        } else if path.extension().is_some_and(|extension| extension == "nc") {
            found.push(path);
        }
    }
}

#[test]
fn every_fix_of_every_program_stands_in_its_file_and_safe_ones_change_no_state() {
    let mut paths = Vec::new();
    programs(
        &Path::new(env!("CARGO_MANIFEST_DIR")).join("programs"),
        &mut paths,
    );
    let (mut fixes, mut allowed) = (0, 0);
    for path in paths {
        let Ok(text) = fs::read_to_string(&path) else {
            continue;
        };
        let source = SourceFile::new("a.nc", text.as_str());
        let before = run(&[("a.nc", &text)]);
        let own = before.said.iter().flat_map(|said| &said.fixes);
        let own: Vec<&Fix> = own.filter(|fix| &*fix.place.file == "a.nc").collect();
        for fix in &own {
            let span = source.find(&fix.place);
            assert!(span.is_some(), "{}: {fix:?}", path.display());
        }
        fixes += own.len();
        for said in before
            .said
            .iter()
            .filter(|said| &*said.place.file == "a.nc")
        {
            let Some(fix) = allow_here(said, &source) else {
                continue;
            };
            let mended = Fixed::new(&source, [&fix]);
            assert_eq!(mended.applied, 1, "{}: {fix:?}", path.display());
            let after = run(&[("a.nc", &mended.text)]);
            assert_eq!(after.states, before.states, "{}", path.display());
            let times = |run: &Run| run.said.iter().filter(|it| it.code == said.code).count();
            assert!(
                times(&after) < times(&before),
                "{}: {said:?}\n{}",
                path.display(),
                mended.text
            );
            allowed += 1;
        }
        let safe = own.into_iter().filter(|fix| fix.safety == Safety::Safe);
        let mended = Fixed::new(&source, safe);
        assert_eq!(
            run(&[("a.nc", &mended.text)]).states,
            before.states,
            "{}",
            path.display()
        );
    }
    assert!(fixes > 20, "{fixes} fixes");
    assert!(allowed > 40, "{allowed} messages");
}
