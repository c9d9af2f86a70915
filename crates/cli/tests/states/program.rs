//! Programs made at random, with the blocks that they execute.

use fastrand::Rng;
use frictcomp::machine::Machine;

use crate::support::MACHINE;

/// The axes of the machine below; Z has no friction compensation, B no value list.
pub(crate) const AXES: [&str; 4] = ["X", "Y", "Z", "B"];

/// Kinds that commands name.
pub(crate) const KINDS: [&str; 3] = ["FRICT", "LEAD", "CROSS"];

/// The machine of the other tests, where X has all three kinds, of which CROSS is switched off at program
/// end, and Z has LEAD.
pub(crate) fn machine_text() -> String {
    let x = "compensations = [\"FRICT\", \"LEAD\", \"CROSS\"]\nmanual_activation = [\"CROSS\"]";
    MACHINE
        .replace("name = \"X\"", &format!("name = \"X\"\n{x}"))
        .replace("name = \"Z\"", "name = \"Z\"\ncompensations = [\"LEAD\"]")
}

/// The machine of the other tests, read.
pub(crate) fn machine() -> Machine {
    Machine::from_toml(&machine_text()).expect("the machine")
}

/// The content of a command for an axis.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Command {
    pub(crate) axis: usize,
    pub(crate) on: bool,
    /// Positions in [`KINDS`]; none stands for `OFF_ALL`.
    pub(crate) kinds: Vec<usize>,
}

impl Command {
    fn random(rng: &mut Rng) -> Self {
        let axis = rng.usize(..AXES.len());
        let on = rng.bool();
        let mut kinds: Vec<usize> = (0..KINDS.len()).filter(|_| rng.u8(..3) == 0).collect();
        if kinds.is_empty() && (on || rng.bool()) {
            kinds.push(0);
        }
        Self { axis, on, kinds }
    }

    fn text(&self) -> String {
        let axis = AXES[self.axis];
        if self.kinds.is_empty() {
            return format!("{axis}[COMP OFF_ALL]");
        }
        let on = if self.on { "ON" } else { "OFF" };
        let kinds: Vec<&str> = self.kinds.iter().map(|kind| KINDS[*kind]).collect();
        format!("{axis}[COMP {on} {}]", kinds.join(" "))
    }
}

/// A block: commands, axes that move, codes that a comment allows.
#[derive(Debug, Clone, Default)]
pub(crate) struct Block {
    pub(crate) line: u32,
    pub(crate) commands: Vec<Command>,
    pub(crate) moves: Vec<usize>,
    pub(crate) allows: Vec<&'static str>,
}

/// The text of a program and the blocks that it executes, one after another.
#[derive(Debug, Clone, Default)]
pub(crate) struct Program {
    pub(crate) text: String,
    pub(crate) executed: Vec<Block>,
    lines: u32,
}

impl Program {
    /// A program with loops and a local subprogram.
    pub(crate) fn random(rng: &mut Rng) -> Self {
        let mut program = Self::default();
        program.add("%PROGRAM");
        let mut sub: Option<Vec<Block>> = None;
        if rng.bool() {
            // A local subprogram comes first, so that its lines are known.
            program.text.clear();
            program.lines = 0;
            program.add("%L SUB");
            let mut blocks = program.stretch(rng);
            blocks.push(program.plain("M17"));
            sub = Some(blocks);
            program.add("%PROGRAM");
        }
        for _ in 0..rng.usize(1..4) {
            match (rng.u8(..3), &sub) {
                (0, Some(blocks)) => {
                    let call = program.plain("LL SUB");
                    program.executed.push(call);
                    program.executed.extend(blocks.iter().cloned());
                }
                (1, _) => program.repeated(rng),
                _ => {
                    let blocks = program.stretch(rng);
                    program.executed.extend(blocks);
                }
            }
        }
        let end = program.plain("M30");
        program.executed.push(end);
        program
    }

    /// A stretch that runs twice.
    fn repeated(&mut self, rng: &mut Rng) {
        let head = self.plain("$FOR P1=1,2,1");
        let body = self.stretch(rng);
        let foot = self.plain("$ENDFOR");
        self.executed.push(head);
        for _ in 0..2 {
            self.executed.extend(body.iter().cloned());
            self.executed.push(foot.clone());
        }
    }

    fn stretch(&mut self, rng: &mut Rng) -> Vec<Block> {
        (0..rng.usize(1..5)).map(|_| self.block(rng)).collect()
    }

    fn block(&mut self, rng: &mut Rng) -> Block {
        let mut block = Block::default();
        for _ in 0..[0, 1, 1, 2][rng.usize(..4)] {
            block.commands.push(Command::random(rng));
        }
        if block.commands.is_empty() || rng.u8(..5) == 0 {
            block.moves = (0..AXES.len()).filter(|_| rng.u8(..3) == 0).collect();
        }
        let mut text: Vec<String> = block.commands.iter().map(Command::text).collect();
        text.extend(block.moves.iter().map(|axis| format!("{}1", AXES[*axis])));
        if text.is_empty() {
            text.push("G90".to_owned());
        }
        if rng.u8(..6) == 0 {
            block.allows = vec![["FC401", "FC402", "FC403", "FC407"][rng.usize(..4)]];
            text.push(format!("; frictcomp: allow {}", block.allows[0]));
        }
        block.line = self.add(&text.join(" "));
        block
    }

    fn plain(&mut self, text: &str) -> Block {
        Block {
            line: self.add(text),
            ..Block::default()
        }
    }

    fn add(&mut self, text: &str) -> u32 {
        self.text.push_str(text);
        self.text.push('\n');
        self.lines += 1;
        self.lines
    }
}
