//! The calls between the programs of the project, found once a save.

use std::path::PathBuf;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

use frictcomp_host::{
    CallGraph, Disk, FileRegistry, MachineOptions, Machines, find_programs, processors,
};

/// The calls of the programs of a project as they are saved, found when first asked for.
#[derive(Debug, Clone)]
pub(super) struct ProjectCalls {
    /// The folder that the client names; nothing is searched without one.
    folder: Option<PathBuf>,
    /// Rises with each save.
    saves: Arc<AtomicU64>,
    /// The calls that were found last.
    found: Arc<Mutex<Option<FoundCalls>>>,
}

/// Calls, and the number of saves before they were found.
type FoundCalls = (u64, Arc<CallGraph>);

impl ProjectCalls {
    /// Those of a folder.
    pub(super) fn new(folder: Option<PathBuf>) -> Self {
        Self {
            folder,
            saves: Arc::default(),
            found: Arc::default(),
        }
    }

    /// Whether there is a folder.
    pub(super) fn are_known(&self) -> bool {
        self.folder.is_some()
    }

    /// A file was saved: the calls are found anew when they are asked for.
    pub(super) fn forget(&self) {
        // The calls may be on their way: the server does not wait for them.
        self.saves.fetch_add(1, Ordering::Relaxed);
    }

    /// The calls, with the texts that are open in place of their files.
    pub(super) fn graph(&self, disk: &Disk) -> Option<Arc<CallGraph>> {
        let folder = self.folder.as_ref()?;
        let mut found = self.found.lock().unwrap_or_else(PoisonError::into_inner);
        let saves = self.saves.load(Ordering::Relaxed);
        if let Some((at, graph)) = &*found
            && *at == saves
        {
            return Some(Arc::clone(graph));
        }
        let registry = FileRegistry::default();
        let mut machines = Machines::new(MachineOptions::default(), &registry).on_disk(disk);
        let paths = [folder.clone()];
        let inputs = find_programs(&paths, |folder| machines.extensions(folder)).inputs;
        // What cannot be read calls nothing; its check says so.
        let (graph, _) = CallGraph::of(&inputs, &mut machines, processors());
        let graph = Arc::new(graph);
        *found = Some((saves, Arc::clone(&graph)));
        Some(graph)
    }
}
