//! Answers that recordings give (R15.2, R15.4): made by a small machine, in the layouts of real recordings.

use std::fs;

use super::machine::{CYCLE_S, Cycle, LIST, Machine};
use super::{MACHINE, programs};
use crate::folder::Bench;
use frictcomp::readings::{Question, Way};
use frictcomp_testing::layouts::{
    Comments, Export, Filled, Header, Letters, Signal, Task, Times, sinumerik,
};

fn bench() -> Bench {
    let bench = Bench::new(&[]);
    bench.write("frictcomp.toml", &format!("{MACHINE}{LIST}"));
    bench.stdout(&["ask", "write", "--axis", "X", "--into", "ask"]);
    bench
}

/// Returns a number from -1 to 1 that looks like noise.
fn noise(at: usize) -> f64 {
    let mut bits = (at as u64 + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    bits ^= bits >> 29;
    bits = bits.wrapping_mul(0xbf58_476d_1ce4_e5b9);
    (bits >> 40) as f64 / f64::from(1 << 23) - 1.0
}

/// Returns the channels of a recording, one sample every so many cycles, with noise of 2 % on the current.
fn task(cycles: &[Cycle], every: usize, axis: u32) -> Task {
    let kept: Vec<&Cycle> = cycles.iter().step_by(every).collect();
    let signal = |name: &str, unit: &str, value: &dyn Fn(usize, &Cycle) -> f64| Signal {
        name: name.to_owned(),
        comment: String::new(),
        unit: unit.to_owned(),
        axis,
        samples: kept
            .iter()
            .enumerate()
            .map(|(at, it)| value(at, it))
            .collect(),
    };
    Task {
        step_ms: CYCLE_S * 1000.0 * every as f64,
        signals: vec![
            signal("x", "mm", &|_, it| (it.x * 1e9).round() / 1e9),
            signal("v", "mm/s", &|_, it| (it.v * 1e9).round() / 1e9),
            signal("frict_comp.output", "", &|at, it| {
                (it.current + 6.0 * noise(at) * f64::from(u8::from(it.is_on))).round()
            }),
            signal("V.A.FRICT_COMP_ACTIVE.X", "", &|_, it| {
                f64::from(u8::from(it.is_on))
            }),
        ],
    }
}

fn scope(task: Task) -> Export {
    Export {
        tasks: vec![task],
        separator: '\t',
        decimal: '.',
        header: Header::Full,
        times: Times::Milliseconds,
        filled: Filled::Blank,
        comments: Comments::Bare,
        letters: Letters::Utf8,
        end: "\r\n",
        has_eof: true,
        ends_in_separator: false,
    }
}

fn plain(task: &Task) -> String {
    with_header(["t", "x [mm]", "v [mm/s]", "output_X", "active_X"], task)
}

fn with_header(header: [&str; 5], task: &Task) -> String {
    let mut text = header.join(";") + "\n";
    let rows = task.signals[0].samples.len();
    for row in 0..rows {
        let time = row as f64 * task.step_ms / 1000.0;
        let cells = task.signals.iter().map(|it| it.samples[row].to_string());
        let cells: Vec<String> = std::iter::once(time.to_string()).chain(cells).collect();
        text.push_str(&cells.join(";"));
        text.push('\n');
    }
    text
}

/// Returns the bytes of a recording in one of the layouts.
fn laid_out(task: Task, layout: usize) -> Vec<u8> {
    match layout % 6 {
        0 => plain(&task).into_bytes(),
        1 => scope(task).bytes(),
        2 => Export {
            separator: ';',
            decimal: ',',
            times: Times::FileTime,
            letters: Letters::Little,
            ..scope(task)
        }
        .bytes(),
        3 => sinumerik(&task, true).into_bytes(),
        4 => with_header(["t", "pos_X", "speed", "output_X", "active_X"], &task).into_bytes(),
        _ => {
            let (motion, friction) = task.signals.split_at(2);
            let tasks = [motion, friction].map(|signals| Task {
                step_ms: task.step_ms,
                signals: signals.to_vec(),
            });
            Export {
                tasks: tasks.to_vec(),
                header: Header::WithoutFile,
                ..scope(task.clone())
            }
            .bytes()
        }
    }
}

fn record(bench: &Bench, name: &str, bytes: &[u8]) {
    fs::write(bench.folder().join(name), bytes).expect("written");
}

/// Returns the result for a question, on one line.
fn said_of(bench: &Bench, rule: &str, arguments: &[&str]) -> String {
    let said = bench.stdout(&[&["ask", "read"], arguments].concat());
    let mut found = String::new();
    let mut is_own = false;
    for line in said.lines() {
        if !line.starts_with(' ') {
            let mut words = line.split(' ');
            is_own = words.any(|word| word.trim_end_matches(',') == rule);
        }
        if is_own {
            found += line.trim();
            found.push(' ');
        }
    }
    assert!(!found.is_empty(), "{rule}: {said}");
    found
}

fn recorded_questions() -> impl Iterator<Item = (usize, Question)> {
    let all = Question::ALL.into_iter();
    all.filter(|it| it.facts().way == Way::Recording)
        .enumerate()
}

/// R15.2, R15.4: a machine of either kind is recorded with noise, and read correctly.
#[test]
fn a_machine_of_either_kind_is_read_from_its_recording() {
    for (place, question) in recorded_questions() {
        let facts = question.facts();
        for (at, reading) in facts.readings.into_iter().enumerate() {
            let bench = bench();
            let machine = Machine {
                second: (at == 1).then_some(facts.rule),
            };
            let cycles = machine.run(&programs(&bench, facts.rule)[0]);
            record(
                &bench,
                "r.csv",
                &laid_out(task(&cycles, 1, 1), 2 * place + at),
            );
            let said = said_of(&bench, facts.rule, &["r.csv"]);
            let word = ["confirmed", "refuted"][at];
            let head = format!("{} {word}: {reading} axis X", facts.rule);
            assert!(said.starts_with(&head), "{} {reading}: {said}", facts.rule);
            let written = bench.read("frictcomp.toml");
            let line = format!("\"{}\" = \"{reading}\"", facts.rule);
            assert!(written.contains(&line), "{written}");
        }
    }
}

/// R15.2: no reading of any question is read wrongly from a recording of another one's program.
#[test]
fn a_recording_of_another_program_decides_nothing_wrongly() {
    let all: Vec<_> = recorded_questions().map(|it| it.1.facts()).collect();
    for (place, second) in all.iter().enumerate() {
        let bench = bench();
        let machine = Machine {
            second: Some(second.rule),
        };
        let other = all[(place + 1) % all.len()];
        let cycles = machine.run(&programs(&bench, other.rule)[0]);
        record(&bench, "r.csv", &laid_out(task(&cycles, 1, 1), place));
        for facts in &all {
            let said = said_of(&bench, facts.rule, &["r.csv"]);
            let wrong = facts.readings[usize::from(facts.rule != second.rule)];
            let wrong = format!(": {wrong} ");
            assert!(
                !said.contains(&wrong),
                "{} on {}: {said}",
                second.rule,
                other.rule
            );
        }
    }
}

/// R15.2: nothing is concluded from recordings that cannot carry it.
#[test]
fn recordings_that_tell_nothing_say_why() {
    let refused = |bytes: &[u8], rule: &str, reason: &str| {
        let bench = bench();
        record(&bench, "r.csv", bytes);
        let said = said_of(&bench, rule, &["r.csv"]);
        assert!(said.contains(" not decidable "), "{said}");
        assert!(said.contains(reason), "{said}");
        let written = bench.read("frictcomp.toml");
        assert!(!written.contains(&format!("\"{rule}\"")), "{written}");
    };
    let bench = bench();
    let program = |rule: &str| programs(&bench, rule)[0].clone();
    let machine = Machine { second: None };
    let cycles = machine.run(&program("R4.2"));

    let mut without = task(&cycles, 1, 1);
    without.signals.truncate(2);
    let without = scope(without).bytes();
    refused(&without, "R4.2", "no channel with the additive current");
    refused(&without, "R1.9", "no channel with the state");

    refused(
        &scope(task(&cycles, 1, 2)).bytes(),
        "R4.6",
        "its channels are those of axis 2, and X is axis 1",
    );

    refused(
        &plain(&task(&cycles, 10, 1)).into_bytes(),
        "R4.2",
        "sampled every 10 ms",
    );

    let off: Vec<Cycle> = cycles
        .iter()
        .map(|it| Cycle {
            is_on: false,
            current: 0.0,
            ..*it
        })
        .collect();
    refused(&scope(task(&off, 1, 1)).bytes(), "R4.5", "off throughout");
    let silent: Vec<Cycle> = cycles
        .iter()
        .map(|it| Cycle {
            current: 0.0,
            ..*it
        })
        .collect();
    let mut silent = task(&silent, 1, 1);
    silent.signals[2].samples.fill(0.0);
    silent.signals.truncate(3);
    refused(&scope(silent).bytes(), "R4.5", "0 throughout");

    let mut larger = task(&cycles, 1, 1);
    larger.signals[2]
        .samples
        .iter_mut()
        .for_each(|it| *it *= 1.5);
    refused(
        &scope(larger).bytes(),
        "R4.2",
        "times that of the value list",
    );

    let mut noisy = task(&cycles, 1, 1);
    for (at, sample) in noisy.signals[2].samples.iter_mut().enumerate() {
        *sample += 500.0 * noise(3 * at);
    }
    refused(
        &scope(noisy).bytes(),
        "R4.2",
        "no combination of readings explains",
    );

    let holed = plain(&task(&cycles, 1, 1));
    let rows: Vec<&str> = holed.lines().collect();
    let holed = [&rows[..900], &rows[1000..]].concat().join("\n");
    refused(holed.as_bytes(), "R4.2", "the recording has a gap at 0.89");

    let never_slow = machine.run(&program("R4.5"));
    refused(
        &scope(task(&never_slow, 1, 1)).bytes(),
        "R1.57",
        "is not that of `ask-R1.57.nc`: it never switches",
    );

    let still: Vec<Cycle> = cycles
        .iter()
        .map(|it| Cycle {
            v: 0.0,
            x: 0.0,
            ..*it
        })
        .collect();
    refused(&scope(task(&still, 1, 1)).bytes(), "R4.2", "does not move");
}

/// R15.2: a list under which both readings are the same decides nothing.
#[test]
fn a_list_without_a_difference_decides_nothing() {
    let bench = bench();
    let machine = Machine { second: None };
    let cycles = machine.run(&programs(&bench, "R4.6")[0]);
    record(&bench, "r.csv", &scope(task(&cycles, 1, 1)).bytes());
    for (from, to, rule, reason) in [
        (
            "delay_cycles = 9",
            "delay_cycles = 0",
            "R4.5",
            "`delay_cycles` is 0",
        ),
        (
            "position_delay = 10",
            "position_delay = 0",
            "R4.3",
            "`position_delay` is 0",
        ),
        (
            "lookahead = 4",
            "lookahead = 1",
            "R4.2",
            "`reversal_lookahead` is below 2",
        ),
        ("[[100, 200]", "[[0, 200]", "R4.7", "nothing is below it"),
        ("[[100, 200]", "[[0, 0]", "R4.6", "no current at standstill"),
    ] {
        bench.write(
            "frictcomp.toml",
            &format!("{MACHINE}{}", LIST.replace(from, to)),
        );
        let said = said_of(&bench, rule, &["r.csv"]);
        assert!(said.contains(reason), "{rule}: {said}");
    }
    bench.write("frictcomp.toml", MACHINE);
    let said = said_of(&bench, "R4.6", &["r.csv"]);
    assert!(said.contains("no value list of X is known"), "{said}");
}
