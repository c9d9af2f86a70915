//! The fixes of every program and list with a mistake: their places, and what is said after them.

use std::collections::BTreeMap;
use std::fs;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};

use frictcomp::diagnostic::{Code, Diagnostic, Fix, Fixed, Safety, Severity};
use frictcomp::interpreter::{NoFiles, Options, StopPolicy};
use frictcomp::machine::{
    Configuration, ListFiles, Machine, NoList, check_configuration, check_list,
};
use frictcomp::session::{Program, Session, SessionOptions, allow_here};
use frictcomp::text::SourceFile;
use frictcomp::timeline::{Record, Sink};

use crate::support::MACHINE;

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
fn a_text_without_a_last_line_end_gets_none() {
    // R2.20 R12.5
    for (text, expected) in [
        (
            "[[axis]]\nname = \"X\"",
            "[[axis]]\nname = \"X\"\n\n[[axis]]\nname = \"C\"",
        ),
        (
            "[[axis]]\nname = \"X\"\n# the end",
            "[[axis]]\nname = \"X\"\n# the end\n\n[[axis]]\nname = \"C\"",
        ),
    ] {
        let machine = Machine::from_toml(text).expect(text);
        let said = run_on(machine, &[("a.nc", "C[COMP OFF LEAD]\nM30")]).said;
        let mended = Fixed::new(&SourceFile::new("frictcomp.toml", text), &said[0].fixes);
        assert_eq!(mended.text, expected);
    }
    let list = "kopf.achs_nr 1\r\nkopf.log_achs_name X\r\na 2";
    let mut lists = Single(list);
    let startup = SourceFile::new("h.lis", "achs_mds[0] x.lis\nzahl_mds 1\nEnde");
    let machine = Configuration::from_startup(startup, &mut lists).machine;
    let said = run_on(machine, &[("a.nc", "X[COMP ON FRICT]\nM30")]).said;
    let mended = Fixed::new(&SourceFile::new("x.lis", list), &said[0].fixes);
    assert_eq!(mended.text, format!("{list}\r\nlr_param.frict_comp 1"));
}

/// A list under every name.
struct Single(&'static str);

impl ListFiles for Single {
    fn read(&mut self, path: &str) -> Result<SourceFile, NoList> {
        Ok(SourceFile::new(path, self.0))
    }
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
fn a_comment_stands_above_a_block_that_it_would_make_too_long() {
    // R12.20: a block has at most 4000 characters (R2.2).
    let block = "X[COMP OFF FRICT]";
    for (blanks, above) in [(3900, false), (3960, true)] {
        let text = format!("N1 {}{block}\nM30\n", " ".repeat(blanks));
        let before = run(&[("a.nc", &text)]).said;
        let source = SourceFile::new("a.nc", text.as_str());
        let fix = allow_here(&before[0], &source).expect("a comment");
        let mended = Fixed::new(&source, [&fix]).text;
        assert_eq!(mended.starts_with("; frictcomp: allow FC401\nN1 "), above);
        assert_eq!(run(&[("a.nc", &mended)]).said, [], "{mended}");
    }
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
