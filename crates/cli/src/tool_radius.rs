//! The radius of the tool on the command line.

use clap::Args;

/// The tool of G41 and G42.
#[derive(Debug, Clone, Default, Args)]
pub(super) struct ToolArgs {
    /// The radius of the tool in mm, for G41 and G42; without it the programmed contour is followed
    #[arg(long = "tool-radius", value_name = "MM", value_parser = parse_radius)]
    pub(super) radius_mm: Option<f64>,
}

fn parse_radius(text: &str) -> Result<f64, String> {
    let radius: Option<f64> = text.trim().parse().ok();
    radius
        .filter(|it| *it > 0.0 && *it <= 1e4)
        .ok_or_else(|| "write the mm of a radius, such as `5`".to_owned())
}
