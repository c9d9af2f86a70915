//! Plants on the command line: a name, or a file.

use std::path::Path;

use super::failure::Failure;
use super::files::read_text;
use super::ledger::Ledger;
use crate::circle::{CircleError, FrictionModel, Plant, Preset};
use crate::source::SourceFile;
use clap::ValueEnum;

/// A friction model.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, ValueEnum)]
pub(super) enum Model {
    /// One bristle.
    #[default]
    Lugre,
    /// Elements that stick and slip.
    Gms,
    /// The static curve.
    Stribeck,
}

impl From<Model> for FrictionModel {
    fn from(model: Model) -> Self {
        match model {
            Model::Lugre => Self::Lugre,
            Model::Gms => Self::Gms,
            Model::Stribeck => Self::Stribeck,
        }
    }
}

/// The plant that the user names: a preset, or a TOML file.
pub(super) fn plant(word: &str, ledger: &Ledger) -> Result<Plant, Failure> {
    if let Some(preset) = Preset::from_name(word) {
        return Ok(preset.plant());
    }
    let path = Path::new(word);
    let is_file = path.extension().is_some() || path.exists();
    if !is_file {
        let names = Preset::ALL.map(Preset::name).join(", ");
        let failure = Failure::new(format!("there is no plant `{word}`"));
        return Err(
            match crate::diagnostic::did_you_mean(word, Preset::ALL.map(Preset::name)) {
                Some(meant) => failure.with_help(format!("did you mean `{meant}`?")),
                None => {
                    failure.with_help(format!("there are {names}, and files: `--plant FILE.toml`"))
                }
            },
        );
    }
    ledger.reads("plant", path);
    let source = SourceFile::new(word.to_owned(), read_text(path)?);
    Plant::from_toml(source).map_err(|error| Failure {
        message: format!("the plant `{word}` cannot be used"),
        help: Vec::new(),
        diagnostics: vec![*error.diagnostic],
    })
}

impl From<CircleError> for Failure {
    fn from(error: CircleError) -> Self {
        Self::new(error.to_string()).with_help(error.help())
    }
}
