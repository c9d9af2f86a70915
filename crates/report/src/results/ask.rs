//! The open questions, what is assumed, and what a control answered, `ask`.

use std::fmt::Write as _;

use serde_json::{Value, json};

use crate::document::{Document, Headline, Standing};
use crate::wording::{counted, to_json, visible_line};
use frictcomp::comp::CncBuild;
use frictcomp::machine::Machine;
use frictcomp::readings::{Basis, Question};
use frictcomp_recordings::evidence::{Answer, AnswerVerdict, UnreadAnswer};

/// Returns the questions with the readings in force on a machine; `build` is that of its control.
pub fn document(machine: &Machine, build: Option<CncBuild>) -> Document<'static> {
    let mut out = Document::new("Open questions", headline(machine, build));
    out.push_str("\n");
    for question in Question::ALL {
        let facts = question.facts();
        let _ = writeln!(out, "{} {}", facts.rule, facts.question);
        let _ = writeln!(out, "  reading: {}", basis(question, machine, build));
        let _ = writeln!(out, "  depends on it: {}", facts.depends);
        let _ = writeln!(out, "  asked by {}: {}", facts.way.as_str(), facts.how);
    }
    out
}

/// Returns the questions as JSON.
pub fn render_json(machine: &Machine, build: Option<CncBuild>) -> String {
    let questions = Question::ALL.into_iter();
    let questions: Vec<Value> = questions.map(|it| record(it, machine)).collect();
    let headline = headline(machine, build);
    let list = json!({ "schema": 1, "headline": headline, "questions": questions });
    to_json(&list)
}

/// Programs that were written to ask a control.
#[derive(Debug)]
pub struct WrittenPrograms<'a> {
    /// The axis that they test.
    pub axis: &'a str,
    /// The distance that it may move, in mm or degrees.
    pub travel: f64,
    /// The build of the control, if it is known.
    pub build: Option<CncBuild>,
    /// The folder.
    pub folder: String,
    /// The names of the programs in it.
    pub programs: Vec<String>,
}

impl WrittenPrograms<'_> {
    /// The verdict: how many programs there are, and what to do with them.
    fn headline(&self) -> Headline {
        let text = format!(
            "{} for {} in `{}`: run them on the control as `README.txt` there says, then `frictcomp ask read` what they \
             leave",
            counted(self.programs.len(), "program"),
            visible_line(self.axis),
            visible_line(&self.folder)
        );
        Headline::new(Standing::Plain, text)
    }

    /// The verdict as a document.
    pub fn document(&self) -> Document<'static> {
        Document::new("Programs that ask the control", self.headline())
    }

    /// The programs as JSON.
    pub fn render_json(&self) -> String {
        to_json(&json!({
            "schema": 1,
            "headline": self.headline(),
            "axis": self.axis,
            "travel": self.travel,
            "build": self.build.map(|it| it.to_string()),
            "folder": self.folder,
            "programs": self.programs,
        }))
    }
}

/// The answers of a control, and what became of them.
#[derive(Debug)]
pub struct AnswersReport<'a> {
    /// The answers in the order of the questions.
    pub answers: &'a [Answer],
    /// The lines that are marked as answers and cannot be read.
    pub unread: Vec<UnreadAnswer>,
    /// The configuration in which what is decided was recorded, if anything was.
    pub recorded_in: Option<String>,
    /// Whether a decision is not confirmed because the build is not known.
    pub lacks_build: bool,
}

impl AnswersReport<'_> {
    /// The answers as JSON.
    pub fn render_json(&self) -> String {
        let answers = self.answers.iter().map(answer_record);
        to_json(&json!({
            "schema": 1,
            "headline": answers_headline(self.answers),
            "answers": answers.collect::<Vec<_>>(),
            "unread": self.unread,
            "recorded_in": self.recorded_in,
            "lacks_build": self.lacks_build,
        }))
    }

    /// The answers; a reason for several undecidable ones is given once.
    pub fn document(&self) -> Document<'static> {
        answers_document(self.answers)
    }
}

fn answer_record(answer: &Answer) -> Value {
    let facts = answer.question.facts();
    let reading = match answer.verdict {
        AnswerVerdict::Reading(reading) => Some(answer.question.name_of(reading)),
        AnswerVerdict::Undecidable => None,
    };
    json!({
        "rule": facts.rule,
        "question": facts.question,
        "axis": answer.axis,
        "build": answer.build.map(|it| it.to_string()),
        "answer": answer.word(),
        "reading": reading,
        "evidence": answer.evidence,
    })
}

/// The verdict: how many questions are answered, and how many are not.
fn answers_headline(answers: &[Answer]) -> Headline {
    let undecided = |it: &&Answer| it.verdict == AnswerVerdict::Undecidable;
    let undecided = answers.iter().filter(undecided).count();
    let answered = match answers.len() - undecided {
        0 => "no question answered".to_owned(),
        answered => format!("{} answered", counted(answered, "question")),
    };
    let left = match undecided {
        0 => String::new(),
        left => format!(", {left} left open"),
    };
    Headline::new(Standing::Plain, format!("{answered}{left}"))
}

fn answers_document(answers: &[Answer]) -> Document<'static> {
    let mut out = Document::new("Answers of the control", answers_headline(answers));
    out.push_str("\n");
    let is_alike = |one: &Answer, other: &Answer| {
        one.verdict == AnswerVerdict::Undecidable
            && one.verdict == other.verdict
            && (&one.axis, one.build, &one.evidence) == (&other.axis, other.build, &other.evidence)
    };
    for alike in answers.chunk_by(is_alike) {
        let answer = &alike[0];
        let question = answer.question;
        let rules: Vec<_> = alike.iter().map(|it| it.question.facts().rule).collect();
        let reading = match answer.verdict {
            AnswerVerdict::Reading(reading) => format!(": {}", question.name_of(reading)),
            AnswerVerdict::Undecidable => String::new(),
        };
        let build = answer.build.map_or(String::new(), |it| format!(" on {it}"));
        let _ = writeln!(out, "{} {}{reading}", rules.join(", "), answer.word());
        let _ = writeln!(
            out,
            "  axis {}{build}: {}",
            visible_line(&answer.axis),
            visible_line(&answer.evidence)
        );
    }
    out
}

/// Returns the basis of the reading in force, in words.
fn basis(question: Question, machine: &Machine, build: Option<CncBuild>) -> String {
    let readings = &machine.readings;
    let name = readings.name(question);
    match readings.basis(question, build) {
        Basis::Confirmed(it) => format!("{name}, confirmed on {} ({})", it.build, it.date),
        Basis::Selected => format!("{name}, selected, not confirmed on this build"),
        Basis::Assumed if readings.of(question).is_none() => "open, taken as unknown".to_owned(),
        Basis::Assumed => format!("{name}, assumed"),
    }
}

/// Returns the verdict: how many questions the control has answered.
fn headline(machine: &Machine, build: Option<CncBuild>) -> Headline {
    let bases = Question::ALL.map(|it| machine.readings.basis(it, build));
    let confirmed = bases.iter().filter(|it| matches!(it, Basis::Confirmed(_)));
    let selected = bases.iter().filter(|it| matches!(it, Basis::Selected));
    let (confirmed, selected) = (confirmed.count(), selected.count());
    let assumed = bases.len() - confirmed - selected;
    let cure = if confirmed < bases.len() {
        "; `frictcomp ask write` writes the programs that ask the control"
    } else {
        ""
    };
    let text = format!(
        "{}: {confirmed} confirmed, {selected} selected, {assumed} assumed{cure}",
        counted(bases.len(), "question")
    );
    Headline::new(Standing::Plain, text)
}

fn record(question: Question, machine: &Machine) -> Value {
    let facts = question.facts();
    let confirmation = machine.readings.confirmation(question);
    json!({
        "rule": facts.rule,
        "question": facts.question,
        "readings": facts.readings,
        "assumed": facts.assumed_name(),
        "reading": machine.readings.name(question),
        "confirmed": confirmation.map(|it| json!({ "build": it.build.to_string(), "date": it.date })),
        "way": facts.way.as_str(),
        "depends": facts.depends,
        "how": facts.how,
    })
}
