//! The calls between programs, found without running them (R17.2).

use std::collections::{BTreeMap, HashMap};
use std::num::NonZeroUsize;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::main_programs::{callers_first, may_end};
use crate::disk::{Disk, Input, Naming, OpenText};
use crate::error::HostError;
use crate::machines::{LoadedMachine, Machines, ProgramFinder};
use crate::workers::in_order;
use frictcomp::interpreter::NoProgram;
use frictcomp::interpreter::{CallSite, call_sites};
use frictcomp::machine::ConfiguredPrograms;

/// The programs of several paths and all files that they call, with their calls.
#[derive(Debug, Default)]
pub struct CallGraph {
    programs: Vec<GraphProgram>,
    disk: Disk,
}

/// A program with its calls.
#[derive(Debug)]
pub struct GraphProgram {
    /// The program.
    pub input: Input,
    /// Name in outputs.
    pub name: String,
    /// The one path to which all names of its file lead; `None` for standard input.
    pub place: Option<PathBuf>,
    /// Whether the program is one of the requested ones, not only called by one.
    pub is_named: bool,
    /// The calls of programs that were found, in the order of the text.
    pub calls: Vec<FoundCall>,
    /// The calls of programs that were not found.
    pub missing: Vec<MissingCall>,
    /// The lines of calls whose program is known only at run time.
    pub open: Vec<u32>,
    /// The positions of the programs that call it, each once.
    pub called_by: Vec<usize>,
    /// The programs that the configuration runs before and after a main program.
    around: Vec<usize>,
}

impl GraphProgram {
    /// Returns whether it does not call anything.
    pub fn is_leaf(&self) -> bool {
        self.calls.is_empty() && self.missing.is_empty() && self.open.is_empty()
    }
}

/// A call of a program.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub struct FoundCall {
    /// The position of the program that is called.
    pub program: usize,
    /// The line of the call, from 1.
    pub line: u32,
}

/// A call whose program does not exist.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub struct MissingCall {
    /// The name as it is called.
    pub name: String,
    /// The line of the call, from 1.
    pub line: u32,
    /// Reason why it was not found.
    pub why: NoProgram,
}

/// Finders and their results, one for the programs of a folder.
#[derive(Default)]
struct Finders {
    of_folders: HashMap<PathBuf, ProgramFinder>,
    found: HashMap<(PathBuf, String), Result<PathBuf, NoProgram>>,
}

/// A graph under construction.
struct Builder<'a> {
    machines: &'a mut Machines,
    disk: Disk,
    workers: NonZeroUsize,
    graph: CallGraph,
    /// The programs by their real paths.
    known: HashMap<PathBuf, usize>,
    finders: Finders,
    errors: Vec<HostError>,
}

impl CallGraph {
    /// Builds the graph of programs, each on the machine of its folder, and returns what cannot be read.
    pub fn of(
        inputs: &[Input],
        machines: &mut Machines,
        workers: NonZeroUsize,
    ) -> (Self, Vec<HostError>) {
        let disk = machines.disk().clone();
        let mut builder = Builder {
            machines,
            disk: disk.clone(),
            workers,
            graph: Self {
                programs: Vec::new(),
                disk,
            },
            known: HashMap::new(),
            finders: Finders::default(),
            errors: Vec::new(),
        };
        for input in inputs {
            builder.add(input.clone(), input.name(Naming::AsGiven), true);
        }
        let mut done = 0;
        while done < builder.graph.programs.len() {
            let batch = done..builder.graph.programs.len();
            done = batch.end;
            builder.follow(batch);
        }
        let Builder {
            mut graph, errors, ..
        } = builder;
        graph.link();
        (graph, errors)
    }

    /// Returns the programs, in the order in which they were found.
    pub fn programs(&self) -> &[GraphProgram] {
        &self.programs
    }

    /// Returns whether each program is a main program in its own right: no program calls it, it may end a main program,
    /// or it is called in a circle that no main program reaches (R17.2). The programs that the configuration runs
    /// around main programs become calls of these.
    pub fn mains(&mut self, workers: NonZeroUsize) -> Vec<bool> {
        let mut may_end_at = vec![false; self.programs.len()];
        let disk = &self.disk;
        let programs = self.programs.iter().enumerate();
        let ends = |(at, program): (usize, &GraphProgram)| (at, may_end(&program.input, disk));
        in_order(programs, workers, ends, |(at, ends)| {
            may_end_at[at] = ends;
            ControlFlow::Continue(())
        });
        let own = self.mains_of(&may_end_at);
        for (at, is_main) in own.iter().enumerate() {
            if *is_main {
                self.take_around(at);
            }
        }
        self.link();
        self.mains_of(&may_end_at)
    }

    fn mains_of(&self, may_end_at: &[bool]) -> Vec<bool> {
        let edges = self.edges();
        let is_main = |at: usize| {
            let callers = &self.programs[at].called_by;
            may_end_at[at] || callers.iter().all(|caller| *caller == at)
        };
        let mut mains: Vec<bool> = (0..edges.len()).map(is_main).collect();
        let mut reached = vec![false; edges.len()];
        let mut next: Vec<usize> = (0..edges.len()).filter(|at| mains[*at]).collect();
        walk(&edges, &mut next, &mut reached);
        for circle in callers_first(&edges) {
            next.extend(circle.into_iter().filter(|at| !reached[*at]));
            for at in &next {
                mains[*at] = true;
            }
            walk(&edges, &mut next, &mut reached);
        }
        mains
    }

    /// Adds the calls of the programs around a main program, which its text does not contain.
    fn take_around(&mut self, at: usize) {
        let program = &mut self.programs[at];
        let around = std::mem::take(&mut program.around).into_iter();
        let around = around.filter(|called| *called != at);
        let around = around.map(|program| FoundCall { program, line: 1 });
        program.calls.extend(around);
    }

    /// Returns the programs that call each other in a cycle, or themselves, by their positions.
    pub fn circles(&self) -> Vec<Vec<usize>> {
        let edges = self.edges();
        let mut circles = callers_first(&edges);
        circles.retain(|circle| match circle.as_slice() {
            [one] => edges[*one].contains(one),
            _ => true,
        });
        circles.sort_unstable();
        circles
    }

    /// Returns programs of one name in several folders of which one is called, by their positions.
    pub fn of_one_name(&self) -> Vec<Vec<usize>> {
        let mut names: BTreeMap<String, Vec<usize>> = BTreeMap::new();
        for (at, program) in self.programs.iter().enumerate() {
            let last = program.name.rsplit('/').next().unwrap_or_default();
            names.entry(last.to_lowercase()).or_default().push(at);
        }
        let is_called = |at: &usize| !self.programs[*at].called_by.is_empty();
        let several = names.into_values();
        several
            .filter(|all| all.len() > 1 && all.iter().any(is_called))
            .collect()
    }

    /// Returns whether each program is one of `changed`, or reaches one by its calls.
    pub fn reaching(&self, changed: impl Fn(&GraphProgram) -> bool) -> Vec<bool> {
        let mut reached = vec![false; self.programs.len()];
        let programs = self.programs.iter().enumerate();
        let changed = programs.filter(|(_, program)| changed(program));
        let mut next: Vec<usize> = changed.map(|(at, _)| at).collect();
        let callers: Vec<Vec<usize>> = self
            .programs
            .iter()
            .map(|program| program.called_by.clone())
            .collect();
        walk(&callers, &mut next, &mut reached);
        reached
    }

    /// Returns the programs that reach a program by their calls, except itself, by their positions.
    pub fn callers(&self, program: usize) -> Vec<usize> {
        let mut reached = vec![false; self.programs.len()];
        let mut next = vec![program];
        while let Some(at) = next.pop() {
            let callers = self.programs[at].called_by.iter();
            for caller in callers.copied() {
                if !std::mem::replace(&mut reached[caller], true) {
                    next.push(caller);
                }
            }
        }
        reached[program] = false;
        (0..reached.len()).filter(|at| reached[*at]).collect()
    }

    fn edges(&self) -> Vec<Vec<usize>> {
        let calls = self.programs.iter().map(|program| program.calls.iter());
        calls
            .map(|calls| calls.map(|call| call.program).collect())
            .collect()
    }

    /// Notes the callers of each program.
    fn link(&mut self) {
        let mut called_by = vec![Vec::new(); self.programs.len()];
        for (at, program) in self.programs.iter().enumerate() {
            for call in &program.calls {
                let callers: &mut Vec<usize> = &mut called_by[call.program];
                if callers.last() != Some(&at) {
                    callers.push(at);
                }
            }
        }
        for (program, called_by) in self.programs.iter_mut().zip(called_by) {
            program.called_by = called_by;
        }
    }
}

/// Follows edges from the positions that come next, and marks what is reached, them included.
fn walk(edges: &[Vec<usize>], next: &mut Vec<usize>, reached: &mut [bool]) {
    while let Some(at) = next.pop() {
        if !std::mem::replace(&mut reached[at], true) {
            next.extend(edges[at].iter().filter(|to| !reached[**to]));
        }
    }
}

impl Builder<'_> {
    /// Returns the position of a program, and adds it if it is new.
    fn add(&mut self, input: Input, name: String, is_named: bool) -> usize {
        let next = self.graph.programs.len();
        let place = match &input {
            Input::File(path) | Input::Open(OpenText { path, .. }) => {
                Some(self.disk.real(path).unwrap_or_else(|_| path.clone()))
            }
            Input::Stdin => None,
        };
        if let Some(place) = &place {
            let at = *self.known.entry(place.clone()).or_insert(next);
            if at < next {
                return at;
            }
        }
        self.graph.programs.push(GraphProgram {
            input,
            name,
            place,
            is_named,
            calls: Vec::new(),
            missing: Vec::new(),
            open: Vec::new(),
            called_by: Vec::new(),
            around: Vec::new(),
        });
        next
    }

    /// Reads programs, and finds what they call.
    fn follow(&mut self, batch: std::ops::Range<usize>) {
        let mut jobs = Vec::with_capacity(batch.len());
        for at in batch {
            let input = self.graph.programs[at].input.clone();
            match self.machines.for_folder(input.folder()) {
                Ok(loaded) => jobs.push((at, input, loaded)),
                Err(error) => self.errors.push(error),
            }
        }
        let disk = &self.disk;
        let read = |(at, input, loaded): (usize, Input, Arc<LoadedMachine>)| {
            let sites = sites_of(&input, &loaded.machine.programs, disk);
            (at, loaded, sites)
        };
        let mut found = Vec::with_capacity(jobs.len());
        in_order(jobs.into_iter(), self.workers, read, |read| {
            found.push(read);
            ControlFlow::Continue(())
        });
        for (at, loaded, sites) in found {
            match sites {
                Ok(sites) => self.resolve(at, &loaded, sites),
                Err(error) => self.errors.push(error),
            }
        }
    }

    fn resolve(&mut self, at: usize, loaded: &LoadedMachine, sites: Vec<CallSite>) {
        let input = self.graph.programs[at].input.clone();
        for CallSite { name, line } in sites {
            let Some(name) = name else {
                self.graph.programs[at].open.push(line);
                continue;
            };
            if loaded.machine.programs.is_external(&name) {
                continue;
            }
            match self.finders.find(&name, &input, loaded) {
                Ok(path) => {
                    let program = self.called(path);
                    let call = FoundCall { program, line };
                    self.graph.programs[at].calls.push(call);
                }
                Err(why) => {
                    let missing = MissingCall { name, line, why };
                    self.graph.programs[at].missing.push(missing);
                }
            }
        }
        let programs = &loaded.machine.programs;
        for name in [&programs.start, &programs.end].into_iter().flatten() {
            if let Ok(path) = self.finders.find(name, &input, loaded) {
                let program = self.called(path);
                self.graph.programs[at].around.push(program);
            }
        }
    }

    fn called(&mut self, path: PathBuf) -> usize {
        let name = Naming::AsGiven.name(&path);
        self.add(Input::File(path), name, false)
    }
}

impl Finders {
    /// Returns the file that a program refers to by a name.
    fn find(
        &mut self,
        name: &str,
        caller: &Input,
        loaded: &LoadedMachine,
    ) -> Result<PathBuf, NoProgram> {
        let folder = caller.folder().to_owned();
        let key = (folder.clone(), name.to_owned());
        if let Some(found) = self.found.get(&key) {
            return found.clone();
        }
        let new = || ProgramFinder::new(caller, &loaded.search_path, Naming::AsGiven, &loaded.disk);
        let finder = self.of_folders.entry(folder).or_insert_with(new);
        let found = finder.place(name, caller.folder());
        self.found.insert(key, found.clone());
        found
    }
}

/// Returns the calls in a program.
fn sites_of(
    input: &Input,
    programs: &ConfiguredPrograms,
    disk: &Disk,
) -> Result<Vec<CallSite>, HostError> {
    match input {
        Input::File(path) => {
            let text = disk
                .read(path)
                .map_err(|error| HostError::read(path, error))?;
            Ok(call_sites(&text, programs))
        }
        Input::Open(open) => Ok(call_sites(&open.text, programs)),
        Input::Stdin => Err(HostError::read(
            Path::new("-"),
            std::io::Error::from(std::io::ErrorKind::Unsupported),
        )),
    }
}
