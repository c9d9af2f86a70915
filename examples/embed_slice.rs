//! A host with its own interpreter loads the lists of the control, passes only axis brackets to frictcomp, and asks for
//! the state of an axis where it moves.
//!
//! `cargo run --example embed_slice`

use frictcomp::comp::{CompensationError, Kind};
use frictcomp::machine::{Configuration, ListFiles, NoList};
use frictcomp::syntax::parse_comp;
use frictcomp::text::SourceFile;

const STARTUP: &str = "programs/demo/lists/hochlauf.lis";

const PROGRAM: &str = "\
N10 X[COMP OFF FRICT]
N20 G01 X50 F1500
N30 X[COMP ON FRICT]
N40 Z[COMP ON FRICT]
N50 M30
";

/// The lists on the disk. Each is named by its path, in the folder of the list that names it.
struct Disk;

impl ListFiles for Disk {
    fn read(&mut self, path: &str) -> Result<SourceFile, NoList> {
        let text = std::fs::read_to_string(path).map_err(|_| NoList::Missing)?;
        Ok(SourceFile::new(path, text))
    }
}

/// Returns the host's own idea of a block: where the axis brackets are.
fn brackets(block: &str) -> impl Iterator<Item = &str> {
    block.match_indices('[').filter_map(|(open, _)| {
        let start = block[..open].rfind(' ').map_or(0, |blank| blank + 1);
        let close = open + block[open..].find(']')?;
        Some(&block[start..=close])
    })
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let startup = SourceFile::new(STARTUP, std::fs::read_to_string(STARTUP)?);
    let configuration = Configuration::from_startup(startup, &mut Disk);
    for said in &configuration.diagnostics {
        say(&format!("{}: {}", said.code, said.message));
    }
    let machine = configuration.machine;
    let x = machine.find("X").ok_or("the lists have no axis X")?;
    let mut compensation = machine.compensation();
    let mut refused = Vec::new();
    for block in PROGRAM.lines() {
        for bracket in brackets(block) {
            let command = match parse_comp(bracket) {
                Ok(Some(command)) => command,
                Ok(None) => continue, // Another command, or an expression: for the host.
                Err(fault) => return Err(format!("{block}: {fault}").into()),
            };
            match compensation.apply(&command) {
                Ok(changes) => {
                    for change in changes {
                        let axis = &machine.axis(change.axis).name;
                        say(&format!(
                            "{block}: {axis} {} → {}",
                            change.from.as_str(),
                            change.to.as_str()
                        ));
                    }
                }
                Err(error) => {
                    say(&format!("{block}: {}: {error}", error.code()));
                    refused.push(error);
                }
            }
        }
        if block.contains("G01") {
            let state = compensation.state(x, Kind::Frict);
            say(&format!("{block}: X moves {}", state.as_str()));
        }
    }
    compensation.program_end(); // Friction compensation stays as it is.
    assert!(matches!(
        refused[..],
        [CompensationError::NotConfigured { .. }]
    ));
    Ok(())
}

#[test]
fn it_runs() {
    main().expect("a slice");
}

#[allow(clippy::print_stdout, reason = "an example shows what happens")]
fn say(text: &str) {
    println!("{text}");
}
