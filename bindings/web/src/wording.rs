//! The wording of advice on the page: what the page offers, instead of a command line option.

use frictcomp::diagnostic::Advice;

/// Returns the page's words; `None` where the general ones will do.
pub(crate) fn page(advice: &Advice) -> Option<String> {
    Some(match advice {
        Advice::DescribeMachine(switched) => {
            let assumed = match switched.as_slice() {
                [] => String::new(),
                axes => format!(" of {}", axes.join(", ")),
            };
            format!(
                "no machine is described, so P-AXIS-00522 counts as 0 on every axis: drop frictcomp.toml or the start-up list with its axis lists, or assume friction compensation{assumed}"
            )
        }
        Advice::Enable(axes) => format!(
            "to continue as if it were set, assume friction compensation of {}",
            axes.join(", ")
        ),
        Advice::SetVariable(name) => {
            format!(
                "give `{name}` its value in `[variables]` of frictcomp.toml, and drop that file"
            )
        }
        Advice::AllowOutside => {
            "drop the folder that holds all programs, so that their folders are known".to_owned()
        }
        _ => return None,
    })
}
