//! The tree of a program, from which a test derives what it expects.

/// An NC program as a tree.
#[derive(Debug, Clone, Default)]
pub struct NcProgram {
    /// The names of its axes.
    pub axes: &'static [&'static str],
    /// Local subprograms.
    pub subprograms: Vec<Subprogram>,
    /// The line that begins the main program, `%MAIN`, or nothing.
    pub head: &'static str,
    /// The main program.
    pub body: Vec<Statement>,
    /// The block that ends it, `M30`, or nothing.
    pub end: &'static str,
    /// The number of values, from 0, of each machine variable, `V.E.C0` and so on.
    pub values: Vec<usize>,
}

/// A local subprogram.
#[derive(Debug, Clone)]
pub struct Subprogram {
    /// Name.
    pub name: String,
    /// Statements before M17.
    pub body: Vec<Statement>,
}

/// A statement of a program.
#[derive(Debug, Clone)]
pub struct Statement {
    /// The line on which it begins, once it is written.
    pub line: u32,
    /// Lines that have a skip mark.
    pub marks: SkipMarks,
    /// Form of the statement.
    pub form: Form,
}

/// The lines of a statement that have a skip mark.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SkipMarks {
    /// No line.
    None,
    /// The first one.
    First,
    /// The last one of a structure.
    Last,
    /// The first and the last one.
    Both,
}

/// Form of a statement.
#[derive(Debug, Clone)]
pub enum Form {
    /// COMP commands and motions.
    Block(CompBlock),
    /// Assignment to a variable.
    Assign(Variable, Operand),
    /// `$IF`, with `$ELSEIF` for each further branch, and `$ELSE`.
    If(Vec<(Condition, Vec<Statement>)>, Option<Vec<Statement>>),
    /// `$SWITCH`, with the case of each number, and `$DEFAULT`.
    Switch(Operand, Vec<SwitchCase>, Option<Vec<Statement>>),
    /// `$FOR` from 1 by 1.
    For(Variable, Operand, Vec<Statement>),
    /// `$WHILE`.
    While(Condition, Vec<Statement>),
    /// `$REPEAT`.
    Repeat(Vec<Statement>, Condition),
    /// `$IF … $GOTO` to a label.
    JumpIf(Condition, usize),
    /// `$GOTO` to a label whose number is the sum of a number and a value.
    Goto(usize, Operand),
    /// A label.
    Label(usize),
    /// A call of a local subprogram, with `@P1` or without.
    Call(String, Option<Operand>),
    /// `#WAIT FOR`.
    WaitFor(Condition),
    /// Lines around others, as text: a structure that may lack its end.
    Around(String, Vec<Statement>, String),
    /// Anything else, as text.
    Text(String),
}

impl From<Form> for Statement {
    fn from(form: Form) -> Self {
        let (line, marks) = (0, SkipMarks::None);
        Self { line, marks, form }
    }
}

impl Statement {
    /// Makes a statement of a text.
    pub fn text(text: impl Into<String>) -> Self {
        Form::Text(text.into()).into()
    }

    /// Marks lines of it to be skipped.
    pub fn marked(mut self, marks: SkipMarks) -> Self {
        self.marks = marks;
        self
    }
}

/// A block of commands and motions.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct CompBlock {
    /// Commands.
    pub commands: Vec<CompSwitch>,
    /// The axes that it moves, by their positions.
    pub moves: Vec<usize>,
    /// Pace of the motions.
    pub pace: Pace,
    /// The code of a message that a comment allows.
    pub allows: Option<&'static str>,
}

/// A COMP command.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct CompSwitch {
    /// The axis, by its position.
    pub axis: usize,
    /// Whether the command switches on.
    pub is_on: bool,
    /// The kinds that it names; none stands for `OFF_ALL`.
    pub kinds: Vec<&'static str>,
}

/// The pace of a motion.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum Pace {
    /// Pace of the blocks before.
    #[default]
    Modal,
    /// `G00`.
    Rapid,
    /// `G01`.
    Feed,
}

/// A case of a switch.
#[derive(Debug, Clone)]
pub struct SwitchCase {
    /// The number that selects it.
    pub number: usize,
    /// Statements.
    pub body: Vec<Statement>,
    /// Whether `$BREAK` ends the case.
    pub has_break: bool,
}

/// A variable.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Variable {
    /// A variable of the machine.
    Machine(usize),
    /// A parameter, `P1`.
    Parameter(usize),
    /// The parameter `@P1` of a subprogram.
    Given,
    /// `V.A.FRICT_COMP_ACTIVE` of an axis.
    Active(&'static str),
}

/// A value in a program.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Operand {
    /// A number.
    Number(usize),
    /// A variable, and a number that is added.
    Of(Variable, usize),
}

impl From<Variable> for Operand {
    fn from(variable: Variable) -> Self {
        Self::Of(variable, 0)
    }
}

/// A condition.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Condition {
    /// A condition that is always true, or never.
    Fixed(bool),
    /// A variable compared with a value.
    Compare(Variable, &'static str, Operand),
    /// The opposite of another one.
    Not(Box<Condition>),
    /// The conjunction of two conditions.
    Both(Box<[Condition; 2]>),
    /// Any text.
    Text(String),
}

impl Condition {
    /// Compares a variable with a number.
    pub fn is(variable: Variable, number: usize) -> Self {
        Self::Compare(variable, "==", Operand::Number(number))
    }
}
