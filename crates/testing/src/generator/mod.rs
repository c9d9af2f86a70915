//! NC programs for tests and fuzzers: [`Choices`] of a seed or of bytes make the tree of a program by a [`Profile`],
//! from which a test derives what it expects; it is written in a [`Style`].

mod choices;
mod hostile;
mod lines;
mod phrases;
mod profile;
mod structures;
mod tree;
mod written;

pub use choices::Choices;
pub use lines::{any_lines, plain_line, spaced_words};
pub use profile::{Ask, Profile, Shape};
pub use tree::{
    CompBlock, CompSwitch, Condition, Form, NcProgram, Operand, Pace, SkipMarks, Statement,
    Subprogram, SwitchCase, Variable,
};
pub use written::{Style, SubprogramPlace, TextEnd};

use SkipMarks::{Both, First, Last};

/// Blocks in which the PLC acts by design.
const PLC_ACTS: [&str; 8] = [
    "M0",
    "M1",
    "M26",
    "G04 0.5",
    "#TIME 0.1",
    "#FLUSH WAIT",
    "#MSG ACK [\"WAIT\"]",
    "S[M5]",
];

/// Blocks at which the control stops.
const ERRORS: [(&str, usize); 5] = [
    ("#ERROR [ID=5 RC=2]", 1),
    ("#ERROR [RC[1+1], ID 7]", 1),
    ("#ERROR [ID1 RC 1 PV1=\"RC=0\"]", 1),
    ("W[COMP ON FRICT]", 2),
    ("L MISSING.NC", 2),
];

/// The codes of messages that comments allow.
const ALLOWED: [&str; 4] = ["FC401", "FC402", "FC403", "FC407"];

impl NcProgram {
    /// Makes a program.
    pub fn choose(profile: &Profile, choices: &mut Choices<'_>) -> Self {
        let mut generator = Generator {
            profile,
            choices,
            subprograms: Vec::new(),
            values: vec![3; profile.shared],
            labels: 1000,
            again: 0,
        };
        let head = generator.choices.one_of(profile.heads);
        generator.subprograms_to_call_again();
        let mut body: Vec<Statement> = profile
            .prelude
            .iter()
            .copied()
            .map(Statement::text)
            .collect();
        let depth = generator.choices.between(profile.depth);
        body.extend(generator.statements(profile.program, depth));
        Self {
            axes: profile.axes,
            head,
            body,
            end: generator.choices.one_of(profile.ends),
            subprograms: generator.subprograms,
            values: generator.values,
        }
    }
}

/// A program while it is made.
struct Generator<'a, 'b> {
    profile: &'a Profile,
    choices: &'a mut Choices<'b>,
    subprograms: Vec<Subprogram>,
    values: Vec<usize>,
    /// The last label.
    labels: usize,
    /// The number of subprograms that are called again.
    again: usize,
}

impl Generator<'_, '_> {
    fn subprograms_to_call_again(&mut self) {
        for name in ["A", "B"]
            .iter()
            .take(self.choices.between(self.profile.subprograms))
        {
            let body = self.statements(self.profile.body, 0);
            let name = (*name).to_owned();
            self.subprograms.push(Subprogram { name, body });
        }
        self.again = self.subprograms.len();
    }

    /// Makes statements, at most as many as there are choices.
    fn statements(&mut self, range: [usize; 2], depth: usize) -> Vec<Statement> {
        let mut made = Vec::new();
        for at in 0..self.choices.between(range) {
            if at > 0 && self.choices.is_used_up() {
                break;
            }
            made.extend(self.statement(depth));
        }
        made
    }

    /// Makes what a statement holds.
    fn inner(&mut self, depth: usize) -> Vec<Statement> {
        self.statements(self.profile.body, depth - 1)
    }

    /// Returns whether there are as many machine variables as answers can be tried.
    fn is_full(&self) -> bool {
        self.values.len() >= self.profile.variables
    }

    /// Returns a machine variable with a number of values, from 0.
    fn machine(&mut self, values: usize) -> Variable {
        if !self.values.is_empty() && self.choices.chance(self.profile.reuse) {
            return Variable::Machine(self.choices.below(self.values.len()));
        }
        self.values.push(values);
        Variable::Machine(self.values.len() - 1)
    }

    fn parameter(&mut self) -> Variable {
        Variable::Parameter(self.choices.between([1, 3]))
    }

    fn condition(&mut self) -> Condition {
        match self.choices.weighted(self.profile.conditions) {
            Ask::Fixed => Condition::Fixed(self.choices.chance(50)),
            Ask::AnyValue => Condition::is(self.machine(3), self.choices.below(3)),
            Ask::One => Condition::is(self.machine(2), 1),
            Ask::NotZero => Condition::Compare(self.machine(2), "!=", Operand::Number(0)),
            Ask::NotOne => Condition::Not(Box::new(Condition::is(self.machine(2), 1))),
            Ask::Both => {
                let both = [(); 2].map(|()| Condition::is(self.machine(2), 1));
                Condition::Both(Box::new(both))
            }
            Ask::Parameter => Condition::is(self.parameter(), self.choices.below(3)),
            Ask::Above => {
                let value = Operand::Number(self.choices.below(3));
                Condition::Compare(self.parameter(), ">", value)
            }
            Ask::Active => {
                let axis = self.choices.one_of(self.profile.axes);
                Condition::is(Variable::Active(axis), self.choices.below(2))
            }
        }
    }

    /// Makes a statement, or some that belong together.
    fn statement(&mut self, depth: usize) -> Vec<Statement> {
        let shapes = if depth == 0 || self.is_full() {
            self.profile.leaves
        } else {
            self.profile.statements
        };
        match self.choices.weighted(shapes) {
            Shape::Comp => vec![self.comp()],
            Shape::Block => vec![self.block()],
            Shape::Move => vec![self.motion()],
            Shape::Remark => vec![Statement::text(self.choices.one_of(&["; size", "; Größe"]))],
            Shape::If => vec![self.branch(depth)],
            Shape::Switch => vec![self.switch(depth)],
            Shape::Case => {
                let subject = self.machine(3).into();
                let case = SwitchCase {
                    number: 1,
                    body: self.inner(depth),
                    has_break: false,
                };
                vec![Form::Switch(subject, vec![case], None).into()]
            }
            Shape::End => {
                let condition = self.condition();
                let mut body = self.inner(depth);
                body.push(self.end(&[]));
                vec![Form::If(vec![(condition, body)], None).into()]
            }
            Shape::JumpAhead => {
                let label = self.label();
                let condition = self.condition();
                let over = self.inner(depth);
                between(Form::JumpIf(condition, label), over, Form::Label(label))
            }
            Shape::JumpBack => self.jump_back(depth),
            Shape::JumpAnywhere => self.jump_anywhere(depth),
            Shape::Skipped => self.skipped(),
            Shape::SkippedIf => {
                let condition = self.condition();
                let marks = self.choices.one_of(&[Both, First, Last]);
                let held = Form::If(vec![(condition, vec![self.comp()])], None);
                vec![Statement::from(held).marked(marks)]
            }
            Shape::Call => self.call(depth),
            Shape::CallGiven => self.call_given(depth),
            Shape::CallAgain => self.call_again(),
            Shape::Recursion => self.recursion(depth),
            Shape::ModalCycle => self.modal_cycle(depth),
            Shape::Assign => vec![self.assign()],
            Shape::Write => {
                let variable = self.machine(3);
                let value = Operand::Number(self.choices.below(3));
                vec![Form::Assign(variable, value).into()]
            }
            Shape::PlcActs => vec![Statement::text(self.choices.one_of(&PLC_ACTS))],
            Shape::WaitFor => vec![Form::WaitFor(self.condition()).into()],
            Shape::WaitLoop => {
                let value = Operand::Number(self.choices.below(3));
                let condition = Condition::Compare(self.machine(3), "!=", value);
                vec![Form::While(condition, Vec::new()).into()]
            }
            // A counter of its own for each level.
            Shape::Times => {
                let end = Operand::Number(self.choices.between([1, 3]));
                let counter = Variable::Parameter(10 + depth);
                vec![Form::For(counter, end, self.inner(depth)).into()]
            }
            Shape::For => vec![self.for_loop(Operand::Number(3), depth)],
            Shape::ForUnknown => {
                let end = self.machine(3).into();
                vec![self.for_loop(end, depth)]
            }
            Shape::WhileUnknown => self.while_loop(depth),
            Shape::RepeatUnknown => self.repeat_loop(depth),
            Shape::MacroOfCommand => self.macro_of_command(),
            Shape::MacroOfCondition => {
                let macro_text = format!("\"ASKED\" = \"{}\"", self.condition());
                let asked = Condition::Text("\"ASKED\"".to_owned());
                let held = Form::If(vec![(asked, self.inner(depth))], None);
                vec![Statement::text(macro_text), held.into()]
            }
            Shape::UnknownWord => self.unknown_word(),
            Shape::Coupling => self.coupling(depth),
            Shape::Unread => vec![Statement::text("FOO[1]"), self.comp()],
            Shape::HostileLine => vec![Statement::text(self.hostile_line())],
            Shape::HostileFlow => vec![self.hostile_flow(depth)],
            Shape::Declarations => vec![Statement::text(self.declarations())],
            Shape::Contour => vec![self.contour(depth)],
            Shape::Growth => self.growth(),
        }
    }

    /// Makes a command for one kind.
    fn comp(&mut self) -> Statement {
        let axis = self.choices.below(self.profile.axes.len());
        let is_on = self.choices.chance(50);
        let all = !is_on && self.choices.chance(25);
        let kinds = if all { &[] } else { &self.profile.kinds[..1] };
        let command = CompSwitch {
            axis,
            is_on,
            kinds: kinds.to_vec(),
        };
        Form::Block(CompBlock {
            commands: vec![command],
            ..CompBlock::default()
        })
        .into()
    }

    fn block(&mut self) -> Statement {
        let mut block = CompBlock::default();
        for _ in 0..self.choices.one_of(&[0, 1, 1, 2]) {
            let command = self.command_of_kinds();
            block.commands.push(command);
        }
        if block.commands.is_empty() || self.choices.chance(20) {
            block.moves = self.axes(33);
        }
        if self.choices.chance(16) {
            block.allows = Some(self.choices.one_of(&ALLOWED));
        }
        Form::Block(block).into()
    }

    fn command_of_kinds(&mut self) -> CompSwitch {
        let axis = self.choices.below(self.profile.axes.len());
        let is_on = self.choices.chance(50);
        let kinds = self.profile.kinds.iter().copied();
        let mut kinds: Vec<&str> = kinds.filter(|_| self.choices.chance(33)).collect();
        if kinds.is_empty() && (is_on || self.choices.chance(50)) {
            kinds.push(self.profile.kinds[0]);
        }
        CompSwitch { axis, is_on, kinds }
    }

    /// Chooses axes, each with a percentage.
    fn axes(&mut self, percent: usize) -> Vec<usize> {
        let axes = 0..self.profile.axes.len();
        axes.filter(|_| self.choices.chance(percent)).collect()
    }

    fn motion(&mut self) -> Statement {
        let mut moves = self.axes(45);
        if moves.is_empty() {
            moves.push(self.choices.below(self.profile.axes.len()));
        }
        let pace = if self.choices.chance(40) {
            Pace::Rapid
        } else {
            Pace::Feed
        };
        Form::Block(CompBlock {
            moves,
            pace,
            ..CompBlock::default()
        })
        .into()
    }

    fn assign(&mut self) -> Statement {
        let parameter = self.parameter();
        let value = match self.choices.below(3) {
            0 => Operand::Number(self.choices.below(3)),
            1 => Operand::Of(self.parameter(), 1),
            _ if self.is_full() => Operand::Number(1),
            _ => self.machine(3).into(),
        };
        Form::Assign(parameter, value).into()
    }

    /// Makes a block at which the control stops, or may, where not only conditions ask.
    fn error(&mut self) -> Statement {
        let asks = self.profile.reuse > 0 && !self.is_full();
        if asks && self.choices.chance(15) {
            return Statement::text(format!("#ERROR [ID=5 RC={}]", self.machine(3)));
        }
        Statement::text(self.choices.weighted(&ERRORS))
    }

    /// Makes a block that ends the program, or one of some others.
    fn end(&mut self, others: &[&str]) -> Statement {
        match self.choices.below(others.len() + 2) {
            0 => Statement::text("M30"),
            1 => self.error(),
            other => Statement::text(others[other - 2]),
        }
    }
}

/// Puts statements between two others.
fn between(first: Form, mut body: Vec<Statement>, last: Form) -> Vec<Statement> {
    body.insert(0, first.into());
    body.push(last.into());
    body
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_profile_makes_a_program_of_no_choices_and_the_same_one_of_the_same_choices() {
        for profile in [
            Profile::ASKED_ONCE,
            Profile::ASKED_AGAIN,
            Profile::SHARED,
            Profile::EXECUTED,
            Profile::ARCHIVED,
            Profile::HOSTILE,
            Profile::GROWING,
        ] {
            let written = |mut choices: Choices<'_>| {
                NcProgram::choose(&profile, &mut choices).write(Style::default())
            };
            assert!(!written(Choices::of_bytes(&[])).is_empty());
            let [one, other] = [7, 7].map(|seed| written(Choices::of_seed(seed)));
            assert_eq!(one, other);
        }
    }

    #[test]
    fn lines_of_statements_are_those_of_the_text() {
        let mut choices = Choices::of_seed(3);
        for _ in 0..100 {
            let style = Style::choose(&mut choices);
            let mut program = NcProgram::choose(&Profile::ARCHIVED, &mut choices);
            let text = program.write(style);
            for statement in &program.body {
                let at = usize::try_from(statement.line).expect("a line") - 1;
                let line = text.lines().nth(at).expect("a line");
                let is_it = match &statement.form {
                    Form::Block(block) if block.moves.is_empty() => line.contains("[COMP "),
                    Form::Block(_) => line.contains("G0"),
                    Form::If(..) => line.contains("$IF"),
                    Form::For(..) => line.contains("$FOR"),
                    Form::Call(..) => line.contains("LL "),
                    _ => line.starts_with(';'),
                };
                assert!(is_it, "{line}\n{text}");
            }
        }
    }
}
