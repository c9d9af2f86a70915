//! The wording of advice in an editor: its settings in place of options.

use frictcomp::diagnostic::{Advice, Budget};

/// Words advice for an editor; `None` if the general wording fits.
pub(super) fn editor(advice: &Advice) -> Option<String> {
    Some(match advice {
        Advice::RaiseBudget(Budget::Blocks) => {
            "look for a loop that does not end, or raise `frictcomp.maxBlocks` in the settings of the editor"
                .to_owned()
        }
        Advice::DescribeMachine(_) => {
            "no machine is described, so P-AXIS-00522 counts as 0 on every axis: describe it in a `frictcomp.toml` next to the program"
                .to_owned()
        }
        _ => return None,
    })
}
