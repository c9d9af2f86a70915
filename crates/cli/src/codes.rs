//! `frictcomp codes`: every code with its severity and title.

use std::fmt::Write as _;

use clap::Args;
use serde_json::json;

use super::console::Console;
use super::exit;
use super::failure::Failure;
use super::painted::severities;
use super::result::ResultFormat;
use frictcomp::diagnostic::Code;

/// List all codes with severity and title
#[derive(Debug, Args)]
pub(super) struct CodesArgs {
    /// The format of the list
    #[arg(long, default_value = "text")]
    format: ResultFormat,
}

/// Runs the command.
pub(super) fn run(args: &CodesArgs, console: Console) -> Result<u8, Failure> {
    let mut output = String::new();
    match args.format {
        ResultFormat::Text => {
            for code in Code::ALL {
                let severity = code.severity().as_str();
                let _ = writeln!(
                    output,
                    "{:<12}  {severity:<7}  {}",
                    code.as_str(),
                    code.title()
                );
            }
            output = console.fitted(&output);
        }
        ResultFormat::Json => {
            let codes: Vec<_> = Code::ALL
                .iter()
                .map(|code| {
                    json!({
                        "code": code.as_str(),
                        "severity": code.severity().as_str(),
                        "title": code.title(),
                    })
                })
                .collect();
            let document = json!({ "schema": 1, "codes": codes });
            let _ = writeln!(output, "{document:#}");
        }
    }
    console.print_painted(&output, severities)?;
    Ok(exit::CLEAN)
}
