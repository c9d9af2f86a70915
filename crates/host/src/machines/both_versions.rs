//! The machine for two versions of a program, and where each finds what it calls (R17.4).

use std::cmp::Ordering;
use std::path::{Path, PathBuf};

use super::allowed_roots::{AllowedRoots, OutsidePolicy};
use super::discovery::{ConfigurationChoice, LoadedMachine, Machines};
use super::finder::SearchPath;
use crate::disk::{Input, folder, read_text};
use crate::error::HostError;
use frictcomp::interpreter::call_sites;

/// The machine for two versions of a program: the same for both, each with its own folders for
/// called programs.
#[derive(Debug, Clone)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct MachineOfVersions {
    /// The machine as the old version finds it.
    pub old: LoadedMachine,
    /// The machine as the new version finds it.
    pub new: LoadedMachine,
    /// Owner of the machine.
    pub owner: MachineOwner,
}

impl MachineOfVersions {
    /// Returns whether two versions are the same text, and what they call is the same, too: they are in one folder, or
    /// call nothing.
    pub fn runs_alike(&self, versions: &[Input; 2]) -> bool {
        let [Input::File(old), Input::File(new)] = versions else {
            return false;
        };
        let (Ok(text), Ok(other)) = (read_text(old), read_text(new)) else {
            return false;
        };
        let folders = [old, new].map(|path| folder(path).canonicalize().ok());
        let are_together = folders[0].is_some() && folders[0] == folders[1];
        text == other && (are_together || self.calls_nothing(&text))
    }

    fn calls_nothing(&self, text: &str) -> bool {
        let programs = &self.new.machine.programs;
        let around = [&programs.start, &programs.end];
        around.into_iter().all(Option::is_none) && call_sites(text, programs).is_empty()
    }
}

/// Owner of the machine on which two versions run.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub enum MachineOwner {
    /// Both versions, which have no other machine.
    Both,
    /// The new version; the old one has another configuration.
    NewNotOld(PathBuf),
    /// The current folder; neither version has a machine.
    CurrentFolder,
}

/// Distance of a version from the machine.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Nearness {
    /// Version anywhere, like the copies that `git difftool` makes.
    OutsidePolicy,
    /// Version below the current folder.
    Here,
    /// Version below a configuration.
    Configured,
}

impl Machines {
    /// Returns the machine of two versions: that of the new one, else that of the old one, else that of the
    /// current folder. A version that lies elsewhere finds called programs where the other one does.
    ///
    /// # Errors
    /// The configuration or the start-up list cannot be used, or an axis is unknown.
    pub fn for_versions(&mut self, versions: &[Input; 2]) -> Result<MachineOfVersions, HostError> {
        let folders = versions.each_ref().map(|input| input.folder().to_owned());
        let [old, new] = &folders;
        let mut own = [None, None];
        let mut owner = MachineOwner::Both;
        if *self.choice() == ConfigurationChoice::Nearest {
            own = [self.configuration(old), self.configuration(new)];
            let nearest = own[1].clone().or_else(|| own[0].clone());
            let taken = nearest.or_else(|| self.configuration(Path::new("")));
            owner = match (&own, &taken) {
                ([None, None], Some(_)) => MachineOwner::CurrentFolder,
                ([Some(old), _], Some(taken)) if old != taken => {
                    MachineOwner::NewNotOld(old.clone())
                }
                _ => MachineOwner::Both,
            };
            for folder in &folders {
                self.settle(folder, taken.clone());
            }
        }
        self.look_ahead(versions);
        let loaded = self.for_folder(new)?;
        let mut reaches = [loaded.search_path.clone(), loaded.search_path.clone()];
        if let MachineOwner::NewNotOld(path) = &owner
            && let Ok(own) = self.plain(Some(path))
        {
            reaches[0] = with_own(&own.search_path, &loaded.search_path);
        }
        let nearness = [0, 1].map(|at| self.nearness(&folders[at], own[at].as_deref()));
        for (at, other) in [(0, 1), (1, 0)] {
            let beside = match nearness[at].cmp(&nearness[other]) {
                Ordering::Less => folders[other].clone(),
                Ordering::Equal if owner == MachineOwner::CurrentFolder => PathBuf::new(),
                _ => continue,
            };
            reaches[at].program_dirs.insert(0, beside);
        }
        let [old, new] = reaches.map(|search_path| LoadedMachine {
            search_path,
            ..(*loaded).clone()
        });
        Ok(MachineOfVersions { old, new, owner })
    }

    fn nearness(&self, folder: &Path, own: Option<&Path>) -> Nearness {
        let here = AllowedRoots::on(self.disk(), OutsidePolicy::Kept).with(Path::new(""));
        if own.is_some() {
            Nearness::Configured
        } else if here.holds(folder) {
            Nearness::Here
        } else {
            Nearness::OutsidePolicy
        }
    }
}

/// Returns the folders of a version itself, then those of the machine that it runs on.
fn with_own(own: &SearchPath, shared: &SearchPath) -> SearchPath {
    let dirs = own.program_dirs.iter().chain(&shared.program_dirs);
    SearchPath {
        program_dirs: dirs.cloned().collect(),
        project: own.project.clone(),
        outside_policy: shared.outside_policy,
    }
}
