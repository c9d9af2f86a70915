//! Evidence in a folder on the machine of its programs, before it has a configuration (R9.73).

use std::path::{Path, PathBuf};

use ignore::WalkBuilder;

use super::walk::find_programs;
use crate::disk::{
    Disk, FolderOptions, FolderSelection, Input, is_list, is_project, normal, read_text, relative,
};
use crate::error::HostError;
use crate::machines::{ListsOnDisk, check_list_file, read_list};
use frictcomp::diagnostic::Code;
use frictcomp::lists::{ListKind, is_xml};
use frictcomp::machine::{Configuration, NoLists, Outline, check_list};
use frictcomp::text::shown_path;

/// Depth below the folder at which a start-up list is looked for.
const DEPTH: usize = 4;

/// Returns what a folder shows about its machine: the given or found start-up list or TwinCAT project, otherwise
/// the axes of the programs.
///
/// # Errors
/// The folder does not exist, contains several of them, or the given file is neither.
pub fn outline_of(
    folder: &Path,
    startup: Option<&Path>,
    options: &FolderOptions,
) -> Result<Outline, HostError> {
    if !folder.is_dir() {
        return Err(HostError::NoFolder(folder.to_owned()));
    }
    let startup = match startup {
        Some(path) => Some(path.to_owned()),
        None => lists_below(folder)?
            .pop()
            .filter(|it| it.kind == ListKind::Startup)
            .map(|it| it.path),
    };
    let Some(path) = startup else {
        return Ok(Outline::of_programs(programs(folder, options)));
    };
    let seen = shown_path(&seen_from(folder, &path)?);
    if is_xml(read_list(&path, &Disk::default())?.text()) {
        check_list_file(&path, None, &Disk::default())?;
        return Ok(Outline::Project(seen));
    }
    check_startup(&path)?;
    Ok(Outline::Startup(seen))
}

/// A list below a folder.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub struct FoundList {
    /// Path of the list.
    pub path: PathBuf,
    /// Kind of the list; a TwinCAT project, which holds all lists, counts as a start-up list.
    pub kind: ListKind,
}

/// Returns the start-up list or the TwinCAT project below a folder, or else all lists there, recognised by their
/// content.
///
/// # Errors
/// There are several start-up lists or projects.
pub fn lists_below(folder: &Path) -> Result<Vec<FoundList>, HostError> {
    let disk = Disk::default();
    let mut found: Vec<FoundList> = Vec::new();
    let walk = WalkBuilder::new(folder)
        .max_depth(Some(DEPTH))
        .sort_by_file_name(std::ffi::OsStr::cmp)
        .build();
    for entry in walk.filter_map(Result::ok) {
        let path = entry.path();
        let kind = if is_project(path) {
            let project = check_list_file(path, None, &disk).ok();
            project.map(|_| ListKind::Startup)
        } else if is_list(path) {
            let list = read_list(path, &disk).ok();
            list.and_then(|list| check_list(list, None, &mut NoLists).kind)
        } else {
            None
        };
        let path = path.strip_prefix(".").unwrap_or(path).to_owned();
        found.extend(kind.map(|kind| FoundList { path, kind }));
    }
    let is_startup = |it: &FoundList| it.kind == ListKind::Startup;
    match found.iter().filter(|it| is_startup(it)).count() {
        0 => {}
        1 => found.retain(is_startup),
        _ => {
            let several = found.into_iter().filter(is_startup).map(|it| it.path);
            return Err(HostError::SeveralStartupLists(several.collect()));
        }
    }
    Ok(found)
}

/// Returns an error that names the kind of file found instead of a start-up list.
fn check_startup(path: &Path) -> Result<(), HostError> {
    let disk = Disk::default();
    let list = read_list(path, &disk)?;
    let configuration = Configuration::from_startup(list, &mut ListsOnDisk::new(&disk));
    let wrong = configuration
        .diagnostics
        .iter()
        .find(|said| said.code == Code::Fc125 && *said.place.file == *shown_path(path));
    match wrong {
        Some(wrong) if configuration.files.len() == 1 => Err(HostError::NotAStartupList {
            path: path.to_owned(),
            message: wrong.message.clone(),
        }),
        _ => Ok(()),
    }
}

/// Returns a path as a configuration in the folder writes it.
fn seen_from(folder: &Path, path: &Path) -> Result<PathBuf, HostError> {
    let absolute = |path: &Path| {
        let found = std::path::absolute(path).map(|path| normal(&path));
        found.map_err(|error| HostError::read(path, error))
    };
    Ok(relative(&absolute(path)?, &absolute(folder)?))
}

/// Returns the texts of the programs below a folder. Programs that cannot be read are skipped.
fn programs(folder: &Path, options: &FolderOptions) -> impl Iterator<Item = String> {
    let selection = FolderSelection {
        options: options.clone(),
        ..FolderSelection::default()
    };
    let inputs = find_programs(&[folder.to_owned()], |_| selection.clone()).inputs;
    inputs.into_iter().filter_map(|input| match input {
        Input::File(path) => read_text(&path).ok(),
        Input::Open(open) => Some(open.text.to_string()),
        Input::Stdin => None,
    })
}
