//! Unknown names.

use super::spelling::did_you_mean;

/// An unknown name, and the known ones.
#[derive(Debug, Clone, PartialEq, Eq)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct UnknownName {
    /// The name as it was given.
    pub name: String,
    /// The known name that is probably intended.
    pub near: Option<String>,
    /// The known names.
    pub known: Vec<String>,
}

impl UnknownName {
    /// Creates an unknown name.
    pub fn new<'a>(name: &str, known: impl Iterator<Item = &'a str> + Clone) -> Self {
        Self {
            name: name.to_owned(),
            near: did_you_mean(name, known.clone()).map(str::to_owned),
            known: known.map(str::to_owned).collect(),
        }
    }

    /// Returns help: the name that is probably intended, else the known ones: `its axes are X, Y`.
    pub fn help(&self, known: &str) -> Option<String> {
        match &self.near {
            Some(near) => Some(format!("did you mean `{near}`?")),
            None if self.known.is_empty() => None,
            None => Some(format!("{known} {}", self.known.join(", "))),
        }
    }
}
