//! An option that is given for every axis, `v.lis`, or for one of them, `X=v.lis`.

use std::ffi::{OsStr, OsString};
use std::path::Path;

use crate::output::Failure;
use frictcomp_report::visible_line;

/// A value of an option as it is written. `NAME=` counts as an axis only where there is an axis of that name:
/// `./X=a.lis` is a file.
#[derive(Debug, Clone)]
pub(crate) struct PerAxis(OsString);

impl From<OsString> for PerAxis {
    fn from(written: OsString) -> Self {
        Self(written)
    }
}

impl PerAxis {
    /// Returns whether `%` stands for the name of the axis in it.
    pub(crate) fn is_pattern(&self) -> bool {
        self.0.to_string_lossy().contains('%')
    }

    /// Returns whether it names an axis.
    pub(crate) fn is_of(&self, axis: &str) -> bool {
        self.parts().is_some_and(|(name, _)| name == axis)
    }

    /// Returns the axis whose channel has a name, where the option is a pattern or names an axis.
    pub(crate) fn axis_of<'n>(&'n self, channel: &'n str) -> Option<&'n str> {
        let is_axis = |it: &&str| !it.is_empty() && it.chars().all(char::is_alphanumeric);
        match (self.parts(), self.0.to_str()?.split_once('%')) {
            (Some((axis, named)), _) => (named == channel).then_some(axis),
            (None, Some((before, after))) => {
                let axis = channel.strip_prefix(before)?;
                axis.strip_suffix(after)
            }
            (None, None) => None,
        }
        .filter(is_axis)
    }

    fn parts(&self) -> Option<(&str, &str)> {
        let (name, value) = self.0.to_str()?.split_once('=')?;
        Some((name.trim(), value.trim()))
    }
}

/// The values of an option, and the axes that they may name.
#[derive(Debug, Clone, Copy)]
pub(crate) struct ByAxis<'a> {
    pub(crate) option: &'static str,
    pub(crate) given: &'a [PerAxis],
    pub(crate) axes: &'a [&'a str],
}

impl<'a> ByAxis<'a> {
    pub(crate) fn new(option: &'static str, given: &'a [PerAxis], axes: &'a [&'a str]) -> Self {
        Self {
            option,
            given,
            axes,
        }
    }

    /// Returns the value for an axis: the one that names it, otherwise the one for every axis.
    pub(crate) fn of(self, axis: &str) -> Result<Option<&'a OsStr>, Failure> {
        let mut own = Vec::new();
        let mut every = Vec::new();
        for given in self.given {
            match given.parts().filter(|(name, _)| self.axes.contains(name)) {
                Some((name, value)) if name == axis => own.push(OsStr::new(value)),
                Some(_) => {}
                None => every.push(&*given.0),
            }
        }
        let found = if own.is_empty() { every } else { own };
        match found[..] {
            [] => Ok(None),
            [one] => Ok(Some(one)),
            _ => {
                let option = self.option;
                let message = format!("`{option}` was given more than once for the same axis");
                Err(Failure::new(message).with_help(format!(
                    "give one for every axis, or `{option} AXIS=…` for each"
                )))
            }
        }
    }

    /// Returns the channel of an axis.
    pub(crate) fn channel(self, axis: &str) -> Result<Option<String>, Failure> {
        let channel = self.of(axis)?;
        Ok(channel.map(|it| it.to_string_lossy().into_owned()))
    }

    /// Returns the channel of each axis that has one, for channels that differ from axis to axis.
    pub(crate) fn channels(self) -> Result<Vec<(String, String)>, Failure> {
        let is_named = |it: &PerAxis| {
            it.parts()
                .is_some_and(|(name, _)| self.axes.contains(&name))
        };
        let is_common = |it: &&PerAxis| !is_named(it) && !it.is_pattern();
        if let Some(PerAxis(channel)) = self.given.iter().find(is_common)
            && self.axes.len() != 1
        {
            let (option, channel) = (self.option, channel.to_string_lossy());
            let message = format!("`{option} {}` names no axis", visible_line(&channel));
            return Err(Failure::new(message).with_help(format!(
                "write `{option} AXIS={}`, or `%` for the name of each axis; the axes are {}",
                visible_line(&channel),
                visible_line(&self.axes.join(", "))
            )));
        }
        let mut channels = Vec::new();
        for axis in self.axes {
            let channel = self.channel(axis)?;
            channels.extend(channel.map(|it| ((*axis).to_owned(), it)));
        }
        Ok(channels)
    }

    /// Returns the list of an axis.
    pub(crate) fn list(self, axis: &str) -> Result<Option<&'a Path>, Failure> {
        let is_name = |it: &str| it.chars().all(|it| it.is_alphanumeric() || it == '_');
        let is_stranger = |given: &&PerAxis| {
            let name = given.parts().map_or("", |it| it.0);
            !name.is_empty() && is_name(name) && !self.axes.contains(&name)
        };
        let strangers = self.given.iter().filter(is_stranger);
        let mut absent = strangers.filter(|it| !Path::new(&it.0).exists());
        if let Some((name, _)) = absent.find_map(PerAxis::parts) {
            let message = format!(
                "`{}` names `{name}`, which is not an axis here",
                self.option
            );
            let help = match &*self.axes.join(", ") {
                "" => format!("say which axis is meant, `--axis {name}`"),
                all => format!("the axes are {}", visible_line(all)),
            };
            return Err(Failure::new(message).with_help(help));
        }
        Ok(self.of(axis)?.map(Path::new))
    }

    /// Returns the list of an axis, which has to have one.
    pub(crate) fn required(self, axis: &str) -> Result<&'a Path, Failure> {
        self.list(axis)?.ok_or_else(|| {
            let message = format!(
                "`{}` gives no list of `{}`",
                self.option,
                visible_line(axis)
            );
            let help = format!(
                "give one list for every axis, or `{} {axis}=LIST`",
                self.option
            );
            Failure::new(message).with_help(help)
        })
    }
}
