//! `frictcomp verify`: a recorded torque against a value list.

use std::path::PathBuf;

use clap::Args;

use super::channels::AxisChannels;
use super::console::Console;
use super::cycle::CycleArgs;
use super::exit;
use super::failure::Failure;
use super::machine::value_list;
use super::outputs::Outputs;
use super::result::{Format, ResultArgs};
use crate::current::Reading;
use crate::host::{Ledger, read_axis};
use crate::identify::{Predictor, verify};
use crate::report::fitted;
use crate::report::verify::{VerifyReport, render_json, render_text};
use crate::text::shown_path;

/// Compare a recorded torque with what a value list predicts
///
/// The prediction is the additive current that the control computes from the list. Says at which
/// speeds the list is too low or too high, whether its sign is inverted, and by how many cycles it is
/// late at reversals. The channels are named as for `identify`. Record without compensation, or
/// record the torque that the drive measures.
#[derive(Debug, Args)]
pub(super) struct VerifyArgs {
    /// The recorded trace
    trace: PathBuf,
    /// The compensation value list
    #[arg(long, value_name = "LIST")]
    value_list: PathBuf,
    #[command(flatten)]
    channels: AxisChannels,
    #[command(flatten)]
    cycle: CycleArgs,
    /// Where the documents leave something open: `standstill=zero,below=origin,delay=reversal`
    #[arg(
        long,
        value_name = "READING",
        default_value = "",
        hide_default_value = true
    )]
    reading: Reading,
    #[command(flatten)]
    result: ResultArgs,
}

/// Runs the command.
pub(super) fn run(args: &VerifyArgs, console: Console) -> Result<u8, Failure> {
    let ledger = Ledger::default();
    ledger.reads("trace", &args.trace);
    let mut outputs = Outputs::new(&ledger, console);
    let mut result = outputs.result(args.result.output.as_deref())?;
    let list = value_list(&args.value_list, &ledger)?;
    outputs.check()?;
    let cycle_s = args.cycle.seconds()?;
    let recording = read_axis(&args.trace, &args.channels.selection(), cycle_s)?;
    let predictor = Predictor {
        list: &list,
        reading: args.reading,
        cycle_s,
    };
    let verified = verify(&recording.track, &predictor)?;
    let report = VerifyReport {
        trace: shown_path(&args.trace),
        list: shown_path(&args.value_list),
        recording,
        verified,
    };
    result.text(&match args.result.format {
        Format::Text => fitted(&render_text(&report), result.look.width),
        Format::Json => render_json(&report),
    })?;
    outputs.finish()?;
    Ok(exit::CLEAN)
}
