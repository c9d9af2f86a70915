//! The lists given to `lists` and `drive`, and how they are read.

use std::path::{Path, PathBuf};

use clap::Args;

use super::control::CncBuildArgs;
use super::machine::outside_policy;
use crate::output::Failure;
use frictcomp::lists::ListKind;
use frictcomp::machine::ListsReport;
use frictcomp::text::shown_path;
use frictcomp_host::{
    AllowedRoots, CONFIG_NAME, Disk, check_list_file, is_configuration, lists_below, nearest_config,
};

/// The lists of a command.
#[derive(Debug, Args)]
pub(crate) struct NamedLists {
    /// The lists, a TwinCAT project, the `frictcomp.toml` that names them, or a folder with one of these; by default
    /// the nearest `frictcomp.toml` in the current folder or above
    #[arg(value_name = "PATH")]
    files: Vec<PathBuf>,
    #[command(flatten)]
    build: CncBuildArgs,
    /// Also show the text of lists outside the current folder and the folders of the files named
    #[arg(long)]
    allow_outside: bool,
}

/// Returns the configuration in a folder, or else the start-up list or project below it, or else its lists of a kind.
fn lists_in(folder: &Path, is_taken: fn(ListKind) -> bool) -> Result<Vec<PathBuf>, Failure> {
    let config = folder.join(CONFIG_NAME);
    if config.is_file() {
        return Ok(vec![config]);
    }
    let lists = lists_below(folder)?.into_iter();
    let lists = lists.filter(|it| it.kind == ListKind::Startup || is_taken(it.kind));
    let lists: Vec<PathBuf> = lists.map(|it| it.path).collect();
    if lists.is_empty() {
        let failure = Failure::new(format!("there is no list below `{}`", shown_path(folder)));
        return Err(failure.with_help(
            "name a folder with `hochlauf.lis`, axis lists, a project or a `frictcomp.toml`",
        ));
    }
    Ok(lists)
}

impl NamedLists {
    /// Returns the files to check; of a folder without a machine the lists of a kind (R9.72).
    pub(crate) fn files(&self, is_taken: fn(ListKind) -> bool) -> Result<Vec<PathBuf>, Failure> {
        if !self.files.is_empty() {
            let mut files = Vec::new();
            for path in &self.files {
                if path.is_dir() {
                    files.extend(lists_in(path, is_taken)?);
                } else {
                    files.push(path.clone());
                }
            }
            return Ok(files);
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
