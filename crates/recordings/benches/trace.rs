//! Reading speed of recorded traces: ten minutes at 1 kHz, ten channels, of which three are kept
//! (R6.18). `cargo bench --bench trace` prints the time and the memory of the columns.

#![allow(clippy::print_stdout)] // The line is its purpose.
#![allow(clippy::cast_precision_loss)] // Rows of a file.

use std::fmt::Write as _;
use std::time::Instant;

use frictcomp_recordings::trace::{ChannelQuantity, ChannelSelection, Choice, TraceReader};

const ROWS: usize = 600_000;
const CHANNELS: usize = 10;
/// Bytes read at a time, as from a file.
const PIECE: usize = 1 << 18;
/// The goal in s.
const GOAL_S: f64 = 2.0;

/// Returns an export of Scope with a column of times for each channel, decimal commas and long numbers.
fn export() -> String {
    let names = ["SetVelo", "ActTorque", "SetPos"];
    let mut text = String::with_capacity(170 << 20);
    for channel in 0..CHANNELS {
        let name = names
            .get(channel)
            .map_or_else(|| format!("Other{channel}"), |it| (*it).to_owned());
        let between = if channel == 0 { "" } else { "\t" };
        let _ = write!(text, "{between}Name\t{name}");
    }
    text.push_str("\n\n");
    for row in 0..ROWS {
        for channel in 0..CHANNELS {
            let between = if channel == 0 { "" } else { "\t" };
            let value = ((row * 7919 + channel * 104_729) % 2_000_003) as f64 / 1000.0 - 1000.0;
            let _ = write!(text, "{between}{row}\t{value:.9}");
        }
        text.push('\n');
    }
    text.replace('.', ",")
}

fn main() {
    let text = export();
    let megabytes = text.len() as f64 / 1e6;
    let selection = ChannelSelection {
        velocity: Some("SetVelo".to_owned()),
        position: Some("SetPos".to_owned()),
        torque: Some("ActTorque".to_owned()),
        ..ChannelSelection::default()
    };
    let begin = Instant::now();
    let mut reader = TraceReader::new(ROWS, |channels| {
        let quantities = [
            ChannelQuantity::Velocity,
            ChannelQuantity::Position,
            ChannelQuantity::Torque,
        ];
        let picks = quantities.map(|quantity| selection.require(quantity, channels));
        let values = picks.into_iter().map(|pick| pick.map(|pick| pick.channel));
        Ok(Choice {
            values: values.collect::<Result<_, _>>()?,
            ..Choice::default()
        })
    });
    for piece in text.as_bytes().chunks(PIECE) {
        reader.feed(piece).expect("a trace");
    }
    let recording = reader.finish().expect("a recording");
    let seconds = begin.elapsed().as_secs_f64();
    let kept: usize = recording
        .kept()
        .map(|channel| recording.values(channel).len())
        .sum();
    println!(
        "{megabytes:.0} MB, {} of {CHANNELS} channels, {kept} samples: {seconds:.2} s, {:.0} MB/s (goal {GOAL_S} s)",
        recording.kept().count(),
        megabytes / seconds
    );
}
