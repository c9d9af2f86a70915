//! A plant as a plant file.

use std::fmt::Write as _;

use super::from_file::parameter;
use super::parameters::DriveParameters;
use super::plant::Plant;
use super::plant_keys::{ATTRACTION, AXES, ELEMENTS, PlantQuantity};

impl Plant {
    /// Returns the plant file of this plant, except for stiction compensation and friction that differs between the
    /// directions. Each remark is a comment at its top.
    pub fn to_toml(&self, remarks: &[String]) -> String {
        let mut out = String::new();
        for remark in remarks {
            let line = remark.replace(char::is_control, " ");
            let _ = writeln!(out, "# {line}");
        }
        for (axis, drive) in AXES.into_iter().zip([&self.x, &self.y]) {
            let _ = write!(out, "\n[{axis}]\n{}", table(drive));
        }
        out
    }
}

fn table(drive: &DriveParameters) -> String {
    let mut drive = drive.clone();
    let mut out = String::new();
    for quantity in PlantQuantity::ALL {
        let value = match quantity {
            PlantQuantity::Backlash => Some(drive.backlash_m * 1e6),
            _ => parameter(&mut drive, quantity).copied(),
        };
        let facts = quantity.facts();
        if let Some(value) = value {
            let unit = if facts.unit.is_empty() { "" } else { "  # " };
            let _ = writeln!(out, "{} = {value:?}{unit}{}", facts.key, facts.unit);
        }
    }
    let elements = drive.friction.elements.iter();
    let elements: Vec<String> = elements
        .map(|it| format!("[{:?}, {:?}]", it.share, it.stiffness_n_per_m))
        .collect();
    let _ = writeln!(out, "{ELEMENTS} = [{}]", elements.join(", "));
    let _ = writeln!(
        out,
        "{ATTRACTION} = {:?}",
        drive.friction.attraction_n_per_s
    );
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::simulation::Preset;
    use frictcomp::text::SourceFile;

    #[test]
    fn what_is_written_is_read_again() {
        // R16.3
        let mut plant = Preset::Mid.plant();
        plant.x = plant.x.with_contact(1.234_567);
        plant.y.mass_kg = 987.6;
        plant.y.backlash_m = 2e-6;
        let text = plant.to_toml(&["fitted\nto circles".to_owned()]);
        assert!(text.starts_with("# fitted to circles\n"), "{text}");
        let name = plant.name.clone();
        let read = Plant::from_toml(SourceFile::new(name, text)).unwrap();
        assert_eq!(read, plant);
    }
}
