//! Text keeps within its width, from 40 to 200 columns (R9.72).

use crate::folder::{call, stderr, stdout};
use crate::workspace::root;
use std::process::Output;

use unicode_width::UnicodeWidthStr;

fn wide(width: usize, arguments: &[&str]) -> Output {
    call(
        root(),
        &[arguments, &["--width", &width.to_string()]].concat(),
    )
}

/// Returns the output of a command on both channels at a width.
fn said(width: usize, arguments: &[&str]) -> [String; 2] {
    let output = wide(width, arguments);
    [stdout(&output), stderr(&output)]
}

/// Returns the result of a command at a width.
fn printed(width: usize, arguments: &[&str]) -> String {
    let output = wide(width, arguments);
    assert!(matches!(output.status.code(), Some(0 | 1)), "{arguments:?}");
    stdout(&output)
}

/// Returns the minimum columns of a line: its indent or prefix, and its longest word.
fn least(line: &str) -> usize {
    let longest = line
        .split([' ', '\u{a0}'])
        .map(UnicodeWidthStr::width)
        .max();
    let indent = line.width() - line.trim_start().width();
    longest.unwrap_or_default() + indent + 12
}

#[test]
fn no_line_is_wider_than_asked() {
    // R9.72
    let commands: [&[&str]; 6] = [
        &["run", "programs/demo/friction.nc", "programs/demo/next.nc"],
        &["run", "programs/demo/unset/friction.nc"],
        &[
            "run",
            "--keep-going",
            "programs/err/P-ERR-21947-unknown-axis.nc",
        ],
        &["run", "--full", "programs/ok/switched-in-loops.nc"],
        &["check", "programs/demo"],
        &["lists", "--show", "programs/machines/mill3/hochlauf.lis"],
    ];
    for arguments in commands {
        for width in (40..=200).step_by(10) {
            for line in printed(width, arguments).lines() {
                // A place in a file and a line of source have no blank at which they could end.
                let is_place = line.trim_start().starts_with("-->") || line.contains(" | ");
                let room = if is_place {
                    usize::MAX
                } else {
                    width.max(least(line))
                };
                assert!(line.width() <= room, "{arguments:?} {width}\n{line}");
            }
        }
    }
}

#[test]
fn tables_and_failures_keep_within_their_width() {
    // R9.72
    let commands: [&[&str]; 13] = [
        &["audit", "programs/demo/order"],
        &["audit", "--sequence", "programs/demo/order/monday.txt"],
        &["contour", "programs/demo/contour/plate.nc"],
        &[
            "replay",
            "programs/demo/replay/other.csv",
            "programs/demo/replay/pocket.nc",
        ],
        &["config", "show", "programs/machines/mill3"],
        &["explain"],
        &["circle", "--radius", "5", "--feed", "3000"],
        &[
            "tune", "--plant", "stiff", "--radii", "5", "--feeds", "5000",
        ],
        &["diff", "programs/demo/friction.nc", "programs/demo/next.nc"],
        &["golden", "programs/demo"],
        &["run", "no/such/program.nc"],
        &[
            "run",
            "--enable",
            "Q",
            "--isolated",
            "programs/demo/friction.nc",
        ],
        &[
            "tune", "--plant", "no.toml", "--radii", "5", "--feeds", "1000",
        ],
    ];
    for arguments in commands {
        for width in [40, 60, 100, 200] {
            let [stdout, stderr] = said(width, arguments);
            let failure = stderr.lines().filter(|_| stdout.is_empty());
            for line in stdout.lines().chain(failure) {
                let room = width.max(least(line));
                assert!(line.width() <= room, "{arguments:?} {width}\n{line}");
            }
        }
    }
}
