//! The programs that differ from a revision, or reach one that does (R17.4).

use std::collections::{BTreeMap, BTreeSet};
use std::num::NonZeroUsize;
use std::path::{Path, PathBuf};

use super::call_graph::{CallGraph, GraphProgram};
use super::git::{ChangedFile, OldFile, Revision};
use crate::disk::{CONFIG_NAME, Disk, Input, OpenText, is_parameters, is_program};
use crate::error::HostError;
use crate::machines::Machines;

/// The programs of a call that differ from a revision, or reach a file that differs.
#[derive(Debug)]
pub struct ChangedPrograms {
    /// The programs, in the order in which they were named.
    pub inputs: Vec<Input>,
    /// The files that differ.
    pub files: Vec<ChangedFile>,
    /// Whether a configuration or a list differs.
    pub is_machine_changed: bool,
    /// The places of the programs and lists that git does not track: those that it ignores, or that
    /// lie elsewhere.
    pub unseen: Vec<PathBuf>,
    /// The extensions of programs here, in lower case.
    extensions: BTreeSet<String>,
    /// The places of the programs that were looked at.
    read: Vec<PathBuf>,
}

/// Differences, in the form used to compare programs with them.
struct Changes<'a> {
    files: &'a [ChangedFile],
    /// The files of the work tree that differ.
    places: BTreeSet<PathBuf>,
    /// The names of deleted files, in lower case and without their extensions.
    gone: BTreeSet<String>,
    /// Whether a list that a machine has read differs, or one was deleted.
    lists: bool,
}

impl ChangedPrograms {
    /// Returns the inputs affected, and what cannot be read. Where a configuration or a list differs, every
    /// program of its machine is one; so is a program with a call known only at run time, where any
    /// program differs.
    ///
    /// # Errors
    /// The command `git` fails.
    pub fn since(
        revision: &Revision,
        inputs: &[Input],
        machines: &mut Machines,
        workers: NonZeroUsize,
    ) -> Result<(Self, Vec<HostError>), HostError> {
        let files = revision.changes()?;
        let (mut changed, errors) = Self::of(files, inputs, machines, workers);
        if !changed.read.is_empty() {
            let mut seen = revision.files()?;
            seen.extend(changed.files.iter().filter_map(|file| file.new.clone()));
            let lists = machines.files_read().into_iter();
            let lists = lists.map(|list| Disk::place(&list));
            let read = std::mem::take(&mut changed.read).into_iter().chain(lists);
            changed.unseen = read.filter(|place| !seen.contains(place)).collect();
        }
        Ok((changed, errors))
    }

    /// Returns the changed programs for files that are known to differ.
    pub fn of(
        files: Vec<ChangedFile>,
        inputs: &[Input],
        machines: &mut Machines,
        workers: NonZeroUsize,
    ) -> (Self, Vec<HostError>) {
        let (graph, errors) = CallGraph::of(inputs, machines, workers);
        let differing = Changes::new(&files, machines);
        let mut machine_of = BTreeMap::new();
        let mut is_machine_changed = false;
        for program in graph.programs() {
            let folder = program.input.folder();
            let is_changed = *machine_of
                .entry(folder.to_owned())
                .or_insert_with(|| differing.hold_machine(folder, machines));
            is_machine_changed |= is_changed;
        }
        let reached = graph.reaching(|program| {
            machine_of.get(program.input.folder()) == Some(&true) || differing.hold(program)
        });
        let programs = graph.programs().iter().zip(reached);
        let reached = programs.filter(|(program, is_reached)| program.is_named && *is_reached);
        let inputs = reached.map(|(program, _)| program.input.clone()).collect();
        let programs = graph.programs().iter();
        let read: Vec<PathBuf> = programs.filter_map(|it| it.place.clone()).collect();
        let extensions = read.iter().filter_map(|path| path.extension()?.to_str());
        let extensions = extensions.map(str::to_ascii_lowercase).collect();
        let changed = Self {
            inputs,
            files,
            is_machine_changed,
            unseen: Vec::new(),
            extensions,
            read,
        };
        (changed, errors)
    }

    /// Returns whether a file is a program, judged by its name.
    pub fn is_program(&self, path: &Path) -> bool {
        let extensions: Vec<String> = self.extensions.iter().cloned().collect();
        is_program(path, None) || is_program(path, Some(&extensions))
    }

    /// Returns the disk with the programs as they are in the revision.
    ///
    /// # Errors
    /// The command `git` fails, or a program is too big to be kept.
    pub fn disk(&self, revision: &Revision) -> Result<Disk, HostError> {
        let olds = self.old_programs();
        let texts = revision.texts(olds)?;
        let is_old = |path: &PathBuf| texts.contains_key(path);
        let news = self.files.iter().filter_map(|file| file.new.clone());
        let absent: Vec<PathBuf> = news.filter(|path| !is_old(path)).collect();
        let texts = texts.into_iter().map(|(path, text)| OpenText {
            path,
            text: text.into(),
        });
        Ok(Disk::of_revision(texts, absent))
    }

    /// Returns the programs of the revision that differ from those of the work tree.
    pub fn old_programs(&self) -> impl Iterator<Item = &OldFile> {
        let olds = self.files.iter().filter_map(|file| file.old.as_ref());
        olds.filter(|old| self.is_program(&old.path))
    }
}

impl<'a> Changes<'a> {
    fn new(files: &'a [ChangedFile], machines: &Machines) -> Self {
        let new = files.iter().filter_map(|file| file.new.as_deref());
        let places: BTreeSet<PathBuf> = new.map(Disk::place).collect();
        let gone = files.iter().filter_map(|file| {
            let old = file.old.as_ref()?;
            (file.new.as_ref() != Some(&old.path)).then_some(&old.path)
        });
        let gone: Vec<&PathBuf> = gone.collect();
        let read = machines.files_read();
        let mut read = read.iter().filter(|path| is_parameters(path));
        let lists = gone.iter().any(|path| is_parameters(path))
            || read.any(|path| places.contains(&Disk::place(path)));
        Self {
            lists,
            gone: gone.into_iter().map(|path| stem(path)).collect(),
            places,
            files,
        }
    }

    /// Returns whether a program differs, or one of its calls means another program.
    fn hold(&self, program: &GraphProgram) -> bool {
        let place = program.place.as_deref();
        let misses = |name: &str| {
            let name = name.replace('\\', "/");
            self.gone.contains(&stem(Path::new(&name)))
        };
        place.is_some_and(|place| self.places.contains(place))
            || !program.open.is_empty()
            || program.missing.iter().any(|missing| misses(&missing.name))
    }

    /// Returns whether the machine of a folder differs.
    fn hold_machine(&self, folder: &Path, machines: &mut Machines) -> bool {
        let here = Disk::place(folder);
        let olds = self.files.iter().filter_map(|file| file.old.as_ref());
        let paths = olds
            .map(|old| old.path.as_path())
            .chain(self.files.iter().filter_map(|file| file.new.as_deref()));
        let is_above = |path: &Path| {
            let is_configuration = path.file_name().is_some_and(|name| name == CONFIG_NAME);
            is_configuration && path.parent().is_some_and(|above| here.starts_with(above))
        };
        let mut paths = paths;
        if paths.any(is_above) {
            return true;
        }
        // A machine that cannot be used is reported where it is needed.
        machines.for_folder(folder).is_ok_and(|loaded| {
            let origin = loaded.origin.as_deref();
            let has_lists = loaded.lists != (0, 0);
            (self.lists && has_lists)
                || origin.is_some_and(|path| self.places.contains(&Disk::place(path)))
        })
    }
}

/// Returns the name of a file without its extension, in lower case: the control ignores case.
fn stem(path: &Path) -> String {
    let stem = path.file_stem().unwrap_or_default();
    stem.to_string_lossy().to_lowercase()
}
