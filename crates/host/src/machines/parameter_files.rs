//! Value lists, plants and whole configurations, each read from a file that the user names.

use std::path::Path;

use super::list_files::{ListsOnDisk, read_list};
use crate::disk::{Disk, FileRegistry, read_text};
use crate::error::HostError;
use frictcomp::comp::CncBuild;
use frictcomp::lists::{FrictionList, ReadList, is_xml};
use frictcomp::machine::{ListsReport, check_configuration, check_list};
use frictcomp::text::SourceFile;
use frictcomp_physics::simulation::{Plant, Preset};

/// Reads the values that a list alone would give the control.
///
/// # Errors
/// The file cannot be read, or the control would reject it.
pub fn read_value_list(
    path: &Path,
    registry: &FileRegistry,
    disk: &Disk,
) -> Result<ReadList, HostError> {
    registry.reads("value list", path);
    let source = read_list(path, disk)?;
    FrictionList::read(source).map_err(|refused| HostError::ValueList {
        path: path.to_owned(),
        reason: refused.reason,
        diagnostics: refused.diagnostics,
    })
}

/// Returns the plant of a name: a preset, or a TOML file.
///
/// # Errors
/// There is no such preset, or the file cannot be used.
pub fn find_plant(name: &str, registry: &FileRegistry) -> Result<Plant, HostError> {
    let unknown = match name.parse::<Preset>() {
        Ok(preset) => return Ok(preset.plant()),
        Err(unknown) => unknown,
    };
    let path = Path::new(name);
    let is_file = path.extension().is_some() || path.exists();
    if !is_file {
        return Err(HostError::NoPlant(unknown));
    }
    registry.reads("plant", path);
    let source = SourceFile::new(name.to_owned(), read_text(path)?);
    Plant::from_toml(source).map_err(|error| HostError::Plant {
        path: path.to_owned(),
        diagnostics: vec![*error.diagnostic],
    })
}

/// Returns whether a file is a `frictcomp.toml`, not a list of the control.
pub fn is_configuration(path: &Path) -> bool {
    path.extension()
        .is_some_and(|extension| extension.eq_ignore_ascii_case("toml"))
}

/// Checks a list under a kernel version, where that is known, or a `frictcomp.toml`, which gives its
/// own version; a start-up list and a configuration are checked with every list that they name.
///
/// # Errors
/// The file cannot be read.
pub fn check_list_file(
    path: &Path,
    build: Option<CncBuild>,
    disk: &Disk,
) -> Result<ListsReport, HostError> {
    let mut lists = ListsOnDisk::new(disk);
    let source = read_list(path, disk)?;
    Ok(if is_configuration(path) {
        check_configuration(source, &mut lists)
    } else {
        let is_xml = is_xml(source.text());
        let report = check_list(source, build, &mut lists);
        match report.diagnostics.first() {
            Some(said) if is_xml && report.kind.is_none() => {
                return Err(HostError::NotAProject {
                    path: path.to_owned(),
                    message: said.message.clone(),
                });
            }
            _ => report,
        }
    })
}
