//! `frictcomp commission trend`: the friction of an axis over the dates of its recordings (R16.6).

use std::path::{Path, PathBuf};

use clap::Args;

use crate::args::{AxisChannelArgs, CycleArgs, ResultArgs, ResultFormat, TorqueArgs, named};
use crate::commands::identify::refusal;
use crate::output::{Console, Failure, HtmlArgs, Outputs, exit, write_page, write_picture};
use frictcomp::text::shown_path;
use frictcomp_host::{Disk, FileRegistry, copies_among, read_axis, recordings_in};
use frictcomp_recordings::identify::{FrictionLevels, IdentifyOptions, friction_changes, identify};
use frictcomp_report::trend::{DatedFriction, TrendReport, document, render_json};

/// Follow the friction of an axis over the dates of its recordings
///
/// Takes every recording of constant speeds in a folder whose name holds a date, `x-2026-03-01.csv`, and
/// lists where Fc, Fs, the viscous part or the offset changed by more than 3 combined errors and 5 %. Give
/// recordings of the same state, for example warm, of one axis.
#[derive(Debug, Args)]
pub(crate) struct TrendArgs {
    /// The folder with the recordings
    #[arg(value_name = "FOLDER")]
    folder: PathBuf,
    #[command(flatten)]
    channels: AxisChannelArgs,
    #[command(flatten)]
    cycle: CycleArgs,
    #[command(flatten)]
    torque: TorqueArgs,
    #[command(flatten)]
    result: ResultArgs,
    /// Draw the parameters over the dates to this SVG file
    #[arg(long, value_name = "FILE")]
    svg: Option<PathBuf>,
    #[command(flatten)]
    html: HtmlArgs,
}

/// Runs the command.
pub(crate) fn run(args: &TrendArgs, console: Console) -> Result<u8, Failure> {
    let paths = recordings_in(&args.folder)?;
    let axis = args.channels.sole_axis("a trend is that of")?;
    let registry = FileRegistry::default();
    for path in &paths {
        registry.reads("recording", path);
    }
    let mut outputs = Outputs::new(&registry, console);
    let svg = outputs.optional("--svg", args.svg.as_deref())?;
    let html = args.html.page(&mut outputs)?;
    let mut target = outputs.result(args.result.output.as_deref())?;
    outputs.check()?;
    let mut report = TrendReport {
        axis: named(axis),
        unit: String::new(),
        dates: Vec::new(),
        changes: Vec::new(),
        left_out: Vec::new(),
    };
    let (dated, undated): (Vec<PathBuf>, Vec<PathBuf>) =
        paths.iter().cloned().partition(|it| date_of(it).is_some());
    for (path, copy) in dated.iter().zip(copies_among(&dated)) {
        if let Some(of) = copy {
            let reason = format!("it is a copy of `{}`", shown_path(of));
            report.left_out.push((shown_path(path), reason));
            continue;
        }
        match args.dated(axis, path, &registry) {
            Ok((dated, unit)) if report.unit.is_empty() || report.unit == unit => {
                report.unit = unit;
                report.dates.push(dated);
            }
            Ok((_, unit)) => {
                let reason = format!("its torque is in {unit}, that of others in {}", report.unit);
                report.left_out.push((shown_path(path), reason));
            }
            Err(failure) => report.left_out.push((shown_path(path), failure.message)),
        }
    }
    let no_date = "its name has no date such as 2026-03-01";
    let undated = undated
        .iter()
        .map(|it| (shown_path(it), no_date.to_owned()));
    report.left_out.extend(undated);
    report.dates.sort_by(|one, other| one.date.cmp(&other.date));
    if report.dates.len() < 2 {
        let message = format!(
            "{} of the {} recordings in `{}` give the friction at a date; a trend needs two",
            report.dates.len(),
            paths.len(),
            shown_path(&args.folder)
        );
        let said = report.left_out.iter();
        return Err(said.fold(Failure::new(message), |failure, (file, reason)| {
            failure.with_help(format!("{file}: {reason}"))
        }));
    }
    let levels: Vec<FrictionLevels> = report.dates.iter().map(|it| it.levels).collect();
    report.changes = friction_changes(&levels);
    let document = document(&report);
    write_picture(svg, &document)?;
    write_page(html, &document)?;
    target.text(&match args.result.format {
        ResultFormat::Text => document.text(console.detail, target.look.width),
        ResultFormat::Json => render_json(&report),
    })?;
    outputs.finish()?;
    Ok(exit::CLEAN)
}

impl TrendArgs {
    /// Returns the friction of a recording with its date, and the unit of its torque.
    fn dated(
        &self,
        axis: &str,
        path: &Path,
        registry: &FileRegistry,
    ) -> Result<(DatedFriction, String), Failure> {
        let (date, day) = date_of(path).unwrap_or_default();
        let cycle = self.cycle.seconds()?;
        let recording = read_axis(
            path,
            &self.channels.selection(axis, path, registry)?,
            cycle,
            &Disk::default(),
        )?;
        let options = IdentifyOptions {
            measured: self.torque.measured(recording.measured),
            ..IdentifyOptions::default()
        };
        let found = identify(&recording.track, &options)
            .map_err(|error| refusal(error, &recording.findings))?;
        let levels = FrictionLevels::of(&found).ok_or_else(|| {
            Failure::new("its friction does not have the form given by Fc, Fs and fv")
        })?;
        let unit = recording
            .torque_unit
            .unwrap_or_else(|| "drive units".to_owned());
        let file = shown_path(path);
        Ok((
            DatedFriction {
                date,
                day,
                file,
                levels,
            },
            unit,
        ))
    }
}

/// Returns the first date in the name of a file, and the days since 1970-01-01.
fn date_of(path: &Path) -> Option<(String, f64)> {
    date_in(&path.file_name()?.to_string_lossy())
}

/// Returns the first date in a name, `2026-03-01`, and the days since 1970-01-01.
fn date_in(name: &str) -> Option<(String, f64)> {
    const FORM: &str = "0000-00-00";
    let starts = name.char_indices().map(|(at, _)| at);
    let mut texts = starts.filter_map(|at| name.get(at..at + FORM.len()));
    texts.find_map(|text| Some((text.to_owned(), day_of(text)?)))
}

/// Returns the days from 1970-01-01 to a date of the Gregorian calendar.
fn day_of(date: &str) -> Option<f64> {
    let mut parts = date.splitn(3, '-');
    let mut part = |length: usize| {
        let text = parts.next()?;
        let is_number = text.len() == length && text.bytes().all(|it| it.is_ascii_digit());
        is_number.then(|| text.parse::<i32>().ok()).flatten()
    };
    let (year, month, day) = (part(4)?, part(2)?, part(2)?);
    let is_leap = (year % 4 == 0 && year % 100 != 0) || year % 400 == 0;
    let february = if is_leap { 29 } else { 28 };
    let months = [31, february, 31, 30, 31, 30, 31, 31, 30, 31, 30, 31];
    let before = usize::try_from(month - 1).ok()?;
    if !(1..=*months.get(before)?).contains(&day) || year < 1 {
        return None;
    }
    let earlier = year - 1;
    let leaps = earlier / 4 - earlier / 100 + earlier / 400;
    let days = earlier * 365 + leaps + months[..before].iter().sum::<i32>() + day - 1;
    // The number of days before 1970-01-01.
    Some(f64::from(days - 719_162))
}

#[cfg(test)]
mod tests {
    use super::date_in;

    /// R16.6: the date of a recording is the first one in its name.
    #[test]
    fn a_date_is_found_in_a_name() {
        let found = |name: &str| date_in(name).map(|(date, day)| format!("{date} {day}"));
        assert_eq!(found("x-1970-01-01.csv").as_deref(), Some("1970-01-01 0"));
        assert_eq!(
            found("ü2024-02-29_x.csv").as_deref(),
            Some("2024-02-29 19782")
        );
        assert_eq!(
            found("99-2026-13-01 2026-03-01.txt").as_deref(),
            Some("2026-03-01 20513")
        );
        assert_eq!(found("2023-02-29.csv"), None);
        assert_eq!(found("friction_x.csv"), None);
    }
}
