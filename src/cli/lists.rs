//! `frictcomp lists`: axis, value, channel and start-up lists.

use std::path::PathBuf;

use clap::Args;

use super::check::{Format, ListingArgs, total};
use super::console::Console;
use super::exit;
use super::failure::Failure;
use super::files::read_text;
use crate::diagnostic::Diagnostic;
use crate::report::Listing;
use crate::source::SourceFile;

/// Reads and checks axis, value, channel and start-up lists
#[derive(Debug, Args)]
pub(super) struct ListsArgs {
    /// The lists
    #[arg(required = true, value_name = "FILE")]
    files: Vec<PathBuf>,
    #[command(flatten)]
    listing: ListingArgs,
}

/// Runs the command.
pub(super) fn run(args: &ListsArgs, console: Console) -> Result<u8, Failure> {
    let mut sources = Vec::new();
    for path in &args.files {
        sources.push(SourceFile::new(
            path.display().to_string(),
            read_text(path)?,
        ));
    }
    let target = console.target(args.listing.output.as_deref())?;
    let mut listing = Listing::new(target.writer, args.listing.format.into(), target.look);
    for source in &sources {
        listing.file();
        for diagnostic in check_list(source)? {
            if listing.diagnostic(&diagnostic).is_break() {
                break;
            }
        }
    }
    listing.finish().map_err(|error| Failure::output(&error))?;
    if listing.is_closed() {
        return Ok(exit::CLEAN);
    }
    if args.listing.format == Format::Text {
        Console::talk(&total(listing.tally()));
    }
    Ok(args.listing.fail_on.status(listing.tally()))
}

/// What there is to say about one list and the lists that it names.
fn check_list(source: &SourceFile) -> Result<Vec<Diagnostic>, Failure> {
    Err(Failure::new(format!(
        "`{}` cannot be checked, this build reads no lists",
        source.name()
    )))
}
