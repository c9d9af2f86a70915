//! Settings of the user of an editor (R12.4, R12.7).

use std::collections::BTreeMap;

use serde_json::Value;

/// Executed blocks of a program that are checked as the user types.
pub(super) const MAX_BLOCKS: u64 = 500_000;

/// Offer of an outline, definitions, references, folding and renaming.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) enum Navigation {
    /// Features that ISG's extension lacks; all of them if the client says that it is absent.
    #[default]
    Auto,
    /// Navigation is offered.
    On,
    /// Navigation is not offered.
    Off,
}

/// Settings for the contour of a program: the keys below `contour` (R12.17).
#[derive(Debug, Clone, PartialEq)]
pub(super) struct ContourSettings {
    /// `contour.plant`: the drives, a preset or a file.
    pub(super) plant: String,
    /// `contour.plane`: the axes of the plane.
    pub(super) plane: [String; 2],
    /// `contour.start`: axis positions before the program, in mm or degrees.
    pub(super) start: BTreeMap<String, f64>,
}

impl Default for ContourSettings {
    fn default() -> Self {
        Self {
            plant: "stiff".to_owned(),
            plane: ["X", "Y"].map(str::to_owned),
            start: BTreeMap::new(),
        }
    }
}

/// The settings of the client, the keys of `frictcomp`.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Settings {
    /// `inlayHints.enable`: changes of states are shown in the text.
    pub(super) inlay_hints: bool,
    /// `codeLens.enable`: what a program leaves and inherits is shown above it.
    pub(super) code_lens: bool,
    /// `navigation`: `auto`, `on` or `off`.
    pub(super) navigation: Navigation,
    /// `isgExtension`: whether ISG's extension is installed; `None` if the client does not say.
    pub(super) isg_extension: Option<bool>,
    /// `maxBlocks`: the executed blocks of a program that are checked as the user types.
    pub(super) max_blocks: u64,
    /// `pages`: the URI of the folder that holds the pages of the codes.
    pub(super) pages: Option<String>,
    /// `languages`: further languages of the editor whose texts are programs, whatever they are called.
    pub(super) languages: Vec<String>,
    /// Settings for the contour of a program.
    pub(super) contour: ContourSettings,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            inlay_hints: true,
            code_lens: true,
            navigation: Navigation::Auto,
            isg_extension: None,
            max_blocks: MAX_BLOCKS,
            pages: None,
            languages: Vec::new(),
            contour: ContourSettings::default(),
        }
    }
}

impl Settings {
    /// Takes the settings of a client, below `frictcomp` or by themselves; settings that it leaves out
    /// keep their values. Returns the settings that cannot be used.
    pub(super) fn take(&mut self, given: &Value) -> Vec<String> {
        let given = given.get("frictcomp").unwrap_or(given);
        let mut wrong = Vec::new();
        let mut read =
            |keys: &[&str], expected: &str, take: &mut dyn FnMut(&Value) -> Option<()>| {
                let value = keys.iter().try_fold(given, |value, key| value.get(key));
                let value = value.filter(|value| !value.is_null());
                if let Some(value) = value
                    && take(value).is_none()
                {
                    let key = keys.join(".");
                    wrong.push(format!(
                        "`frictcomp.{key}` is {value}; it must be {expected}"
                    ));
                }
            };
        let truth = "true or false";
        read(&["inlayHints", "enable"], truth, &mut |value| {
            self.inlay_hints = value.as_bool()?;
            Some(())
        });
        read(&["codeLens", "enable"], truth, &mut |value| {
            self.code_lens = value.as_bool()?;
            Some(())
        });
        read(&["isgExtension"], truth, &mut |value| {
            self.isg_extension = Some(value.as_bool()?);
            Some(())
        });
        read(&["navigation"], "`auto`, `on` or `off`", &mut |value| {
            self.navigation = match value.as_str()? {
                "auto" => Navigation::Auto,
                "on" => Navigation::On,
                "off" => Navigation::Off,
                _ => return None,
            };
            Some(())
        });
        read(&["maxBlocks"], "a number from 1", &mut |value| {
            self.max_blocks = value.as_u64().filter(|blocks| *blocks > 0)?;
            Some(())
        });
        read(&["pages"], "a URI", &mut |value| {
            self.pages = Some(value.as_str()?.trim_end_matches('/').to_owned());
            Some(())
        });
        read(&["languages"], "a list of texts", &mut |value| {
            let names = value.as_array()?.iter();
            let names = names.map(|name| name.as_str().map(str::to_owned));
            self.languages = names.collect::<Option<_>>()?;
            Some(())
        });
        let contour = &mut self.contour;
        read(
            &["contour", "plant"],
            "`stiff`, `mid`, `soft` or a file",
            &mut |value| {
                let plant = value.as_str()?.trim();
                let usual = || ContourSettings::default().plant;
                contour.plant = Some(plant.to_owned())
                    .filter(|it| !it.is_empty())
                    .unwrap_or_else(usual);
                Some(())
            },
        );
        read(&["contour", "plane"], "a list of two axes", &mut |value| {
            let [first, second] = value.as_array()?.as_slice() else {
                return None;
            };
            contour.plane = [first.as_str()?.to_owned(), second.as_str()?.to_owned()];
            Some(())
        });
        read(
            &["contour", "start"],
            "positions of axes in mm or degrees",
            &mut |value| {
                let axes = value.as_object()?.iter();
                let axes = axes.map(|(axis, at)| Some((axis.clone(), at.as_f64()?)));
                contour.start = axes.collect::<Option<_>>()?;
                Some(())
            },
        );
        wrong
    }

    /// Returns whether an outline, folding and renaming are offered, which ISG's extension does not have.
    pub(super) fn outlines(&self) -> bool {
        self.navigation != Navigation::Off
    }

    /// Returns whether definitions and references are offered, which ISG's extension has (R12.12).
    pub(super) fn finds_names(&self) -> bool {
        match self.navigation {
            Navigation::On => true,
            Navigation::Off => false,
            Navigation::Auto => self.isg_extension == Some(false),
        }
    }
}
#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    #[test]
    fn settings_are_taken_key_by_key() {
        // R12.4
        let mut settings = Settings::default();
        let wrong = settings.take(&json!({ "frictcomp": {
            "inlayHints": { "enable": false },
            "codeLens": { "enable": "no" },
            "maxBlocks": 0,
            "navigation": "maybe",
            "isgExtension": false,
            "other": 1,
        }}));
        assert_eq!(wrong.len(), 3, "{wrong:?}");
        assert!(wrong[0].starts_with("`frictcomp.codeLens.enable` is \"no\"; it must be"));
        let expected = Settings {
            inlay_hints: false,
            isg_extension: Some(false),
            ..Settings::default()
        };
        assert_eq!(settings, expected);
        assert!(settings.finds_names() && settings.outlines());
        assert!(
            settings
                .take(&json!({ "maxBlocks": 7, "navigation": "off" }))
                .is_empty()
        );
        assert_eq!(
            (settings.max_blocks, settings.navigation),
            (7, Navigation::Off)
        );
        assert!(!settings.finds_names() && !settings.outlines());
        assert!(settings.take(&json!(null)).is_empty());
        assert!(settings.take(&json!([1])).is_empty());
    }
}
