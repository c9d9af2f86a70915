//! A recording, told by its signature, and the result of its program.

use std::path::{Path, PathBuf};

use clap::Args;

use crate::channels::{TorqueKindArgs, parse_unit};
use crate::cycle::CycleArgs;
use crate::failure::Failure;
use frictcomp_host::{
    CircleChannels, SignedAt, read_circles, read_motion, read_turns, signatures_of, switches_of,
};
use frictcomp_physics::circle::{Circle, CommandedCircle, PathCentre, RecordedCircle};
use frictcomp_physics::current::Switched;
use frictcomp_recordings::commission::{
    CirclesFound, Found, MeasuredAxis, Measurement, NotFollowed, Plan, Program, RecordedStrokes,
    Stage, StrokesFound,
};
use frictcomp_recordings::identify::AxisRecording;
use frictcomp_recordings::trace::{ChannelSelection, Unit};
use frictcomp_report::visible_line;

/// Channels of the recordings; `%` stands for the name of the axis.
#[derive(Debug, Clone, Args)]
pub(super) struct ReadingArgs {
    /// The channel of the times in a recording
    #[arg(long, value_name = "CHANNEL")]
    time: Option<String>,
    /// The channel of the commanded positions; `%` stands for the name of the axis: `%.SetPos`
    #[arg(long, value_name = "CHANNEL")]
    position: Option<String>,
    /// The channel of the commanded velocities: `%.SetVelo`
    #[arg(long, value_name = "CHANNEL")]
    velocity: Option<String>,
    /// The channel of the torque: `%.ActTorque`
    #[arg(long, value_name = "CHANNEL")]
    pub(super) torque: Option<String>,
    /// The channel of the actual positions, of which circles are made: `%.ActPos`; by default `x` and `y`, in
    /// strokes `x_act`
    #[arg(long, value_name = "CHANNEL")]
    actual_position: Option<String>,
    /// The channel of the following error in strokes, in place of the actual positions: `%.PosDiff`; by default `e`
    #[arg(long, value_name = "CHANNEL")]
    following_error: Option<String>,
    /// The unit of a channel, where the file does not name it: `--unit SetVelo=mm/s`
    #[arg(long, value_name = "CHANNEL=UNIT", value_parser = parse_unit)]
    unit: Vec<(String, Unit)>,
    #[command(flatten)]
    pub(super) cycle: CycleArgs,
    #[command(flatten)]
    pub(super) kind: TorqueKindArgs,
    /// The program of a recording without a signature, by its number: `friction.csv=1`
    #[arg(long, value_name = "FILE=NUMBER", value_parser = parse_role)]
    role: Vec<(String, u16)>,
}

/// A program that was recorded, with its plan.
#[derive(Debug, Clone, Copy)]
pub(super) struct Recorded<'a> {
    pub(super) program: &'a Program,
    plan: &'a Plan,
    /// The end of its signature in s.
    pub(super) from_s: f64,
}

impl ReadingArgs {
    /// All that decides how a recording is read.
    pub(super) fn key(&self) -> String {
        format!("{self:?}")
    }

    /// All that decides how recorded circles are read.
    pub(super) fn circles_key(&self) -> String {
        let (time, places) = (&self.time, &self.actual_position);
        format!("{time:?} {places:?} {:?} {:?}", self.unit, self.cycle)
    }

    /// Statements of the user about the recordings.
    pub(super) fn said(&self) -> Vec<String> {
        let roles = self.role.iter();
        let mut said: Vec<String> = roles
            .map(|(file, number)| format!("{file} is the recording of program {number}"))
            .collect();
        if let Some(kind) = self.kind.torque_kind {
            said.push(format!("the recorded torque is the {} one", kind.as_str()));
        }
        said
    }

    /// Checks that the recordings whose programs are said are there.
    pub(super) fn check_roles(&self, paths: &[PathBuf]) -> Result<(), Failure> {
        let is_there = |file: &str| paths.iter().any(|it| it.ends_with(file));
        let absent = self.role.iter().find(|(file, _)| !is_there(file));
        absent.map_or(Ok(()), |(file, _)| {
            let message = format!(
                "`--role` names `{}`, and there is no such recording",
                visible_line(file)
            );
            Err(Failure::new(message).with_help("give the name of the file without its folder"))
        })
    }

    /// The number of the program and what its recording tells. What cannot be read is a result, too: the
    /// other recordings are read all the same.
    pub(super) fn read(&self, path: &Path, plans: &[&Plan]) -> (Option<u16>, Found) {
        let recorded = match self.recognise(path, plans) {
            Ok(recorded) => recorded,
            Err(failure) => return (None, Found::Refused(sentence(&failure))),
        };
        let axis = |at: usize| {
            let axis = recorded.plan.axes.get(at);
            axis.ok_or_else(|| Failure::new("its axis is not in the plan"))
        };
        let found = match &recorded.program.role {
            Measurement::Friction { axis: at, speeds } => axis(*at)
                .and_then(|axis| self.friction(path, recorded, axis, speeds))
                .map(Found::Friction),
            Measurement::Circles { feed, radius } => {
                self.circles(path, recorded.plan, *feed, *radius)
            }
            Measurement::Strokes { axis: at, feeds } => {
                axis(*at).and_then(|axis| self.strokes(path, recorded, axis, feeds))
            }
        };
        let mut found = found.unwrap_or_else(|failure| Found::Refused(sentence(&failure)));
        match self.switched_otherwise(path, recorded, &found) {
            Ok(None) => {}
            Ok(Some(reason)) => found.refuse(reason),
            Err(failure) => found.refuse(sentence(&failure)),
        }
        (Some(recorded.program.number), found)
    }

    /// Says where the recorded state of the compensation is not the one of the program, from the end of its
    /// signature to shortly before its own end: what was before and after is switched back there.
    fn switched_otherwise(
        &self,
        path: &Path,
        recorded: Recorded<'_>,
        found: &Found,
    ) -> Result<Option<String>, Failure> {
        const MEASURED: f64 = 0.9;
        let wanted = recorded.wanted();
        let driven = found.driven_part().unwrap_or(1.0).max(1.0);
        let to_s = recorded.from_s + MEASURED * recorded.program.time_after_signature_s() / driven;
        let axes = match &recorded.program.role {
            Measurement::Friction { axis, .. } | Measurement::Strokes { axis, .. } => {
                recorded.plan.axes.get(*axis..=*axis).unwrap_or_default()
            }
            Measurement::Circles { .. } => &recorded.plan.axes[..],
        };
        let cycle = self.cycle.seconds()?;
        for axis in axes {
            let switches = switches_of(path, &self.selection(&axis.name), cycle)?;
            let within = switches
                .iter()
                .filter(|it| it.0 > recorded.from_s && it.0 < to_s);
            let begin = switches.iter().rfind(|it| it.0 <= recorded.from_s);
            let Some(other) = begin.into_iter().chain(within).find(|it| it.1 != wanted) else {
                continue;
            };
            let state = if wanted == Switched::On { "on" } else { "off" };
            return Ok(Some(format!(
                "its program has compensation of {} {state}, and the recording says otherwise at {:.3} s",
                axis.name,
                other.0.max(recorded.from_s)
            )));
        }
        Ok(None)
    }

    /// The program of a recording, by its signature or by what the user says.
    fn recognise<'a>(&self, path: &Path, plans: &[&'a Plan]) -> Result<Recorded<'a>, Failure> {
        let name = path
            .file_name()
            .map(|it| it.to_string_lossy().into_owned())
            .unwrap_or_default();
        let program = |number: u16| {
            let mut programs = plans
                .iter()
                .flat_map(|plan| plan.programs.iter().map(move |it| (it, *plan)));
            programs.find(|(it, _)| it.number == number).ok_or_else(|| {
                Failure::new(format!(
                    "it carries the number {number}, which no plan in this folder has"
                ))
            })
        };
        let said = self.role.iter().find(|(file, _)| *file == name);
        let said = said.map(|(_, number)| *number);
        let cycle = self.cycle.seconds()?;
        let mut signed: Vec<(&str, SignedAt)> = Vec::new();
        let mut failed = None;
        for axis in plans.iter().flat_map(|plan| &plan.axes) {
            match signatures_of(path, &self.selection(&axis.name), cycle) {
                Ok(found) => signed.extend(found.into_iter().map(|it| (axis.name.as_str(), it))),
                Err(error) => failed = Some(error),
            }
        }
        let Some((_, first)) = signed.first().copied() else {
            if let Some(number) = said {
                let (program, plan) = program(number)?;
                return Ok(Recorded {
                    program,
                    plan,
                    from_s: 0.0,
                });
            }
            return Err(failed.map_or_else(
                || {
                    Failure::new(format!(
                        "it has no signature; say `--role {name}=NUMBER` if you know its program"
                    ))
                },
                Failure::from,
            ));
        };
        let number = first.signature.number();
        if let Some(said) = said.filter(|it| *it != number) {
            let message = format!("its strokes are the number {number}, and `--role` says {said}");
            return Err(Failure::new(message));
        }
        if signed
            .iter()
            .any(|(_, it)| it.signature != first.signature || it.end_s > first.end_s)
        {
            let numbers: Vec<String> = signed
                .iter()
                .map(|it| it.1.signature.number().to_string())
                .collect();
            let message = format!(
                "it holds several programs, {}: record each alone",
                numbers.join(", ")
            );
            return Err(Failure::new(message));
        }
        let (program, plan) = program(number)?;
        let moved = plan
            .axes
            .get(program.signed_axis())
            .map_or("", |it| it.name.as_str());
        if !signed.iter().any(|(axis, _)| *axis == moved) {
            let message =
                format!("its strokes are those of another axis than `{moved}`: two axes are mixed");
            return Err(Failure::new(message));
        }
        Ok(Recorded {
            program,
            plan,
            from_s: first.end_s,
        })
    }

    /// The following error of an axis alone in a recorded program of strokes.
    fn strokes(
        &self,
        path: &Path,
        recorded: Recorded<'_>,
        axis: &MeasuredAxis,
        feeds: &[f64],
    ) -> Result<Found, Failure> {
        let cycle = self.cycle.seconds()?;
        let AxisRecording {
            track,
            following_errors,
            ..
        } = read_motion(path, &self.followed(&axis.name), cycle)?;
        let before = track
            .times_s
            .partition_point(|it| *it < recorded.from_s)
            .min(following_errors.len());
        let strokes = RecordedStrokes {
            track: &track.since(recorded.from_s),
            following_errors: &following_errors[before..],
        };
        let found = StrokesFound::of((&axis.name, axis.unit()), strokes, feeds);
        let mut found = found.map_err(|error| {
            let failure = Failure::new(error.to_string());
            if error == NotFollowed::Absent {
                failure.with_help(
                    "name them with `--following-error`, or `--actual-position` and `--position`",
                )
            } else {
                failure
            }
        })?;
        if recorded.plan.stage == Stage::Off && found.against.is_empty() && !found.is_seen() {
            found.against.push(
                "no reversal shows in the following error: it is that of another axis, or compensation is on"
                    .to_owned(),
            );
        }
        Ok(Found::Strokes(found))
    }

    /// The CNC cycle in s.
    pub(super) fn cycle_time_s(&self) -> Result<f64, Failure> {
        let given = self.cycle.seconds()?;
        Ok(given.unwrap_or(Circle::default().cycle_time_s))
    }

    /// The turns of a recorded program of circles, in the units of their plan.
    pub(super) fn turns(
        &self,
        path: &Path,
        plan: &Plan,
        radius: f64,
    ) -> Result<Vec<RecordedCircle>, Failure> {
        Ok(read_turns(path, &self.circle_channels(plan), Some(radius))?)
    }

    /// The circles of a recorded program.
    fn circles(&self, path: &Path, plan: &Plan, feed: f64, radius: f64) -> Result<Found, Failure> {
        let channels = self.circle_channels(plan);
        let commanded = CommandedCircle {
            radius_mm: Some(radius),
            feed_mm_per_min: None,
        };
        let path = PathBuf::from(path);
        let recording = read_circles(&[path], &channels, commanded, PathCentre::Common)?;
        Ok(Found::Circles(CirclesFound::of(&recording, feed, radius)))
    }

    /// The channels of circles.
    fn circle_channels(&self, plan: &Plan) -> CircleChannels {
        let of_axis = |at: usize| {
            let name = plan.axes.get(at).map(|it| it.name.as_str())?;
            let named = self
                .actual_position
                .as_deref()
                .map(|it| it.replace('%', name));
            named.or_else(|| (!["X", "Y"].contains(&name)).then(|| name.to_owned()))
        };
        CircleChannels {
            names: [of_axis(0), of_axis(1)],
            selection: ChannelSelection {
                time: self.time.clone(),
                units: self.unit.clone(),
                ..ChannelSelection::default()
            },
        }
    }

    /// The channels of an axis with its actual position or its following error.
    pub(super) fn followed(&self, axis: &str) -> ChannelSelection {
        let named = |channel: &Option<String>| channel.as_ref().map(|it| it.replace('%', axis));
        ChannelSelection {
            actual_position: named(&self.actual_position),
            following_error: named(&self.following_error),
            ..self.selection(axis)
        }
    }

    /// The channels of an axis.
    pub(super) fn selection(&self, axis: &str) -> ChannelSelection {
        let named = |channel: &Option<String>| channel.as_ref().map(|it| it.replace('%', axis));
        ChannelSelection {
            axis: Some(axis.to_owned()),
            time: self.time.clone(),
            position: named(&self.position),
            velocity: named(&self.velocity),
            torque: named(&self.torque),
            units: self.unit.clone(),
            ..ChannelSelection::default()
        }
    }
}

impl Recorded<'_> {
    /// The state to which the program switches compensation.
    pub(super) fn wanted(self) -> Switched {
        match self.plan.stage {
            Stage::Off => Switched::Off,
            Stage::On => Switched::On,
        }
    }
}

/// A failure with its advice in one sentence.
pub(super) fn sentence(failure: &Failure) -> String {
    match failure.help.first() {
        Some(help) => format!("{}; {help}", failure.message),
        None => failure.message.clone(),
    }
}

/// `FILE=NUMBER`.
fn parse_role(text: &str) -> Result<(String, u16), String> {
    let parsed = text.rsplit_once('=').and_then(|(file, number)| {
        let number = number
            .trim()
            .parse()
            .ok()
            .filter(|it| (1..1024).contains(it))?;
        (!file.is_empty()).then(|| (file.to_owned(), number))
    });
    parsed
        .ok_or_else(|| "write the file and the number of its program, `friction.csv=1`".to_owned())
}
