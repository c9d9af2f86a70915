//! A value list on the command line, for both axes of a plane or for one: `v.lis`, `X=v.lis`.

use std::convert::Infallible;
use std::path::{Path, PathBuf};
use std::str::FromStr;

use super::failure::Failure;
use frictcomp_physics::circle::PlaneAxis;

/// `v.lis`, or `X=v.lis`.
#[derive(Debug, Clone)]
pub(super) struct AxisList {
    axis: Option<PlaneAxis>,
    path: PathBuf,
}

impl FromStr for AxisList {
    type Err = Infallible;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        let named = PlaneAxis::ALL.into_iter().find_map(|axis| {
            let path = text.strip_prefix(axis.as_str())?.strip_prefix('=')?;
            Some((axis, path))
        });
        Ok(match named {
            Some((axis, path)) => Self {
                axis: Some(axis),
                path: path.into(),
            },
            None => Self {
                axis: None,
                path: text.into(),
            },
        })
    }
}

/// Returns the files of X and Y that an option names, one for both or one for each.
pub(super) fn files_of<'a>(option: &str, given: &'a [AxisList]) -> Result<[&'a Path; 2], Failure> {
    if let [both @ AxisList { axis: None, .. }] = given {
        return Ok([&both.path; 2]);
    }
    let of = |axis: PlaneAxis| {
        let mut lists = given.iter().filter(|list| list.axis == Some(axis));
        lists.next().filter(|_| lists.next().is_none())
    };
    match (of(PlaneAxis::X), of(PlaneAxis::Y)) {
        (Some(x), Some(y)) if given.len() == 2 => Ok([&x.path, &y.path]),
        _ => {
            let message = format!("`{option}` takes one list for both axes, or one for each");
            let help = format!("give `{option} X=a.lis {option} Y=b.lis`");
            Err(Failure::new(message).with_help(help))
        }
    }
}
