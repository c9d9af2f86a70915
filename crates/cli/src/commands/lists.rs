//! `frictcomp lists`: axis, value, channel and start-up lists.

use std::path::{Path, PathBuf};

use clap::Args;

use crate::args::{ListingArgs, NamedLists};
use crate::output::{Console, Failure, Failures, Outputs, Printed, exit, parts, write_text};
use frictcomp::diagnostic::{Code, Severity};
use frictcomp::machine::{AcceptedList, ListsReport};
use frictcomp_host::{FileRegistry, is_configuration};
use frictcomp_report::pictures::value_curves;
use frictcomp_report::results::lists::render_parameters;
use frictcomp_report::svg::Frame;
use frictcomp_report::{ListingFormat, Tally, command_line};

/// Check axis, value, channel and start-up lists
///
/// A start-up list or a `frictcomp.toml` is checked together with every list that it names, any
/// other list by itself.
#[derive(Debug, Args)]
pub(crate) struct ListsArgs {
    #[command(flatten)]
    lists: NamedLists,
    /// Print the effective parameters of every axis and where each comes from
    #[arg(long)]
    show: bool,
    /// Draw the value lists that the control would accept to this SVG file
    #[arg(long, value_name = "FILE")]
    svg: Option<PathBuf>,
    /// Treat values outside the documented range (FC132) as errors
    #[arg(long)]
    strict: bool,
    #[command(flatten)]
    listing: ListingArgs,
}

impl ListsArgs {
    /// Reports which options have no effect in this combination (R9.71).
    fn check_options(&self) -> Result<(), Failure> {
        let format = self.listing.format;
        if self.show
            && !matches!(
                format,
                ListingFormat::Text | ListingFormat::Json | ListingFormat::Ndjson
            )
        {
            return Err(Failure::new("`--show` has no effect with this `--format`")
                .with_help("write `--format text`, `json` or `ndjson`"));
        }
        Ok(())
    }
}

/// Draws the curves of all accepted value lists.
fn draw(reports: &[ListsReport]) -> Result<String, Failure> {
    let accepted: Vec<&AcceptedList> = reports.iter().flat_map(|it| &it.accepted).collect();
    if accepted.is_empty() {
        return Err(Failure::new(
            "there is no value list to draw: the control would accept none of them",
        )
        .with_help("leave `--svg` out to see why"));
    }
    Ok(value_curves(&accepted).render(Frame::Alone))
}

/// Runs the command.
pub(crate) fn run(args: &ListsArgs, console: Console) -> Result<u8, Failure> {
    let console = args.listing.console(console)?;
    Failures::of(console, |failures| check(args, console, failures))
}

fn check(args: &ListsArgs, console: Console, failures: &mut Failures) -> Result<u8, Failure> {
    let registry = FileRegistry::default();
    args.check_options()?;
    let codes = args.listing.severities.filter()?;
    let files = args.lists.files(|_| true)?;
    let allowed_roots = args.lists.allowed_roots(&files);
    let mut outputs = Outputs::new(&registry, console);
    let target = outputs.result(args.listing.output.as_deref())?;
    let mut reports = Vec::new();
    for path in &files {
        registry.reads("list", path);
        let mut report = match args.lists.check(path) {
            Ok(report) => report,
            Err(failure) => {
                failures.push(failure);
                continue;
            }
        };
        allowed_roots.conceal(&mut report.diagnostics);
        codes.sift(&mut report.diagnostics);
        for diagnostic in &mut report.diagnostics {
            diagnostic.reword(Some(command_line));
            if args.strict && diagnostic.code == Code::Fc132 {
                diagnostic.severity = Severity::Error;
            }
        }
        for file in &report.files {
            registry.reads("list", Path::new(&**file));
        }
        reports.push(report);
    }
    outputs.check()?;
    let width = console.stdout().look.width;
    let mut table = String::new();
    if args.show && args.listing.format == ListingFormat::Text {
        for report in &reports {
            table += &render_parameters(&report.reports, &report.programs, width);
        }
    }
    if let Some(path) = &args.svg {
        write_text(&mut outputs.file("--svg", path)?, &draw(&reports)?)?;
    }
    let mut listing = args.listing.lister(target)?;
    let mut tally = Tally::default();
    for report in &reports {
        tally.files += u64::try_from(report.files.len()).unwrap_or(u64::MAX);
        tally.missing += u64::try_from(report.missing).unwrap_or(u64::MAX);
        report
            .diagnostics
            .iter()
            .for_each(|it| tally.count(it.severity));
    }
    if tally.files > 0 {
        listing.headline(tally.on_lists());
    }
    for report in &reports {
        for _ in &report.files {
            listing.file();
        }
        for diagnostic in &report.diagnostics {
            if listing.diagnostic(diagnostic).is_break() {
                break;
            }
        }
        if args.show {
            listing.parameters(&report.reports);
        }
    }
    let printed = listing.finish()?;
    if printed == Printed::Unread && failures.is_empty() {
        return Ok(exit::CLEAN);
    }
    if !table.is_empty() {
        console.print_painted(&format!("\n{table}"), parts)?;
    }
    outputs.finish()?;
    if args.listing.format == ListingFormat::Text {
        listing.hint().iter().for_each(|hint| console.remark(hint));
    }
    let is_checked = |report: &ListsReport| report.kind.is_some() || !is_alone(report);
    if listing.status() == exit::CLEAN && !reports.is_empty() && !reports.iter().any(is_checked) {
        return Err(Failure::new(
            "nothing was checked: no file is an axis, value, channel or start-up list",
        )
        .with_help("name the lists of the axes, `hochlauf.lis`, a project or a `frictcomp.toml`"));
    }
    Ok(listing.status())
}

/// Returns whether a report is about a single list, not about a configuration.
fn is_alone(report: &ListsReport) -> bool {
    let mut files = report.files.iter();
    !files.any(|file| is_configuration(Path::new(&**file)))
}
