//! The readings of the additive current, from its recording (R4.2, R4.3, R4.5 to R4.7).

use super::answer::Conclusion;
use super::doubts::{no_difference, not_moved, unseen};
use super::fit::{Counted, Explained, Model};
use super::recorded::{CycleMotion, EvidenceRecording};
use frictcomp::diagnostic::ReadableNumber;
use frictcomp::lists::FrictionList;
use frictcomp::readings::{Alternative, Question};
use frictcomp_physics::current::Reading;

/// The questions that the additive current answers.
const QUESTIONS: [Question; 5] = [
    Question::Decay,
    Question::Start,
    Question::Delay,
    Question::Standstill,
    Question::Below,
];

/// Samples in which two combinations differ by less than this part of the largest current do not count.
const DIFFERS: f64 = 0.02;

/// Minimum number of samples for a decision.
const LEAST_SAMPLES: usize = 3;

/// Minimum ratio of the difference of two combinations in all samples to the noise of one.
const CLEAR: f64 = 10.0;

/// The part of the largest current by which a sample may differ from its explanation.
const MISFIT: f64 = 0.1;

/// The part of the samples that may be unexplained.
const UNEXPLAINED: f64 = 0.02;

/// Largest noise as a part of the largest current.
const NOISIEST: f64 = 0.25;

/// The part by which the recorded current as a whole may be larger or smaller than that of the list.
const GAIN: f64 = 0.1;

/// Judges the five questions on the additive current by the recording of an axis with its value list.
pub fn judge_currents(recorded: &EvidenceRecording, list: &FrictionList) -> Vec<Conclusion> {
    let judged = Judgement::of(recorded, list);
    let evidence = QUESTIONS.into_iter().map(|question| {
        let shown = match (no_difference(question, list), &judged) {
            (Some(reason), _) => Err(reason),
            (None, Ok(judgement)) => judgement.on(question),
            (None, Err(reason)) => Err(reason.clone()),
        };
        Conclusion::of(question, shown)
    });
    evidence.collect()
}

/// The explanation of the recording, for the questions.
struct Judgement<'a> {
    recorded: &'a EvidenceRecording,
    list: &'a FrictionList,
    motion: CycleMotion,
    counted: Counted,
    best: Explained,
    /// The noise of a sample.
    noise: f64,
    amplitude: f64,
    /// The questions on which the current of this list depends.
    open: Vec<Question>,
}

/// Margin by which the recording deviates from a combination.
struct Margin {
    rival: Explained,
    /// Samples in which it differs from the best one.
    samples: usize,
    /// The difference in all of them.
    difference: f64,
    /// 1 if the recording follows the best one, 0 if it follows the rival.
    share: f64,
}

impl<'a> Judgement<'a> {
    fn of(recorded: &'a EvidenceRecording, list: &'a FrictionList) -> Result<Self, String> {
        if recorded.current.is_none() {
            return Err("the recording has no additive current".to_owned());
        }
        let motion = recorded.motion()?;
        let counted = Counted::of(recorded, &motion, list);
        if counted.samples.is_empty() {
            return Err(unseen(recorded, &motion).to_owned());
        }
        let open: Vec<Question> = QUESTIONS
            .into_iter()
            .filter(|question| no_difference(*question, list).is_none())
            .collect();
        let model = Model {
            motion: &motion,
            list,
            torque_scale: recorded.torque_scale,
        };
        let all = combinations(&open).flat_map(|reading| model.explain(reading, &counted));
        let mut best: Option<(f64, Explained)> = None;
        for explained in all {
            let cost = explained.cost(&counted);
            // Of equal ones the first counts, which has the assumed readings and no shift.
            if best.as_ref().is_none_or(|(least, _)| cost < *least) {
                best = Some((cost, explained));
            }
        }
        let (_, best) = best.ok_or("nothing explains the recording")?;
        let amplitude = best.amplitude();
        let noise = noise_of(&best, &counted).max(0.01 * amplitude);
        let judgement = Self {
            recorded,
            list,
            motion,
            counted,
            best,
            noise,
            amplitude,
            open,
        };
        judgement.check()?;
        Ok(judgement)
    }

    /// Checks that the best combination explains the recording at all.
    fn check(&self) -> Result<(), String> {
        if self.amplitude == 0.0 {
            return Err("the value list gives no current in this motion".to_owned());
        }
        let samples = &self.counted.samples;
        if samples.iter().all(|(_, current)| *current == 0.0) {
            return Err(
                "the recorded current is 0 throughout: compensation was off, or another axis was recorded"
                    .to_owned(),
            );
        }
        let pairs = || self.best.currents.iter().zip(samples);
        let square: f64 = pairs().map(|(current, _)| current * current).sum();
        let common: f64 = pairs().map(|(current, (_, it))| current * it).sum();
        let gain = common / square;
        if (gain - 1.0).abs() > GAIN {
            return Err(format!(
                "the recorded current is {} times that of the value list: it has another unit, or another \
                 list or axis was recorded",
                ReadableNumber(rounded(gain))
            ));
        }
        let rests = || self.best.rests(&self.counted);
        let allowed = (MISFIT * self.amplitude).max(4.0 * self.noise);
        #[allow(clippy::cast_precision_loss)] // samples of a file
        let unexplained = rests().filter(|it| *it > allowed).count() as f64 / samples.len() as f64;
        if unexplained > UNEXPLAINED || self.noise > NOISIEST * self.amplitude {
            let most = rests().fold(0.0, f64::max);
            return Err(format!(
                "no combination of readings explains the recorded current: it differs from the nearest one by {} \
                 at most, mostly by less than {}; another list or axis, or another CNC cycle than {} ms?",
                ReadableNumber(rounded(most)),
                ReadableNumber(rounded(2.0 * self.noise)),
                ReadableNumber(rounded(self.motion.cycle_s * 1000.0))
            ));
        }
        Ok(())
    }

    fn on(&self, question: Question) -> Result<(Alternative, String), String> {
        let counts_cycles = matches!(question, Question::Decay | Question::Delay);
        if counts_cycles && !self.recorded.has_every_cycle() {
            return Err(self.too_coarse());
        }
        let reading = taken(self.best.hypothesis.reading, question);
        let model = Model {
            motion: &self.motion,
            list: self.list,
            torque_scale: self.recorded.torque_scale,
        };
        let rivals = combinations(&self.open).filter(|it| taken(*it, question) != reading);
        let rivals = rivals.flat_map(|it| model.explain(it, &self.counted));
        let mut closest: Option<Margin> = None;
        for rival in rivals {
            let margin = self.margin(rival);
            let is_clear =
                margin.samples >= LEAST_SAMPLES && margin.difference >= CLEAR * self.noise;
            if !is_clear {
                return Err(self.not_told(question, &margin));
            }
            if (margin.share - 1.0).abs() > 0.25 {
                return Err(format!(
                    "the recorded current follows neither reading: {}",
                    self.at_most(question, &margin)
                ));
            }
            if closest
                .as_ref()
                .is_none_or(|it| margin.difference < it.difference)
            {
                closest = Some(margin);
            }
        }
        let closest = closest.ok_or("nothing explains the recording")?;
        let mut words = self.at_most(question, &closest);
        let shift = self.best.hypothesis.shift;
        if shift != 0 {
            let (cycles, when) = (
                shift.unsigned_abs(),
                if shift > 0 { "after" } else { "before" },
            );
            words = format!("{words}; the current comes {cycles} cycles {when} the motion");
        }
        Ok((reading, words))
    }

    fn margin(&self, rival: Explained) -> Margin {
        let least = DIFFERS * self.amplitude;
        let (mut samples, mut square, mut along) = (0, 0.0, 0.0);
        let pairs = self.best.currents.iter().zip(&rival.currents);
        for ((best, other), (_, recorded)) in pairs.zip(&self.counted.samples) {
            let difference = best - other;
            if difference.abs() > least {
                samples += 1;
                square += difference * difference;
                along += (recorded - other) * difference;
            }
        }
        Margin {
            rival,
            samples,
            difference: f64::sqrt(square),
            share: if square > 0.0 { along / square } else { 0.0 },
        }
    }

    /// Returns the sample in which two combinations differ most.
    fn at_most(&self, question: Question, margin: &Margin) -> String {
        let pairs = self.best.currents.iter().zip(&margin.rival.currents);
        let differences = pairs.map(|(best, other)| (best - other).abs()).enumerate();
        let most = differences.max_by(|(_, one), (_, other)| one.total_cmp(other));
        let at = most.map_or(0, |(at, _)| at);
        let (cycle, recorded) = self.counted.samples[at];
        let row = self.motion.rows[cycle];
        let [own, other] = [self.best.hypothesis, margin.rival.hypothesis]
            .map(|it| question.name_of(taken(it.reading, question)));
        format!(
            "at {:.3} s and {} µm/s the current is {}, `{own}` gives {}, `{other}` {}; {} samples tell them apart",
            row.time_s,
            ReadableNumber(rounded(row.velocity)),
            ReadableNumber(rounded(recorded)),
            ReadableNumber(rounded(self.best.currents[at])),
            ReadableNumber(rounded(margin.rival.currents[at])),
            margin.samples
        )
    }

    /// Returns the reason why the recording does not distinguish a reading from another.
    fn not_told(&self, question: Question, margin: &Margin) -> String {
        if let Some(reason) = not_moved(question, self.list, &self.motion) {
            return reason;
        }
        let other = QUESTIONS.into_iter().find(|it| {
            let [own, other] = [self.best.hypothesis, margin.rival.hypothesis]
                .map(|hypothesis| taken(hypothesis.reading, *it));
            *it != question && own != other
        });
        match other {
            Some(other) if margin.samples < LEAST_SAMPLES => format!(
                "another answer to {} looks the same in this motion; record one that tells both",
                other.facts().rule
            ),
            _ if margin.samples < LEAST_SAMPLES && !self.recorded.has_every_cycle() => {
                self.too_coarse()
            }
            _ if margin.samples < LEAST_SAMPLES => format!(
                "the readings differ in {} samples only, less than {LEAST_SAMPLES}",
                margin.samples
            ),
            _ => format!(
                "the noise of {} hides the difference of the readings",
                ReadableNumber(rounded(self.noise))
            ),
        }
    }

    fn too_coarse(&self) -> String {
        format!(
            "it is sampled every {} ms, and the CNC cycle has {} ms: record every cycle",
            ReadableNumber(rounded(self.recorded.step_s() * 1000.0)),
            ReadableNumber(rounded(self.motion.cycle_s * 1000.0))
        )
    }
}

/// Returns every combination of readings of some questions, the assumed ones first.
fn combinations(open: &[Question]) -> impl Iterator<Item = Reading> {
    let open = open.to_vec();
    (0..1_u32 << open.len()).map(move |bits| {
        let chosen = open.iter().enumerate();
        let second = chosen.filter(|(at, _)| bits & 1 << at != 0);
        second.fold(Reading::default(), |reading, (_, question)| {
            reading.with(*question, Alternative::Second)
        })
    })
}

/// Returns the reading of a question in a combination.
fn taken(reading: Reading, question: Question) -> Alternative {
    if reading == reading.with(question, Alternative::First) {
        Alternative::First
    } else {
        Alternative::Second
    }
}

/// Returns the usual difference of the samples from their explanation, as a standard deviation.
fn noise_of(best: &Explained, counted: &Counted) -> f64 {
    let mut rests: Vec<f64> = best.rests(counted).collect();
    let middle = rests.len() / 2;
    let (_, median, _) = rests.select_nth_unstable_by(middle, f64::total_cmp);
    1.4826 * *median
}

fn rounded(value: f64) -> f64 {
    (value * 1000.0).round() / 1000.0
}
