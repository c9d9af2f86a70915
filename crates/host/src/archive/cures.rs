//! Mending of the files of an archive (R10.3): each block is tried on every program that is known to run it
//! (R10.8).

use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::audits::{ArchiveAuditor, ProgramAuditor, find};
use crate::disk::{Disk, OpenText};
use crate::error::HostError;
use crate::outputs::{MendedFile, read_encoded};
use crate::workers::in_order;
use frictcomp::audit::{
    Affected, Archive, CuredMotions, MendedEnd, Mending, Missed, insertions, mend,
};
use frictcomp::interpreter::{Interpreter, Observer};

/// A mended program of an archive, or a file that programs call.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub struct MendedProgram {
    /// The position of the machine in [`ArchiveAuditor::machines`].
    pub machine: usize,
    /// The position of the program in the archive of its machine; `None` for a file that was not audited.
    pub program: Option<usize>,
    /// The file with the blocks, if there are any.
    pub file: Option<MendedFile>,
    /// The other programs that the blocks mend; they call the file.
    pub also: Vec<String>,
    /// The programs in which the blocks change the state of a motion.
    pub changed: Vec<String>,
    /// Mendings left to the user.
    pub missed: Vec<Missed>,
}

/// A program: its machine, and its position in the archive of the machine.
type ArchivedProgram = (usize, usize);

impl ArchiveAuditor {
    /// Finds the blocks that mend the archives of [`audit`](Self::audit); nothing is written. A file that
    /// several programs call is mended first, so that one block there mends them all.
    pub fn mend(
        &self,
        archives: &[Archive],
        end: MendedEnd,
        motions: CuredMotions,
    ) -> (Vec<MendedProgram>, Vec<HostError>) {
        let mut auditors = self.auditors();
        find(&mut auditors, archives);
        let mut cures = Cures::new(auditors, archives, (end, motions));
        let (mut changes, mut errors) = (Vec::new(), Vec::new());
        let (shared, alone) = cures.files();
        for place in shared {
            if self.flow().is_break() {
                return (changes, errors);
            }
            match cures.mend(&place) {
                Ok(change) => {
                    cures.keep(&change);
                    changes.push(change);
                }
                Err(error) => errors.push(error),
            }
        }
        let work = |place: &PathBuf| cures.mend(place);
        in_order(alone.iter(), self.workers(alone.len()), work, |change| {
            match change {
                Ok(change) => changes.push(change),
                Err(error) => errors.push(error),
            }
            self.flow()
        });
        changes.retain(|change| change.file.is_some() || !change.missed.is_empty());
        changes.sort_by_key(|change| (change.machine, change.program));
        (changes, errors)
    }
}

/// The files of archives to be mended. Files are known by their real paths.
struct Cures<'a> {
    auditors: Vec<ProgramAuditor<'a>>,
    archives: &'a [Archive],
    motions: CuredMotions,
    wanted: BTreeMap<ArchivedProgram, Vec<Mending>>,
    places: Places,
    /// The programs of the archives.
    programs: HashMap<PathBuf, ArchivedProgram>,
    /// The programs that call a file, each with the name used in the call.
    callers: HashMap<PathBuf, BTreeMap<ArchivedProgram, Arc<str>>>,
    /// Texts with the blocks that were found.
    texts: Vec<OpenText>,
}

/// The real paths of files by their names.
#[derive(Default)]
struct Places(HashMap<Arc<str>, PathBuf>);

impl Places {
    fn of(&mut self, name: &Arc<str>) -> PathBuf {
        let place = self.0.entry(Arc::clone(name)).or_insert_with(|| {
            let path = Path::new(&**name);
            path.canonicalize().unwrap_or_else(|_| path.to_owned())
        });
        place.clone()
    }

    fn known(&self, name: &str) -> Option<&Path> {
        self.0.get(name).map(PathBuf::as_path)
    }
}

impl<'a> Cures<'a> {
    fn new(
        auditors: Vec<ProgramAuditor<'a>>,
        archives: &'a [Archive],
        (end, motions): (MendedEnd, CuredMotions),
    ) -> Self {
        let mut cures = Self {
            auditors,
            archives,
            motions,
            wanted: BTreeMap::new(),
            places: Places::default(),
            programs: HashMap::new(),
            callers: HashMap::new(),
            texts: Vec::new(),
        };
        for (machine, archive) in archives.iter().enumerate() {
            let wanted = archive.to_mend(end).into_iter();
            let wanted = wanted.map(|(at, mendings)| ((machine, at), mendings));
            cures.wanted.extend(wanted);
            for (at, program) in archive.programs().iter().enumerate() {
                let place = cures.places.of(&Arc::from(program.file.as_str()));
                cures.programs.insert(place, (machine, at));
                for called in &program.called {
                    let place = cures.places.of(called);
                    let callers = cures.callers.entry(place).or_default();
                    callers.insert((machine, at), Arc::clone(called));
                }
            }
        }
        cures
    }

    /// Returns the files to be mended: those that other programs call, a called file before its callers, and all
    /// others.
    fn files(&self) -> (Vec<PathBuf>, Vec<PathBuf>) {
        let mut files: BTreeSet<PathBuf> = BTreeSet::new();
        for (&program, mendings) in &self.wanted {
            let own = self.place(program);
            files.extend(own.map(Path::to_owned));
            for mending in mendings {
                files.extend(self.cause(program, *mending).map(Path::to_owned));
            }
        }
        let (mut shared, alone): (Vec<_>, Vec<_>) = files
            .into_iter()
            .partition(|place| self.callers(place).next().is_some());
        shared.sort_by_key(|place| {
            let program = self.programs.get(place);
            program.map_or(0, |&program| self.audit(program).called.len())
        });
        (shared, alone)
    }

    fn audit(&self, (machine, at): ArchivedProgram) -> &'a frictcomp::audit::ProgramAudit {
        &self.archives[machine].programs()[at]
    }

    fn place(&self, program: ArchivedProgram) -> Option<&Path> {
        self.places.known(&self.audit(program).file)
    }

    /// Returns the other programs that call a file, each with the name used in the call.
    fn callers(&self, place: &Path) -> impl Iterator<Item = (ArchivedProgram, &Arc<str>)> {
        let own = self.programs.get(place);
        let callers = self.callers.get(place).into_iter().flatten();
        let callers = callers.map(|(program, name)| (*program, name));
        callers.filter(move |(program, _)| Some(program) != own)
    }

    /// Returns the file that makes a program need mending.
    fn cause(&self, program: ArchivedProgram, mending: Mending) -> Option<&Path> {
        let axis = &self.audit(program).axes[mending.at];
        let site = axis.cause(mending.cure)?;
        self.places.known(&site.file)
    }

    /// Mends one file, on all programs that run it.
    fn mend(&self, place: &Path) -> Result<MendedProgram, HostError> {
        let own = self.programs.get(place).copied();
        let programs: Vec<ArchivedProgram> = own
            .into_iter()
            .chain(self.callers(place).map(|(program, _)| program))
            .collect();
        let affected: Vec<Affected<'_>> = programs
            .iter()
            .map(|&program| self.affected(place, program))
            .collect();
        let named = self.callers(place).next().map(|(_, name)| &**name);
        let path = own.map_or(named, |own| Some(self.audit(own).file.as_str()));
        let path = path.map_or(place, Path::new);
        let encoded = read_encoded(path)?;
        let run =
            |at: usize, text: &str, interpreter: &mut Interpreter, listen: &mut dyn Observer| {
                let tried = OpenText {
                    path: place.to_owned(),
                    text: Arc::new(text.to_owned()),
                };
                let texts = Disk::with_open(self.texts.iter().cloned().chain([tried]));
                let (machine, _) = programs[at];
                let path = Path::new(&self.audit(programs[at]).file);
                self.auditors[machine].run_with(&texts, path, (interpreter, listen))
            };
        let mended = mend(encoded.text(), &affected, self.motions, run)?;
        let changes = insertions(encoded.text(), &mended.insertions);
        let cured = mended.cured.iter().map(|&at| programs[at]);
        let cured = cured.filter(|program| Some(*program) != own);
        let machine = own.or(programs.first().copied());
        Ok(MendedProgram {
            machine: machine.map_or(0, |(machine, _)| machine),
            program: own.map(|(_, at)| at),
            file: MendedFile::new(path, &encoded, &changes)?,
            also: cured.map(|it| self.audit(it).file.clone()).collect(),
            changed: mended.changed.iter().map(ToString::to_string).collect(),
            missed: mended.missed,
        })
    }

    /// Returns a program that runs a file, and what a block in the file should mend of it: all in the file
    /// itself; in its callers, what comes from the file or from what it calls.
    fn affected(&self, place: &Path, program: ArchivedProgram) -> Affected<'_> {
        let own = self.programs.get(place).copied();
        let is_own = own == Some(program);
        let own_mendings = own.and_then(|own| self.wanted.get(&own));
        let from_here = |mending: &&Mending| {
            let cause = self.cause(program, **mending);
            let through = own.filter(|_| own_mendings.is_some_and(|own| own.contains(mending)));
            let through = through.and_then(|own| self.cause(own, **mending));
            is_own || cause.is_some() && (cause == Some(place) || cause == through)
        };
        let is_of_machine = own.is_none_or(|(machine, _)| machine == program.0);
        let wanted = self.wanted.get(&program).into_iter().flatten();
        let wanted = wanted.filter(|_| is_of_machine).filter(from_here);
        let callers = self.callers.get(place);
        Affected {
            auditor: &self.auditors[program.0].auditor,
            name: Arc::from(self.audit(program).file.as_str()),
            calls: callers
                .filter(|_| !is_own)
                .and_then(|callers| callers.get(&program).cloned()),
            wanted: wanted.copied().collect(),
        }
    }

    /// Keeps the blocks found for a file, so that later blocks are tried with them.
    fn keep(&mut self, change: &MendedProgram) {
        self.texts.extend(change.file.iter().map(|file| OpenText {
            path: file.path.clone(),
            text: Arc::new(file.after.clone()),
        }));
    }
}
