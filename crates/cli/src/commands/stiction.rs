//! `frictcomp stiction`: the formulas of Heidenhain's stiction compensation.

use std::collections::BTreeMap;

use clap::Args;

use crate::output::{Console, Failure, HtmlArgs, Job, ResultArgs, exit};
use frictcomp_host::FileRegistry;
use frictcomp_physics::stiction::{Quantity, StictionError, solve};
use frictcomp_report::results::stiction::{document, guideline, render_json};

/// Compute stiction compensation of the Heidenhain TNC 407, 415 and 425 (MP1511 to MP1513)
///
/// Give the values that are known, with or without a unit; what follows from them is computed.
#[derive(Debug, Args)]
pub(crate) struct StictionArgs {
    /// Change of the servo lag over one control loop cycle, in mm by default
    #[arg(long, value_name = "LENGTH", allow_hyphen_values = true, value_parser = |it: &str| Quantity::DeltaSa.parse(it))]
    delta_sa: Option<f64>,
    /// Control loop cycle, in µs by default
    #[arg(long, value_name = "TIME", value_parser = |it: &str| Quantity::Tc.parse(it))]
    tc: Option<f64>,
    /// Gain of the position loop, in (m/min)/mm by default
    #[arg(long, value_name = "GAIN", value_parser = |it: &str| Quantity::Kv.parse(it))]
    kv: Option<f64>,
    /// Factor of stiction compensation, in µs by default
    #[arg(long, value_name = "TIME", value_parser = |it: &str| Quantity::Mp1511.parse(it))]
    mp1511: Option<f64>,
    /// Feed that is added, in m/min by default
    #[arg(long, value_name = "FEED", allow_hyphen_values = true, value_parser = |it: &str| Quantity::FAdd.parse(it))]
    f_add: Option<f64>,
    /// Voltage for rapid traverse, in V by default
    #[arg(long, value_name = "VOLTAGE", value_parser = |it: &str| Quantity::Mp1050.parse(it))]
    mp1050: Option<f64>,
    /// Rapid traverse, in m/min by default
    #[arg(long, value_name = "FEED", value_parser = |it: &str| Quantity::Mp1010.parse(it))]
    mp1010: Option<f64>,
    /// Voltage that is added, in V by default
    #[arg(long, value_name = "VOLTAGE", allow_hyphen_values = true, value_parser = |it: &str| Quantity::VAdd.parse(it))]
    v_add: Option<f64>,
    /// Grating period of the encoder, in µm by default
    #[arg(long, value_name = "LENGTH", value_parser = |it: &str| Quantity::Gp.parse(it))]
    gp: Option<f64>,
    /// Limit of the change of the servo lag, in counting steps
    #[arg(long, value_name = "STEPS", value_parser = |it: &str| Quantity::Mp1512.parse(it))]
    mp1512: Option<f64>,
    /// The same limit as a length, in µm by default
    #[arg(long, value_name = "LENGTH", value_parser = |it: &str| Quantity::DeltaSaLimit.parse(it))]
    delta_sa_limit: Option<f64>,
    /// Commanded feed, in m/min by default
    #[arg(long, value_name = "FEED", value_parser = |it: &str| Quantity::Feed.parse(it))]
    feed: Option<f64>,
    /// Feed up to which stiction is compensated, in m/min by default
    #[arg(long, value_name = "FEED", value_parser = |it: &str| Quantity::Mp1513.parse(it))]
    mp1513: Option<f64>,
    #[command(flatten)]
    result: ResultArgs,
    #[command(flatten)]
    html: HtmlArgs,
}

impl StictionArgs {
    fn given(&self) -> BTreeMap<Quantity, f64> {
        let options = [
            (Quantity::DeltaSa, self.delta_sa),
            (Quantity::Tc, self.tc),
            (Quantity::Kv, self.kv),
            (Quantity::Mp1511, self.mp1511),
            (Quantity::FAdd, self.f_add),
            (Quantity::Mp1050, self.mp1050),
            (Quantity::Mp1010, self.mp1010),
            (Quantity::VAdd, self.v_add),
            (Quantity::Gp, self.gp),
            (Quantity::Mp1512, self.mp1512),
            (Quantity::DeltaSaLimit, self.delta_sa_limit),
            (Quantity::Feed, self.feed),
            (Quantity::Mp1513, self.mp1513),
        ];
        let given = options
            .into_iter()
            .filter_map(|(quantity, value)| Some((quantity, value?)));
        given.collect()
    }
}

/// Returns the advice on values that give no result.
fn help(error: &StictionError) -> &'static str {
    match error {
        StictionError::Nothing | StictionError::TooFew { .. } => {
            "give all quantities of a formula but one, each with its own option"
        }
        StictionError::Contradiction { .. } => "leave out the value that is to be computed",
        StictionError::Limited { .. } => "raise MP1511 or the limit, MP1512",
        _ => "correct the value",
    }
}

/// Runs the command.
pub(crate) fn run(args: &StictionArgs, console: Console) -> Result<u8, Failure> {
    let solution = solve(&args.given())
        .map_err(|error| Failure::new(error.to_string()).with_help(help(&error)))?;
    let job = Job::new(&args.result, &FileRegistry::default(), console)?.with_page(&args.html)?;
    job.finish(&document(&solution), || render_json(&solution))?;
    for kept in &solution.guidelines {
        Console::talk(&format!("warning: {}", guideline(*kept)));
    }
    Ok(exit::CLEAN)
}
