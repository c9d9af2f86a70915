//! The findings of an earlier run, so that only new ones are shown (R17.3).

use std::path::PathBuf;

use clap::Args;
use serde_json::{Value, json};

use crate::output::{Console, Failure, Outputs, write_text};
use frictcomp_host::{Baseline, FileRegistry, KnownFindings, OutputFile};

/// Options for known findings.
#[derive(Debug, Clone, Args)]
pub(crate) struct BaselineArgs {
    /// Instead of listing the messages, write them to this file, for `--baseline`
    #[arg(long, value_name = "FILE")]
    #[arg(conflicts_with_all = ["baseline", "diff", "format", "output", "statistics"])]
    write_baseline: Option<PathBuf>,
    /// List only messages that are not in this file, which `--write-baseline` wrote
    #[arg(long, value_name = "FILE", conflicts_with_all = ["diff"])]
    baseline: Option<PathBuf>,
}

impl BaselineArgs {
    /// Opens the file to be written, or reads the one that is there.
    pub(crate) fn open(
        &self,
        registry: &FileRegistry,
        outputs: &mut Outputs,
    ) -> Result<(Baseline, Option<OutputFile>), Failure> {
        if let Some(path) = &self.write_baseline {
            let file = outputs.file("--write-baseline", path)?;
            return Ok((Baseline::kept_for(path), Some(file)));
        }
        let known = match &self.baseline {
            Some(path) => Baseline::read(path, registry)?,
            None => Baseline::default(),
        };
        Ok((known, None))
    }

    /// Returns whether findings are written instead of listed.
    pub(crate) fn is_written(&self) -> bool {
        self.write_baseline.is_some()
    }
}

/// Writes the file, or reports what was known, and what is gone; returns the record of that.
pub(crate) fn finish(
    (mut baseline, file): (Baseline, Option<OutputFile>),
    console: Console,
    registry: &FileRegistry,
) -> Result<Option<Value>, Failure> {
    let Some(KnownFindings {
        known,
        errors,
        gone,
        ..
    }) = baseline.counts(registry)
    else {
        return Ok(None);
    };
    let of_errors = match errors {
        0 => String::new(),
        1 => " (1 error of the control)".to_owned(),
        several => format!(" ({several} errors of the control)"),
    };
    let plural = if known == 1 { "" } else { "s" };
    let say = |line: &str| {
        // Errors are never hidden, whatever else is.
        if errors > 0 {
            Console::talk(line);
        } else {
            console.remark(line);
        }
    };
    if let Some(mut file) = file {
        write_text(&mut file, &baseline.text())?;
        say(&format!(
            "baseline: {known} finding{plural} written{of_errors}"
        ));
        return Ok(None);
    }
    say(&format!(
        "baseline: {known} known finding{plural}{of_errors}, {gone} no longer there"
    ));
    let record = json!({ "record": "baseline", "known": known, "errors": errors, "gone": gone });
    Ok(Some(record))
}
