//! The calls between the programs of the project and their local subprograms, found once per save.

use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

use frictcomp::syntax::ast::Block;
use frictcomp::syntax::{BlockReader, FastPath, Stretch};
use frictcomp::text::{Place, TextLines};
use frictcomp_host::{
    CallGraph, Disk, FileRegistry, Input, MachineOptions, Machines, find_programs, processors,
    read_text,
};

/// A project, with the number of saves before it was searched.
type FoundProject = (u64, Arc<Project>);

/// The calls of the programs of a project as saved, found on first use.
#[derive(Debug, Clone)]
pub(super) struct ProjectCalls {
    /// The folder that the client names; without one nothing is searched.
    folder: Option<PathBuf>,
    /// Rises with each save.
    saves: Arc<AtomicU64>,
    /// The calls that were found last.
    found: Arc<Mutex<Option<FoundProject>>>,
}

/// The programs of a project as of a save.
#[derive(Debug)]
pub(super) struct Project {
    /// The calls between them.
    pub(super) graph: CallGraph,
    disk: Disk,
    subprograms: OnceLock<Vec<Subprogram>>,
}

/// A local subprogram, `%L NAME`.
#[derive(Debug)]
pub(super) struct Subprogram {
    /// The file that holds it.
    pub(super) path: PathBuf,
    /// Name.
    pub(super) name: String,
    /// The place of the name.
    pub(super) place: Place,
}

impl Project {
    fn text(&self, path: &Path) -> Option<String> {
        match self.disk.text(path) {
            Some(text) => Some(text.to_string()),
            None => read_text(path).ok(),
        }
    }

    /// Returns the local subprograms of all programs, found on first use.
    pub(super) fn subprograms(&self) -> &[Subprogram] {
        self.subprograms.get_or_init(|| {
            let files = self.graph.programs().iter();
            let files = files.filter_map(|program| match &program.input {
                Input::File(path) => Some((path, self.text(path)?)),
                Input::Open(_) | Input::Stdin => None,
            });
            files
                .flat_map(|(path, text)| subprograms(path, &text))
                .collect()
        })
    }
}

/// Returns the local subprograms of a text.
fn subprograms(path: &Path, text: &str) -> Vec<Subprogram> {
    let mut found = Vec::new();
    let begins = |line: &str| {
        let name = line.trim_start().strip_prefix('%');
        name.is_some_and(|name| name.trim_start().starts_with(['L', 'l']))
    };
    if !text.split(['\n', '\r']).any(begins) {
        return found;
    }
    let mut reader = BlockReader::new(TextLines::new(text), 1, FastPath::On);
    let mut block = Block::default();
    while let Some(raw) = reader.next(&mut block) {
        if let Stretch::Program { name, local: true } = raw.stretch {
            found.push(Subprogram {
                path: path.to_owned(),
                name: name.of(raw.text).to_owned(),
                place: Place {
                    file: "".into(),
                    text: raw.text.into(),
                    first_line: raw.line,
                    span: name,
                },
            });
        }
    }
    found
}

impl ProjectCalls {
    /// Creates the calls of a folder, not yet searched.
    pub(super) fn new(folder: Option<PathBuf>) -> Self {
        Self {
            folder,
            saves: Arc::default(),
            found: Arc::default(),
        }
    }

    /// Returns whether there is a folder.
    pub(super) fn are_known(&self) -> bool {
        self.folder.is_some()
    }

    /// Notes that a file was saved: the calls are found again on the next use.
    pub(super) fn forget(&self) {
        // A search may be running: the server does not wait for it.
        self.saves.fetch_add(1, Ordering::Relaxed);
    }

    /// Returns the programs with their calls, with the open texts in place of their files.
    pub(super) fn project(&self, disk: &Disk) -> Option<Arc<Project>> {
        let folder = self.folder.as_ref()?;
        let mut found = self.found.lock().unwrap_or_else(PoisonError::into_inner);
        let saves = self.saves.load(Ordering::Relaxed);
        if let Some((at, project)) = &*found
            && *at == saves
        {
            return Some(Arc::clone(project));
        }
        let registry = FileRegistry::default();
        let mut machines = Machines::new(MachineOptions::default(), &registry).on_disk(disk);
        let paths = [folder.clone()];
        let inputs = find_programs(&paths, |folder| machines.selection(folder)).inputs;
        // A program that cannot be read calls nothing; its check reports the error.
        let (graph, _) = CallGraph::of(&inputs, &mut machines, processors());
        let project = Arc::new(Project {
            graph,
            disk: disk.clone(),
            subprograms: OnceLock::new(),
        });
        *found = Some((saves, Arc::clone(&project)));
        Some(project)
    }
}
