//! `frictcomp man`: the manual pages, for `man` and for the book.

use std::collections::VecDeque;
use std::fmt::Write as _;
use std::path::PathBuf;

use clap::builder::StyledStr;
use clap::{Args, ValueEnum};

use crate::output::{Console, Failure, Outputs, exit, write_text};
use frictcomp_host::FileRegistry;

/// Print the manual page, or write one for each command
#[derive(Debug, Args)]
pub(crate) struct ManArgs {
    /// Write the pages of the tool and of each command to this folder
    #[arg(long, value_name = "FOLDER")]
    into: Option<PathBuf>,
    /// Format of the pages
    #[arg(long, value_enum, value_name = "FORMAT", default_value = "roff")]
    format: PageFormat,
}

/// Format of a manual page.
#[derive(Debug, Clone, Copy, ValueEnum)]
enum PageFormat {
    /// For the command `man`
    Roff,
    /// For the book and for web pages
    Markdown,
}

impl PageFormat {
    /// Returns the name of the page of a command and its text.
    fn page(self, command: clap::Command) -> Result<(String, String), Failure> {
        match self {
            Self::Roff => page(command),
            Self::Markdown => Ok(markdown(&command)),
        }
    }
}

/// Runs the command.
pub(crate) fn run(args: &ManArgs, tool: clap::Command, console: Console) -> Result<u8, Failure> {
    let Some(folder) = &args.into else {
        let (_, page) = args.format.page(tool)?;
        console.print(&page)?;
        return Ok(exit::CLEAN);
    };
    std::fs::create_dir_all(folder).map_err(|error| Failure::writing(folder, error))?;
    let mut outputs = Outputs::new(&FileRegistry::default(), console);
    for command in commands(tool) {
        let (name, text) = args.format.page(command)?;
        let mut file = outputs.file("--into", &folder.join(name))?;
        write_text(&mut file, &text)?;
    }
    outputs.finish()?;
    Ok(exit::CLEAN)
}

/// Returns the tool and its commands, each by its full name, `frictcomp-config-show`.
fn commands(command: clap::Command) -> Vec<clap::Command> {
    let mut found = Vec::new();
    let mut open = VecDeque::from([command.disable_help_subcommand(true)]);
    while let Some(mut command) = open.pop_front() {
        // Propagates global options to the subcommands.
        command.build();
        let name = command.get_display_name().unwrap_or("frictcomp").to_owned();
        open.extend(command.get_subcommands().map(|it| {
            let whole = format!("{name}-{}", it.get_name());
            it.clone().display_name(whole)
        }));
        found.push(command);
    }
    found
}

/// Returns the name of a page and its text.
fn page(command: clap::Command) -> Result<(String, String), Failure> {
    let man = clap_mangen::Man::new(command);
    let name = man.get_filename();
    let mut page = Vec::new();
    man.render(&mut page).map_err(Failure::output)?;
    Ok((name, String::from_utf8_lossy(&page).into_owned()))
}

/// Returns the name and the text of a page in Markdown: what a command does, how it is called, its arguments and options
/// under their headings, and its commands.
fn markdown(command: &clap::Command) -> (String, String) {
    let name = command.get_display_name().unwrap_or("frictcomp");
    let usage = command.clone().render_usage().to_string();
    let usage = usage.trim_start_matches("Usage: ");
    let words = usage
        .split(' ')
        .take_while(|it| !it.starts_with(['[', '<', '-']));
    let mut page = format!("# {}\n\n", words.collect::<Vec<_>>().join(" "));
    let about = command.get_long_about().or_else(|| command.get_about());
    let about = about.map(ToString::to_string).unwrap_or_default();
    for paragraph in about.split("\n\n") {
        let _ = write!(
            page,
            "{}.\n\n",
            paragraph.trim_end_matches('.').replace('\n', " ")
        );
    }
    let _ = write!(page, "```text\n{usage}\n```\n");
    let shown = || command.get_arguments().filter(|it| !it.is_hide_set());
    let mut headings: Vec<&str> = Vec::new();
    for heading in shown().map(heading) {
        if !headings.contains(&heading) {
            headings.push(heading);
        }
    }
    for title in headings {
        let _ = write!(page, "\n## {title}\n\n");
        for argument in shown().filter(|it| heading(it) == title) {
            let help = argument.get_long_help().or_else(|| argument.get_help());
            let _ = writeln!(page, "- `{}`: {}", spelling(argument), plain(help));
            for value in argument.get_possible_values() {
                if let Some(help) = value.get_help() {
                    let _ = writeln!(page, "  - `{}`: {}", value.get_name(), plain(Some(help)));
                }
            }
        }
    }
    let commands: Vec<_> = command
        .get_subcommands()
        .filter(|it| !it.is_hide_set() && it.get_name() != "help")
        .collect();
    if !commands.is_empty() {
        page.push_str("\n## Commands\n\n");
    }
    for command in commands {
        let (word, about) = (command.get_name(), plain(command.get_about()));
        let _ = writeln!(page, "- [`{word}`]({name}-{word}.md): {about}");
    }
    if let Some(examples) = command.get_after_help() {
        let _ = write!(
            page,
            "\n## Examples\n\n```text\n{}\n```\n",
            examples.to_string().trim()
        );
    }
    (format!("{name}.md"), page)
}

/// Returns a text of the help as one line.
fn plain(text: Option<&StyledStr>) -> String {
    let text = text.map(ToString::to_string).unwrap_or_default();
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

/// Returns the heading of an argument.
fn heading(argument: &clap::Arg) -> &str {
    match argument.get_help_heading() {
        Some(heading) => heading,
        None if argument.is_positional() => "Arguments",
        None => "Options",
    }
}

/// Returns how an argument is written: `-o, --output <FILE>`.
fn spelling(argument: &clap::Arg) -> String {
    let (short, long) = (argument.get_short(), argument.get_long());
    let names = short.map(|it| format!("-{it}")).into_iter();
    let mut names: Vec<String> = names.chain(long.map(|it| format!("--{it}"))).collect();
    let values = argument.get_value_names().unwrap_or_default();
    if argument.get_action().takes_values() {
        names.extend(values.iter().map(|it| format!("<{it}>")));
    }
    match names.as_slice() {
        [short, long, rest @ ..] if long.starts_with("--") => {
            [&[format!("{short}, {long}")], rest].concat().join(" ")
        }
        names => names.join(" "),
    }
}
