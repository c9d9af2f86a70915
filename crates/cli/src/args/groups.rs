//! The list of commands that `frictcomp` alone and `frictcomp --help` print: five groups, in the order in which a
//! user meets them.

use std::fmt::Write as _;

use clap::Command;
use clap::builder::StyledStr;

/// The headings, each with its commands.
pub(crate) static GROUPS: [(&str, &[&str]); 5] = [
    (
        "Programs",
        &["run", "check", "audit", "diff", "golden", "contour", "show"],
    ),
    ("Machine", &["init", "config", "lists", "drive"]),
    (
        "Commissioning",
        &[
            "commission",
            "trace",
            "identify",
            "verify",
            "circle",
            "tune",
            "current",
        ],
    ),
    ("The control", &["ask", "replay"]),
    ("Help", &["explain", "help"]),
];

/// Returns the command line with its commands in groups.
pub(crate) fn in_groups(tool: Command) -> Command {
    let about_help = "Print the help of the tool or of a command";
    let tool = tool.subcommand_help_heading("Commands");
    let header = *tool.get_styles().get_header();
    let literal = *tool.get_styles().get_literal();
    let names = GROUPS.iter().flat_map(|(_, names)| names.iter());
    let width = names.map(|name| name.len()).max().unwrap_or_default();
    let mut list = String::new();
    for (heading, names) in GROUPS {
        let _ = writeln!(list, "{header}{heading}:{header:#}");
        for name in names {
            let command = tool.find_subcommand(name);
            let about = command
                .and_then(Command::get_about)
                .map(StyledStr::to_string);
            let about = about.as_deref().unwrap_or(about_help);
            let _ = writeln!(list, "  {literal}{name:width$}{literal:#}  {about}");
        }
        list.push('\n');
    }
    let template = format!(
        "{{before-help}}{{about-with-newline}}\n{{usage-heading}} {{usage}}\n\n{list}{header}Options:{header:#}\n\
         {{options}}{{after-help}}"
    );
    tool.help_template(template)
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::GROUPS;

    #[test]
    fn every_visible_command_is_in_one_group() {
        let tool = crate::description();
        let visible = tool.get_subcommands().filter(|it| !it.is_hide_set());
        let visible: BTreeSet<&str> = visible.map(clap::Command::get_name).collect();
        let grouped = GROUPS.iter().flat_map(|(_, names)| names.iter().copied());
        let grouped: Vec<&str> = grouped.filter(|name| *name != "help").collect();
        assert_eq!(grouped.iter().copied().collect::<BTreeSet<_>>(), visible);
        assert_eq!(grouped.len(), visible.len());
    }
}
