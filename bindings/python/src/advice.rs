//! What to do, in terms of the arguments of Python, where the host has no advice.

use frictcomp_host::HostError;
use frictcomp_host::ask::AskError;
use frictcomp_host::commission::CommissionError;

/// Returns the advice about an error, if there is any.
pub(crate) fn about(error: &HostError) -> Option<String> {
    if let HostError::Ask(AskError::Recording(reason)) = error {
        let advice = about(reason).map_or_else(String::new, |it| it + "; ");
        return Some(advice + AskError::ANSWERS);
    }
    error
        .help()
        .or_else(|| in_arguments(error).map(str::to_owned))
}

fn in_arguments(error: &HostError) -> Option<&'static str> {
    Some(match error {
        HostError::ReplacesSource { .. } => {
            "name another place for the output, or remove the file if nothing needs it"
        }
        HostError::Baseline { .. } => "write a new one with `frictcomp check --write-baseline`",
        HostError::SeveralStartupLists(_) => "name that of the machine with `machine=`",
        HostError::Commission(error) => return of_commissioning(error),
        _ => return None,
    })
}

fn of_commissioning(error: &CommissionError) -> Option<&'static str> {
    Some(match error {
        CommissionError::NotAPlan { .. } => "`frictcomp.plan` writes it",
        CommissionError::NoPlan(_) => {
            "`frictcomp.plan` with `into=` the folder writes it with the programs"
        }
        CommissionError::OtherPlan(_) => {
            "its recordings would count for the new plan; plan into another folder"
        }
        CommissionError::NoLimit { .. } => {
            "give it in `frictcomp.toml`, or the axis list with `machine=`: the way to accelerate has to fit into the \
             travel"
        }
        CommissionError::NotBegun(_) => {
            "begin with the measured friction, `friction={'X': 'comp_x.lis', 'Y': 'comp_y.lis'}`"
        }
        CommissionError::Begun(_) => {
            "leave `friction` and `value_list` out to continue, or name another folder"
        }
        CommissionError::NoBestList => {
            "leave `write_list` out until the circles of a round are recorded"
        }
        _ => return None,
    })
}
