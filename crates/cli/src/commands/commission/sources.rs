//! The recordings from which lists are made, and the list files.

use std::path::{Path, PathBuf};

use crate::output::{Failure, Outputs, write_text};
use frictcomp_host::{read_text, sha256_of_text};
use frictcomp_recordings::commission::{
    FrictionFound, MeasuredAxis, PlanFile, RecordingOutcome, RecordingResult, Stage,
};

/// Returns the stage of the program with a number.
pub(super) fn stage_of(plans: &[PlanFile], number: u16) -> Option<Stage> {
    PlanFile::of(plans, Some(number)).map(|it| it.plan.stage)
}

/// Writes a list under a name derived from its content, so that no list replaces another one.
pub(super) fn write_list(
    folder: &Path,
    name: &str,
    text: &str,
    outputs: &mut Outputs,
) -> Result<PathBuf, Failure> {
    let sum = sha256_of_text(text);
    let path = folder.join(format!("{name}-{}.lis", sum.get(..8).unwrap_or(&sum)));
    if read_text(&path).is_ok_and(|there| there == text) {
        return Ok(path);
    }
    std::fs::create_dir_all(folder).map_err(|error| Failure::writing(folder, error))?;
    let mut file = outputs.list("the value list", &path)?;
    write_text(&mut file, text)?;
    Ok(path)
}

/// Returns the recording from which the list of an axis is made, the last by name; or the reasons against a list.
pub(super) fn source_of<'a>(
    axis: &MeasuredAxis,
    plans: &[PlanFile],
    results: &'a [RecordingResult],
) -> (
    Option<(&'a RecordingResult, &'a FrictionFound)>,
    Vec<String>,
) {
    let frictions = results.iter().filter_map(|it| match &it.found {
        RecordingOutcome::Friction(found)
            if found.axis == axis.name && found.against.is_empty() =>
        {
            Some((it, found))
        }
        _ => None,
    });
    let of_stage = |stage: Stage| {
        let is_so = move |it: &RecordingResult| {
            it.program.and_then(|number| stage_of(plans, number)) == Some(stage)
        };
        frictions.clone().filter(move |(it, _)| is_so(it))
    };
    let Some((last, found)) = of_stage(Stage::Off).next_back() else {
        return (
            None,
            vec!["no recording of its constant speeds can be used".to_owned()],
        );
    };
    let other = of_stage(Stage::Off)
        .chain(of_stage(Stage::On))
        .find(|(_, it)| !found.is_steady_with(it));
    if let Some((other, it)) = other {
        let apart = found.apart_from(it).map_or_else(
            || "have no speed in common".to_owned(),
            |part| format!("differ by {:.0} % of the friction", part * 100.0),
        );
        let note = format!("{} and {} {apart}: repeat both warm", last.file, other.file);
        return (None, vec![note]);
    }
    (Some((last, found)), Vec::new())
}
