//! The readings of the documents where they are silent.

use std::fmt;
use std::str::FromStr;

use thiserror::Error;

use frictcomp::diagnostic::did_you_mean;
use frictcomp::lists::FrictionList;
use frictcomp::readings::{Alternative, Question, QuestionSet, Readings};

/// Interpretation of the documents where they are silent (R4.2, R4.3, R4.5 to R4.7). The default is the assumption
/// unless the user selects otherwise.
///
/// It is written in reports, and can be given, as text:
///
/// ```
/// use frictcomp_physics::current::{Delay, Reading};
///
/// let reading: Reading = "delay=reversal".parse()?;
/// assert_eq!(reading.delay, Delay::Reversal);
/// assert_eq!(reading.to_string(), "standstill=hold,below=hold,delay=reversal,start=first");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Reading {
    /// The value while the axis is at standstill.
    pub standstill: Standstill,
    /// The value below the first point of the table.
    pub below: Below,
    /// Quantity that `delay_cycles` postpones.
    pub delay: Delay,
    /// The starts after which the current builds up.
    pub start: Start,
    /// Decay of the current before a reversal.
    pub decay: Decay,
}

/// The value while the axis is at standstill (R4.6).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[non_exhaustive]
pub enum Standstill {
    /// The direction of the last motion is remembered and the value held.
    #[default]
    Hold,
    /// No current is added.
    Zero,
}

/// The value below the first point of the table (R4.7).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[non_exhaustive]
pub enum Below {
    /// The first output is held.
    #[default]
    Hold,
    /// A line from (0, 0) to the first point.
    Origin,
}

/// Quantity that `delay_cycles` postpones (R4.5).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[non_exhaustive]
pub enum Delay {
    /// The whole output: a dead time.
    #[default]
    All,
    /// Only the build-up after a reversal.
    Reversal,
}

/// The starts after which the current builds up, in addition to reversals (R4.3).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[non_exhaustive]
pub enum Start {
    /// The first start only.
    #[default]
    First,
    /// Every start after a standstill, even in the same direction.
    Every,
}

/// Decay of the current over the cycles of `reversal_lookahead` (R4.2).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[non_exhaustive]
pub enum Decay {
    /// Decay by the same part in each cycle.
    #[default]
    Linear,
    /// Decay to zero in the first cycle.
    Step,
}

/// Makes a choice.
type Choose = fn(&mut Reading);

/// The options; of those that exclude each other one is always in force.
const OPTIONS: [(&str, Choose); 10] = [
    ("standstill=hold", |it| it.standstill = Standstill::Hold),
    ("standstill=zero", |it| it.standstill = Standstill::Zero),
    ("below=hold", |it| it.below = Below::Hold),
    ("below=origin", |it| it.below = Below::Origin),
    ("delay=all", |it| it.delay = Delay::All),
    ("delay=reversal", |it| it.delay = Delay::Reversal),
    ("start=first", |it| it.start = Start::First),
    ("start=every", |it| it.start = Start::Every),
    ("decay=linear", |it| it.decay = Decay::Linear),
    ("decay=step", |it| it.decay = Decay::Step),
];

/// The questions that a recording answers, and the option of each.
const QUESTIONS: [(Question, &str); 5] = [
    (Question::Standstill, "standstill"),
    (Question::Below, "below"),
    (Question::Delay, "delay"),
    (Question::Start, "start"),
    (Question::Decay, "decay"),
];

impl Reading {
    /// Sets the reading of a question; has no effect if the question does not concern the current.
    pub fn with(mut self, question: Question, reading: Alternative) -> Self {
        self.choose(question, question.name_of(reading));
        self
    }

    /// Returns the questions whose readings, as selected by a machine, decide the current of a list (R4.2 to R4.7,
    /// R15.3); those that were chosen otherwise are not among them.
    pub fn rests_on(self, readings: &Readings, list: &FrictionList) -> QuestionSet {
        let mut questions = QuestionSet::default();
        let Some(first) = list.table.first() else {
            return questions;
        };
        for (question, decides) in [
            (Question::Standstill, true),
            (Question::Below, first.input > 0.0),
            (Question::Delay, list.delay_cycles > 0),
            (Question::Start, list.position_delay > 0),
            (Question::Decay, list.reversal_lookahead > 1),
        ] {
            let mut of_machine = self;
            of_machine.choose(question, readings.name(question));
            if decides && of_machine == self {
                questions.insert(question);
            }
        }
        questions
    }

    fn choose(&mut self, question: Question, name: &str) {
        let key = QUESTIONS.iter().find(|(it, _)| *it == question);
        let word = key.map(|(_, key)| format!("{key}={name}"));
        let chosen = OPTIONS
            .iter()
            .find(|(option, _)| word.as_deref() == Some(*option));
        if let Some((_, choose)) = chosen {
            choose(self);
        }
    }
}

/// A word that is not an option of a reading.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("`{word}` is not a reading{help}")]
pub struct UnknownReading {
    /// The word as written.
    pub word: String,
    help: String,
}

/// The options that a user chose, over those of a machine.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct ChosenOptions(Vec<usize>);

impl ChosenOptions {
    /// Returns the reading of a machine with these options in place of its own.
    pub fn over(&self, mut reading: Reading) -> Reading {
        for (_, choose) in self.0.iter().filter_map(|&option| OPTIONS.get(option)) {
            choose(&mut reading);
        }
        reading
    }
}

impl FromStr for ChosenOptions {
    type Err = UnknownReading;

    /// Reads an option as for [`Reading`].
    fn from_str(text: &str) -> Result<Self, Self::Err> {
        let words = text.split(',').map(str::trim);
        let words = words.filter(|word| !word.is_empty());
        let chosen = words.map(|word| {
            let found = OPTIONS.iter().position(|(option, _)| *option == word);
            found.ok_or_else(|| UnknownReading::new(word))
        });
        chosen.collect::<Result<_, _>>().map(Self)
    }
}

impl UnknownReading {
    fn new(word: &str) -> Self {
        let known = OPTIONS.map(|(option, _)| option);
        Self {
            word: word.to_owned(),
            help: match did_you_mean(word, known) {
                Some(near) => format!(", did you mean `{near}`?"),
                None => format!("; the readings are {}", known.join(", ")),
            },
        }
    }
}

impl fmt::Display for Reading {
    /// Writes every option that is in force: `standstill=hold,below=hold,delay=all,start=first`, and `decay=step` if
    /// that is selected.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let in_force = OPTIONS.iter().filter(|(choice, choose)| {
            let mut chosen = *self;
            choose(&mut chosen);
            chosen == *self && *choice != "decay=linear"
        });
        let options: Vec<&str> = in_force.map(|(option, _)| *option).collect();
        f.pad(&options.join(","))
    }
}

impl From<&Readings> for Reading {
    /// Returns the selection in `[reading]` of a machine's configuration.
    fn from(readings: &Readings) -> Self {
        let mut reading = Self::default();
        for (question, _) in QUESTIONS {
            reading.choose(question, readings.name(question));
        }
        reading
    }
}

impl FromStr for Reading {
    type Err = UnknownReading;

    /// Reads `standstill=zero,below=origin,delay=reversal`, each of them optional; of two that exclude each other the
    /// later one counts.
    fn from_str(text: &str) -> Result<Self, Self::Err> {
        let chosen: ChosenOptions = text.parse()?;
        Ok(chosen.over(Self::default()))
    }
}
