//! Recordings of one axis in several states: `--states cold=FILE warm=FILE` (R16.6).

use std::path::{Path, PathBuf};

use super::args::{IdentifyArgs, identified};
use super::read;
use crate::output::{Console, Failure, Job, exit, write_text};
use frictcomp::text::shown_path;
use frictcomp_host::{FileRegistry, refuse_copies};
use frictcomp_recordings::identify::{ComparedStates, IdentifyOptions};
use frictcomp_report::results::identify::states::{StatesReport, document, render_json};
use frictcomp_report::visible_line;

/// The state for which the list is made, unless another one is named.
const WORKING: &str = "warm";

/// Identifies each state; the list is made for the state in which the machine works.
pub(super) fn run(
    args: &mut IdentifyArgs,
    options: &IdentifyOptions,
    console: Console,
) -> Result<u8, Failure> {
    let given = std::mem::take(&mut args.recordings);
    let recordings = given.iter().map(|it| state_of(it));
    let recordings = recordings.collect::<Result<Vec<(&str, PathBuf)>, Failure>>()?;
    if let Some((_, first)) = recordings.first() {
        args.channels.find_axes(first, &[])?;
    }
    let args = &*args;
    let names: Vec<&str> = recordings.iter().map(|it| it.0).collect();
    let axis = args.channels.sole_axis("the states are those of")?;
    let working = working(&names, args.working.as_deref().unwrap_or(WORKING))?;
    let registry = FileRegistry::default();
    for (_, path) in &recordings {
        registry.reads("recording", path);
    }
    let mut job = Job::new(&args.result, &registry, console)?;
    let list = args.write_list.as_deref();
    let list = list
        .map(|path| job.outputs.list("--write-list", path))
        .transpose()?;
    let job = job
        .with_picture(args.svg.as_deref())?
        .with_page(&args.html)?;
    job.outputs.check()?;
    let paths: Vec<PathBuf> = recordings.iter().map(|it| it.1.clone()).collect();
    refuse_copies(&paths)?;
    let states = recordings.iter().map(|(name, path)| {
        let recording = read(args, (axis, path), &registry)?;
        Ok((
            (*name).to_owned(),
            identified((axis, path), recording, options)?,
        ))
    });
    let states = states.collect::<Result<Vec<_>, Failure>>()?;
    let found: Vec<_> = states.iter().map(|(_, it)| &it.identified).collect();
    let report = StatesReport {
        compared: ComparedStates::of(&found, working),
        states,
        working,
    };
    if let (Some(mut list), Some((_, state))) = (list, report.states.get(working)) {
        write_text(&mut list, &args.list_of(state, &[report.spread()]))?;
    }
    let document = document(&report);
    job.finish(&document, || render_json(&report))?;
    Ok(exit::CLEAN)
}

/// Returns the state and the recording of `STATE=FILE`.
fn state_of(written: &Path) -> Result<(&str, PathBuf), Failure> {
    let pair = written.to_str().and_then(|it| it.split_once('='));
    let pair = pair.map(|(name, path)| (name.trim(), path.trim()));
    let pair = pair.filter(|(name, path)| !name.is_empty() && !path.is_empty());
    pair.map(|(name, path)| (name, path.into())).ok_or_else(|| {
        let message = format!("`{}` names no state", shown_path(written));
        Failure::new(message).with_help("write the state and its recording, `warm=friction.csv`")
    })
}

/// Returns the position of the state for which the list is made.
fn working(names: &[&str], wanted: &str) -> Result<usize, Failure> {
    let twice = names.iter().enumerate();
    if let Some((_, name)) = twice.clone().find(|(at, name)| names[..*at].contains(name)) {
        let message = format!("the state `{}` was given twice", visible_line(name));
        return Err(Failure::new(message).with_help("give each state its own name"));
    }
    let found = names.iter().position(|name| *name == wanted);
    found.ok_or_else(|| {
        let message = format!(
            "there is no recording of the state `{}`",
            visible_line(wanted)
        );
        let help = format!(
            "name the state in which the machine works with `--working`: {}",
            names.join(", ")
        );
        Failure::new(message).with_help(visible_line(&help))
    })
}
