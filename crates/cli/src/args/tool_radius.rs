//! The radii of tools on the command line.

use std::collections::BTreeMap;
use std::sync::Arc;

use clap::Args;

use super::quantities;
use frictcomp_physics::motion::ToolRadii;

/// The tools of G41 and G42.
#[derive(Debug, Clone, Default, Args)]
pub(crate) struct ToolArgs {
    /// The radius of the tool in mm, for G41 and G42, or one for each D word, such as `D1=5,D2=8`; without it the
    /// programmed contour is followed
    #[arg(long = "tool-radius", value_name = "MM", value_parser = parse_radii)]
    pub(crate) radii: Option<ToolRadii>,
}

fn parse_radii(text: &str) -> Result<ToolRadii, String> {
    if !text.contains('=') {
        return parse_radius(text).map(ToolRadii::Every);
    }
    let mut radii = BTreeMap::new();
    for one in text.split(',') {
        let (word, radius) = one
            .split_once('=')
            .ok_or_else(|| format!("write `{one}` as a D word and its radius, such as `D1=5`"))?;
        let number = word.trim().strip_prefix(['D', 'd']).unwrap_or_default();
        let number: u32 = number
            .parse()
            .map_err(|_| format!("`{word}` is no D word; write it as in `D1=5`"))?;
        if radii.insert(number, parse_radius(radius)?).is_some() {
            return Err(format!("D{number} is given twice"));
        }
    }
    Ok(ToolRadii::OfData(Arc::new(radii)))
}

fn parse_radius(text: &str) -> Result<f64, String> {
    let radius = quantities::mm(text).ok();
    radius
        .filter(|it| *it > 0.0 && *it <= 1e4)
        .ok_or_else(|| format!("`{text}` is no radius in mm; write it as in `5`, or `D1=5,D2=8`"))
}
