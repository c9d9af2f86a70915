//! The answers of a control.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use super::control::AskedAxis;
use super::programs::{TAG, fingerprint};
use frictcomp::readings::{Alternative, Question, Way};
use frictcomp::text::shown_path;
use frictcomp_recordings::evidence::{Answer, AnswerVerdict, UnreadAnswer};

/// The values of one run, by their words; the last value of a word counts.
type Values = BTreeMap<String, String>;

/// The values left by one run, with the operator's notes.
#[derive(Default)]
struct AskedRun {
    /// The fingerprint of the program.
    print: String,
    values: Values,
    /// The readings named in notes.
    noted: BTreeSet<String>,
}

/// Reads the answers in the text of a file, in the order of the questions, and the lines that are marked as answers
/// but cannot be read. `axis` returns what else is known of an axis by its
/// name, as when the programs were written.
pub(super) fn read_answers(
    (path, text): (&Path, &str),
    axis: impl Fn(&str) -> AskedAxis,
) -> (Vec<Answer>, Vec<UnreadAnswer>) {
    let mut unread = Vec::new();
    let mut runs: BTreeMap<(Question, String, String), AskedRun> = BTreeMap::new();
    for (at, line) in text.lines().enumerate() {
        let mut leave = |reason: String| {
            unread.push(UnreadAnswer {
                file: shown_path(path),
                line: at + 1,
                reason,
            });
        };
        let Some(found) = line.find(TAG) else {
            continue;
        };
        let words: Vec<&str> = line[found..].split_whitespace().collect();
        let [_, rule, print, name, build, word, rest @ ..] = words.as_slice() else {
            leave(format!(
                "after `{TAG}` an answer has a rule, a fingerprint, an axis, a build and what was seen"
            ));
            continue;
        };
        let Some(question) = Question::of_rule(rule) else {
            leave(format!("there is no question `{rule}`"));
            continue;
        };
        let key = (question, (*name).to_owned(), (*build).to_owned());
        let run = runs.entry(key).or_default();
        (*print).clone_into(&mut run.print);
        let value = rest.join(" ");
        match *word {
            "reading" => {
                run.noted.insert(value);
            }
            "begin" => (run.values, run.noted) = Default::default(),
            _ => {
                run.values.insert((*word).to_owned(), value);
            }
        }
    }
    let answers = runs.into_iter().map(|((question, name, build), run)| {
        let asked = fingerprint(question, &axis(&name));
        let judged = if run.print == asked {
            judge(question, &run)
        } else {
            Err(format!(
                "the programs that asked have the fingerprint {}, this version writes {asked}; write them again",
                run.print
            ))
        };
        let (verdict, evidence) = match judged {
            Ok((reading, evidence)) => (AnswerVerdict::Reading(reading), evidence),
            Err(reason) => (AnswerVerdict::Undecidable, reason),
        };
        Answer {
            question,
            axis: name,
            build: build.parse().ok(),
            verdict,
            evidence,
        }
    });
    (answers.collect(), unread)
}

/// A reading with its evidence, or the reason for none.
type Judged = Result<(Alternative, String), String>;

/// Returns the reading that the run of a question shows, or that a note on it names.
fn judge(question: Question, run: &AskedRun) -> Judged {
    if !run.noted.is_empty() {
        return judge_noted(question, &run.noted);
    }
    let values = &run.values;
    if question.facts().way != Way::Program {
        return Err("what was seen is not written down yet".to_owned());
    }
    match question {
        Question::LowerCase
        | Question::OffUnconfigured
        | Question::OnWithoutList
        | Question::RemedyClass
        | Question::Undeclared
        | Question::JumpInto
        | Question::Described
        | Question::ProgramNumber => judge_refusable(question, values),
        Question::ContinueInSwitch | Question::NearlyEqual => {
            let answer = value(values, "answer")?;
            Ok((
                first_if(answer),
                format!("the value is {}", u8::from(answer)),
            ))
        }
        Question::WholeNumber => {
            let answer = value(values, "answer")?;
            Ok((
                first_if(!answer),
                format!("0.5 becomes {}", u8::from(answer)),
            ))
        }
        Question::OrderInBlock => judge_order(values),
        Question::ManualActivation => {
            let otherwise = "V.A.LEAD_COMP_INIT is 0: the axis has no leadscrew compensation";
            require(values, ("init", true), otherwise)?;
            let answer = value(values, "answer")?;
            let evidence = format!("LEAD is {} at the start", u8::from(answer));
            Ok((first_if(!answer), evidence))
        }
        Question::SkipLevel => {
            let answer = value(values, "answer")?;
            let what = if answer { "executed" } else { "skipped" };
            let evidence = format!("the marked block was {what} after the level was turned on");
            Ok((first_if(!answer), evidence))
        }
        Question::BlockSearch => {
            let otherwise = "it is not noted that a block search started the program";
            require(values, ("searched", true), otherwise)?;
            let answer = value(values, "answer")?;
            let evidence = format!("the state after the search is {}", u8::from(answer));
            Ok((first_if(!answer), evidence))
        }
        _ => {
            require(values, ("start", true), STARTS)?;
            let otherwise = "COMP OFF FRICT had no effect; the axis or its value list is not as the program requires";
            require(values, ("off", false), otherwise)?;
            let answer = value(values, "answer")?;
            let goes_back = matches!(question, Question::Restart | Question::MachineData);
            let evidence = format!("switched off, the state is {} afterwards", u8::from(answer));
            Ok((first_if(answer == goes_back), evidence))
        }
    }
}

/// Returns the reading that a note names. The lines to copy name both.
fn judge_noted(question: Question, noted: &BTreeSet<String>) -> Judged {
    let names: Vec<String> = noted.iter().map(|name| format!("`{name}`")).collect();
    let said = format!("the note says {}", names.join(" and "));
    let mut names = noted.iter();
    let (Some(name), None) = (names.next(), names.next()) else {
        return Err(format!("{said}; keep the line of what was seen"));
    };
    match question.reading(name) {
        Some(reading) => Ok((reading, said)),
        None => Err(format!(
            "{said}, which is not a reading of {}",
            question.facts().rule
        )),
    }
}

const STARTS: &str = "the axis was not active before; it needs P-AXIS-00522 = 1 and a value list";

fn value(values: &Values, word: &str) -> Result<bool, String> {
    match values.get(word).map(String::as_str) {
        Some("0") => Ok(false),
        Some("1") => Ok(true),
        Some(other) => Err(format!("`{word}` is `{other}`, neither 0 nor 1")),
        None => Err(format!("there is no line with `{word}`")),
    }
}

/// Checks a condition that must hold for the answer to count.
fn require(values: &Values, (word, wanted): (&str, bool), otherwise: &str) -> Result<(), String> {
    if value(values, word)? == wanted {
        Ok(())
    } else {
        Err(otherwise.to_owned())
    }
}

fn first_if(holds: bool) -> Alternative {
    if holds {
        Alternative::First
    } else {
        Alternative::Second
    }
}

/// Judges a command that the control accepts or refuses.
fn judge_refusable(question: Question, values: &Values) -> Judged {
    if question == Question::LowerCase {
        require(values, ("start", true), STARTS)?;
    } else if matches!(
        question,
        Question::OffUnconfigured | Question::OnWithoutList
    ) {
        let otherwise = "V.A.FRICT_COMP_INIT is 1: the axis is not as the program requires";
        require(values, ("init", false), otherwise)?;
    }
    if let Some(number) = values.get("error") {
        return refused(question, number);
    }
    let answer = value(values, "answer").map_err(|_| {
        "the program did not reach its answer; write down the error of the control".to_owned()
    })?;
    match question {
        Question::LowerCase if answer => Err("the command was taken and had no effect".to_owned()),
        Question::OnWithoutList if answer => {
            Err("the axis became active, so it has a value list".to_owned())
        }
        _ => Ok((
            Alternative::First,
            "the program continued after the command".to_owned(),
        )),
    }
}

/// Judges two blocks with opposite commands, in either order.
fn judge_order(values: &Values) -> Judged {
    require(values, ("start", true), STARTS)?;
    let (answer, other) = (value(values, "answer")?, value(values, "other")?);
    if answer == other {
        let left = if answer { "on" } else { "off" };
        return Err(format!(
            "both orders leave the axis {left}: neither reading holds"
        ));
    }
    let evidence = format!("off and on leaves {}", u8::from(answer));
    Ok((first_if(answer), evidence))
}

/// Judges an error of the control at the command in question.
fn refused(question: Question, number: &str) -> Judged {
    let number = number.trim_start_matches("P-ERR-");
    if number == "70495" && question == Question::OnWithoutList {
        return Err("P-ERR-70495 says that P-AXIS-00522 of the axis is 0".to_owned());
    }
    if number.is_empty() || !number.bytes().all(|byte| byte.is_ascii_digit()) {
        return Err("the error is noted without its number".to_owned());
    }
    Ok((
        Alternative::Second,
        format!("the control showed error {number}"),
    ))
}
