//! The blocks that end hazards, in sentences (R10.8).

use crate::wording::{counted, visible_line};
use frictcomp::audit::{Missed, ProgramAudit, WhyMissed};

/// Programs that one block mends and that are named.
const NAMED: usize = 20;

/// Returns why a program is left to the user.
pub fn missed_text(program: &ProgramAudit, missed: &Missed) -> String {
    let way_home = program.axes[missed.mending.at].way_home();
    let changes = "a block that mends this would change the state in which axes move";
    let why = match &missed.why {
        WhyMissed::ChangesMotion(of) if **of == *program.file => changes.to_owned(),
        WhyMissed::ChangesMotion(of) => format!("{changes} in `{of}`, which calls it"),
        _ => "no single block mends this".to_owned(),
    };
    let takes_it = match &missed.why {
        WhyMissed::ChangesMotion(_) => ", or take the block with `--unsafe`",
        _ => "",
    };
    format!(
        "{}: {why}; write `{way_home}` wherever it is needed by hand{takes_it}",
        program.file,
    )
}

/// Returns the programs in which a block of a file changes the state in which axes move.
pub fn changed_text(file: &str, programs: &[String]) -> String {
    format!(
        "{}: a block changes the state in which axes move in {}",
        visible_line(file),
        programs.join(", "),
    )
}

/// Returns which programs the blocks of a file mend, too, since they call it; others may call a file that is no audited
/// program.
pub fn also_mended_text(file: &str, audited: Option<&ProgramAudit>, callers: &[String]) -> String {
    let programs = counted(callers.len(), "program");
    let named = callers.len().min(NAMED);
    let more = match callers.len() - named {
        0 => String::new(),
        more => format!(" and {more} more"),
    };
    let verb = if callers.len() == 1 { "calls" } else { "call" };
    let unnamed = match audited {
        Some(_) => "",
        None => "; programs that were not audited may call it, too",
    };
    format!(
        "{}: this mends {programs} that {verb} it: {}{more}{unnamed}",
        visible_line(file),
        callers[..named].join(", "),
    )
}

/// Returns the effect of `--fix` in words.
pub fn to_write_text(blocks: usize, programs: usize) -> String {
    match blocks {
        0 => "nothing to write".to_owned(),
        _ => format!(
            "{} in {} (`--fix` writes {})",
            counted(blocks, "block"),
            counted(programs, "program"),
            if blocks == 1 { "it" } else { "them" },
        ),
    }
}
