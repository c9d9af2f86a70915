//! Values that may differ from axis to axis, as Python gives them.

use std::collections::BTreeMap;

use pyo3::prelude::*;

use crate::failure::Failure;

/// The axes of circles.
const PLANE: [&str; 2] = ["X", "Y"];

/// One value for every axis, or one for each, by its name.
#[derive(FromPyObject)]
pub(crate) enum PerAxis<T> {
    /// For every axis.
    Every(T),
    /// By the name of the axis.
    Each(BTreeMap<String, T>),
}

impl<T> PerAxis<T> {
    /// The value of one of some axes in an argument, if it has one.
    pub(crate) fn of(
        &self,
        name: &str,
        (argument, axes): (&str, &[&str]),
    ) -> Result<Option<&T>, Failure> {
        let values = match self {
            Self::Every(value) => return Ok(Some(value)),
            Self::Each(values) => values,
        };
        if let Some(other) = values.keys().find(|it| !axes.contains(&it.as_str())) {
            let message = format!("`{argument}` names `{other}`, which is not an axis here");
            let help = format!("the axes are {}", axes.join(", "));
            return Err(Failure::new(message).with_help(help));
        }
        Ok(values.get(name))
    }

    /// The value of one of some axes in an argument that has to give one for each.
    pub(crate) fn required(
        &self,
        name: &str,
        (argument, axes): (&str, &[&str]),
    ) -> Result<&T, Failure> {
        self.of(name, (argument, axes))?.ok_or_else(|| {
            let each = axes.iter().map(|it| format!("'{it}': …"));
            let each = each.collect::<Vec<_>>().join(", ");
            Failure::new(format!("`{argument}` gives nothing for `{name}`")).with_help(format!(
                "give one value for every axis, or `{argument}={{{each}}}`"
            ))
        })
    }

    /// The values of X and of Y in an argument.
    pub(crate) fn of_plane(&self, argument: &str) -> Result<[Option<&T>; 2], Failure> {
        let [x, y] = PLANE.map(|axis| self.of(axis, (argument, &PLANE)));
        Ok([x?, y?])
    }

    /// The values of X and of Y in an argument that has to give both.
    pub(crate) fn required_of_plane(&self, argument: &str) -> Result<[&T; 2], Failure> {
        let [x, y] = PLANE.map(|axis| self.required(axis, (argument, &PLANE)));
        Ok([x?, y?])
    }
}
