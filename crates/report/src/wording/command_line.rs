//! The wording of advice on the command line: its options.

use frictcomp::diagnostic::{Advice, Budget, Code};

/// Words advice for the command line; `None` if the general wording fits.
pub fn command_line(advice: &Advice) -> Option<String> {
    Some(match advice {
        Advice::RaiseBudget(budget) => raise(*budget).to_owned(),
        Advice::Enable(axes) => {
            let axes = axes.join(",");
            format!("to continue as if it were set, run with `--enable {axes}`")
        }
        Advice::DescribeMachine(switched) => {
            let axes = match switched.as_slice() {
                [] => String::new(),
                axes => format!(" {}", axes.join(",")),
            };
            format!(
                "no machine is described, so P-AXIS-00522 counts as 0 on every axis: describe it with `frictcomp init`, or assume friction compensation with `--enable{axes}`"
            )
        }
        Advice::SetVariable(name) => {
            format!("give it with `--set {name}=VALUE` or in `[variables]` of frictcomp.toml")
        }
        Advice::SetSkip(level) => format!(
            "say which skip levels are on, with `--skip {level}` or `--skip none`, or with `skip` in `[machine]` of frictcomp.toml"
        ),
        Advice::AssignVariable(name) => {
            format!("assign it first, `{name} = …`, or give it with `--set {name}=VALUE`")
        }
        Advice::EndLoop => {
            "if a value of the machine ends the loop, test it in the condition and give it with `--set`"
                .to_owned()
        }
        Advice::CompleteMotion => {
            "write what is missing into the program (`F`, absolute positions), or give values with `--set`; the trace restarts after it"
                .to_owned()
        }
        Advice::GiveStart(axes) => {
            let start: Vec<String> = axes.iter().map(|axis| start_word(axis)).collect();
            format!("give it, for example with `--start {}`", start.join(","))
        }
        Advice::GiveToolRadius => {
            "give it with `--tool-radius`, in mm, or for each D word as in `D1=5`: in a bore the tool runs on a smaller circle, and its axes reverse with a larger acceleration"
                .to_owned()
        }
        Advice::AllowOutside => {
            "add its folder to `program_dirs`, or call programs from anywhere with `--allow-outside`"
                .to_owned()
        }
        Advice::TakeIgnored => {
            "take such programs with `--no-ignore`, or exclude it".to_owned()
        }
        Advice::ShowOutside => "`--allow-outside` shows it".to_owned(),
        Advice::GiveNetwork => {
            "export the network information of the master and give it with `--eni FILE`".to_owned()
        }
        Advice::AssignSlave(axis) => {
            format!("say which device drives the axis, with `--slave {axis}=NAME` or `{axis}=NAME:2`")
        }
        Advice::WriteConfiguration => {
            "`frictcomp init` writes a configuration to start from".to_owned()
        }
        Advice::ReadPage(Code::Fc124) => {
            "`frictcomp explain FC124` says how these lists are written".to_owned()
        }
        Advice::ReadPage(code) => format!("`frictcomp explain {code}` says why"),
        _ => return None,
    })
}

/// Returns an axis at 0, `X0`, `X1=0`.
fn start_word(axis: &str) -> String {
    match axis.len() {
        1 => format!("{axis}0"),
        _ => format!("{axis}=0"),
    }
}

fn raise(budget: Budget) -> &'static str {
    match budget {
        Budget::Blocks => {
            "look for a loop that does not end, or raise the budget with `--max-blocks`"
        }
        Budget::Calls => {
            "look for a program that calls itself, or raise the budget with `--max-calls`"
        }
        Budget::Nesting => "allow deeper nesting with `--max-nesting`",
        Budget::Macros => "allow deeper nesting with `--max-macros`",
        Budget::Values => {
            "look for a loop that keeps creating variables, or raise the budget with `--max-values`"
        }
        Budget::Work => {
            "look for macros that use each other, strings that grow, and long regions under an unknown condition, or raise the budget with `--max-work`"
        }
        Budget::Ways => {
            "decide these conditions beforehand with `--set` and `--skip`, or raise the budget with `--max-work`"
        }
        Budget::Cycles => "raise the budget with `--max-cycles`",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_axes_are_proposed_in_one_list() {
        // R1.37
        let words = |axes: &[&str]| {
            let axes = axes.iter().map(|&axis| axis.to_owned()).collect();
            command_line(&Advice::DescribeMachine(axes)).unwrap_or_default()
        };
        assert!(words(&["X", "Y"]).ends_with("`--enable X,Y`"));
        assert!(words(&[]).ends_with("with `--enable`"));
        assert!(words(&[]).contains("`frictcomp init`"));
    }
}
