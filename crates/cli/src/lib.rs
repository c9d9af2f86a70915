//! The command line: files, arguments, exit status. Each command is a file or a folder of `commands`.
//!
//! Takes the arguments and returns the exit status, for a process that continues:
//!
//! ```
//! assert_eq!(frictcomp_cli::status(["frictcomp", "explain", "no such word"].map(Into::into)), 2);
//! ```

mod args;
mod commands;
mod moved;
mod output;

use std::ffi::OsString;
use std::io::Write;
use std::process::ExitCode;

use clap::error::ErrorKind;
use clap::{ArgMatches, CommandFactory, FromArgMatches, Parser, Subcommand};

pub use commands::explain::{NoPage, page_about};

use args::{Meant, expanded, in_groups, parse_width, with_examples};
use commands::{
    ask, audit, check, circle, commission, completions, config, conformance, contour, current, dap,
    diff, drive, explain, golden, identify, init, lists, lsp, man, replay, run, show, stiction,
    trace, tune, verify,
};
use output::{CodePage, Color, Console, Encoded, Failure, OutputContents, broken_pipe, exit};

use frictcomp::syntax::bound_reading;
use frictcomp_host::{Replaces, clean_up_when_stopped, survive_file_size_limit};
use frictcomp_report::{Detail, visible, visible_line};

/// Dry-run ISG and TwinCAT CNC programs and show, block by block, which axes have friction
/// compensation active.
#[derive(Debug, Parser)]
#[command(
    name = "frictcomp",
    bin_name = "frictcomp",
    version,
    max_term_width = 100
)]
struct Arguments {
    /// When to colour the output
    #[arg(long, global = true, value_name = "WHEN", default_value = "auto")]
    #[arg(help_heading = "Terminal")]
    color: Color,
    /// Width of text in columns; by default that of the terminal, else `COLUMNS`, else 100
    #[arg(long, global = true, value_name = "N", value_parser = parse_width)]
    #[arg(help_heading = "Terminal")]
    width: Option<usize>,
    /// Let an output take the place of a program, a list or frictcomp.toml
    #[arg(long, global = true, help_heading = "Terminal")]
    force: bool,
    /// Add conditions, assumed limits, readings of the documents and totals to the text
    #[arg(long, short, global = true, help_heading = "Terminal")]
    verbose: bool,
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    Run(run::RunArgs),
    Check(check::CheckArgs),
    Audit(audit::AuditArgs),
    Diff(diff::DiffArgs),
    Golden(golden::GoldenArgs),
    Contour(contour::ContourArgs),
    #[command(subcommand)]
    Show(show::ShowCommand),
    Init(init::InitArgs),
    #[command(subcommand)]
    Config(config::ConfigCommand),
    Lists(lists::ListsArgs),
    Drive(drive::DriveArgs),
    #[command(subcommand)]
    Commission(commission::CommissionCommand),
    Trace(trace::TraceArgs),
    Identify(identify::IdentifyArgs),
    Verify(verify::VerifyArgs),
    Circle(circle::CircleArgs),
    Tune(tune::TuneArgs),
    Current(current::CurrentCall),
    #[command(subcommand)]
    Ask(ask::AskCommand),
    Replay(replay::ReplayArgs),
    Explain(explain::ExplainArgs),
    #[command(hide = true)]
    Conformance(conformance::ConformanceArgs),
    #[command(hide = true)]
    Stiction(stiction::StictionArgs),
    #[command(hide = true)]
    Lsp(lsp::LspArgs),
    #[command(hide = true)]
    Dap(dap::DapArgs),
    #[command(hide = true)]
    Completions(completions::CompletionsArgs),
    #[command(hide = true)]
    Man(man::ManArgs),
}

/// Runs the tool with its arguments, the name of the program first.
pub fn run(arguments: impl IntoIterator<Item = OsString>) -> ExitCode {
    ExitCode::from(status(arguments))
}

/// Runs the tool and returns its exit status, for a process that continues after it.
pub fn status(arguments: impl IntoIterator<Item = OsString>) -> u8 {
    let mut arguments: Vec<OsString> = arguments.into_iter().collect();
    if cfg!(windows) {
        arguments = expanded(arguments);
    }
    let tool = moved::with_moved(description());
    let is_command = |word: &str| tool.find_subcommand(word).is_some();
    let (arguments, report) = Meant::new(arguments, is_command).split();
    let status = status_of(tool, arguments);
    Meant::finish(report, status);
    status
}

fn status_of(tool: clap::Command, arguments: Vec<OsString>) -> u8 {
    let hidden = hidden(&arguments);
    let command = called(&tool, &arguments);
    let gone = moved::command(&command, &tool);
    let parsed = tool.try_get_matches_from(arguments);
    let moved = || moved::option(&command, parsed.as_ref().err()?);
    if let Some(answer) = gone.or_else(moved) {
        Console::talk(&answer);
        return exit::FAILED;
    }
    let parsed = parsed.and_then(|matches| {
        let arguments = Arguments::from_arg_matches(&matches)?;
        Ok((arguments, written(&matches)))
    });
    let (mut arguments, written) = match parsed {
        Ok(parsed) => parsed,
        // Options alone are answered as no words at all, with the list of commands.
        Err(error) if error.kind() == ErrorKind::MissingSubcommand && command.is_empty() => {
            let list = description().try_get_matches_from(["frictcomp"]);
            return list.map_or_else(|list| say_usage(&list, &hidden), |_| exit::FAILED);
        }
        Err(error) => return say_usage(&error, &hidden),
    };
    bound_reading();
    survive_file_size_limit();
    clean_up_when_stopped(exit::FAILED);
    let forced = arguments.force.then_some(Replaces::Anything);
    let console = Console::new(arguments.color, arguments.width);
    let console = console.writing(written).forcing(forced);
    let console = console.detailed(if arguments.verbose {
        Detail::Full
    } else {
        Detail::Brief
    });
    dispatch(&mut arguments.command, console).unwrap_or_else(|failure| {
        console.explain(&failure);
        exit::FAILED
    })
}

/// Returns the command that is called, with its own one: `commission learn`.
fn called(tool: &clap::Command, arguments: &[OsString]) -> String {
    let mut command = tool;
    let mut path = Vec::new();
    for word in arguments {
        if let Some(below) = command.find_subcommand(word) {
            path.push(below.get_name());
            command = below;
        }
    }
    path.join(" ")
}

/// Returns the contents that a command writes with its `--format`.
fn written(matches: &ArgMatches) -> OutputContents {
    let Some((_, command)) = matches.subcommand() else {
        let format = matches.try_get_raw("format").ok().flatten();
        let format = format.and_then(|mut given| given.next()?.to_str());
        return match format {
            None | Some("text" | "concise") => OutputContents::Text,
            Some(_) => OutputContents::Records,
        };
    };
    written(command)
}

/// Returns the arguments with invisible characters, each with its visible form (R9.76).
fn hidden(arguments: &[OsString]) -> Vec<(String, String)> {
    let texts = arguments.iter().map(|argument| argument.to_string_lossy());
    let pairs = texts.map(|text| (text.clone().into_owned(), visible_line(&text).into_owned()));
    pairs.filter(|(text, shown)| text != shown).collect()
}

/// Prints help, the version, or what is wrong with the arguments.
fn say_usage(error: &clap::Error, hidden: &[(String, String)]) -> u8 {
    let page = if error.use_stderr() {
        CodePage::behind(&std::io::stderr())
    } else {
        CodePage::behind(&std::io::stdout())
    };
    if error.use_stderr() && hidden.is_empty() && page.is_none() {
        let _ = error.print();
        return exit::FAILED;
    }
    if error.use_stderr() {
        let mut text = error.render().to_string();
        for (argument, shown) in hidden {
            text = text.replace(argument, shown);
        }
        // A part of an argument, as of `--set=...`, may appear there alone.
        visible(&text).lines().for_each(Console::talk);
        return exit::FAILED;
    }
    let printed = match page {
        Some(page) => {
            let text = error.render().to_string();
            Encoded::new(std::io::stdout(), page).write_all(text.as_bytes())
        }
        None => error.print(),
    };
    let flushed = printed.and_then(|()| std::io::stdout().flush());
    match flushed.map_err(broken_pipe) {
        Err(error) if error.kind() != std::io::ErrorKind::BrokenPipe => {
            Console::new(Color::Auto, None).explain(&Failure::output(error));
            exit::FAILED
        }
        _ => exit::CLEAN,
    }
}

fn dispatch(command: &mut Command, console: Console) -> Result<u8, Failure> {
    match command {
        Command::Run(args) => run::run(args, console),
        Command::Check(args) => check::run(args, console),
        Command::Audit(args) => audit::run(args, console),
        Command::Golden(args) => golden::run(args, console),
        Command::Diff(args) => diff::run(args, console),
        Command::Show(command) => show::run(command, console),
        Command::Lists(args) => lists::run(args, console),
        Command::Drive(args) => drive::run(args, console),
        Command::Current(args) => current::run(args, console),
        Command::Circle(args) => circle::run(args, console),
        Command::Contour(args) => contour::run(args, console),
        Command::Tune(args) => tune::run(args, console),
        Command::Stiction(args) => stiction::run(args, console),
        Command::Trace(args) => trace::run(args, console),
        Command::Identify(args) => identify::run(args, console),
        Command::Verify(args) => verify::run(args, console),
        Command::Replay(args) => replay::run(args, console),
        Command::Ask(command) => ask::run(command, console),
        Command::Conformance(args) => conformance::run(args, console),
        Command::Commission(command) => commission::run(command, console),
        Command::Explain(args) => explain::run(args, console),
        Command::Lsp(args) => lsp::run(args),
        Command::Dap(args) => dap::run(args),
        Command::Init(args) => init::run(args),
        Command::Config(command) => config::run(command, console),
        Command::Completions(args) => completions::run(args, description(), console),
        Command::Man(args) => man::run(args, description(), console),
    }
}

/// Returns the description of the command line, for completions and the manual page.
fn description() -> clap::Command {
    in_groups(with_examples(Arguments::command()))
}

#[cfg(test)]
mod tests {
    #[test]
    fn the_description_holds_together() {
        super::description().debug_assert();
    }
}
