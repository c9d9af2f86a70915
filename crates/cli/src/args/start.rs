//! The positions of axes before a program, on the command line.

use clap::Args;

use super::quantities;
use crate::output::Failure;
use frictcomp::diagnostic::UnknownName;
use frictcomp::machine::Machine;

/// Axis positions before the first program.
#[derive(Debug, Clone, Default, Args)]
pub(crate) struct StartArgs {
    /// Axis positions before the first program, in mm or degrees: `X0,Y-12.5,Z1=30`
    #[arg(long, value_name = "POSITIONS", value_delimiter = ',', value_parser = parse_position)]
    start: Vec<(String, f64)>,
}

impl StartArgs {
    /// Returns the positions as given.
    pub(crate) fn given(&self) -> &[(String, f64)] {
        &self.start
    }

    /// Returns the positions of axes of the machine (R9.74).
    pub(crate) fn positions(&self, machine: &Machine) -> Result<Vec<(String, f64)>, Failure> {
        for (place, (name, _)) in self.start.iter().enumerate() {
            if machine.find(name).is_none() {
                let known = machine.axes.iter().map(|axis| axis.name.as_str());
                let unknown = UnknownName::new(name, known);
                let failure =
                    Failure::new(format!("the machine has no axis `{name}`, from `--start`"));
                return Err(match unknown.help("its axes are") {
                    Some(help) => failure.with_help(help),
                    None => failure,
                });
            }
            if self.start[..place]
                .iter()
                .any(|(earlier, _)| earlier == name)
            {
                return Err(Failure::new(format!(
                    "`--start` gives the position of axis `{name}` twice"
                )));
            }
        }
        Ok(self.start.clone())
    }
}

/// Parses `X12.5`, or `X1=12.5` for names of several letters.
fn parse_position(text: &str) -> Result<(String, f64), String> {
    let text = text.trim();
    let name_end = text.chars().next().map_or(0, char::len_utf8);
    let (name, value) = match text.split_once('=') {
        Some((name, value)) => (name.trim(), value.trim()),
        None => text.split_at(name_end),
    };
    let position = quantities::mm_or_degrees(value).ok();
    match position {
        Some(position) if name.starts_with(|c: char| c.is_ascii_alphabetic()) => {
            Ok((name.to_owned(), position))
        }
        _ => Err("write axes with their positions, `X0,Y-12.5,Z1=30`".to_owned()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn positions_stand_after_names() {
        // R5.1
        let of = |text| parse_position(text);
        assert_eq!(of("X0"), Ok(("X".to_owned(), 0.0)));
        assert_eq!(of(" Y-12.5"), Ok(("Y".to_owned(), -12.5)));
        assert_eq!(of("Z1=30"), Ok(("Z1".to_owned(), 30.0)));
        assert_eq!(of("C = 1e2"), Ok(("C".to_owned(), 100.0)));
        for wrong in ["", "X", "5", "Xnan", "X=inf", "=3", "X1,5x", "Ä5"] {
            assert!(of(wrong).is_err(), "{wrong}");
        }
    }
}
