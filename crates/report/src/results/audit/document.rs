//! An audit as a document: the findings of each axis with the cure, and a table of programs and axes.

use super::subject::{AuditReport, CurePlace, MachineAudit, Word, axis_name, possible_leavers};
use crate::assumptions::rests_on_text;
use crate::document::{Document, Phrase, Table};
use crate::wording::{counted, visible_line};
use frictcomp::audit::{AxisAudit, AxisFinding, Cure, Inherits, ProgramAudit, Site};
use frictcomp::interpreter::MotionKind;

/// Returns the table, the findings and the cure of every machine; the verdict is the last line of the text (R18.20).
pub fn document(report: &AuditReport) -> Document<'static> {
    let mut out = Document::new("What the order of programs does", report.headline());
    out.conclude_with_verdict();
    let not_checked = report.not_checked.as_ref();
    out.aside(not_checked.map(|programs| format!("not checked: {programs}")));
    for machine in &report.machines {
        let origin = report.origin_among_several(machine);
        let subject = origin.map(|origin| format!("machine {}", visible_line(origin)));
        let findings: Vec<&AxisFinding> = machine.shown().collect();
        if findings.is_empty() && subject.is_none() {
            continue;
        }
        out.below("Programs and axes");
        out.subject(subject.clone());
        if findings.is_empty() {
            out.lines(["no axis is configured for friction compensation"]);
        } else {
            out.table(table(machine, &findings));
        }
        out.section("Findings");
        out.subject(subject);
        for finding in findings {
            push_finding(&mut out, machine, finding);
        }
        out.push_str("\n");
    }
    out.folded("Conditions");
    out.lines(rests_on_text(&report.rests_on()));
    out
}

/// Returns the effect of each program on each axis, the most dangerous programs first.
fn table(machine: &MachineAudit, findings: &[&AxisFinding]) -> Table {
    let heads = findings.iter().map(|it| axis_name(&it.axis, it.kind));
    let table = Table::default().folding("program").left("program");
    let table = heads.fold(table, |table, head| table.left(visible_line(&head)));
    let legend = Word::ALL.map(|word| {
        (
            Phrase::from(word.as_str()).toned(word.tone()),
            word.meaning(),
        )
    });
    let mut table = table.explaining(legend.into());
    for program in machine.by_danger(findings) {
        let cells = findings.iter().map(|it| cell(&program.axes[it.at]));
        table.cells(std::iter::once(visible_line(&program.file).into()).chain(cells));
    }
    table
}

fn cell(axis: &AxisAudit) -> Phrase {
    let word = Word::of(axis);
    let inherits = axis.inherits.motion().map(|it| &it.site);
    let site = match word {
        Word::Both => axis.by.as_ref().or(inherits),
        Word::Leaves | Word::Depends => axis.by.as_ref(),
        Word::Unknown => axis.reason.as_ref().and_then(|it| it.site.as_ref()),
        Word::Inherits | Word::Perhaps => inherits,
        Word::StartUp | Word::Keeps => None,
    };
    let text = word.as_str();
    let cell = site.map_or(text.into(), |it| Phrase::leading(text, &it.file, it.line));
    cell.toned(word.tone())
}

fn push_finding(out: &mut Document<'_>, machine: &MachineAudit, finding: &AxisFinding) {
    let away = if finding.on_at_start_up { "off" } else { "on" };
    let unknown = match finding.unknown.len() {
        0 => String::new(),
        count => format!(", {}", counted(count, "unknown program")),
    };
    let leave = match possible_leavers(&machine.archive, finding) {
        0 => ("leaves", "leave"),
        all if all == finding.leavers.len() => ("may leave", "may leave"),
        _ => ("leaves or may leave", "leave or may leave"),
    };
    out.lines([format!(
        "\n{}: {} it {away}, {} in that state{unknown}",
        visible_line(&axis_name(&finding.axis, finding.kind)),
        verb(finding.leavers.len(), finding, leave),
        verb(finding.inheritors.len(), finding, ("moves", "move")),
    )]);
    let mut list =
        |title: &str, programs: &[usize], say: fn(&ProgramAudit, &AxisAudit) -> Phrase| {
            let programs = programs.iter().map(|&at| &machine.archive.programs()[at]);
            let items = programs.map(|program| say(program, &program.axes[finding.at]));
            out.list(title, items.collect());
        };
    let only = |list: &[usize]| -> Vec<usize> {
        let only = list
            .iter()
            .filter(|at| finding.both.binary_search(at).is_err());
        only.copied().collect()
    };
    list(
        "the second run differs from the first:",
        &finding.both,
        |program, axis| {
            leaver(program, axis)
                .then(", ")
                .and(inheritor(program, axis))
        },
    );
    list(
        &format!("leave it {away}:"),
        &only(&finding.leavers),
        leaver,
    );
    list("inherit it:", &only(&finding.inheritors), inheritor);
    list("may inherit it:", &finding.possible_inheritors, inheritor);
    list("not known:", &finding.unknown, unknown_effect);
    push_cure(out, machine, finding);
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

/// Returns a line as `file:line`, which leads to it.
fn at(site: &Site) -> Phrase {
    let text = format!("{}:{}", visible_line(&site.file), site.line);
    Phrase::leading(text, &site.file, site.line)
}

fn leaver(program: &ProgramAudit, axis: &AxisAudit) -> Phrase {
    let file = Phrase::from(visible_line(&program.file));
    let place = match &axis.by {
        Some(by) if *by.file == *program.file => at(by),
        Some(by) => file.then(" (at ").and(at(by)).then(")"),
        None => file.then(" (at its end)"),
    };
    match axis.leaves_away_when(&program.file) {
        Some(when) => place.then(format!(", {}", visible_line(&when))),
        None => place,
    }
}

fn inheritor(program: &ProgramAudit, axis: &AxisAudit) -> Phrase {
    let file = Phrase::from(visible_line(&program.file));
    let Some(motion) = axis.inherits.motion() else {
        return file;
    };
    let may = if motion.perhaps { "may move" } else { "moves" };
    let condition = motion.condition(&program.file);
    let condition = condition.map_or(String::new(), |words| {
        format!(", if {}", visible_line(&words))
    });
    let refused = if motion.is_refused {
        ", which the control refuses"
    } else {
        ""
    };
    let pace = format!("{may}{}{refused}{condition})", way(motion.motion));
    if *motion.site.file == *program.file {
        at(&motion.site).then(" (").then(pace)
    } else {
        file.then(" (at ")
            .and(at(&motion.site))
            .then(", ")
            .then(pace)
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

fn unknown_effect(program: &ProgramAudit, axis: &AxisAudit) -> Phrase {
    let file = Phrase::from(visible_line(&program.file));
    let Some(reason) = &axis.reason else {
        return match axis.inherits {
            Inherits::Unknown => file.then(": it stops before the axis is moved or set"),
            _ => file,
        };
    };
    let place = match &reason.site {
        Some(site) if *site.file == *program.file => at(site),
        Some(site) => file.then(", ").and(at(site)),
        None => file,
    };
    let code = reason
        .code
        .map_or(String::new(), |code| format!(" {code}:"));
    place.then(format!(":{code} {}", visible_line(&reason.message)))
}

fn push_cure(out: &mut Document<'_>, machine: &MachineAudit, finding: &AxisFinding) {
    let what = match finding.cure() {
        Cure::Leavers => "before the end of each program that leaves it",
        Cure::Inheritors => "before the first motion of each that inherits it",
        _ => return,
    };
    let cures = machine.cures(finding).into_iter().map(|(program, place)| {
        let block = Phrase::default().code(program.axes[finding.at].way_home());
        let file = visible_line(&program.file);
        match place {
            CurePlace::Beginning => block.then(format!("  at the beginning of {file}")),
            CurePlace::Before(line) => block.then("  before ").and(Phrase::leading(
                format!("{file}:{line}"),
                &program.file.as_str().into(),
                line,
            )),
            CurePlace::End => block.then(format!("  at the end of {file}")),
        }
    });
    out.list(format!("cure: one block {what}"), cures.collect());
}
