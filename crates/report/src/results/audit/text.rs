//! An audit for people: a table of programs and axes, the findings of each axis, the cure.

use std::fmt::Write as _;

use super::subject::{AuditReport, CurePlace, MachineAudit, Word, axis_name};
use crate::assumptions::rests_on_text;
use crate::document::Table;
use crate::wording::{Detail, counted, visible_line};
use frictcomp::audit::{AxisAudit, AxisFinding, Cure, Inherits, ProgramAudit};
use frictcomp::interpreter::MotionKind;

/// Rows of a table, and programs of a list, that are shown.
const ROWS: usize = 40;
const LISTED: usize = 10;

/// Length at which tables and lists are shown.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Length {
    /// The dangerous part; the rest is counted.
    Folded,
    /// All of it.
    Whole,
}

impl Length {
    fn of(self, folded: usize) -> usize {
        match self {
            Self::Folded => folded,
            Self::Whole => usize::MAX,
        }
    }
}

/// The table, the findings and the cure of every machine; the verdict is the last line (R18.20).
pub fn render_text(report: &AuditReport, length: Length, detail: Detail) -> String {
    let mut out = String::new();
    for machine in &report.machines {
        if let Some(origin) = report.origin_among_several(machine) {
            let _ = writeln!(out, "machine {}\n", visible_line(origin));
        }
        push_table(&mut out, machine, length);
        for finding in machine.shown() {
            out.push('\n');
            push_finding(&mut out, machine, finding, length);
        }
        out.push('\n');
    }
    if let Some(text) = detail.full(rests_on_text(&report.rests_on())).flatten() {
        let _ = writeln!(out, "{text}");
    }
    let _ = writeln!(out, "{}", report.headline());
    out
}

/// A count that follows another one, if it is not zero.
fn more(count: u64, noun: &str) -> String {
    match count {
        0 => String::new(),
        count => format!(", {}", counted(count, noun)),
    }
}

/// The rows of the table, the most dangerous first.
fn push_table(out: &mut String, machine: &MachineAudit, length: Length) {
    let columns: Vec<&AxisFinding> = machine.shown().collect();
    if columns.is_empty() {
        return;
    }
    let rows = machine.by_danger();
    let shown = rows.len().min(length.of(ROWS));
    let (shown, folded) = rows.split_at(shown);
    let heads = columns.iter().map(|it| axis_name(&it.axis, it.kind));
    let table = Table::default().left("program");
    let mut table = heads.fold(table, |table, head| table.left(visible_line(&head)));
    for (program, words) in shown {
        let words = words.iter().map(|word| word.as_str().to_owned());
        let name = visible_line(&program.file).into_owned();
        table.cells(std::iter::once(name).chain(words).collect());
    }
    let _ = write!(out, "{table}");
    push_folded(out, folded);
    let met = |word: &Word| rows.iter().any(|(_, words)| words.contains(word));
    out.push('\n');
    for word in Word::ALL.into_iter().filter(met) {
        let _ = writeln!(out, "  {:<9} {}", word.as_str(), word.meaning());
    }
}

/// Writes the number of programs that are not shown, by their most dangerous word.
fn push_folded(out: &mut String, folded: &[(&ProgramAudit, Vec<Word>)]) {
    if folded.is_empty() {
        return;
    }
    let counts = Word::ALL.map(|word| {
        let worst = folded.iter().map(|(_, words)| words.iter().min());
        (word, worst.filter(|worst| *worst == Some(&word)).count())
    });
    let counts = counts.iter().filter(|(_, count)| *count > 0);
    let counts: Vec<String> = counts
        .map(|(word, count)| format!("{count} {}", word.as_str()))
        .collect();
    let more = counted(length_of(folded.len()), "more program");
    let _ = writeln!(out, "… {more}: {}", counts.join(", "));
}

fn push_finding(out: &mut String, machine: &MachineAudit, finding: &AxisFinding, length: Length) {
    let name = axis_name(&finding.axis, finding.kind);
    let away = if finding.on_at_start_up { "off" } else { "on" };
    let _ = writeln!(
        out,
        "{}: {} it {away}, {} in that state{}",
        visible_line(&name),
        verb(finding.leavers.len(), finding, ("leaves", "leave")),
        verb(finding.inheritors.len(), finding, ("moves", "move")),
        more(length_of(finding.unknown.len()), "unknown program"),
    );
    let mut list = |title: &str, programs: &[usize], say: &dyn Fn(&ProgramAudit) -> String| {
        if programs.is_empty() {
            return;
        }
        let _ = writeln!(out, "  {title}");
        let shown = programs.len().min(length.of(LISTED));
        for &program in &programs[..shown] {
            let _ = writeln!(out, "    {}", say(&machine.archive.programs()[program]));
        }
        if programs.len() > shown {
            let _ = writeln!(out, "    … {} more", programs.len() - shown);
        }
    };
    let of = |program: &ProgramAudit| program.axes[finding.at].clone();
    list(
        "the second run differs from the first:",
        &finding.both,
        &|program| {
            format!(
                "{}, {}",
                leaver(program, &of(program)),
                inheritor(program, &of(program))
            )
        },
    );
    let only = |list: &[usize]| -> Vec<usize> {
        let only = list.iter().filter(|at| !finding.both.contains(at));
        only.copied().collect()
    };
    let title = format!("leave it {away}:");
    list(&title, &only(&finding.leavers), &|program| {
        leaver(program, &of(program))
    });
    list("inherit it:", &only(&finding.inheritors), &|program| {
        inheritor(program, &of(program))
    });
    list(
        "may inherit it:",
        &finding.possible_inheritors,
        &|program| inheritor(program, &of(program)),
    );
    list("not known:", &finding.unknown, &|program| {
        unknown(program, &of(program))
    });
    push_cure(out, machine, finding, length);
}

fn length_of(list: usize) -> u64 {
    u64::try_from(list).unwrap_or(u64::MAX)
}

fn verb(count: usize, finding: &AxisFinding, (one, several): (&str, &str)) -> String {
    match count {
        // Any of the others may (R10.9).
        0 if !finding.unknown.is_empty() => format!("no program is known to {several}"),
        0 => format!("no program {one}"),
        1 => format!("1 program {one}"),
        count => format!("{count} programs {several}"),
    }
}

fn leaver(program: &ProgramAudit, axis: &AxisAudit) -> String {
    let file = visible_line(&program.file);
    let when = axis.leaves_away_when(&program.file);
    let when = when.map_or(String::new(), |when| format!(", {}", visible_line(&when)));
    match &axis.by {
        Some(by) if *by.file == *program.file => format!("{file}:{}{when}", by.line),
        Some(by) => format!("{file} (at {}:{}){when}", visible_line(&by.file), by.line),
        None => format!("{file} (at its end){when}"),
    }
}

fn inheritor(program: &ProgramAudit, axis: &AxisAudit) -> String {
    let Some(motion) = axis.inherits.motion() else {
        return visible_line(&program.file).into_owned();
    };
    let may = if motion.perhaps { "may move" } else { "moves" };
    let condition = motion.condition(&program.file);
    let condition = condition.map_or(String::new(), |words| {
        format!(", if {}", visible_line(&words))
    });
    let pace = format!("{}{condition}", way(motion.motion));
    let (file, line) = (visible_line(&motion.site.file), motion.site.line);
    if *motion.site.file == *program.file {
        format!("{file}:{line} ({may}{pace})")
    } else {
        let program = visible_line(&program.file);
        format!("{program} (at {file}:{line}, {may}{pace})")
    }
}

/// Returns the kind of motion, after `moves` or `may move`.
fn way(kind: MotionKind) -> &'static str {
    match kind {
        MotionKind::Rapid => " in rapid",
        MotionKind::Feed => " at feed",
        MotionKind::Homing => " to its reference point",
        MotionKind::Independent => " by itself",
        MotionKind::Coupled => " with another axis",
        MotionKind::Frame => " in a turned frame",
        _ => "",
    }
}

fn unknown(program: &ProgramAudit, axis: &AxisAudit) -> String {
    let file = visible_line(&program.file);
    let Some(reason) = &axis.reason else {
        return match axis.inherits {
            Inherits::Unknown => format!("{file}: it stops before the axis is moved or set"),
            _ => file.into_owned(),
        };
    };
    let place = match &reason.site {
        Some(site) => format!("{}:{}", visible_line(&site.file), site.line),
        None => file.to_string(),
    };
    let code = reason
        .code
        .map_or(String::new(), |code| format!(" {code}:"));
    let of = match &reason.site {
        Some(site) if *site.file != *program.file => format!("{file}, "),
        _ => String::new(),
    };
    format!("{of}{place}:{code} {}", visible_line(&reason.message))
}

fn push_cure(out: &mut String, machine: &MachineAudit, finding: &AxisFinding, length: Length) {
    let what = match finding.cure() {
        Cure::Leavers => "before the end of each program that leaves it",
        Cure::Inheritors => "before the first motion of each that inherits it",
        _ => return,
    };
    let _ = writeln!(out, "  cure: one block {what}");
    let cures = machine.cures(finding);
    let shown = cures.len().min(length.of(LISTED));
    for (program, place) in &cures[..shown] {
        let way_home = program.axes[finding.at].way_home();
        let file = visible_line(&program.file);
        let _ = match place {
            CurePlace::Beginning => writeln!(out, "    {way_home}  at the beginning of {file}"),
            CurePlace::Before(line) => writeln!(out, "    {way_home}  before {file}:{line}"),
            CurePlace::End => writeln!(out, "    {way_home}  at the end of {file}"),
        };
    }
    if cures.len() > shown {
        let _ = writeln!(out, "    … {} more", cures.len() - shown);
    }
}
