//! The centre about which both paths are compared.

use std::str::FromStr;

use serde::Serialize;
use thiserror::Error;

frictcomp::words! {
    /// The centre that G(b) and H refer to (R5.21).
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize)]
    #[serde(rename_all = "lowercase")]
    #[non_exhaustive]
    pub enum PathCentre {
        /// The mean of the least-squares centres of both paths.
        #[default]
        Common = "common",
        /// The least-squares centre of each path: a shift of one path as a whole does not count.
        Own = "own",
    }
}

/// A word that is not the name of a centre.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("there is no centre `{0}`; there are `common` and `own`")]
pub struct UnknownPathCentre(pub String);

impl PathCentre {
    /// Returns the meaning in words.
    pub fn title(self) -> &'static str {
        match self {
            Self::Common => "the mean of both least-squares centres",
            Self::Own => "the least-squares centre of each path",
        }
    }
}

impl FromStr for PathCentre {
    type Err = UnknownPathCentre;

    fn from_str(name: &str) -> Result<Self, Self::Err> {
        match name {
            "common" => Ok(Self::Common),
            "own" => Ok(Self::Own),
            _ => Err(UnknownPathCentre(name.to_owned())),
        }
    }
}
