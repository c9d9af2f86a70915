//! The lists given to `lists` and `drive`, and how they are read.

use std::path::{Path, PathBuf};

use clap::Args;

use super::control::CncBuildArgs;
use super::machine::outside_policy;
use crate::output::Failure;
use frictcomp::machine::ListsReport;
use frictcomp::text::shown_path;
use frictcomp_host::{
    AllowedRoots, CONFIG_NAME, Disk, check_list_file, find_startup, is_configuration,
    nearest_config,
};

/// The lists of a command.
#[derive(Debug, Args)]
pub(crate) struct NamedLists {
    /// The lists, a TwinCAT project, the `frictcomp.toml` that names them, or the folder of one of these; by default
    /// the nearest `frictcomp.toml` in the current folder or above
    #[arg(value_name = "PATH")]
    files: Vec<PathBuf>,
    #[command(flatten)]
    build: CncBuildArgs,
    /// Also show the text of lists outside the current folder and the folders of the files named
    #[arg(long)]
    allow_outside: bool,
}

/// Returns the configuration in a folder, or else the start-up list or project below it.
fn machine_in(folder: &Path) -> Result<Option<PathBuf>, Failure> {
    let config = folder.join(CONFIG_NAME);
    if config.is_file() {
        return Ok(Some(config));
    }
    Ok(find_startup(folder)?)
}

impl NamedLists {
    /// Returns the files to check (R9.72).
    pub(crate) fn files(&self) -> Result<Vec<PathBuf>, Failure> {
        if !self.files.is_empty() {
            let files = self.files.iter().map(|path| {
                let found = if path.is_dir() {
                    machine_in(path)?
                } else {
                    None
                };
                Ok(found.unwrap_or_else(|| path.clone()))
            });
            return files.collect();
        }
        let nearest = nearest_config(Path::new(""), &Disk::default());
        let failure = || {
            Failure::new(format!("there is no {CONFIG_NAME} in this folder or above"))
                .with_help("name the lists, `frictcomp lists hochlauf.lis`")
        };
        nearest.map(|path| vec![path]).ok_or_else(failure)
    }

    /// Returns the folders whose lists are shown: the current one and those of the files.
    pub(crate) fn allowed_roots(&self, files: &[PathBuf]) -> AllowedRoots {
        let named = files.iter().filter_map(|path| path.parent());
        let real: Vec<PathBuf> = files.iter().flat_map(|path| path.canonicalize()).collect();
        let real = real.iter().filter_map(|path| path.parent());
        let allowed_roots =
            AllowedRoots::new(outside_policy(self.allow_outside)).with(Path::new(""));
        named.chain(real).fold(allowed_roots, AllowedRoots::with)
    }

    /// Checks a list, or every list that a configuration names.
    pub(crate) fn check(&self, path: &Path) -> Result<ListsReport, Failure> {
        let report = check_list_file(path, self.build.cnc_build, &Disk::default())?;
        if self.build.cnc_build.is_some() && is_configuration(path) {
            let message = format!(
                "the build of `{}` is given in the file itself",
                shown_path(path)
            );
            return Err(Failure::new(message).with_help("leave `--cnc-build` out"));
        }
        Ok(report)
    }
}
