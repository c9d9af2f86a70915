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

/// The output of a command on both channels at a width.
fn said(width: usize, arguments: &[&str]) -> [String; 2] {
    let output = wide(width, arguments);
    [stdout(&output), stderr(&output)]
}

/// The result of a command at a width.
fn printed(width: usize, arguments: &[&str]) -> String {
    let output = wide(width, arguments);
    assert!(matches!(output.status.code(), Some(0 | 1)), "{arguments:?}");
    stdout(&output)
}

/// The minimum columns of a line: its indent or prefix, and its longest word.
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
fn states_stand_near_their_blocks() {
    // R9.72: the room of wide screens is not put between a block and its states
    let text = printed(200, &["run", "programs/demo/friction.nc"]);
    let row = text
        .lines()
        .find(|line| line.contains("N35 X22 Y33 Z44"))
        .unwrap();
    let blanks = row.trim().split("N35 X22 Y33 Z44").nth(1).unwrap();
    let gap = blanks.len() - blanks.trim_start().len();
    assert!(gap <= 62, "{gap} blanks: {row}");
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

#[test]
fn many_axes_stand_below_their_blocks_where_there_is_no_room_beside() {
    // R9.72
    let bench = tempfile::tempdir().unwrap();
    let program = bench.path().join("eight.nc");
    std::fs::write(
        &program,
        "N10 X1 Y1 Z1 A1 B1 C1 U1 V1\nN20 V[COMP ON FRICT]\nN30 V[COMP OFF FRICT]\nN40 M30\n",
    )
    .unwrap();
    let program = program.to_str().unwrap();
    let arguments = ["run", "--isolated", "--enable", "X,Y,Z,A,B,C,U,V", program];
    let text = printed(40, &arguments);
    assert!(text.contains("     3  N30 V[COMP OFF FRICT]\n"), "{text}");
    assert!(
        text.contains("        X on   Y on   Z on   A on\n        B on   C on   U on   V off◄\n"),
        "{text}"
    );
    let wide = printed(100, &arguments);
    assert!(!wide.contains("X on "), "{wide}");
}
