//! Recorded traces in files: which of their channels are which columns of a circle or of a commanded
//! trace. The module `trace` handles the file layouts.

use std::io::{self, Read as _};
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

use super::trace_error::TraceError;
use crate::disk::{Disk, decode};
use crate::error::HostError;
use frictcomp::syntax::no_program;
use frictcomp_physics::circle::{
    CommandedCircle, PathCentre, RecordedCircle, RecordedTrace, Recording as Circles,
};
use frictcomp_physics::current::{
    CommandedTrace, POSITION_UNITS_PER_MM, Resampling, Switched, TraceColumns, TraceOptions,
    VELOCITY_UNITS_PER_MM_PER_S,
};
use frictcomp_recordings::identify::{
    AxisChannels, AxisRecording, TraceFinding, check_motion, unit_finding,
};
use frictcomp_recordings::trace::{
    Channel, ChannelIndex, ChannelQuantity, ChannelRole, ChannelSelection, Choice, Missing, Pick,
    SelectError, TimeSource, TraceProblem, TraceReader, TraceRecording,
};

/// Largest number of rows of a recorded circle; they are kept in memory until the circle is evaluated.
const MAX_POINTS: usize = 4_000_000;

/// Largest number of rows of a trace: eleven hours of cycles of 1 ms.
const MAX_ROWS: usize = 40_000_000;

/// Number of leading bytes that tell a recording from a program.
const HEAD: u64 = 1 << 18;

/// Number of bytes read at a time.
const PIECE: usize = 1 << 18;

/// Kinds of files that Scope writes and that cannot be read.
const CLOSED: [&str; 4] = ["svdx", "svd", "svb", "tdms"];

/// The ending of what Scope is to record, which holds no values (R6.28).
const SCOPE_CONFIGURATION: &str = "tcscopex";

/// Reads the channels of a trace that `choose` selects.
///
/// # Errors
/// The file cannot be read, is not a trace, or lacks the requested channels.
pub fn read_trace(
    path: &Path,
    disk: &Disk,
    choose: impl FnMut(&[Channel]) -> Result<Choice, SelectError> + Send,
) -> Result<TraceRecording, HostError> {
    read(path, MAX_ROWS, disk, choose)
}

/// Returns whether a file is a recording, told by its head: it is XML, or has rows of numbers, with or without a
/// header. A program has none.
pub fn is_recording(path: &Path, disk: &Disk) -> bool {
    let Ok(file) = disk.open(path) else {
        return false;
    };
    let mut head = Vec::new();
    if file.take(HEAD).read_to_end(&mut head).is_err() {
        return false;
    }
    let mut has_channels = false;
    let mut reader = TraceReader::new(MAX_ROWS, |channels| {
        has_channels = !channels.is_empty();
        Ok(Choice::default())
    });
    // A fault of the head is reported where the trace is read.
    let read = reader.feed(&head);
    drop(read.and_then(|()| reader.finish()));
    has_channels || no_program(&decode(head)) == Some("XML")
}

fn read(
    path: &Path,
    most_rows: usize,
    disk: &Disk,
    choose: impl FnMut(&[Channel]) -> Result<Choice, SelectError> + Send,
) -> Result<TraceRecording, HostError> {
    let mut reader = TraceReader::new(most_rows, choose);
    feed(path, disk, &mut reader, || false)?;
    let problem = |problem| TraceError::problem(path, problem);
    Ok(reader.finish().map_err(problem)?)
}

/// Feeds a reader with a file, until it is done.
fn feed(
    path: &Path,
    disk: &Disk,
    reader: &mut TraceReader<'_>,
    is_done: impl Fn() -> bool,
) -> Result<(), HostError> {
    let failed = |error: io::Error| match error.kind() {
        io::ErrorKind::IsADirectory => HostError::FolderAsRecording(path.to_owned()),
        _ => HostError::read(path, error),
    };
    let extension = path
        .extension()
        .map(|it| it.to_string_lossy().to_lowercase());
    if extension.as_deref() == Some(SCOPE_CONFIGURATION) {
        return Err(TraceError::WithoutValues(path.to_owned()).into());
    }
    if extension.is_some_and(|it| CLOSED.contains(&it.as_str())) {
        return Err(TraceError::Closed(path.to_owned()).into());
    }
    let mut file = disk.open(path).map_err(failed)?;
    let mut piece = vec![0; PIECE];
    while !is_done() {
        let length = file.read(&mut piece).map_err(failed)?;
        if length == 0 {
            break;
        }
        let fed = reader.feed(&piece[..length]);
        fed.map_err(|problem| TraceError::problem(path, problem))?;
    }
    Ok(())
}

/// Returns the channels of a recording.
///
/// # Errors
/// The file cannot be read, or is not a trace.
pub fn channels_of(path: &Path, disk: &Disk) -> Result<Vec<Channel>, HostError> {
    let found = OnceLock::new();
    let mut reader = TraceReader::new(MAX_ROWS, |channels: &[Channel]| {
        found.get_or_init(|| channels.to_vec());
        Ok(Choice::default())
    });
    feed(path, disk, &mut reader, || found.get().is_some())?;
    if found.get().is_none() {
        let problem = |problem| TraceError::problem(path, problem);
        reader.finish().map_err(problem)?;
    }
    Ok(found.get().cloned().unwrap_or_default())
}

/// Returns the only axis by whose name the channels of a recording are recognised.
///
/// # Errors
/// The file cannot be read, or is not a trace.
pub fn sole_axis(path: &Path, disk: &Disk) -> Result<Option<String>, HostError> {
    let mut named = named_axes(&channels_of(path, disk)?);
    Ok(named.pop().filter(|_| named.is_empty()))
}

/// Returns the axes by whose names channels are recognised, in their order.
pub fn named_axes(channels: &[Channel]) -> Vec<String> {
    let mut axes: Vec<String> = Vec::new();
    let named = channels.iter().filter_map(|it| it.recognised()?.axis);
    for axis in named.filter(|axis| !axis.starts_with(|it: char| it.is_ascii_digit())) {
        if !axes.contains(&axis) {
            axes.push(axis);
        }
    }
    axes
}

/// Returns the axes of a recording by whose names commanded positions or velocities are recognised, in the order of its
/// channels; none where it has a column `x` or `v`, or the motion of one axis only.
///
/// # Errors
/// The file cannot be read, or has other content.
pub fn commanded_axes(path: &Path) -> Result<Vec<String>, HostError> {
    let channels = channels_of(path, &Disk::default())?;
    let any = ChannelSelection::default();
    let quantities = [ChannelQuantity::Position, ChannelQuantity::Velocity];
    if quantities.map(|quantity| any.find(quantity, &channels)) != [Ok(None), Ok(None)] {
        return Ok(Vec::new());
    }
    let mut axes: Vec<String> = Vec::new();
    let motion = [ChannelRole::Position, ChannelRole::Velocity];
    let recognised = channels.iter().filter_map(Channel::recognised);
    for axis in recognised.filter_map(|it| it.axis.filter(|_| motion.contains(&it.role))) {
        if !axes.contains(&axis) {
            axes.push(axis);
        }
    }
    Ok(axes)
}

/// Reads a commanded trace: positions in 0.1 µm or 0.0001°, or velocities in µm/s or 0.001°/s, or
/// both; optionally times in s and a column `comp` with `on` and `off`. Without times, a
/// row is a CNC cycle.
///
/// # Errors
/// The file cannot be read, has other content, or its rows are not CNC cycles and are not
/// resampled.
pub fn read_commanded(
    path: &Path,
    selection: &ChannelSelection,
    options: TraceOptions,
) -> Result<CommandedTrace, HostError> {
    let mut found: [Option<Pick>; 3] = [None; 3];
    let mut switch = None;
    let recording = read(path, MAX_ROWS, &Disk::default(), |channels| {
        let find = |quantity| selection.find(quantity, channels);
        found = [
            find(ChannelQuantity::Time)?,
            find(ChannelQuantity::Position)?,
            find(ChannelQuantity::Velocity)?,
        ];
        let [time, position, velocity] = found;
        if position.is_none() && velocity.is_none() {
            return Err(lacks(
                channels,
                "neither a column `x` nor a column `v`",
                "name the columns `t` (s), `x` (0.1 µm or 0.0001°), `v` (µm/s or 0.001°/s), `comp`, \
                 or say which channels they are",
            ));
        }
        let motion = [
            (ChannelQuantity::Position, position),
            (ChannelQuantity::Velocity, velocity),
        ];
        let motion = motion.into_iter().filter_map(|it| Some((it.0, it.1?)));
        selection.check_axis(motion, channels)?;
        let values = [position, velocity].into_iter().flatten();
        let choice = Choice {
            values: values.map(|pick| pick.channel).collect(),
            time: time.map_or(TimeSource::Layout, TimeSource::Channel),
            ..Choice::all(&[], None)
        };
        let (choice, comp) = choice.with_switch("comp", channels);
        switch = comp;
        Ok(choice)
    })?;
    let [_, position, velocity] = found;
    let commanded = CommandedChannels {
        path,
        recording: &recording,
        motion: [position, velocity],
        switch,
    };
    let assumed = commanded.assumed_units();
    let (columns, remarks) = if commanded.have_one_clock() {
        (commanded.columns()?, Vec::new())
    } else if options.resampling == Resampling::Done {
        commanded.aligned(options.cycle_s)?
    } else {
        return Err(TraceError::SeveralClocks(path.to_owned()).into());
    };
    let trace = CommandedTrace::new(columns, options).map_err(|reason| {
        let path = path.to_owned();
        HostError::from(TraceError::Cycles { path, reason })
    })?;
    if let [Some(_), Some(_)] = commanded.motion {
        let motion = trace.rows().map(|row| {
            let velocity = row.velocity / VELOCITY_UNITS_PER_MM_PER_S;
            [row.time_s, velocity, row.position / POSITION_UNITS_PER_MM]
        });
        let times_s: Vec<f64> = trace.rows().take(2).map(|row| row.time_s).collect();
        let step_s = times_s
            .windows(2)
            .next()
            .map_or(1.0, |pair| pair[1] - pair[0]);
        check_motion(step_s, motion).map_err(|reason| {
            let path = path.to_owned();
            HostError::from(TraceError::Motion { path, reason })
        })?;
    }
    Ok(trace.after([assumed, remarks].concat()))
}

/// The channels of a commanded trace.
struct CommandedChannels<'a> {
    path: &'a Path,
    recording: &'a TraceRecording,
    /// Position and velocity.
    motion: [Option<Pick>; 2],
    /// Channel of the state of compensation.
    switch: Option<ChannelIndex>,
}

impl CommandedChannels<'_> {
    /// Returns the units that the recording does not give, a sentence each.
    fn assumed_units(&self) -> Vec<String> {
        let quantities = [ChannelQuantity::Position, ChannelQuantity::Velocity];
        let picks = quantities.into_iter().zip(self.motion);
        let findings = picks.filter_map(|(quantity, pick)| {
            let pick = pick?;
            let channel = &self.recording.channels()[pick.channel.get()];
            unit_finding(channel, quantity, pick)
        });
        let sentences = findings.map(|it| format!("{}: {}; {}", it.code, it.message, it.help));
        sentences.collect()
    }

    /// Returns whether they were sampled together.
    fn have_one_clock(&self) -> bool {
        let motion = self.motion.into_iter().flatten();
        let channels = motion.map(|pick| pick.channel).chain(self.switch);
        let mut clocks = channels.map(|channel| self.recording.clock(channel));
        let first = clocks.next();
        clocks.all(|clock| Some(clock) == first)
    }

    /// Returns the columns of channels that were sampled together.
    fn columns(&self) -> Result<TraceColumns, TraceError> {
        let column = |pick: Option<Pick>| {
            pick.map(|pick| numbers(self.path, self.recording, &pick))
                .transpose()
        };
        let [position, velocity] = self.motion;
        let [positions, velocities] = [column(position)?, column(velocity)?];
        let rows = positions
            .as_ref()
            .or(velocities.as_ref())
            .map_or(0, Vec::len);
        let states = self.states()?;
        let switched = |row: usize| match states.and_then(|states| states.get(row)) {
            Some(0.0) => Switched::Off,
            _ => Switched::On,
        };
        let times = position
            .or(velocity)
            .and_then(|pick| self.recording.times_s(pick.channel));
        Ok(TraceColumns {
            times_s: times.map(<[f64]>::to_vec),
            switched: (0..rows).map(switched).collect(),
            positions,
            velocities,
        })
    }

    /// Returns the columns of channels that were sampled at different times, aligned with those of the
    /// fastest, and what was done for it.
    fn aligned(&self, cycle_s: Option<f64>) -> Result<(TraceColumns, Vec<String>), TraceError> {
        let picks: Vec<Pick> = self.motion.into_iter().flatten().collect();
        let aligned = self.recording.align(&picks, cycle_s);
        let aligned = aligned.map_err(|reason| TraceError::Apart {
            path: self.path.to_owned(),
            reason,
        })?;
        let states = self.states()?.unwrap_or_default();
        let times = self.switch.and_then(|it| self.recording.times_s(it));
        let times = times.unwrap_or_default();
        // It applies from its row on.
        let switched = |time: &f64| {
            let after = times.partition_point(|it| it <= time);
            match states.get(after.saturating_sub(1)) {
                Some(0.0) => Switched::Off,
                _ => Switched::On,
            }
        };
        let switched = aligned.times_s.iter().map(switched).collect();
        let mut columns = aligned.columns.into_iter();
        let [positions, velocities] = self.motion.map(|pick| pick.and_then(|_| columns.next()));
        let columns = TraceColumns {
            times_s: Some(aligned.times_s),
            positions,
            velocities,
            switched,
        };
        Ok((columns, aligned.remarks))
    }

    /// Returns the samples of the switch.
    fn states(&self) -> Result<Option<&[f64]>, TraceError> {
        self.switch
            .map(|channel| numbers_of(self.path, self.recording, channel))
            .transpose()
    }
}

/// Reads one recorded circle, or one of each direction, in one file or two: the positions that are selected for
/// each of its axes, or columns `x` and `y` of actual positions in mm, or with their unit, `x_um`, `X [mm]`;
/// optionally `t` in s. G(b) and H refer to `centre`. Also returns what was assumed to read them.
///
/// # Errors
/// A file cannot be read, or does not contain a circle.
pub fn read_circles(
    paths: &[PathBuf],
    channels: &[ChannelSelection; 2],
    commanded: CommandedCircle,
    centre: PathCentre,
) -> Result<(Circles, Vec<TraceFinding>), HostError> {
    Circles::check(paths.len(), commanded).map_err(TraceError::Circles)?;
    let (mut circles, mut assumed) = (Vec::new(), Vec::new());
    for path in paths {
        let (turns, findings) = read_turns(path, channels, commanded.radius_mm, &Disk::default())?;
        circles.extend(turns);
        assumed.extend(
            findings
                .into_iter()
                .filter(|it| !assumed.contains(it))
                .collect::<Vec<_>>(),
        );
    }
    let circles = Circles::new(circles, commanded, centre).map_err(TraceError::Circles)?;
    Ok((circles, assumed))
}

/// Reads the circles of a recording, one for each direction in which it has a full turn; F and D refer to the
/// commanded radius, if it is known. Also returns what was assumed to read them.
///
/// # Errors
/// The file cannot be read, or is not a recorded circle.
pub fn read_turns(
    path: &Path,
    channels: &[ChannelSelection; 2],
    commanded_mm: Option<f64>,
    disk: &Disk,
) -> Result<(Vec<RecordedCircle>, Vec<TraceFinding>), HostError> {
    let (trace, assumed) = read_positions(path, channels, disk)?;
    let found = RecordedCircle::find(&trace, commanded_mm);
    let found = found.map_err(|reason| TraceError::Circle {
        path: path.to_owned(),
        reason,
    })?;
    // A commanded radius that is found confirms the unit.
    let open = if commanded_mm.is_some() {
        Vec::new()
    } else {
        assumed
    };
    Ok((found, open))
}

/// Reads motion and torque of one axis.
///
/// # Errors
/// The file cannot be read, lacks the requested channels, or has no matching ones.
pub fn read_axis(
    path: &Path,
    selection: &ChannelSelection,
    cycle_s: Option<f64>,
    disk: &Disk,
) -> Result<AxisRecording, HostError> {
    read_channels(path, cycle_s, disk, |described| {
        AxisChannels::find(selection, described)
    })
}

/// Reads motion and following error of one axis, whose torque may be missing.
///
/// # Errors
/// As [`read_axis`].
pub(crate) fn read_motion(
    path: &Path,
    selection: &ChannelSelection,
    cycle_s: Option<f64>,
) -> Result<AxisRecording, HostError> {
    read_channels(path, cycle_s, &Disk::default(), |described| {
        AxisChannels::of_motion(selection, described)
    })
}

fn read_channels(
    path: &Path,
    cycle_s: Option<f64>,
    disk: &Disk,
    find: impl Fn(&[Channel]) -> Result<AxisChannels, SelectError> + Send + Sync,
) -> Result<AxisRecording, HostError> {
    let mut channels = None;
    let recording = read_trace(path, disk, |described| {
        let found = find(described)?;
        let choice = found.choice();
        channels = Some(found);
        Ok(choice)
    })?;
    let channels = channels.unwrap_or_default();
    let axis = channels
        .take(&recording, cycle_s)
        .map_err(|reason| TraceError::Apart {
            path: path.to_owned(),
            reason,
        })?;
    Ok(axis)
}

/// Returns the actual positions of two axes, in the order of the rows. Times that are not in seconds are
/// ignored.
fn read_positions(
    path: &Path,
    wanted: &[ChannelSelection; 2],
    disk: &Disk,
) -> Result<(RecordedTrace, Vec<TraceFinding>), HostError> {
    let timed = read_points(path, wanted, Times::Read, disk);
    match timed {
        Err(HostError::Trace(TraceError::Problem {
            problem: TraceProblem::Number { column, .. },
            ..
        })) if column == "time" => read_points(path, wanted, Times::Ignored, disk),
        timed => timed,
    }
}

/// Reading of a column of times.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Times {
    Read,
    Ignored,
}

fn read_points(
    path: &Path,
    wanted: &[ChannelSelection; 2],
    times: Times,
    disk: &Disk,
) -> Result<(RecordedTrace, Vec<TraceFinding>), HostError> {
    let mut picks = [None; 2];
    let mut assumed = Vec::new();
    let recording = read(path, MAX_POINTS, disk, |channels| {
        for (pick, (usual, wanted)) in picks.iter_mut().zip(["X", "Y"].iter().zip(wanted)) {
            *pick = match (&wanted.position, &wanted.axis) {
                (Some(_), _) => wanted.find(ChannelQuantity::Position, channels)?,
                (None, axis) => wanted.position_of(axis.as_deref().unwrap_or(usual), channels)?,
            };
        }
        for pick in picks.iter_mut().flatten() {
            let channel = &channels[pick.channel.get()];
            let recognised = channel.recognised().map(|it| it.role);
            if recognised == Some(ChannelRole::Position) {
                return Err(lacks(
                    channels,
                    &format!(
                        "no actual position in `{}`, which is a commanded one",
                        channel.name
                    ),
                    "record the actual positions, or name their channels",
                ));
            }
            assumed.extend(unit_finding(channel, ChannelQuantity::Position, *pick));
            pick.unit.factor /= POSITION_UNITS_PER_MM;
        }
        let [Some(x), Some(y)] = picks else {
            return Err(lacks(
                channels,
                "no columns `x` and `y`",
                "name the columns `x` and `y` for mm, or `x_um` and `y_um` for µm, or say which \
                 channels they are",
            ));
        };
        let time = match times {
            Times::Read => wanted[0].find(ChannelQuantity::Time, channels)?,
            Times::Ignored => None,
        };
        Ok(Choice {
            values: vec![x.channel, y.channel],
            time: time.map_or(TimeSource::Layout, TimeSource::Channel),
            ..Choice::default()
        })
    })?;
    let [Some(x), Some(y)] = picks else {
        return Ok((RecordedTrace::default(), assumed));
    };
    let points = |xs: Vec<f64>, ys: Vec<f64>| xs.into_iter().zip(ys).map(|(x, y)| [x, y]).collect();
    if recording.clock(x.channel) == recording.clock(y.channel) {
        let points_mm: Vec<[f64; 2]> = points(
            numbers(path, &recording, &x)?,
            numbers(path, &recording, &y)?,
        );
        let times_s = recording.times_s(x.channel).map(<[f64]>::to_vec);
        let times_s = times_s.filter(|it| it.len() == points_mm.len());
        let trace = RecordedTrace {
            points_mm,
            times_s: times_s.unwrap_or_default(),
        };
        return Ok((trace, assumed));
    }
    let aligned = recording
        .align(&[x, y], None)
        .map_err(|reason| TraceError::Apart {
            path: path.to_owned(),
            reason,
        })?;
    let mut columns = aligned.columns.into_iter();
    let mut column = || columns.next().unwrap_or_default();
    let trace = RecordedTrace {
        points_mm: points(column(), column()),
        times_s: aligned.times_s,
    };
    Ok((trace, assumed))
}

/// Returns the samples of a channel in the requested unit, all of them numbers.
fn numbers(path: &Path, recording: &TraceRecording, pick: &Pick) -> Result<Vec<f64>, TraceError> {
    let values = numbers_of(path, recording, pick.channel)?.iter();
    Ok(values.map(|value| value * pick.unit.factor).collect())
}

/// Returns the samples of a channel as in the file, all of them numbers.
pub(crate) fn numbers_of<'a>(
    path: &Path,
    recording: &'a TraceRecording,
    channel: ChannelIndex,
) -> Result<&'a [f64], TraceError> {
    let Missing { count, line, text } = recording.missing(channel);
    if count > 0 {
        return Err(TraceError::Problem {
            path: path.to_owned(),
            problem: TraceProblem::Number {
                line,
                column: recording.channels()[channel.get()].name.clone(),
                text,
            },
        });
    }
    Ok(recording.values(channel))
}

/// Returns the column `pos_<axis>`, in mm or degrees unless it names another unit.
pub(crate) fn position_column(
    selection: &ChannelSelection,
    axis: &str,
    channels: &[Channel],
) -> Result<Option<Pick>, SelectError> {
    let name = format!("pos_{axis}");
    let mut all = channels.iter();
    let Some(channel) = all.find(|channel| channel.name.eq_ignore_ascii_case(&name)) else {
        return Ok(None);
    };
    let mut pick = selection.pick_named(&channel.name, ChannelQuantity::Position, channels)?;
    if pick.is_unit_assumed {
        pick.unit.factor = POSITION_UNITS_PER_MM;
    }
    Ok(Some(pick))
}

pub(crate) fn lacks(channels: &[Channel], lacks: &str, help: &str) -> SelectError {
    SelectError::Lacks {
        lacks: lacks.to_owned(),
        found: channels
            .iter()
            .map(|channel| channel.name.clone())
            .collect(),
        help: help.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn file(bytes: &[u8]) -> tempfile::NamedTempFile {
        let file = tempfile::NamedTempFile::new().unwrap();
        std::fs::write(file.path(), bytes).unwrap();
        file
    }

    #[test]
    fn a_header_says_the_unit() {
        // R5.20
        for (header, millimetres) in [
            ("x", Some(3.0)),
            ("X [mm]", Some(3.0)),
            ("x_um", Some(0.003)),
            ("X (µm)", Some(0.003)),
            ("x m", Some(3000.0)),
            ("z", None),
        ] {
            let text = format!("{header};y\n3;1\n4;1\n");
            let file = file(text.as_bytes());
            let points = read_positions(file.path(), &Default::default(), &Disk::default());
            let x = points.ok().map(|(trace, _)| trace.points_mm[0][0]);
            match (x, millimetres) {
                (Some(x), Some(wanted)) => {
                    assert!((x - wanted).abs() < 1e-9 * wanted, "{header}: {x}");
                }
                (x, wanted) => assert_eq!(x, wanted, "{header}"),
            }
        }
    }

    #[test]
    fn every_encoding_of_a_header_is_read() {
        // R2.2
        let wide: Vec<u8> = "\u{feff}x [µm],y [µm]\n1,2\n"
            .encode_utf16()
            .flat_map(u16::to_le_bytes)
            .collect();
        let texts: [&[u8]; 3] = [
            "\u{feff}x [µm],y [µm]\n1,2\n".as_bytes(),
            b"x [\xb5m],y [\xb5m]\n1,2\n",
            &wide,
        ];
        for text in texts {
            let file = file(text);
            let trace = read_positions(file.path(), &Default::default(), &Disk::default());
            let (trace, assumed) = trace.unwrap();
            assert_eq!(trace.points_mm, [[0.001, 0.002]]);
            assert_eq!(assumed, []);
        }
    }

    #[test]
    fn what_is_no_trace_is_said_with_its_line() {
        let said = |text: &str| {
            let error = read_commanded(
                file(text.as_bytes()).path(),
                &ChannelSelection::default(),
                TraceOptions::default(),
            )
            .unwrap_err();
            error.to_string()
        };
        assert!(said("x\n1\none\n").ends_with(":3: column `x` holds `one`, which is not a number"));
        assert!(said("v,comp\n1,ja\n").ends_with(":2: column `comp` holds `ja`"));
        assert!(said("a,b\n1,2\n").contains("neither a column `x` nor a column `v`, only a, b"));
        assert!(said("x,v\n1\n").contains("cannot be read"));
        // The number of the line counts blank lines too.
        assert!(said("x\n1\n\n\none\n").contains(":5: column `x`"));
        assert!(said("t,x\n0,1\n5000,2\n").contains("a CNC cycle of 5000000 ms"));
    }

    #[test]
    fn missing_columns_are_computed() {
        let columns = |text: &str| {
            let trace = read_commanded(
                file(text.as_bytes()).path(),
                &ChannelSelection::default(),
                TraceOptions::default().with_cycle_s(Some(0.002)),
            )
            .unwrap();
            let rows = trace.rows();
            rows.map(|row| [row.time_s, row.position, row.velocity])
                .collect::<Vec<_>>()
        };
        assert_eq!(
            columns("x\n0\n20\n"),
            [[0.0, 0.0, 0.0], [0.002, 20.0, 1000.0]]
        );
        assert_eq!(
            columns("v\n0\n1000\n"),
            [[0.0, 0.0, 0.0], [0.002, 20.0, 1000.0]]
        );
    }

    #[test]
    fn files_of_scope_say_how_to_export_them() {
        // R6.28
        let folder = tempfile::tempdir().expect("a folder");
        let said = |name: &str| {
            let path = folder.path().join(name);
            std::fs::write(&path, "<ScopeProject/>").expect("written");
            let error = read_trace(&path, &Disk::default(), |_| panic!("no channels"))
                .expect_err("no trace");
            (error.to_string(), error.help().unwrap_or_default())
        };
        let (message, help) = said("a.svdx");
        assert!(message.contains("only Scope reads") && help.contains("CSV"));
        let (message, help) = said("a.TCSCOPEX");
        assert!(message.contains("holds no values") && help.contains("CSV"));
    }
}
