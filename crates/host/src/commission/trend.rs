//! The friction of an axis over the dates of its recordings (R16.6).

use std::path::{Path, PathBuf};

use super::error::CommissionError;
use crate::disk::Disk;
use crate::error::HostError;
use crate::recordings::{copies_among, read_axis};
use frictcomp::diagnostic::Code;
use frictcomp::text::shown_path;
use frictcomp_physics::current::Switched;
use frictcomp_recordings::identify::{
    DatedFriction, FrictionLevels, IdentifyOptions, TorqueKind, TrendReport, friction_changes,
    identify,
};
use frictcomp_recordings::trace::ChannelSelection;
use frictcomp_recordings::value_lists::DRIVE_UNITS;

/// Recordings of constant speeds of an axis, and how they are read.
#[derive(Debug, Clone)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct DatedRecordings<'a> {
    /// The folder of the recordings.
    pub folder: &'a Path,
    /// The recordings; those whose name holds no date are left out.
    pub recordings: &'a [PathBuf],
    /// The name of the axis, if it is given.
    pub axis: Option<String>,
    /// Channels.
    pub channels: ChannelSelection,
    /// The CNC cycle in s, if it is known.
    pub cycle_s: Option<f64>,
    /// The kind of the recorded torque, if it is known.
    pub torque_kind: Option<TorqueKind>,
    /// State of friction compensation, if it is known.
    pub compensation: Option<Switched>,
}

impl DatedRecordings<'_> {
    /// Returns the friction at each date, and its changes.
    ///
    /// # Errors
    /// Fewer than two recordings give a friction at a date.
    pub fn trend(&self) -> Result<TrendReport, HostError> {
        let mut report = TrendReport {
            axis: self.axis.clone(),
            unit: String::new(),
            dates: Vec::new(),
            changes: Vec::new(),
            left_out: Vec::new(),
        };
        let (dated, undated): (Vec<PathBuf>, Vec<PathBuf>) = self
            .recordings
            .iter()
            .cloned()
            .partition(|it| date_of(it).is_some());
        for (path, copy) in dated.iter().zip(copies_among(&dated)) {
            let found = match copy {
                Some(of) => Err(format!("it is a copy of `{}`", shown_path(of))),
                None => self.dated(path),
            };
            match found {
                Ok((dated, unit)) if report.unit.is_empty() || report.unit == unit => {
                    report.unit = unit;
                    report.dates.push(dated);
                }
                Ok((_, unit)) => {
                    let reason =
                        format!("its torque is in {unit}, that of others in {}", report.unit);
                    report.left_out.push((shown_path(path), reason));
                }
                Err(reason) => report.left_out.push((shown_path(path), reason)),
            }
        }
        let no_date = "its name has no date such as 2026-03-01";
        let undated = undated.iter();
        let undated = undated.map(|it| (shown_path(it), no_date.to_owned()));
        report.left_out.extend(undated);
        report.dates.sort_by(|one, other| one.date.cmp(&other.date));
        if report.dates.len() < 2 {
            return Err(CommissionError::NoTrend {
                folder: self.folder.to_owned(),
                dates: report.dates.len(),
                recordings: self.recordings.len(),
                left_out: report.left_out,
            }
            .into());
        }
        let levels: Vec<FrictionLevels> = report.dates.iter().map(|it| it.levels).collect();
        report.changes = friction_changes(&levels);
        Ok(report)
    }

    /// Returns the friction of a recording with its date, and the unit of its torque; or why there is none.
    fn dated(&self, path: &Path) -> Result<(DatedFriction, String), String> {
        let (date, day) = date_of(path).unwrap_or_default();
        let recording = read_axis(path, &self.channels, self.cycle_s, &Disk::default());
        let recording = recording.map_err(|error| error.to_string())?;
        let options = IdentifyOptions {
            measured: recording
                .measured
                .stated(self.torque_kind, self.compensation),
            ..IdentifyOptions::default()
        };
        let found = identify(&recording.track, &options).map_err(|error| error.to_string())?;
        let mut findings = found.findings.iter().chain(&recording.findings);
        // A torque that is not that of the motion, or a unit that is not that of the values, is no change of the axis.
        if let Some(wrong) = findings.find(|it| matches!(it.code, Code::Fc522 | Code::Fc524)) {
            return Err(format!("{}: {}", wrong.code, wrong.message));
        }
        let levels = FrictionLevels::of(&found).ok_or_else(|| {
            "its friction does not have the form given by Fc, Fs and fv".to_owned()
        })?;
        let unit = recording.torque_unit;
        let file = shown_path(path);
        let dated = DatedFriction {
            date,
            day,
            file,
            levels,
        };
        Ok((dated, unit.unwrap_or_else(|| DRIVE_UNITS.to_owned())))
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
