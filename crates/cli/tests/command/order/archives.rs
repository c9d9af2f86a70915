//! Random archives, and the effect of each of their programs, derived from its tree: without a parser and without an
//! interpreter.

use std::collections::BTreeMap;

use frictcomp_testing::generator::{
    Choices, Condition, Form, NcProgram, Operand, Pace, Profile, Statement, Style,
};

pub(crate) const AXES: &[&str] = Profile::ARCHIVED.axes;

/// A program, how it is written, and its tree.
pub(crate) struct Program {
    pub(crate) name: String,
    pub(crate) bytes: Vec<u8>,
    tree: NcProgram,
}

/// The effect of a program on an axis.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Expected {
    pub(crate) effect: &'static str,
    /// The line of the last command.
    pub(crate) by: Option<u32>,
    /// The line of the first motion before any command, and whether it is rapid.
    pub(crate) inherits: Option<(u32, bool)>,
}

impl Program {
    pub(crate) fn random(choices: &mut Choices<'_>, number: usize) -> Self {
        let style = Style::choose(choices);
        let mut tree = NcProgram::choose(&Profile::ARCHIVED, choices);
        let text = tree.write(style);
        let bytes = if choices.chance(50) {
            let letters = text.chars().map(u8::try_from);
            letters.collect::<Result<_, _>>().expect("Latin")
        } else {
            text.into_bytes()
        };
        Self {
            name: format!("p{number:02}.nc"),
            bytes,
            tree,
        }
    }

    /// Returns the effect of the program on each axis, from its tree.
    pub(crate) fn expected(&self) -> BTreeMap<&'static str, Expected> {
        let mut walk = Walk {
            tree: &self.tree,
            axes: Default::default(),
        };
        walk.statements(&self.tree.body);
        let expected = walk.axes.into_iter().zip(AXES).map(|(axis, name)| {
            let effect = match axis.last {
                None => "keeps",
                Some((true, _)) => "leaves on",
                Some((false, _)) => "leaves off",
            };
            let by = axis.last.map(|(_, line)| line);
            let inherits = axis.inherits;
            (
                *name,
                Expected {
                    effect,
                    by,
                    inherits,
                },
            )
        });
        expected.collect()
    }
}

#[derive(Default)]
struct WalkAxis {
    last: Option<(bool, u32)>,
    inherits: Option<(u32, bool)>,
}

struct Walk<'a> {
    tree: &'a NcProgram,
    axes: [WalkAxis; AXES.len()],
}

impl Walk<'_> {
    fn statements(&mut self, statements: &[Statement]) {
        for Statement { line, form, .. } in statements {
            match form {
                Form::Block(block) => {
                    for command in &block.commands {
                        self.axes[command.axis].last = Some((command.is_on, *line));
                    }
                    let moved = block.moves.iter().map(|axis| (*axis, block.pace));
                    moved.for_each(|motion| self.motion(motion, *line));
                }
                // A remark.
                Form::Text(_) => {}
                Form::If(branches, otherwise) => {
                    let mut branches = branches.iter();
                    let taken =
                        branches.find(|(condition, _)| *condition == Condition::Fixed(true));
                    if let Some(body) = taken.map(|(_, body)| body).or(otherwise.as_ref()) {
                        self.statements(body);
                    }
                }
                Form::For(_, Operand::Number(times), body) => {
                    (0..*times).for_each(|_| self.statements(body));
                }
                Form::Call(name, None) => {
                    let called = self.tree.subprograms.iter().find(|it| it.name == *name);
                    self.statements(&called.expect("a subprogram").body);
                }
                other => panic!("{other:?}"),
            }
        }
    }

    fn motion(&mut self, (axis, pace): (usize, Pace), line: u32) {
        let axis = &mut self.axes[axis];
        if axis.last.is_none() {
            let motion = (line, pace == Pace::Rapid);
            axis.inherits.get_or_insert(motion);
        }
    }
}
