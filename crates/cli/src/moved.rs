//! Earlier words of the command line: each is answered with the present one.

use clap::error::{ContextKind, ContextValue};
use clap::{Arg, ArgAction, Command};

/// A row for each earlier command or option that is no longer there, with its present form, or with the reason why
/// there is none.
const MOVED: &str = include_str!("moved.csv");

/// The arguments of a command that is no longer there.
const REST: &str = "rest";

/// Returns the earlier forms, each with its present one, empty where there is none.
fn moved() -> impl Iterator<Item = (&'static str, &'static str)> {
    let rows = MOVED.lines().skip(1);
    rows.filter_map(|row| {
        let (before, rest) = row.split_once(',')?;
        Some((before, rest.split_once(',')?.0))
    })
}

/// Returns the command line with the earlier commands, which take any arguments and are in no list.
pub(super) fn with_moved(tool: Command) -> Command {
    let gone = moved().map(|it| it.0).filter(|it| !it.contains([' ', '-']));
    gone.fold(tool, |tool, name| {
        if tool.find_subcommand(name).is_some() {
            return tool;
        }
        let rest = Arg::new(REST)
            .action(ArgAction::Append)
            .trailing_var_arg(true)
            .allow_hyphen_values(true)
            .num_args(0..);
        let command = Command::new(name).hide(true).disable_help_flag(true);
        tool.subcommand(command.arg(rest))
    })
}

/// Returns the answer to a command that is no longer there.
pub(super) fn command(name: &str, tool: &Command) -> Option<String> {
    let mut arguments = tool.find_subcommand(name)?.get_arguments();
    let is_gone = arguments.any(|it| it.get_id() == REST);
    is_gone.then(|| answer(name)).flatten()
}

/// Returns the answer to an earlier option of a command, from the error about it.
pub(super) fn option(command: &str, error: &clap::Error) -> Option<String> {
    let Some(ContextValue::String(option)) = error.get(ContextKind::InvalidArg) else {
        return None;
    };
    let option = option.split('=').next().filter(|it| it.starts_with('-'))?;
    answer(&format!("{command} {option}")).or_else(|| {
        let (before, now) = moved().find(|it| it.0 == option)?;
        Some(format!("`{before}` is now `{now}`"))
    })
}

fn answer(before: &str) -> Option<String> {
    let (before, now) = moved().find(|it| it.0 == before && !it.1.is_empty())?;
    Some(format!("`frictcomp {before}` is now `frictcomp {now}`"))
}

/// Each earlier command and option, as `tests/grammar/before.csv` has them, is there, has a new form, or has a reason
/// why it went.
#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use clap::{Arg, Command};

    use super::{MOVED, moved};

    /// Returns the arguments of every command by `run`, `run --state`, `run FILES` and so on.
    fn forms(command: &Command, path: &str, forms: &mut BTreeMap<String, Option<Arg>>) {
        forms.insert(path.to_owned(), None);
        for argument in command.get_arguments() {
            let form = format!("{path} {}", form(argument));
            forms.insert(form.trim_start().to_owned(), Some(argument.clone()));
        }
        for below in command.get_subcommands() {
            let path = format!("{path} {}", below.get_name());
            self::forms(below, path.trim_start(), forms);
        }
    }

    fn form(argument: &Arg) -> String {
        let place = || argument.get_id().to_string().to_uppercase();
        let long = argument.get_long().map(|name| format!("--{name}"));
        long.unwrap_or_else(place)
    }

    fn present() -> BTreeMap<String, Option<Arg>> {
        let mut tool = crate::description();
        tool.build();
        let mut present = BTreeMap::new();
        forms(&tool, "", &mut present);
        present
    }

    /// Returns whether an argument takes each of the earlier values, separated by `|`, and has the earlier default.
    fn keeps(argument: &Arg, values: &str, default: &str) -> bool {
        let possible = argument.get_possible_values();
        let is_there = |value: &str| possible.iter().any(|it| it.matches(value, false));
        let defaults = argument.get_default_values().iter();
        let defaults: Vec<_> = defaults.map(|it| it.to_string_lossy()).collect();
        let is_flag = !argument.get_action().takes_values();
        (!values.contains('|') || possible.is_empty() || values.split('|').all(is_there))
            && (is_flag || defaults.join(",") == default)
    }

    #[test]
    fn every_earlier_word_has_a_present_one_or_a_reason() {
        // R9.71
        let present = present();
        let before = include_str!("../tests/grammar/before.csv");
        let renamed = |before: &str| {
            let row = moved().find(|it| it.0 == before && !before.is_empty());
            row.map_or_else(|| before.to_owned(), |it| it.1.to_owned())
        };
        let mut unexplained = Vec::new();
        for row in before.lines().skip(1) {
            let mut cells = row.splitn(4, ',').map(|cell| cell.trim_matches('"'));
            let mut cell = || cells.next().unwrap_or_default();
            let (command, option, values, default) = (cell(), cell(), cell(), cell());
            let whole = format!("{command} {option}").trim().to_owned();
            let options = [option.to_owned(), renamed(option)];
            let forms = [command.to_owned(), renamed(command)]
                .into_iter()
                .flat_map(|it| options.clone().map(|option| format!("{it} {option}")))
                .chain([renamed(&whole)]);
            let mut found = forms.filter_map(|it| present.get(it.trim()));
            let argument = found.next();
            let is_moved = moved().any(|it| it.0 == whole);
            assert!(
                is_moved || argument.is_some(),
                "`{whole}` has neither a new form nor a reason"
            );
            let has_reason = MOVED.lines().any(|line| {
                line.strip_prefix(&format!("{whole},"))
                    .is_some_and(|it| !it.ends_with(','))
            });
            let is_kept = match argument {
                Some(Some(argument)) => is_moved || keeps(argument, values, default),
                _ => true,
            };
            if !is_kept && !has_reason {
                unexplained.push(row);
            }
        }
        assert!(unexplained.is_empty(), "{unexplained:#?}");
    }

    #[test]
    fn every_present_form_is_there() {
        let present = present();
        for (before, now) in moved() {
            let is_option = now.starts_with('-') && present.keys().any(|it| it.ends_with(now));
            let is_gone = now.is_empty() && !MOVED.contains(&format!("\n{before},,\n"));
            assert!(
                is_gone || is_option || present.contains_key(now),
                "{before}: {now}"
            );
        }
    }
}
