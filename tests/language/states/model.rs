//! The lints on use once more, implemented as literally as the rules state them, for comparison.

use frictcomp_testing::generator::{CompBlock, CompSwitch};

use super::program::{AXES, KINDS, Program};

/// A message: program, executed block, line, code, axis.
pub(crate) type Said = (usize, u64, u32, &'static str, &'static str);

/// Returns whether the machine has a kind on an axis.
fn has(axis: usize, kind: usize) -> bool {
    matches!(
        (AXES[axis], KINDS[kind]),
        ("X", _) | ("Y" | "B", "FRICT") | ("Z", "LEAD")
    )
}

/// Returns the state at the start of the control: CROSS has manual activation.
fn start_up(axis: usize, kind: usize) -> bool {
    has(axis, kind) && KINDS[kind] != "CROSS"
}

/// A command on a kind: executed block, line, direction.
#[derive(Clone, Copy)]
struct Done {
    seq: u64,
    line: u32,
    on: bool,
    allows: [bool; 2],
}

/// The effect of one program on a kind.
#[derive(Clone, Copy, Default)]
struct Kind {
    first: Option<u64>,
    last: Option<Done>,
}

/// A session.
pub(crate) struct Model {
    on: [[bool; 3]; 4],
    programs: usize,
    pub(crate) said: Vec<Said>,
}

impl Model {
    pub(crate) fn new() -> Self {
        Self {
            on: std::array::from_fn(|axis| std::array::from_fn(|kind| start_up(axis, kind))),
            programs: 0,
            said: Vec::new(),
        }
    }

    /// Runs a program as `--keep-going` does: a refused command counts as absent.
    pub(crate) fn run(&mut self, program: &Program) {
        self.programs += 1;
        let mut run = Run {
            model: self,
            kinds: [[Kind::default(); 3]; 4],
            commanded: [false; 4],
            moved: [None; 4],
            said: Vec::new(),
        };
        for (seq, (line, block)) in (1..).zip(&program.executed) {
            run.block((seq, *line), block);
        }
        run.end();
    }
}

struct Run<'a> {
    model: &'a mut Model,
    kinds: [[Kind; 3]; 4],
    commanded: [bool; 4],
    moved: [Option<u64>; 4],
    said: Vec<(u32, &'static str, usize, usize)>,
}

impl Run<'_> {
    fn say(&mut self, block: (u64, u32), code: &'static str, axis: usize) {
        let entry = (self.model.programs, block.0, block.1, code, AXES[axis]);
        self.model.said.push(entry);
    }

    fn block(&mut self, at: (u64, u32), block: &CompBlock) {
        for (place, command) in block.commands.iter().enumerate() {
            self.command(at, (place, command), block);
        }
        for &axis in &block.moves {
            if self.moved[axis].is_some() {
                continue;
            }
            self.moved[axis] = Some(at.0);
            let depends =
                self.kinds[axis][0].first.is_none() && self.model.on[axis][0] != start_up(axis, 0);
            if depends && block.allows != Some("FC403") {
                self.say(at, "FC403", axis);
            }
        }
    }

    fn command(
        &mut self,
        at: (u64, u32),
        (place, command): (usize, &CompSwitch),
        block: &CompBlock,
    ) {
        let axis = command.axis;
        let is_named = |kind: &usize| command.kinds.contains(&KINDS[*kind]);
        let kinds: Vec<usize> = (0..KINDS.len())
            .filter(|kind| command.kinds.is_empty() || is_named(kind))
            .collect();
        if command.is_on && kinds.contains(&0) && !has(axis, 0) {
            return;
        }
        let repeats = |kind: &usize| {
            let last = self.kinds[axis][*kind].last;
            last.is_some_and(|last| last.on == command.is_on)
                || (!command.is_on && !has(axis, *kind))
        };
        // Kinds of the control that this model leaves out are configured nowhere.
        // The axis was believed to have friction compensation (R18.3).
        let believed = !command.is_on && !has(axis, 0) && command.kinds.contains(&"FRICT");
        let useless = believed || (self.commanded[axis] && kinds.iter().all(repeats));
        let once = (at.1, "FC402", place, axis);
        if useless && block.allows != Some("FC402") && !self.said.contains(&once) {
            self.said.push(once);
            self.say(at, "FC402", axis);
        }
        self.commanded[axis] = true;
        for kind in kinds {
            let entry = &mut self.kinds[axis][kind];
            entry.first.get_or_insert(at.0);
            entry.last = Some(Done {
                seq: at.0,
                line: at.1,
                on: command.is_on,
                allows: ["FC401", "FC407"].map(|code| block.allows == Some(code)),
            });
            if has(axis, kind) {
                self.model.on[axis][kind] = command.is_on;
            }
        }
    }

    fn end(&mut self) {
        // CROSS is switched off.
        self.model.on[0][2] = false;
        for axis in 0..AXES.len() {
            // The tool goes through the kinds in the order of its own table: FRICT comes last.
            for kind in [2, 1, 0] {
                let did = self.kinds[axis][kind];
                let Some(last) = did.last else {
                    continue;
                };
                if self.model.on[axis][kind] == start_up(axis, kind) {
                    continue;
                }
                let before = self.moved[axis].is_some_and(|moved| Some(moved) < did.first);
                let (code, allowed) = if before {
                    ("FC407", last.allows[1])
                } else {
                    ("FC401", last.allows[0])
                };
                if !allowed {
                    self.say((last.seq, last.line), code, axis);
                }
            }
        }
    }
}
