//! `frictcomp man`: the manual page.

use super::console::Console;
use super::exit;
use super::failure::Failure;

/// Runs the command.
pub(super) fn run(console: Console) -> Result<u8, Failure> {
    let mut page = Vec::new();
    clap_mangen::Man::new(super::description())
        .render(&mut page)
        .map_err(|error| Failure::output(&error))?;
    console.print(&String::from_utf8_lossy(&page))?;
    Ok(exit::CLEAN)
}
