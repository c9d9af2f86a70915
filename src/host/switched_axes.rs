//! Which axes programs switch, before they run: what is proposed where no machine is described
//! (R1.37). A look over the text is enough for a proposal.

use std::fs::File;
use std::io::{self, BufRead, BufReader};

use super::input::Input;

/// The axes whose friction compensation the programs switch, sorted. What cannot be read is said
/// when it is run; of what comes through a pipe nothing is known yet.
pub fn switched_axes<'a>(inputs: impl IntoIterator<Item = &'a Input>) -> Vec<String> {
    let mut found = Vec::new();
    for input in inputs {
        match input {
            Input::File(path) if path.is_file() => {
                if let Ok(file) = File::open(path) {
                    let _ = look(BufReader::new(file), &mut found);
                }
            }
            Input::Open(open) => _ = look(open.text.as_bytes(), &mut found),
            Input::File(_) | Input::Stdin => {}
        }
    }
    found.sort_unstable();
    found
}

/// Lines longer than that hold no block of the control.
const MAX_LINE: u64 = 64 * 1024;

fn look(mut lines: impl BufRead, found: &mut Vec<String>) -> io::Result<()> {
    let mut line = Vec::new();
    // What an open bracket at the end of the line before belongs to.
    let mut open = String::new();
    loop {
        line.clear();
        if io::Read::take(&mut lines, MAX_LINE).read_until(b'\n', &mut line)? == 0 {
            return Ok(());
        }
        if open.is_empty() && !has_comp(&line) {
            continue;
        }
        open.push_str(&code(&line));
        if open.trim_end().ends_with('\\') && open.len() < line.len() + 4096 {
            let kept = open.trim_end().len() - 1;
            open.truncate(kept);
            continue;
        }
        brackets(&open.to_ascii_uppercase(), &open, found);
        open.clear();
    }
}

/// Whether a line may hold a command. Of the letters of the word the last one is the rarest in
/// programs.
fn has_comp(line: &[u8]) -> bool {
    memchr::memchr2_iter(b'P', b'p', line).any(|at| {
        let before = at.checked_sub(3).map(|start| &line[start..at]);
        before.is_some_and(|letters| letters.eq_ignore_ascii_case(b"COM"))
    })
}

/// A line without its comments.
fn code(line: &[u8]) -> String {
    let mut depth = 0_u32;
    let mut code = String::new();
    for letter in String::from_utf8_lossy(line).chars() {
        match letter {
            ';' if depth == 0 => break,
            '(' => depth += 1,
            ')' => depth = depth.saturating_sub(1),
            letter if depth == 0 => code.push(letter),
            _ => {}
        }
    }
    code
}

/// The axes of the brackets that switch friction compensation; keywords are compared in upper case.
fn brackets(upper: &str, text: &str, found: &mut Vec<String>) {
    for (at, _) in upper.match_indices('[') {
        let inside = upper[at + 1..].split(']').next().unwrap_or_default();
        let mut words = inside.split_whitespace();
        let switches =
            words.next() == Some("COMP") && words.any(|word| word == "FRICT" || word == "OFF_ALL");
        let before = text[..at].trim_end();
        let is_name = |letter: char| letter.is_ascii_alphanumeric() || letter == '_';
        let name = before.rsplit(|letter| !is_name(letter)).next();
        let Some(name) = name.filter(|name| switches && is_axis(name)) else {
            continue;
        };
        if !found.iter().any(|known| known == name) {
            found.push(name.to_owned());
        }
    }
}

/// Whether a name is that of an axis (R2.20); a block number before it does not belong to it.
fn is_axis(name: &str) -> bool {
    name.starts_with(|first: char| "ABCUVWXYZQ".contains(first))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn axes_that_are_switched_are_found() {
        // R1.37
        let axes = |text: &str| {
            let mut found = Vec::new();
            look(text.as_bytes(), &mut found).unwrap();
            found
        };
        assert_eq!(
            axes("N10 X[COMP OFF FRICT] Y [comp on LEAD FRICT]"),
            ["X", "Y"]
        );
        assert_eq!(axes("N10 (c) X1[COMP OFF_ALL] ; Z[COMP ON FRICT]"), ["X1"]);
        assert_eq!(
            axes("Z[COMP OFF \\ ; more\nN20 FRICT]\nX[COMP OFF LEAD]\n"),
            ["Z"]
        );
        assert_eq!(axes("S[COMP ON FRICT]\nG0 X[P1]\nFRICT COMP"), [""; 0]);
    }
}
