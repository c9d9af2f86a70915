//! A recording, told by its signature, and the result of its program.

use std::path::{Path, PathBuf};

use clap::Args;

use crate::channels::{TorqueArgs, parse_unit};
use crate::cycle::CycleArgs;
use crate::failure::Failure;
use crate::identify::refusal;
use frictcomp_host::{CircleChannels, SignedAt, read_axis, read_circles, signatures_of};
use frictcomp_physics::circle::{CommandedCircle, PathCentre};
use frictcomp_physics::current::Switched;
use frictcomp_recordings::commission::{
    CirclesFound, Found, FrictionFound, Measurement, Plan, Program, Stage,
};
use frictcomp_recordings::identify::{IdentifyOptions, Wanted, identify};
use frictcomp_recordings::trace::{ChannelSelection, Unit};

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
    torque: Option<String>,
    /// The channel of the actual positions, of which circles are made: `%.ActPos`; by default `x` and `y`
    #[arg(long, value_name = "CHANNEL")]
    actual_position: Option<String>,
    /// The unit of a channel, where the file does not name it: `--unit SetVelo=mm/s`
    #[arg(long, value_name = "CHANNEL=UNIT", value_parser = parse_unit)]
    unit: Vec<(String, Unit)>,
    #[command(flatten)]
    cycle: CycleArgs,
    #[command(flatten)]
    torque_args: TorqueArgs,
    /// The program of a recording without a signature, by its number: `friction.csv=1`
    #[arg(long, value_name = "FILE=NUMBER", value_parser = parse_role)]
    role: Vec<(String, u16)>,
}

/// A program that was recorded, with its plan.
#[derive(Debug, Clone, Copy)]
struct Recorded<'a> {
    program: &'a Program,
    plan: &'a Plan,
    /// The end of its signature in s.
    from_s: f64,
}

impl ReadingArgs {
    /// All that decides how a recording is read.
    pub(super) fn key(&self) -> String {
        format!("{self:?}")
    }

    /// The number of the program and what its recording tells. What cannot be read is a result, too: the
    /// other recordings are read all the same.
    pub(super) fn read(&self, path: &Path, plans: &[&Plan]) -> (Option<u16>, Found) {
        let recorded = match self.recognise(path, plans) {
            Ok(recorded) => recorded,
            Err(failure) => return (None, Found::Refused(sentence(&failure))),
        };
        let found = match &recorded.program.role {
            Measurement::Friction { axis, speeds } => self.friction(path, recorded, *axis, speeds),
            Measurement::Circles { feed, radius } => {
                self.circles(path, recorded.plan, *feed, *radius)
            }
            Measurement::Strokes { .. } => Err(Failure::new(
                "strokes show the following error of the motor side, and no contour: `frictcomp verify` \
                 compares it with a list",
            )),
        };
        let found = found.unwrap_or_else(|failure| Found::Refused(sentence(&failure)));
        (Some(recorded.program.number), found)
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

    /// The friction of an axis in a recorded program.
    fn friction(
        &self,
        path: &Path,
        recorded: Recorded<'_>,
        axis: usize,
        speeds: &[f64],
    ) -> Result<Found, Failure> {
        let Some(axis) = recorded.plan.axes.get(axis) else {
            return Err(Failure::new("its axis is not in the plan"));
        };
        let recording = read_axis(path, &self.selection(&axis.name), self.cycle.seconds()?)?;
        let mut measured = self.torque_args.measured(recording.measured);
        let switched = match recorded.plan.stage {
            Stage::Off => Switched::Off,
            Stage::On => Switched::On,
        };
        if measured.compensation.is_some_and(|it| it != switched) {
            let state = if switched == Switched::On {
                "on"
            } else {
                "off"
            };
            let message =
                format!("its program has compensation {state}, and the recording says otherwise");
            return Err(Failure::new(message));
        }
        // The program itself switches it.
        measured.compensation = Some(switched);
        let options = IdentifyOptions {
            measured,
            wanted: Wanted::Points(12),
            ..IdentifyOptions::default()
        };
        let track = recording.track.since(recorded.from_s);
        let found =
            identify(&track, &options).map_err(|error| refusal(error, &recording.findings))?;
        let mut friction = FrictionFound::of(&axis.name, &found, speeds);
        friction.notes.extend(
            recording
                .findings
                .iter()
                .map(|it| format!("{}: {}", it.code, it.message)),
        );
        if let Some(unit) = recording.torque_unit {
            friction.against.push(format!(
                "its torque is in {unit}, and a list has drive units"
            ));
        }
        Ok(Found::Friction(friction))
    }

    /// The circles of a recorded program.
    fn circles(&self, path: &Path, plan: &Plan, feed: f64, radius: f64) -> Result<Found, Failure> {
        let of_axis = |at: usize| {
            let name = plan.axes.get(at).map(|it| it.name.as_str())?;
            let named = self
                .actual_position
                .as_deref()
                .map(|it| it.replace('%', name));
            named.or_else(|| (!["X", "Y"].contains(&name)).then(|| name.to_owned()))
        };
        let channels = CircleChannels {
            names: [of_axis(0), of_axis(1)],
            selection: ChannelSelection {
                time: self.time.clone(),
                units: self.unit.clone(),
                ..ChannelSelection::default()
            },
        };
        let commanded = CommandedCircle {
            radius_mm: Some(radius),
            feed_mm_per_min: None,
        };
        let path = PathBuf::from(path);
        let recording = read_circles(&[path], &channels, commanded, PathCentre::Common)?;
        Ok(Found::Circles(CirclesFound::of(&recording, feed, radius)))
    }

    /// The channels of an axis.
    fn selection(&self, axis: &str) -> ChannelSelection {
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

/// A failure with its advice in one sentence.
fn sentence(failure: &Failure) -> String {
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
