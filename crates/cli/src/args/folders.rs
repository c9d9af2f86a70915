//! The files of folders on the command line (R18.5).

use clap::Args;

use crate::output::Console;
use frictcomp_host::{FileRegistry, FolderOptions, IgnoreFiles, LeftOutFiles};

/// Options for the files that folders contribute.
#[derive(Debug, Clone, Args)]
#[command(next_help_heading = "Folders")]
pub(crate) struct FolderArgs {
    /// Leave out files and folders of this pattern, as in a `.gitignore`; may be given several times
    #[arg(long, value_name = "GLOB")]
    exclude: Vec<String>,
    /// Take the programs that are hidden or that ignore files name, too
    #[arg(long)]
    no_ignore: bool,
}

impl FolderArgs {
    /// Returns the options of the host.
    pub(crate) fn options(&self) -> FolderOptions {
        FolderOptions {
            exclude: self.exclude.clone(),
            ignore_files: if self.no_ignore {
                IgnoreFiles::PassedOver
            } else {
                IgnoreFiles::Obeyed
            },
        }
    }
}

/// Reports which programs of folders were not looked at; those that others call were.
pub(crate) fn say_left_out(left_out: &mut LeftOutFiles, registry: &FileRegistry, console: Console) {
    left_out.forget_read(registry);
    if let Some(kinds) = left_out.in_words() {
        console.remark(&format!(
            "not checked: {kinds} (see `frictcomp show files`)"
        ));
    }
}
