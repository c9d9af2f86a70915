//! The channels of a recorded trace as text and JSON.

use std::fmt::Write as _;

use serde::Serialize;

use crate::document::{Document, Headline, Standing, Table};
use crate::pictures::channels;
use crate::wording::{counted, to_json, visible_line};
use frictcomp_recordings::trace::{Channel, ChannelSummary, TraceRecording};

/// A trace as read.
#[derive(Debug)]
pub struct TraceReport<'a> {
    /// The name of the file.
    pub name: String,
    /// Channels.
    pub recording: &'a TraceRecording,
}

impl TraceReport<'_> {
    /// Returns the title of its picture and of its page.
    pub(crate) fn title(&self) -> String {
        format!("Channels of {}", self.name)
    }

    /// Returns the verdict: the layout and the number of channels, and the first thing that is odd (R18.20).
    pub fn headline(&self) -> Headline {
        let recording = self.recording;
        let channels = counted(recording.channels().len(), "channel");
        let text = format!("{}: {}, {channels}", self.name, recording.layout().as_str());
        Headline::new(Standing::Plain, text)
    }
}

/// Returns the channels over time, as a table, and their oddities.
pub fn document<'a>(report: &'a TraceReport<'_>) -> Document<'a> {
    let mut out = Document::new(report.title(), report.headline());
    out.figure(|| channels(report));
    out.section("Channels");
    out.push_str("\n");
    let recording = report.recording;
    let table = Table::of_numbers(["samples", "every ms", "length s", "least", "greatest"]);
    let mut table = table.left("unit").left("taken as").left("channel");
    for summary in recording.summaries() {
        push_channel(&mut table, &summary);
    }
    out.table(table);
    for summary in recording.summaries() {
        for odd in oddities(&summary) {
            let name = visible_line(&summary.channel.name);
            let _ = writeln!(out, "\nnote: `{name}`: {odd}");
        }
    }
    for remark in recording.remarks() {
        let _ = writeln!(out, "\nnote: {}", visible_line(remark));
    }
    out
}

fn push_channel(table: &mut Table, summary: &ChannelSummary<'_>) {
    let channel = summary.channel;
    let clock = summary.clock.as_ref();
    let step = clock
        .and_then(|clock| clock.step_s)
        .map(|step| number(step * 1000.0));
    let length = clock.map(|clock| number(clock.last_s - clock.first_s));
    let [least, greatest] = summary
        .range
        .map_or([None, None], |range| range.map(|it| Some(number(it))));
    let shown = |text: Option<String>| text.unwrap_or_else(|| "-".to_owned());
    let object = channel
        .object
        .map(|object| object.to_string())
        .unwrap_or_default();
    let known = [&channel.symbol, &channel.comment, &object];
    let known: Vec<String> = known
        .into_iter()
        .filter(|text| !text.is_empty() && **text != channel.name)
        .map(|text| text.split_whitespace().collect::<Vec<_>>().join(" "))
        .collect();
    let mut name = visible_line(&channel.name).into_owned();
    if !known.is_empty() {
        let _ = write!(name, " ({})", visible_line(&known.join("; ")));
    }
    table.row(&[
        &summary.samples,
        &shown(step),
        &shown(length),
        &shown(least),
        &shown(greatest),
        &visible_line(channel.unit.as_deref().unwrap_or("-")),
        &shown(channel.recognised().map(|it| it.to_string())),
        &name,
    ]);
}

/// Returns the oddities of a channel.
fn oddities(summary: &ChannelSummary<'_>) -> Vec<String> {
    let mut odd = Vec::new();
    if let Some(clock) = &summary.clock {
        if clock.gaps > 0 {
            odd.push(format!(
                "{}, the longest of {} ms after {} s",
                counted(clock.gaps, "gap"),
                number(clock.longest_gap_s * 1000.0),
                number(clock.gap_at_s)
            ));
        }
        if clock.backwards > 0 {
            odd.push(format!("{} times do not rise", clock.backwards));
        }
    }
    if summary.missing > 0 {
        odd.push(format!("{} samples are not numbers", summary.missing));
    }
    if let Some(drawn) = &summary.channel.drawn {
        odd.push(format!(
            "drawn by Scope with the factor {} and the offset {}",
            drawn.factor, drawn.offset
        ));
    }
    if let Some([factor, offset]) = summary.channel.unit_scale {
        odd.push(format!(
            "the unit is scaled by Scope, with the factor {factor} and the offset {offset}"
        ));
    }
    odd
}

/// Returns a number with at most six significant digits.
fn number(value: f64) -> String {
    let digits = if value == 0.0 {
        0.0
    } else {
        value.abs().log10().floor()
    };
    if !(-4.0..9.0).contains(&digits) {
        return format!("{value:.3e}");
    }
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // 0 to 9
    let decimals = (5.0 - digits).clamp(0.0, 9.0) as usize;
    let text = format!("{value:.decimals$}");
    if text.contains('.') {
        text.trim_end_matches('0').trim_end_matches('.').to_owned()
    } else {
        text
    }
}

#[derive(Serialize)]
struct TraceDocument<'a> {
    schema: u32,
    headline: Headline,
    file: &'a str,
    layout: &'static str,
    channels: Vec<ChannelRecord<'a>>,
    remarks: &'a [String],
}

#[derive(Serialize)]
struct ChannelRecord<'a> {
    name: &'a str,
    comment: &'a str,
    symbol: &'a str,
    unit: Option<&'a str>,
    object: Option<String>,
    role: Option<&'static str>,
    axis: Option<String>,
    samples: usize,
    missing: u64,
    step_s: Option<f64>,
    first_s: Option<f64>,
    last_s: Option<f64>,
    least: Option<f64>,
    greatest: Option<f64>,
    gaps: Option<u64>,
    longest_gap_s: Option<f64>,
    times_not_rising: Option<u64>,
}

/// Returns the channels as JSON.
pub fn render_json(report: &TraceReport<'_>) -> String {
    let recording = report.recording;
    to_json(&TraceDocument {
        schema: 1,
        headline: report.headline(),
        file: &report.name,
        layout: recording.layout().as_str(),
        channels: recording
            .summaries()
            .map(|summary| record(&summary))
            .collect(),
        remarks: recording.remarks(),
    })
}

fn record<'a>(summary: &ChannelSummary<'a>) -> ChannelRecord<'a> {
    let channel: &'a Channel = summary.channel;
    let clock = summary.clock.as_ref();
    let recognised = channel.recognised();
    ChannelRecord {
        name: &channel.name,
        comment: &channel.comment,
        symbol: &channel.symbol,
        unit: channel.unit.as_deref(),
        object: channel.object.map(|object| object.to_string()),
        role: recognised.as_ref().map(|it| it.role.as_str()),
        axis: recognised.and_then(|it| it.axis),
        samples: summary.samples,
        missing: summary.missing,
        step_s: clock.and_then(|clock| clock.step_s),
        first_s: clock.map(|clock| clock.first_s),
        last_s: clock.map(|clock| clock.last_s),
        least: summary.range.map(|range| range[0]),
        greatest: summary.range.map(|range| range[1]),
        gaps: clock.map(|clock| clock.gaps),
        longest_gap_s: clock
            .filter(|clock| clock.gaps > 0)
            .map(|clock| clock.longest_gap_s),
        times_not_rising: clock.map(|clock| clock.backwards),
    }
}
