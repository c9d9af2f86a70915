//! Plants on the command line: a name, or a file.

use std::path::Path;

use super::failure::Failure;
use super::files::read_text;
use super::ledger::Ledger;
use crate::circle::CircleError;
use crate::simulation::{FrictionModel, Plant, Preset};
use crate::text::SourceFile;
use clap::ValueEnum;

/// A friction model.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, ValueEnum)]
pub(super) enum Model {
    /// LuGre, a single bristle.
    #[default]
    Lugre,
    /// Generalized Maxwell-slip, elements that stick and slip.
    Gms,
    /// The static Stribeck curve.
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
    let unknown = match word.parse::<Preset>() {
        Ok(preset) => return Ok(preset.plant()),
        Err(unknown) => unknown,
    };
    let path = Path::new(word);
    let is_file = path.extension().is_some() || path.exists();
    if !is_file {
        let help = match unknown.near() {
            Some(meant) => format!("did you mean `{meant}`?"),
            None => format!(
                "there are {}, and files: `--plant FILE.toml`",
                Preset::names()
            ),
        };
        return Err(Failure::new(unknown.to_string()).with_help(help));
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
