//! A dropped recording: its channels, its circle, and a value list against it.

use std::path::Path;

use frictcomp_host::{
    FileRegistry, HostError, TraceError, read_axis, read_trace, read_turns, read_value_list,
    sole_axis,
};
use frictcomp_physics::circle::{CommandedCircle, PathCentre, Recording};
use frictcomp_physics::current::Reading;
use frictcomp_recordings::identify::{Predictor, verify_recording};
use frictcomp_recordings::trace::{ChannelQuantity, ChannelSelection, Choice};
use frictcomp_report::Detail;
use frictcomp_report::results::circle::{self, CircleReport};
use frictcomp_report::results::trace::{self, TraceReport};
use frictcomp_report::results::verify::{self, VerifyReport};
use serde::{Deserialize, Serialize};

use crate::drawn_report::DrawnReport;
use crate::dropped::Dropped;
use crate::refusal::Refusal;
use crate::run::json;

/// A recording to be shown.
#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(crate) struct RecordingSettings {
    path: String,
    /// The commanded radius of the circle, if it is known.
    radius_mm: Option<f64>,
}

/// A value list to be compared with a recording.
#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(crate) struct VerifySettings {
    path: String,
    list: String,
    axis: Option<String>,
    velocity: Option<String>,
    torque: Option<String>,
}

#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
struct RecordingAnswer<'a> {
    channels: DrawnReport<'a>,
    /// The names of the channels.
    names: Vec<&'a str>,
    /// Report on the circle of two axes, if they move on one.
    circle: Option<DrawnReport<'a>>,
    /// Reason why positions of two axes are no circle.
    no_circle: Option<String>,
}

/// Returns the channels of a recording, and its circle.
pub(crate) fn answer(
    dropped: &mut Dropped,
    settings: &RecordingSettings,
) -> Result<Vec<u8>, Refusal> {
    let disk = dropped.disk();
    let path = Path::new(&settings.path);
    let recording = read_trace(path, &disk, |channels| {
        let time = ChannelSelection::default().find(ChannelQuantity::Time, channels)?;
        Ok(Choice::all(channels, time))
    })?;
    let report = TraceReport {
        name: settings.path.clone(),
        recording: &recording,
    };
    let channels = trace::document(&report);
    let unnamed = <[ChannelSelection; 2]>::default();
    let turns = read_turns(path, &unnamed, settings.radius_mm, &disk);
    let circle = turns.and_then(|(circles, assumed)| {
        let commanded = CommandedCircle {
            radius_mm: settings.radius_mm,
            ..CommandedCircle::default()
        };
        let circle = Recording::new(circles, commanded, PathCentre::default());
        Ok(CircleReport::recorded((
            circle.map_err(TraceError::Circles)?,
            assumed,
        )))
    });
    let (circle, no_circle) = match circle {
        Ok(report) => (Some(report), None),
        Err(HostError::Trace(error @ (TraceError::Circle { .. } | TraceError::Circles(_)))) => {
            (None, Some(error.to_string()))
        }
        // It has no two axes.
        Err(_) => (None, None),
    };
    let circle = circle.as_ref().map(circle::document);
    Ok(json(&RecordingAnswer {
        channels: DrawnReport::from(&channels),
        names: recording
            .channels()
            .iter()
            .map(|it| it.name.as_str())
            .collect(),
        circle: circle.as_ref().map(DrawnReport::from),
        no_circle,
    }))
}

/// Returns the fit of a value list to a recording.
pub(crate) fn verify(dropped: &mut Dropped, settings: &VerifySettings) -> Result<Vec<u8>, Refusal> {
    let disk = dropped.disk();
    let list = read_value_list(Path::new(&settings.list), &FileRegistry::default(), &disk)?.list;
    let axis = match &settings.axis {
        Some(given) => Some(given.clone()),
        None => sole_axis(Path::new(&settings.path), &disk)?,
    };
    let selection = ChannelSelection {
        axis: axis.clone(),
        velocity: settings.velocity.clone(),
        torque: settings.torque.clone(),
        ..ChannelSelection::default()
    };
    let mut recording = read_axis(Path::new(&settings.path), &selection, None, &disk)?;
    let predictor = Predictor {
        list: &list,
        reading: Reading::default(),
        cycle_s: None,
    };
    let verified = verify_recording(&mut recording, &predictor)
        .map_err(|error| Refusal::new(error.to_string()))?;
    let report = VerifyReport {
        axis,
        trace: settings.path.clone(),
        list: settings.list.clone(),
        recording,
        verified,
    };
    Ok(json(&verify::document(&report).shown(Detail::Brief)))
}
