//! Selection of the main programs (R17.2).

use std::collections::HashMap;
use std::path::{Path, PathBuf};

use crate::disk::{Disk, Input, OpenText};
use frictcomp::interpreter::holds_program_end;

/// A program that was run from the start of the control, and what it called.
#[derive(Debug, Clone)]
pub(super) struct ExecutedProgram<'a> {
    /// The program.
    pub(super) input: &'a Input,
    /// The names of the files that it executed to their end, except itself.
    pub(super) executed_to_end: Vec<String>,
}

/// Returns which of the programs are main programs: all but those that have neither M02 nor M30
/// and that a main program among them executed to their end. Programs that only call each other are
/// main programs (R17.2).
pub(super) fn main_programs(programs: &[ExecutedProgram<'_>], disk: &Disk) -> Vec<bool> {
    let edges = edges(programs, disk);
    let mut is_called = vec![false; programs.len()];
    for (caller, called) in edges.iter().enumerate() {
        for called in called {
            is_called[*called] |= *called != caller;
        }
    }
    let is_main = |at: usize| !is_called[at] || may_end(programs[at].input, disk);
    let mut mains: Vec<bool> = (0..programs.len()).map(is_main).collect();
    let mut is_covered = vec![false; programs.len()];
    let cover = |at: usize, is_covered: &mut Vec<bool>| {
        for called in &edges[at] {
            is_covered[*called] = true;
        }
    };
    for (at, _) in mains.iter().enumerate().filter(|(_, is_main)| **is_main) {
        cover(at, &mut is_covered);
    }
    for circle in callers_first(&edges) {
        let left: Vec<usize> = circle
            .into_iter()
            .filter(|at| !mains[*at] && !is_covered[*at])
            .collect();
        for at in left {
            mains[at] = true;
            cover(at, &mut is_covered);
        }
    }
    mains
}

/// Returns the positions of the programs that each one executed to their end.
fn edges(programs: &[ExecutedProgram<'_>], disk: &Disk) -> Vec<Vec<usize>> {
    if programs.iter().all(|it| it.executed_to_end.is_empty()) {
        return vec![Vec::new(); programs.len()];
    }
    let place = |path: &Path| disk.real(path).unwrap_or_else(|_| path.to_owned());
    let mut positions: HashMap<PathBuf, usize> = HashMap::new();
    for (at, program) in programs.iter().enumerate() {
        if let Input::File(path) | Input::Open(OpenText { path, .. }) = program.input {
            positions.entry(place(path)).or_insert(at);
        }
    }
    let mut known: HashMap<&str, Option<usize>> = HashMap::new();
    let mut position = |name| {
        let found = || positions.get(&place(Path::new(name))).copied();
        *known.entry(name).or_insert_with(found)
    };
    let programs = programs.iter();
    let called = programs.map(|it| it.executed_to_end.iter());
    called
        .map(|names| names.filter_map(|name| position(name.as_str())).collect())
        .collect()
}

/// Returns programs that call each other together, callers before what they call: the strongly connected
/// components of Kosaraju's algorithm, without recursion. The graph crate petgraph would bring in tables
/// of a second version.
pub(crate) fn callers_first(edges: &[Vec<usize>]) -> Vec<Vec<usize>> {
    let mut callers = vec![Vec::new(); edges.len()];
    for (caller, called) in edges.iter().enumerate() {
        for called in called {
            callers[*called].push(caller);
        }
    }
    let mut is_seen = vec![false; edges.len()];
    let mut finished = Vec::with_capacity(edges.len());
    for start in 0..edges.len() {
        finish(edges, start, &mut is_seen, &mut finished);
    }
    let mut is_taken = vec![false; edges.len()];
    let mut circles = Vec::new();
    for start in finished.into_iter().rev() {
        let mut circle = Vec::new();
        finish(&callers, start, &mut is_taken, &mut circle);
        if !circle.is_empty() {
            circle.sort_unstable();
            circles.push(circle);
        }
    }
    circles
}

/// Appends the unseen nodes reached from a start, each after all that it leads to.
fn finish(edges: &[Vec<usize>], start: usize, is_seen: &mut [bool], finished: &mut Vec<usize>) {
    if std::mem::replace(&mut is_seen[start], true) {
        return;
    }
    let mut open = vec![(start, 0)];
    while let Some((at, next)) = open.last_mut() {
        if let Some(to) = edges[*at].get(*next) {
            *next += 1;
            if !std::mem::replace(&mut is_seen[*to], true) {
                open.push((*to, 0));
            }
        } else {
            finished.push(*at);
            open.pop();
        }
    }
}

/// Returns whether a program may end a main program, or cannot be read.
pub(crate) fn may_end(input: &Input, disk: &Disk) -> bool {
    match input {
        Input::File(path) => disk
            .read(path)
            .map_or(true, |text| holds_program_end(&text)),
        Input::Open(open) => holds_program_end(&open.text),
        Input::Stdin => true,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::Arc;

    fn mains(programs: &[(&str, &str, &[&str])]) -> String {
        let open = |name: &str, text: &str| {
            Input::Open(OpenText {
                path: PathBuf::from(name),
                text: Arc::new(text.to_owned()),
            })
        };
        let inputs: Vec<Input> = programs
            .iter()
            .map(|(name, text, _)| open(name, text))
            .collect();
        let executed = |(input, (_, _, called)): (_, &(&str, &str, &[&str]))| ExecutedProgram {
            input,
            executed_to_end: called.iter().map(|name| (*name).to_owned()).collect(),
        };
        let ran: Vec<_> = inputs.iter().zip(programs).map(executed).collect();
        let mains = main_programs(&ran, &Disk::in_memory([]));
        let names = programs.iter().zip(mains).filter(|(_, is_main)| *is_main);
        names
            .map(|((name, ..), _)| *name)
            .collect::<Vec<_>>()
            .join(" ")
    }

    #[test]
    fn called_programs_are_left_to_their_callers() {
        // R17.2
        let sub = "X1\nM17\n";
        assert_eq!(mains(&[("a", "M30", &["s"]), ("s", sub, &[])]), "a");
        // A program that ends itself is a main program.
        assert_eq!(mains(&[("a", "M30", &["b"]), ("b", "M30", &[])]), "a b");
        // Programs that only call each other are main programs.
        assert_eq!(
            mains(&[("a", sub, &["b", "a"]), ("b", sub, &["a", "b"])]),
            "a b"
        );
        // A program that only they call is not.
        let circle: &[&str] = &["a", "b", "s"];
        let programs = [
            ("s", sub, &[] as &[&str]),
            ("a", sub, circle),
            ("b", sub, circle),
        ];
        assert_eq!(mains(&programs), "a b");
        // A program that calls itself has no other caller.
        assert_eq!(mains(&[("a", sub, &["a"])]), "a");
        assert_eq!(
            mains(&[("a", sub, &["b"]), ("b", sub, &["c"]), ("c", sub, &[])]),
            "a c"
        );
    }
}
