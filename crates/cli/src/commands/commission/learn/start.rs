//! The start of learning: the measured friction, and the lists of the first round.

use std::path::Path;

use super::args::LearnArgs;
use super::folder::LearningFolder;
use crate::args::{ByAxis, PerAxis, value_list};
use crate::output::{Failure, Outputs, shown};
use frictcomp_host::{FileRegistry, read_text, sha256_of};
use frictcomp_physics::circle::{PlaneAxis, TooMuchCurrent};
use frictcomp_recordings::commission::MOST_CURRENT;
use frictcomp_recordings::commission::ValueListUsed;

use frictcomp_report::learn::MeasuredFriction;

/// Begins in a folder: copies the lists of the first round into it, each within the limit set by the friction.
pub(super) fn begin(
    args: &LearnArgs,
    registry: &FileRegistry,
    outputs: &mut Outputs,
) -> Result<LearningFolder, Failure> {
    if args.friction.is_empty() {
        let message = format!("`{}` has no `learning.json`", shown(&args.folder));
        let help =
            "begin with the measured friction, `--friction X=comp_x.lis --friction Y=comp_y.lis`";
        return Err(Failure::new(message).with_help(help));
    }
    let frictions = both("--friction", &args.friction)?;
    let lists = match &args.value_list[..] {
        [] => frictions,
        given => both("--value-list", given)?,
    };
    let friction = |at: usize| measured(PlaneAxis::ALL[at], frictions[at], registry);
    let friction = [friction(0)?, friction(1)?];
    for (path, friction) in lists.iter().zip(&friction) {
        let list = value_list(path, registry)?;
        TooMuchCurrent::check(&list, &friction.list, MOST_CURRENT).map_err(|error| {
            let message = format!("`{}` cannot be the first list: {error}", shown(path));
            Failure::new(message).with_help("begin with the list of the measured friction")
        })?;
    }
    let mut folder = LearningFolder::new(&args.folder, friction);
    let texts = [read_text(lists[0])?, read_text(lists[1])?];
    folder.add_round(&texts, [None; 2], outputs)?;
    Ok(folder)
}

/// Returns the lists of both axes.
fn both<'a>(option: &'static str, given: &'a [PerAxis]) -> Result<[&'a Path; 2], Failure> {
    let axes = &["X", "Y"];
    let lists = ByAxis {
        option,
        given,
        axes,
    };
    Ok([lists.required(axes[0])?, lists.required(axes[1])?])
}

/// Returns the measured friction of an axis.
fn measured(
    axis: PlaneAxis,
    path: &Path,
    registry: &FileRegistry,
) -> Result<MeasuredFriction, Failure> {
    let list = value_list(path, registry)?;
    let is_positive = list.table.iter().all(|it| it.output > 0.0) && list.scaling_factor > 0;
    if list.table.is_empty() || !is_positive {
        let message = format!(
            "`{}` is not a measured friction: an output or the scaling is not above 0",
            shown(path)
        );
        return Err(Failure::new(message).with_help("give the list that `identify` wrote"));
    }
    Ok(MeasuredFriction {
        from: ValueListUsed {
            axis: axis.as_str().to_owned(),
            file: shown(path),
            sha256: sha256_of(path)?,
        },
        list,
    })
}

/// Returns the failure for a folder in which learning has begun.
pub(super) fn already(folder: &Path) -> Failure {
    let message = format!("learning has begun in `{}` already", shown(folder));
    Failure::new(message)
        .with_help("leave `--friction` and `--value-list` out to continue, or name another folder")
}
