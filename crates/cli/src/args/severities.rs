//! The codes to report, for one call (R9.72).

use clap::Args;

use crate::output::Failure;
use frictcomp::diagnostic::{Code, CodeFilter, Severity, did_you_mean};

/// The codes to report, for this call; those of the control itself always are.
#[derive(Debug, Clone, Default, Args)]
#[command(next_help_heading = "Messages")]
pub(crate) struct SeverityArgs {
    /// Do not report these codes
    #[arg(long, value_name = "CODE", value_delimiter = ',', value_parser = parse_ours)]
    ignore: Vec<Code>,
    /// Report only these codes, and those of the control
    #[arg(long, value_name = "CODE", value_delimiter = ',', value_parser = parse_code)]
    #[arg(conflicts_with = "ignore")]
    select: Vec<Code>,
    /// Change the severity of a code: `info`, `warning`, `error`
    #[arg(long, value_name = "CODE=LEVEL", value_delimiter = ',', value_parser = parse_severity)]
    severity: Vec<(Code, Severity)>,
}

impl SeverityArgs {
    /// Returns the codes to report.
    pub(crate) fn filter(&self) -> Result<CodeFilter, Failure> {
        let mut filter = CodeFilter::default();
        filter.ignore.clone_from(&self.ignore);
        filter.select.clone_from(&self.select);
        filter.severity.clone_from(&self.severity);
        match filter.without_effect() {
            Some(code) => Err(Failure::new(format!(
                "`--severity {code}` has no effect: the code is not reported"
            ))
            .with_help("remove it from `--ignore`, or add it to `--select`")),
            None => Ok(filter),
        }
    }
}

fn parse_code(text: &str) -> Result<Code, String> {
    let text = text.trim();
    text.parse().map_err(|_| {
        let known = Code::ALL.iter().map(|code| code.as_str());
        match did_you_mean(text, known) {
            Some(near) => format!("there is no code `{text}`; did you mean `{near}`?"),
            None => format!("there is no code `{text}`; `frictcomp explain` lists them"),
        }
    })
}

/// Parses a code that may be changed (R9.24).
fn parse_ours(text: &str) -> Result<Code, String> {
    let code = parse_code(text)?;
    if code.is_controller() {
        return Err(format!(
            "{code} is an error of the control; it is always reported"
        ));
    }
    Ok(code)
}

fn parse_severity(text: &str) -> Result<(Code, Severity), String> {
    let Some((code, level)) = text.split_once('=') else {
        return Err("write it as CODE=LEVEL, such as FC402=warning".to_owned());
    };
    let code = parse_ours(code)?;
    match level.trim() {
        "info" => Ok((code, Severity::Info)),
        "warning" => Ok((code, Severity::Warning)),
        "error" => Ok((code, Severity::Error)),
        "off" => Err(format!("write `--ignore {code}` to leave it out")),
        other => Err(format!(
            "`{other}` is not a severity; write `info`, `warning` or `error`"
        )),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn codes_are_given_as_they_are_printed() {
        assert_eq!(parse_code("fc402"), Ok(Code::Fc402));
        assert!(parse_code("FC4O2").unwrap_err().contains("`FC402`"));
        assert!(
            parse_ours("P-ERR-70495")
                .unwrap_err()
                .contains("always reported")
        );
        assert_eq!(
            parse_severity("FC402=error"),
            Ok((Code::Fc402, Severity::Error))
        );
        for wrong in ["FC402", "FC402=off", "FC402=fatal", "P-ERR-70495=info"] {
            assert!(parse_severity(wrong).is_err(), "{wrong}");
        }
    }
}
