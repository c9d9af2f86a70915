//! Programs made at random, with the blocks that they execute.

use frictcomp::machine::Machine;
use frictcomp_testing::generator::{
    Choices, CompBlock, Form, NcProgram, Operand, Profile, Statement, Style,
};

use crate::support::MACHINE;

/// The axes of the machine below; Z has no friction compensation, B no value list.
pub(crate) const AXES: &[&str] = Profile::EXECUTED.axes;

/// Kinds that commands name.
pub(crate) const KINDS: &[&str] = Profile::EXECUTED.kinds;

/// Returns the machine of the other tests, where X has all three kinds, of which CROSS is switched off at program end,
/// and Z has LEAD.
pub(crate) fn machine_text() -> String {
    let x = "compensations = [\"FRICT\", \"LEAD\", \"CROSS\"]\nmanual_activation = [\"CROSS\"]";
    MACHINE
        .replace("name = \"X\"", &format!("name = \"X\"\n{x}"))
        .replace("name = \"Z\"", "name = \"Z\"\ncompensations = [\"LEAD\"]")
}

/// Returns the machine of the other tests, read.
pub(crate) fn machine() -> Machine {
    Machine::from_toml(&machine_text()).expect("the machine")
}

/// A block that is executed, with its line.
pub(crate) type Executed = (u32, CompBlock);

/// The text of a program and the blocks that it executes, one after another.
#[derive(Debug, Clone)]
pub(crate) struct Program {
    pub(crate) text: String,
    pub(crate) executed: Vec<Executed>,
}

impl Program {
    /// Returns a program with loops and a local subprogram.
    pub(crate) fn random(choices: &mut Choices<'_>) -> Self {
        let mut tree = NcProgram::choose(&Profile::EXECUTED, choices);
        let text = tree.write(Style::default());
        let mut executed = Vec::new();
        execute(&tree, &tree.body, &mut executed);
        executed.push(plain(0));
        Self { text, executed }
    }
}

/// Returns a block without commands and motions, in whose line nothing can be said.
fn plain(line: u32) -> Executed {
    (line, CompBlock::default())
}

fn execute(tree: &NcProgram, statements: &[Statement], executed: &mut Vec<Executed>) {
    for Statement { line, form, .. } in statements {
        match form {
            Form::Block(block) => executed.push((*line, block.clone())),
            Form::For(_, Operand::Number(times), body) => {
                executed.push(plain(*line));
                for _ in 0..*times {
                    execute(tree, body, executed);
                    executed.push(plain(0));
                }
            }
            Form::Call(name, None) => {
                executed.push(plain(*line));
                let called = tree.subprograms.iter().find(|it| it.name == *name);
                execute(tree, &called.expect("a subprogram").body, executed);
                executed.push(plain(0));
            }
            other => panic!("{other:?}"),
        }
    }
}
