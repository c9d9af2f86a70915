//! The conditions that only the machine can decide, and the answers that are tried.

use std::sync::Arc;

use frictcomp::interpreter::WayCondition;
use frictcomp::machine::Setting;
use frictcomp::session::SessionOptions;
use frictcomp::syntax::SkipLevels;
use frictcomp_recordings::replay::TriedCondition;

/// Largest number of combinations of answers that are tried.
pub(super) const MAX_WAYS: usize = 64;

/// A condition that only the machine can decide.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Condition {
    file: Arc<str>,
    line: u32,
    asked: ConditionKey,
}

#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
enum ConditionKey {
    /// Execution of the blocks of a skip level.
    Skip(u8),
    /// A comparison as written.
    Text(Arc<str>),
}

impl Condition {
    /// Returns the condition of a way, if it can be given an answer.
    pub(super) fn of(condition: &WayCondition) -> Option<Self> {
        match condition {
            WayCondition::Condition(asked) => {
                WrittenComparison::parse(&asked.text)?;
                Some(Self {
                    file: Arc::clone(&asked.file),
                    line: asked.line,
                    asked: ConditionKey::Text(Arc::clone(&asked.text)),
                })
            }
            WayCondition::Skip {
                level, file, line, ..
            } => Some(Self {
                file: Arc::clone(file),
                line: *line,
                asked: ConditionKey::Skip(*level),
            }),
            _ => None,
        }
    }

    fn comparison(&self) -> Option<WrittenComparison<'_>> {
        match &self.asked {
            ConditionKey::Text(text) => WrittenComparison::parse(text),
            ConditionKey::Skip(_) => None,
        }
    }
}

/// `V.E.A == 2`.
struct WrittenComparison<'a> {
    variable: &'a str,
    operator: &'static str,
    constant: f64,
}

impl<'a> WrittenComparison<'a> {
    fn parse(text: &'a str) -> Option<Self> {
        const OPERATORS: [&str; 6] = ["==", "!=", ">=", "<=", ">", "<"];
        let mut found = OPERATORS.into_iter();
        let (operator, (variable, constant)) =
            found.find_map(|it| Some((it, text.split_once(it)?)))?;
        let variable = variable.trim();
        let is_name = |it: char| it.is_ascii_alphanumeric() || "._[]".contains(it);
        let is_external = variable.to_uppercase().starts_with("V.");
        let constant: f64 = constant.trim().parse().ok()?;
        (is_external && variable.chars().all(is_name)).then_some(Self {
            variable,
            operator,
            constant,
        })
    }

    // A value is either one of the constants, or clearly different.
    #[allow(clippy::float_cmp)]
    fn holds(&self, value: f64) -> bool {
        match self.operator {
            "==" => value == self.constant,
            "!=" => value != self.constant,
            ">=" => value >= self.constant,
            "<=" => value <= self.constant,
            ">" => value > self.constant,
            _ => value < self.constant,
        }
    }
}

/// An open condition, with its different answers.
enum Knob {
    Variable { name: String, values: Vec<f64> },
    Level(u8),
}

/// One answer to each open condition.
#[derive(Debug, Clone, Default)]
pub(super) struct AssumedAnswers {
    values: Vec<(String, f64)>,
    skipped: Vec<(u8, bool)>,
}

impl AssumedAnswers {
    /// Returns every distinct combination of answers to conditions.
    ///
    /// # Errors
    /// The number of combinations, if there are too many.
    pub(super) fn all(conditions: &[Condition]) -> Result<Vec<Self>, usize> {
        let knobs = knobs(conditions);
        let sizes = knobs.iter().map(|knob| match knob {
            Knob::Variable { values, .. } => values.len(),
            Knob::Level(_) => 2,
        });
        let count = sizes.fold(1_usize, usize::saturating_mul);
        if count > MAX_WAYS {
            return Err(count);
        }
        let mut all = vec![Self::default()];
        for knob in &knobs {
            all = all.iter().flat_map(|answers| answers.with(knob)).collect();
        }
        Ok(all)
    }

    fn with(&self, knob: &Knob) -> Vec<Self> {
        match knob {
            Knob::Variable { name, values } => {
                let each = values.iter().map(|value| {
                    let mut answers = self.clone();
                    answers.values.push((name.clone(), *value));
                    answers
                });
                each.collect()
            }
            Knob::Level(level) => {
                let each = [false, true].into_iter().map(|is_on| {
                    let mut answers = self.clone();
                    answers.skipped.push((*level, is_on));
                    answers
                });
                each.collect()
            }
        }
    }

    /// Returns the options of a run with these answers.
    pub(super) fn options(&self, options: &SessionOptions) -> SessionOptions {
        let mut options = options.clone();
        let settings = self.values.iter();
        let settings = settings.map(|(name, value)| (name.clone(), Setting::Number(*value)));
        options.settings.extend(settings);
        if !self.skipped.is_empty() {
            let on = self.skipped.iter().filter(|(_, is_on)| *is_on);
            let levels = on.fold(SkipLevels::NONE, |levels, (level, _)| {
                levels.with(*level).unwrap_or(levels)
            });
            options.run.skip = Some(levels);
        }
        options
    }

    /// Returns the conditions with these answers.
    pub(super) fn to(&self, conditions: &[Condition]) -> Vec<TriedCondition> {
        let tried = conditions.iter().filter_map(|condition| {
            let (text, holds) = match &condition.asked {
                ConditionKey::Skip(level) => {
                    let (_, is_on) = self.skipped.iter().find(|(it, _)| it == level)?;
                    (format!("skip level {level} is off"), !is_on)
                }
                ConditionKey::Text(text) => {
                    let comparison = condition.comparison()?;
                    let mut values = self.values.iter();
                    let (_, value) = values.find(|(name, _)| name == comparison.variable)?;
                    (text.to_string(), comparison.holds(*value))
                }
            };
            Some(TriedCondition {
                file: Arc::clone(&condition.file),
                line: condition.line,
                condition: text,
                holds,
            })
        });
        tried.collect()
    }
}

fn knobs(conditions: &[Condition]) -> Vec<Knob> {
    let mut knobs: Vec<Knob> = Vec::new();
    for condition in conditions {
        let is_known = knobs.iter().any(|knob| match (knob, &condition.asked) {
            (Knob::Level(known), ConditionKey::Skip(level)) => known == level,
            (Knob::Variable { name, .. }, ConditionKey::Text(_)) => {
                condition.comparison().is_some_and(|it| it.variable == name)
            }
            _ => false,
        });
        if is_known {
            continue;
        }
        match (&condition.asked, condition.comparison()) {
            (ConditionKey::Skip(level), _) => knobs.push(Knob::Level(*level)),
            (_, Some(comparison)) => knobs.push(Knob::Variable {
                name: comparison.variable.to_owned(),
                values: values_of(comparison.variable, conditions),
            }),
            _ => {}
        }
    }
    knobs
}

/// Returns values of a variable, one for each set of answers to the comparisons with it.
fn values_of(variable: &str, conditions: &[Condition]) -> Vec<f64> {
    let comparisons = conditions.iter().filter_map(Condition::comparison);
    let comparisons: Vec<_> = comparisons.filter(|it| it.variable == variable).collect();
    let mut constants: Vec<f64> = comparisons.iter().map(|it| it.constant).collect();
    constants.sort_by(f64::total_cmp);
    constants.dedup();
    let beside = constants.iter().flat_map(|it| [it + 1.0, it - 1.0]);
    let between = constants
        .windows(2)
        .map(|pair| f64::midpoint(pair[0], pair[1]));
    let mut seen: Vec<Vec<bool>> = Vec::new();
    let mut values = Vec::new();
    for value in constants.iter().copied().chain(beside).chain(between) {
        let answers: Vec<bool> = comparisons.iter().map(|it| it.holds(value)).collect();
        if !seen.contains(&answers) {
            seen.push(answers);
            values.push(value);
        }
    }
    values
}
