//! Answers in recordings (R15.2).

use std::path::Path;

use super::control::AskedAxis;
use crate::disk::Disk;
use crate::error::HostError;
use crate::recordings::{TraceError, lacks, position_column, read_trace};
use crate::replay::axis_of;
use frictcomp::machine::{Machine, Parameterisation};
use frictcomp::readings::{Question, Way};
use frictcomp::text::shown_path;
use frictcomp_recordings::evidence::{
    Answer, AnswerVerdict, Conclusion, EvidenceRecording, Samples, judge_currents,
    judge_look_ahead, judge_with_motion,
};
use frictcomp_recordings::trace::{
    Channel, ChannelIndex, ChannelQuantity, ChannelSelection, Choice, CncObject, Pick, SelectError,
    TimeSource, TraceRecording,
};

/// The recorded axis and its channels.
#[derive(Debug, Clone, Copy)]
pub(super) struct RecordedQuestions<'a> {
    /// The axis.
    pub(super) axis: &'a AskedAxis,
    /// Machine.
    pub(super) machine: &'a Machine,
    /// The channels named by the user.
    pub(super) selection: &'a ChannelSelection,
    /// The CNC cycle, where it is known.
    pub(super) cycle_s: Option<f64>,
}

/// The channels of an axis.
#[derive(Default)]
struct AskedChannels {
    motion: [Option<Pick>; 2],
    current: Option<Pick>,
    /// Whether the torque was recorded after its scaling for the drive.
    is_scaled: bool,
    state: Option<ChannelIndex>,
    /// Reason why the channels cannot be those of the axis.
    doubt: Option<String>,
}

/// Objects of an axis that hold its additive current, and whether it is scaled for the drive.
const CURRENTS: [(u32, &str, bool); 3] = [
    (0x10B, "frict_comp.output", false),
    (0x205, "add_torque", true),
    (0x9F, "add_cmd_torque", true),
];

const NO_CURRENT: &str = "the recording has no channel with the additive current: record \
    `0x120300:0x<axis>010B`, `frict_comp.output`, or name the channel with `torque`";

/// Reads the answers to every question that a recording can answer.
pub(super) fn read_recorded_answers(
    path: &Path,
    asked: RecordedQuestions<'_>,
) -> Result<Vec<Answer>, HostError> {
    let mut found = AskedChannels::default();
    let recording = read_trace(path, &Disk::default(), |described| {
        found = asked.find(described)?;
        let time = asked.selection.find(ChannelQuantity::Time, described)?;
        let values = found.motion.into_iter().chain([found.current]).flatten();
        let choice = Choice {
            values: values.map(|pick| pick.channel).chain(found.state).collect(),
            time: time.map_or(TimeSource::Layout, TimeSource::Channel),
            ..Choice::default()
        };
        if found.state.is_some() {
            return Ok(choice);
        }
        let (choice, switch) = choice.with_switch("comp", described);
        found.state = switch;
        Ok(choice)
    })?;
    let evidence = match &found.doubt {
        Some(reason) => recorded_questions()
            .map(|question| Conclusion::none(question, reason.as_str()))
            .collect(),
        None => asked.judge(&asked.recorded(path, &recording, &found)?),
    };
    let answers = evidence.into_iter().map(|it| Answer {
        question: it.question,
        axis: asked.axis.name.clone(),
        build: asked.axis.build,
        verdict: it
            .reading
            .map_or(AnswerVerdict::Undecidable, AnswerVerdict::Reading),
        evidence: format!("{}: {}", shown_path(path), it.words),
    });
    Ok(answers.collect())
}

/// Returns the questions that a recording answers.
fn recorded_questions() -> impl Iterator<Item = Question> {
    let all = Question::ALL.into_iter();
    all.filter(|question| question.facts().way == Way::Recording)
}

impl RecordedQuestions<'_> {
    fn find(&self, channels: &[Channel]) -> Result<AskedChannels, SelectError> {
        if let Some(doubt) = self.other_axis(channels) {
            return Ok(AskedChannels {
                doubt: Some(doubt),
                ..AskedChannels::default()
            });
        }
        let find = |quantity| self.selection.find(quantity, channels);
        let position = match find(ChannelQuantity::Position)? {
            None => position_column(self.selection, &self.axis.name, channels)?,
            found => found,
        };
        let motion = [position, find(ChannelQuantity::Velocity)?];
        if motion == [None, None] {
            return Err(lacks(
                channels,
                "no commanded position or velocity of the axis",
                "in a CSV file the columns are `x` (0.1 µm or 0.0001°), `pos_<axis>` (mm or degrees) or `v` \
                 (µm/s or 0.001°/s); any other is to be named",
            ));
        }
        let state = channels.iter().find(|channel| {
            axis_of(channel, self.machine).is_some_and(|name| name == self.axis.name)
        });
        let state = state.map(|it| self.pick(it, ChannelQuantity::Time, channels));
        let (current, is_scaled) = self.current_of(channels)?;
        Ok(AskedChannels {
            motion,
            current,
            is_scaled,
            state: state.transpose()?.map(|pick| pick.channel),
            doubt: None,
        })
    }

    /// Returns why no channel belongs to the axis: all objects are those of other axes.
    fn other_axis(&self, channels: &[Channel]) -> Option<String> {
        let own = self.axis.number?;
        let objects = channels.iter().filter_map(|it| it.object);
        let mut numbers: Vec<u32> = objects
            .filter(|it| it.is_of_axis())
            .map(CncObject::axis)
            .collect();
        numbers.sort_unstable();
        numbers.dedup();
        if numbers.is_empty() || numbers.contains(&own) {
            return None;
        }
        let others: Vec<String> = numbers.iter().map(u32::to_string).collect();
        Some(format!(
            "its channels are those of axis {}, and {} is axis {own}",
            others.join(", "),
            self.axis.name
        ))
    }

    fn current_of(&self, channels: &[Channel]) -> Result<(Option<Pick>, bool), SelectError> {
        let torque = ChannelQuantity::Torque;
        if let Some(name) = &self.selection.torque {
            return Ok((
                Some(self.selection.pick_named(name, torque, channels)?),
                false,
            ));
        }
        for (element, symbol, is_scaled) in CURRENTS {
            let is_object = |channel: &&Channel| {
                channel.object.is_some_and(|it| {
                    let is_own = self.axis.number.is_none_or(|own| own == it.axis());
                    it.is_of_axis() && it.element() == element && is_own
                })
            };
            let is_named = |channel: &&Channel| {
                [&channel.name, &channel.symbol]
                    .into_iter()
                    .any(|text| text.to_lowercase().ends_with(symbol))
            };
            let mut all = channels.iter();
            let channel = all
                .find(is_object)
                .or_else(|| channels.iter().find(is_named));
            if let Some(channel) = channel {
                return Ok((Some(self.pick(channel, torque, channels)?), is_scaled));
            }
        }
        let own = format!("output_{}", self.axis.name);
        let short = ["output", own.as_str()];
        let mut all = channels.iter();
        let channel = all.find(|it| short.iter().any(|name| it.name.eq_ignore_ascii_case(name)));
        let pick = channel.map(|it| self.pick(it, torque, channels));
        Ok((pick.transpose()?, false))
    }

    /// Picks a channel with its unit; by its object where several have its name.
    fn pick(
        &self,
        channel: &Channel,
        quantity: ChannelQuantity,
        channels: &[Channel],
    ) -> Result<Pick, SelectError> {
        let named = |name: &str| self.selection.pick_named(name, quantity, channels);
        match (named(&channel.name), channel.object) {
            (Err(_), Some(object)) => named(&object.to_string()),
            (pick, _) => pick,
        }
    }

    fn recorded(
        &self,
        path: &Path,
        recording: &TraceRecording,
        found: &AskedChannels,
    ) -> Result<EvidenceRecording, HostError> {
        let picks: Vec<Pick> = found.motion.into_iter().flatten().collect();
        let aligned = recording.align(&picks, self.cycle_s);
        let aligned = aligned.map_err(|reason| TraceError::Apart {
            path: path.to_owned(),
            reason,
        })?;
        let samples = |channel: ChannelIndex, factor: f64| {
            let times_s = recording.times_s(channel);
            let times_s = times_s.ok_or_else(|| TraceError::NoTimes(path.to_owned()))?;
            let values = recording.values(channel).iter().map(|it| it * factor);
            Ok::<_, TraceError>(Samples {
                times_s: times_s.to_vec(),
                values: values.take(times_s.len()).collect(),
            })
        };
        let current = found
            .current
            .map(|pick| samples(pick.channel, pick.unit.factor));
        let state = found.state.map(|channel| samples(channel, 1.0));
        let mut columns = aligned.columns.into_iter();
        let [positions, velocities] = found.motion.map(|pick| pick.and_then(|_| columns.next()));
        let axis = self.machine.find(&self.axis.name);
        let scale = axis.map(|axis| self.machine.axis(axis).torque_scale.factor());
        Ok(EvidenceRecording {
            times_s: aligned.times_s,
            positions,
            velocities,
            current: current.transpose()?,
            state: state.transpose()?,
            cycle_s: self.cycle_s,
            torque_scale: scale.filter(|_| found.is_scaled).unwrap_or(1.0),
        })
    }

    fn judge(&self, recorded: &EvidenceRecording) -> Vec<Conclusion> {
        let mut evidence = vec![judge_with_motion(recorded), judge_look_ahead(recorded)];
        let axis = self.machine.find(&self.axis.name);
        let friction = axis.map(|axis| &self.machine.axis(axis).friction);
        let currents = recorded_questions()
            .filter(|it| !matches!(it, Question::WithMotion | Question::LookAhead));
        match friction {
            _ if recorded.current.is_none() => {
                evidence.extend(currents.map(|it| Conclusion::none(it, NO_CURRENT)));
            }
            Some(Parameterisation::Accepted(list)) => {
                evidence.extend(judge_currents(recorded, list));
            }
            _ => {
                let reason = format!("no value list of {} is known", self.axis.name);
                evidence.extend(currents.map(|it| Conclusion::none(it, reason.as_str())));
            }
        }
        evidence
    }
}
