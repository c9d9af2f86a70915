//! The axes that programs name or switch, found before they run (R9.74).

use std::collections::BTreeSet;
use std::fs::File;

use crate::disk::{Input, whole_lines};
use frictcomp::syntax::{NamedAxes, Scan, SwitchedAxes};

/// The letters that are axes where no machine is described (R2.20).
const LETTERS: [&str; 9] = ["X", "Y", "Z", "A", "B", "C", "U", "V", "W"];

/// The axes that a look through the text of programs found. The interpreter decides what is an axis;
/// the look only says which to expect.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub(crate) struct AxesAhead {
    found: BTreeSet<String>,
    /// The axes whose state programs read.
    read: BTreeSet<String>,
    /// Names that may occur in programs of other runs.
    elsewhere: Vec<String>,
    /// Whether there may be more axes: in called programs, in blocks with faults, or in programs from a pipe.
    is_open: bool,
}

impl AxesAhead {
    /// Looks through programs for the usual axes and for further names.
    pub(crate) fn of<'a>(
        inputs: impl IntoIterator<Item = &'a Input>,
        names: impl IntoIterator<Item = &'a str>,
    ) -> Self {
        let names = LETTERS.into_iter().chain(names).collect::<BTreeSet<_>>();
        let mut ahead = Self::default();
        let mut found = NamedAxes::new(names);
        let (mut has_program, mut has_other) = (false, false);
        for input in inputs {
            if input.probe().is_err() {
                // A file that is no program is reported when it is run.
                has_other = true;
                continue;
            }
            has_program = true;
            let mut scan = Scan::new(found);
            match input {
                Input::File(path) if path.is_file() => {
                    let file = File::open(path);
                    let looked = file.and_then(|file| whole_lines(file, |it| scan.feed(it)));
                    // A program that cannot be read is reported when it is run.
                    ahead.is_open |= looked.is_err();
                }
                Input::Open(open) => scan.feed(open.text.as_bytes()),
                Input::File(_) | Input::Stdin => ahead.is_open = true,
            }
            found = scan.question;
        }
        ahead.is_open |= found.may_name_more() || (has_other && !has_program);
        ahead.read.clone_from(found.read());
        ahead.found = found.into_names();
        ahead
    }

    /// Returns the usual axes that occur, in the order of the machine.
    pub(crate) fn names(&self) -> impl Iterator<Item = &'static str> {
        LETTERS
            .into_iter()
            .filter(|name| self.found.contains(*name))
    }

    /// Allows for other runs, which name the usual axes and those of an earlier run.
    pub(crate) fn expect_more(&mut self, left: Vec<String>) {
        let usual = LETTERS.into_iter().map(str::to_owned);
        self.elsewhere = usual.chain(left).collect();
    }

    /// Returns whether an axis may occur.
    pub(crate) fn may_hold(&self, name: &str) -> bool {
        let unseen = self.is_open && may_be_axis(name);
        let elsewhere = self.elsewhere.iter().any(|known| known == name);
        unseen || elsewhere || self.found.contains(name) || self.read.contains(name)
    }
}

/// Returns whether a program can name such an axis: in capital letters, and not `ALL`.
pub(crate) fn may_be_axis(name: &str) -> bool {
    name != "ALL" && !name.contains(|letter: char| letter.is_ascii_lowercase())
}

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

#[cfg(test)]
mod tests {
    use super::*;

    fn ahead(text: &str) -> (Vec<&'static str>, bool) {
        let file = tempfile::NamedTempFile::new().unwrap();
        std::fs::write(file.path(), text).unwrap();
        let ahead = AxesAhead::of([&Input::File(file.path().to_owned())], []);
        (ahead.names().collect(), !ahead.is_open)
    }

    #[test]
    fn axes_are_words_with_a_value() {
        // R9.74
        let names = |text: &str| ahead(text).0;
        assert_eq!(
            names("N10 G1X1Y-2 Z=P1\nC[COMP ON FRICT]"),
            ["X", "Y", "Z", "C"]
        );
        assert_eq!(
            names("N10 X P5 B.5 W V.P.A\nU[1+2] A = 5"),
            ["X", "A", "B", "U", "W"]
        );
        assert_eq!(
            names("V.E.X = 1 (X5) ;Y5\n#MSG [\"Z5\"]\n%A1\nFRICT\nMAX5"),
            [""; 0]
        );
        assert_eq!(names("$IF P1 == 1\nP1 = 'H1B5'\nV.5"), ["V"]);
        assert_eq!(names("\"CUT\" = \"G1 X5 Y[COMP ON FRICT]\""), ["X", "Y"]);
        assert_eq!(names("V.P.A = \"(\" Z5"), ["Z"]);
    }

    #[test]
    fn calls_may_bring_more_axes() {
        assert!(ahead("G0 X1\nLL SUB\n%L SUB\nM17").1);
        assert!(!ahead("G0 X1\nL SUB.nc\n").1);
        assert!(!ahead("L \"SUB.nc\"").1);
        assert!(!ahead("N10 X[COMP OF FRICT]").1);
    }

    #[test]
    fn a_file_is_looked_at_piece_by_piece() {
        let file = tempfile::NamedTempFile::new().unwrap();
        let text = "N10 X1 (no Y5)\n".repeat(40_000) + "N20 AX2=5\n";
        std::fs::write(file.path(), text).unwrap();
        let input = Input::File(file.path().to_owned());
        let ahead = AxesAhead::of([&input], ["AX2", "AX3"]);
        assert_eq!(ahead.names().collect::<Vec<_>>(), ["X"]);
        assert!(ahead.may_hold("AX2") && !ahead.may_hold("AX3") && !ahead.may_hold("Y"));
        assert!(AxesAhead::of([&Input::Stdin], []).may_hold("Q1"));
    }
}
