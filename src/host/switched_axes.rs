//! Which axes programs switch, before they run: what is proposed where no machine is described
//! (R1.37). A look over the text is enough for a proposal.

use std::fs::File;
use std::io::{self, BufRead, BufReader};

use super::input::Input;
use crate::syntax::SwitchScan;

/// The axes whose friction compensation the programs switch, sorted. What cannot be read is said
/// when it is run; of what comes through a pipe nothing is known yet.
pub fn switched_axes<'a>(inputs: impl IntoIterator<Item = &'a Input>) -> Vec<String> {
    let mut found = Vec::new();
    for input in inputs {
        let mut scan = SwitchScan::default();
        match input {
            Input::File(path) if path.is_file() => {
                if let Ok(file) = File::open(path) {
                    let _ = look(BufReader::new(file), &mut scan);
                }
            }
            Input::Open(open) => _ = look(open.text.as_bytes(), &mut scan),
            Input::File(_) | Input::Stdin => {}
        }
        found.extend(scan.into_axes());
    }
    found.sort_unstable();
    found.dedup();
    found
}

/// Lines longer than that hold no block of the control.
const MAX_LINE: u64 = 64 * 1024;

fn look(mut lines: impl BufRead, scan: &mut SwitchScan) -> io::Result<()> {
    let mut line = Vec::new();
    loop {
        line.clear();
        if io::Read::take(&mut lines, MAX_LINE).read_until(b'\n', &mut line)? == 0 {
            return Ok(());
        }
        scan.feed(&line);
    }
}
