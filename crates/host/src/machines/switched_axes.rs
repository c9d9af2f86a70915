//! The axes that programs switch, found before they run: proposed where no machine is described
//! (R1.37). A look through the text is enough for a proposal.

use std::fs::File;

use crate::disk::{Input, whole_lines};
use frictcomp::syntax::{Scan, SwitchedAxes};

/// Returns the axes whose friction compensation the programs switch, sorted. What cannot be read is reported
/// when it is run; the content of a pipe is not known yet.
pub fn switched_axes<'a>(inputs: impl IntoIterator<Item = &'a Input>) -> Vec<String> {
    let mut found = Vec::new();
    for input in inputs {
        let mut scan = Scan::new(SwitchedAxes::default());
        match input {
            Input::File(path) if path.is_file() => {
                if let Ok(file) = File::open(path) {
                    let _ = whole_lines(file, |piece| scan.feed(piece));
                }
            }
            Input::Open(open) => scan.feed(open.text.as_bytes()),
            Input::File(_) | Input::Stdin => {}
        }
        found.extend(scan.question.0);
    }
    found.sort_unstable();
    found.dedup();
    found
}
