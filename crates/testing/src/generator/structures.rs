//! Statements that hold others.

use super::SkipMarks::First;
use super::{Condition, Form, Generator, Operand, Statement, Subprogram, SwitchCase, Variable};

impl Generator<'_, '_> {
    pub(super) fn branch(&mut self, depth: usize) -> Statement {
        let [elseif, otherwise] = self.profile.branches;
        let mut branches = vec![(self.condition(), self.inner(depth))];
        if self.choices.chance(elseif) && !self.is_full() {
            branches.push((self.condition(), self.inner(depth)));
        }
        let otherwise = self.choices.chance(otherwise).then(|| self.inner(depth));
        Form::If(branches, otherwise).into()
    }

    pub(super) fn switch(&mut self, depth: usize) -> Statement {
        let subject = self.machine(3).into();
        let count = self.choices.between([1, 2]);
        let mut case = |number| SwitchCase {
            number,
            body: self.inner(depth),
            has_break: self.choices.chance(75),
        };
        let cases = (0..count).map(&mut case).collect();
        let otherwise = self.choices.chance(50).then(|| self.inner(depth));
        Form::Switch(subject, cases, otherwise).into()
    }

    pub(super) fn label(&mut self) -> usize {
        self.labels += 10;
        self.labels
    }

    pub(super) fn jump_back(&mut self, depth: usize) -> Vec<Statement> {
        let label = self.label();
        let end = self.machine(3).into();
        let count = Variable::Parameter(7);
        let mut made = vec![Form::Assign(count, Operand::Number(0)).into()];
        made.push(Form::Label(label).into());
        made.push(Form::Assign(count, Operand::Of(count, 1)).into());
        made.extend(self.inner(depth));
        made.push(Form::JumpIf(Condition::Compare(count, "<", end), label).into());
        made
    }

    /// Makes a jump whose target only the machine knows.
    pub(super) fn jump_anywhere(&mut self, depth: usize) -> Vec<Statement> {
        let label = self.label();
        let labels = self.choices.between([2, 3]);
        let mut made = vec![Form::Goto(label, self.machine(labels).into()).into()];
        for at in 0..2 {
            made.extend(self.inner(depth));
            made.push(Form::Label(label + at).into());
        }
        made
    }

    pub(super) fn skipped(&mut self) -> Vec<Statement> {
        let mut made = Vec::new();
        for _ in 0..self.choices.between([1, 2]) {
            made.push(self.comp());
        }
        if self.choices.chance(25) {
            made.push(self.error());
        }
        made.into_iter().map(|it| it.marked(First)).collect()
    }

    /// Writes a subprogram; returns its name.
    fn subprogram(&mut self, make: impl FnOnce(&mut Self, &str) -> Vec<Statement>) -> String {
        let at = self.subprograms.len();
        let name = format!("SUB{at}");
        let placeholder = Subprogram {
            name: name.clone(),
            body: Vec::new(),
        };
        self.subprograms.push(placeholder);
        self.subprograms[at].body = make(self, &name);
        name
    }

    /// Makes a subprogram, called once.
    pub(super) fn call(&mut self, depth: usize) -> Vec<Statement> {
        let name = self.subprogram(|it, _| {
            let mut body = it.inner(depth);
            if !it.is_full() && it.choices.chance(33) {
                body.extend(it.leave(&["M17"]));
            }
            body
        });
        vec![Form::Call(name, None).into()]
    }

    /// Makes a subprogram that asks its parameter, called with one or two values.
    pub(super) fn call_given(&mut self, depth: usize) -> Vec<Statement> {
        let name = self.subprogram(|it, _| {
            let asked = Condition::is(Variable::Given, it.choices.below(2));
            let branch = Form::If(vec![(asked, it.inner(depth))], None);
            vec![branch.into(), it.comp()]
        });
        let mut made = vec![Form::Call(name.clone(), Some(self.machine(2).into())).into()];
        if self.choices.chance(50) {
            made.push(Form::Call(name, Some(Variable::Parameter(1).into())).into());
        }
        made
    }

    pub(super) fn call_again(&mut self) -> Vec<Statement> {
        if self.again == 0 {
            return Vec::new();
        }
        let at = self.choices.below(self.again);
        vec![Form::Call(self.subprograms[at].name.clone(), None).into()]
    }

    pub(super) fn recursion(&mut self, depth: usize) -> Vec<Statement> {
        let times = Variable::Parameter(6);
        let name = self.subprogram(|it, name| {
            let call = Form::Call(name.to_owned(), None).into();
            let more = Condition::Compare(times, ">", Operand::Number(0));
            let mut body = vec![
                Statement::text(format!("{times} = {times} - 1")),
                Form::If(vec![(more, vec![call])], None).into(),
            ];
            body.extend(it.inner(depth));
            body
        });
        let count = self.machine(3).into();
        vec![
            Form::Assign(times, count).into(),
            Form::Call(name, None).into(),
        ]
    }

    /// Makes a cycle after each motion, from some way on.
    pub(super) fn modal_cycle(&mut self, depth: usize) -> Vec<Statement> {
        let condition = self.condition();
        let given = self.choices.below(2);
        let cycle = format!("L CYCLE [NAME=cycle.nc MODAL_MOVE @P1={given}]");
        let mut made = vec![
            Statement::text("P4 = 0"),
            Form::If(vec![(condition, vec![Statement::text(cycle)])], None).into(),
            Statement::text("X1"),
        ];
        made.extend(self.inner(depth));
        made.push(Statement::text("X2"));
        made.push(Statement::text("#DISABLE MODAL CYCLE"));
        made.push(self.comp());
        made
    }

    pub(super) fn for_loop(&mut self, end: Operand, depth: usize) -> Statement {
        let counter = self.parameter();
        Form::For(counter, end, self.loop_body(depth)).into()
    }

    pub(super) fn while_loop(&mut self, depth: usize) -> Vec<Statement> {
        let end = self.machine(3).into();
        let count = Variable::Parameter(9);
        let mut body = vec![Form::Assign(count, Operand::Of(count, 1)).into()];
        body.extend(self.loop_body(depth));
        vec![
            Form::Assign(count, Operand::Number(0)).into(),
            Form::While(Condition::Compare(count, "<", end), body).into(),
        ]
    }

    pub(super) fn repeat_loop(&mut self, depth: usize) -> Vec<Statement> {
        let end = self.machine(3).into();
        let count = Variable::Parameter(8);
        let mut body = vec![Form::Assign(count, Operand::Of(count, 1)).into()];
        body.extend(self.inner(depth));
        vec![
            Form::Assign(count, Operand::Number(0)).into(),
            Form::Repeat(body, Condition::Compare(count, ">=", end)).into(),
        ]
    }

    fn loop_body(&mut self, depth: usize) -> Vec<Statement> {
        let mut body = self.inner(depth);
        if !self.is_full() && self.choices.chance(33) {
            body.extend(self.leave(&["$BREAK", "$CONTINUE"]));
        }
        body
    }

    /// Makes a way out of what is executed, and a command for the others.
    fn leave(&mut self, others: &[&str]) -> [Statement; 2] {
        let condition = self.condition();
        let body = vec![self.comp(), self.end(others)];
        [Form::If(vec![(condition, body)], None).into(), self.comp()]
    }

    /// Makes a macro for a command, used on some way.
    pub(super) fn macro_of_command(&mut self) -> Vec<Statement> {
        let axis = self.choices.one_of(self.profile.axes);
        let used = || Statement::text("\"OFF\"");
        let condition = self.condition();
        let mut made = vec![
            Statement::text(format!("\"OFF\" = \"{axis}[COMP OFF FRICT]\"")),
            Form::If(vec![(condition, vec![used()])], None).into(),
        ];
        if self.choices.chance(50) {
            made.push(used());
        }
        made
    }

    pub(super) fn unknown_word(&mut self) -> Vec<Statement> {
        let (word, first) =
            self.choices
                .one_of(&[("M", 5), ("M", 5), ("M", 0), ("G", 80), ("T", 0)]);
        let number = Operand::Of(self.machine(2), first);
        let parameter = Variable::Parameter(5);
        vec![
            Form::Assign(parameter, number).into(),
            Statement::text(format!("{word}={parameter}")),
        ]
    }

    /// Makes a coupling that comes into force, and is released, on some ways.
    pub(super) fn coupling(&mut self, depth: usize) -> Vec<Statement> {
        let at = self.choices.below(3);
        let [axis, leader] = [at, at + 1].map(|at| self.profile.axes[at % 3]);
        let words = self.choices.one_of(&[
            [
                "#SET AX LINK",
                "#ENABLE AX LINK [1]",
                "#DISABLE AX LINK [1]",
            ],
            ["#AX LINK", "#AX LINK ON [1]", "#AX LINK OFF [1]"],
            [
                "#SET AX LINK",
                "#ENABLE AX LINK [1]",
                "#DISABLE AX LINK ALL",
            ],
        ]);
        let mut made = vec![Statement::text(format!(
            "{} [1, {axis}={leader}]",
            words[0]
        ))];
        made.push(self.perhaps(words[1]));
        made.extend(self.inner(depth));
        made.push(self.perhaps(words[2]));
        made
    }

    /// Makes a block that is executed on some ways, or on all.
    fn perhaps(&mut self, text: &str) -> Statement {
        let text = Statement::text(text);
        if self.is_full() || self.choices.chance(50) {
            return text;
        }
        Form::If(vec![(self.condition(), vec![text])], None).into()
    }
}
