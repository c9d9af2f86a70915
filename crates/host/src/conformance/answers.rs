//! Comparison of a control's answers with the expectations (R15.11).

use std::collections::BTreeMap;

use super::case::{Case, Expectation};
use super::cycles::is_near;
use super::export::TAG;
use super::outcome::Mismatch;
use frictcomp::comp::State;
use frictcomp::readings::Alternative;

/// The answers of a control, from its `message.txt` and what the operator added.
#[derive(Debug, Clone, Default)]
pub struct Answers {
    /// Answers to queries for the activity of a kind; the last answer counts.
    states: BTreeMap<String, bool>,
    /// The error numbers of a case.
    refusals: BTreeMap<String, Vec<String>>,
    /// Currents in drive units, by case and query.
    currents: BTreeMap<String, Vec<f64>>,
}

/// Relative tolerance of an answered current.
const TOLERANCE: f64 = 1e-6;

/// Comparison of a case with the answers of a control.
#[derive(Debug, Clone, PartialEq, Eq)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub enum Compared {
    /// Case without an answer.
    Unanswered,
    /// Every answer is as expected.
    Held,
    /// Open case in which the control follows this reading.
    Reading(Alternative),
    /// Open case whose answers fit both readings, or of which an answer is missing.
    Undecided,
    /// Answers differ.
    Failed(Vec<Mismatch>),
}

impl Answers {
    /// Adds the answers of a file.
    pub fn add(&mut self, text: &str) {
        for line in text.lines() {
            let Some(found) = line.find(&format!("{TAG} ")) else {
                continue;
            };
            let words: Vec<&str> = line[found..].split_whitespace().skip(1).collect();
            match words.as_slice() {
                [case, "refused", number] => {
                    let numbers = self.refusals.entry((*case).to_owned()).or_default();
                    numbers.push(number.trim_start_matches("P-ERR-").to_owned());
                }
                [case, "current", axis, velocity, current] => {
                    self.add_currents([case, axis, velocity].map(|it| *it), &[current]);
                }
                [case, "currents", axis, currents @ ..] => {
                    self.add_currents([case, axis, "cycles"], currents);
                }
                [case, program, after, axis, kind, value @ ("0" | "1")] => {
                    let key = [*case, program, after, axis, kind].join(" ");
                    self.states.insert(key, *value == "1");
                }
                _ => {}
            }
        }
    }

    /// Adds currents; words that are not numbers do not count as answers.
    fn add_currents(&mut self, asked: [&str; 3], words: &[&str]) {
        let numbers = words.iter().map(|it| it.parse());
        if let Ok(numbers) = numbers.collect::<Result<Vec<f64>, _>>() {
            self.currents.insert(asked.join(" "), numbers);
        }
    }

    /// Returns the number of answers.
    pub fn len(&self) -> usize {
        self.states.len() + self.refusals.len() + self.currents.len()
    }

    /// Returns whether no answer is given.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Compares a case with the answers.
    pub fn compare(&self, case: &Case) -> Compared {
        let plain = self.judge(case, &case.expected);
        if case.readings.is_empty() {
            return match plain {
                None => Compared::Unanswered,
                Some(failed) if failed.is_empty() => Compared::Held,
                Some(failed) => Compared::Failed(failed),
            };
        }
        let under = case
            .readings
            .iter()
            .map(|(reading, expected)| (*reading, self.judge(case, expected)));
        let answered: Vec<_> = under
            .filter_map(|(reading, found)| Some((reading, found?)))
            .collect();
        let mut fitting = answered.iter().filter(|(_, failed)| failed.is_empty());
        match (fitting.next(), fitting.next()) {
            _ if answered.is_empty() => Compared::Unanswered,
            (Some((reading, _)), None) => Compared::Reading(*reading),
            (Some(_), Some(_)) => Compared::Undecided,
            (None, _) => {
                let failed = answered.into_iter().flat_map(|(_, failed)| failed);
                Compared::Failed(failed.collect())
            }
        }
    }

    /// Returns the differences from some expectations; `None` where none of them has an answer.
    fn judge(&self, case: &Case, expected: &[Expectation]) -> Option<Vec<Mismatch>> {
        let refused = self.refusals.get(&case.name);
        let mut is_answered = refused.is_some();
        let mut failed = Vec::new();
        for it in expected {
            let found = match it {
                Expectation::State {
                    program,
                    after,
                    axis,
                    kind,
                    state,
                } => {
                    let key = format!("{} {program} {after} {axis} {kind}", case.name);
                    let Some(&active) = self.states.get(&key) else {
                        continue;
                    };
                    is_answered = true;
                    let is_open = *state == State::Unknown;
                    let differs = !is_open && active != (*state == State::Active);
                    differs.then(|| if active { "active" } else { "not active" }.to_owned())
                }
                Expectation::Refusal { code, .. } => {
                    let number = code.trim_start_matches("P-ERR-");
                    let is_it = |it: &String| code == "error" || it == number;
                    match refused {
                        Some(numbers) if numbers.iter().any(is_it) => None,
                        Some(numbers) => Some(numbers.join(", ")),
                        None if self.has_states(case) => {
                            Some("no error was written down".to_owned())
                        }
                        None => None,
                    }
                }
                Expectation::Current {
                    axis,
                    velocity,
                    current,
                } => {
                    let key = format!("{} {axis} {velocity}", case.name);
                    let Some([found]) = self.currents.get(&key).map(Vec::as_slice) else {
                        continue;
                    };
                    is_answered = true;
                    (!is_near(*found, *current, TOLERANCE)).then(|| format!("{found} drive units"))
                }
                Expectation::Currents(cycles) => {
                    let key = format!("{} {} cycles", case.name, cycles.axis);
                    let Some(found) = self.currents.get(&key) else {
                        continue;
                    };
                    is_answered = true;
                    cycles.differs_in(found, TOLERANCE)
                }
            };
            failed.extend(found.map(|found| Mismatch {
                file: case.file.clone(),
                expected: it.to_string(),
                found,
            }));
        }
        let wanted = |it: &Expectation| matches!(it, Expectation::Refusal { .. });
        if let Some(numbers) = refused.filter(|_| !expected.iter().any(wanted)) {
            failed.push(Mismatch {
                file: case.file.clone(),
                expected: "no refusal".to_owned(),
                found: numbers.join(", "),
            });
        }
        (is_answered || !failed.is_empty()).then_some(failed)
    }

    fn has_states(&self, case: &Case) -> bool {
        let begin = format!("{} ", case.name);
        self.states.keys().any(|key| key.starts_with(&begin))
    }
}
