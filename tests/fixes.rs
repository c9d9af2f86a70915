//! Fixes: what they change, that they stand where their text is, and that safe ones change nothing
//! else.

mod support;

use std::fs;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};

use frictcomp::diagnostic::{Diagnostic, Fix, Fixed, Safety};
use frictcomp::machine::{Machine, NoLists, check_list};
use frictcomp::session::{
    NoFiles, Options, Program, Session, SessionOptions, StopPolicy, allow_here,
};
use frictcomp::text::SourceFile;
use frictcomp::timeline::{Record, Sink};

use support::MACHINE;

/// What a run says, and the state of friction compensation after each block.
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
    let options = SessionOptions::from(Options::default().with_stop(StopPolicy::CheckAll));
    let machine = Machine::from_toml(MACHINE).expect("a machine");
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

/// The text after each fix of a code alone, and whether the fix is safe.
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
