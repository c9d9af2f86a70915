//! Many open texts (R12.16): a check or a question of one of them costs what that one costs. It is a separate
//! process, since the server has threads whose processor time is measured together.

#![cfg(unix)]

#[allow(dead_code, reason = "a client of other tests, too")]
#[path = "command/lsp/client.rs"]
mod client;

use std::fs;
use std::path::Path;
use std::time::Duration;

use client::{Client, uri};
use rustix::time::{ClockId, clock_gettime};
use serde_json::json;

/// Returns the processor time of all threads.
fn of_process() -> Duration {
    let now = clock_gettime(ClockId::ProcessCPUTime);
    let seconds = u64::try_from(now.tv_sec).expect("a time since the start");
    let nanoseconds = u32::try_from(now.tv_nsec).expect("part of a second");
    Duration::new(seconds, nanoseconds)
}

/// Returns the processor time of the work.
fn taken(work: impl FnOnce()) -> Duration {
    let before = of_process();
    work();
    of_process().saturating_sub(before)
}

/// Returns a program of five lines. Every other one is on the disk, the others were never saved.
fn program(number: usize) -> String {
    format!("%P{number}\nN10 G1 X1 F100\nN20 X[COMP OFF FRICT]\nN30 X{number}\nN40 M30\n")
}

/// Returns the cost of opening so many programs, and of typing in one of them and asking about it.
fn many(folder: &Path, count: usize) -> [Duration; 2] {
    let uris: Vec<String> = (0..count)
        .map(|number| {
            let path = folder.join(format!("p{number}.nc"));
            if number % 2 == 0 {
                fs::write(&path, program(number)).expect("written");
            }
            uri(&path)
        })
        .collect();
    let mut client = Client::new();
    let opening = taken(|| {
        for (number, uri) in uris.iter().enumerate() {
            client.open_as(uri, "isg-cnc", &program(number));
        }
        for uri in &uris {
            client.diagnostics(uri);
        }
    });
    let mut version = 1;
    let mut one = |uri: &str| {
        version += 1;
        client.replace(uri, version, &program(version.unsigned_abs() as usize));
        client.settle(uri);
        let position = json!({ "line": 2, "character": 5 });
        let hover = json!({ "textDocument": { "uri": uri }, "position": position });
        let said = client.ask("textDocument/hover", &hover);
        assert!(said["contents"]["value"].is_string(), "{said}");
    };
    let asking = (0..5).map(|_| taken(|| (0..4).for_each(|at| one(&uris[at * count / 4]))));
    let asking = asking.min().expect("several times");
    client.drop_all();
    [opening, asking]
}

#[test]
fn one_of_many_open_programs_costs_what_one_costs() {
    // R12.16 R9.90
    let folder = tempfile::tempdir().expect("a folder");
    fs::write(
        folder.path().join("frictcomp.toml"),
        "[[axis]]\nname = \"X\"\nenable = true\n",
    )
    .expect("written");
    let measured = (0..3).map(|_| [250, 1000].map(|count| many(folder.path(), count)));
    let growths: Vec<[f64; 2]> = measured
        .map(|[few, many]| [0, 1].map(|at| many[at].div_duration_f64(few[at])))
        .collect();
    let least = |at: usize| {
        growths
            .iter()
            .map(|growth| growth[at])
            .fold(f64::MAX, f64::min)
    };
    assert!(
        least(0) < 4.0 * 1.2,
        "four times the programs: {growths:.2?}"
    );
    assert!(
        least(1) < 1.5,
        "one of four times the programs: {growths:.2?}"
    );
}
