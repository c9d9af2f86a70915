//! A host with its own interpreter passes only axis brackets to frictcomp.
//!
//! `cargo run --example embed_slice`

use frictcomp::comp::CompensationError;
use frictcomp::machine::Machine;
use frictcomp::syntax::parse_comp;

const MACHINE: &str = r#"
[[axis]]
name = "X"
frict_comp = true
value = { mode = 3, table = [[0, 126], [3000, 112]] }
[[axis]]
name = "Z"
"#;

const PROGRAM: &str = "\
N10 X[COMP OFF FRICT]
N20 G01 X50 F1500
N30 X[COMP ON FRICT]
N40 Z[COMP ON FRICT]
N50 M30
";

/// The host's own idea of a block: where the axis brackets are.
fn brackets(block: &str) -> impl Iterator<Item = &str> {
    block.match_indices('[').filter_map(|(open, _)| {
        let start = block[..open].rfind(' ').map_or(0, |blank| blank + 1);
        let close = open + block[open..].find(']')?;
        Some(&block[start..=close])
    })
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let machine = Machine::from_toml(MACHINE)?;
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
