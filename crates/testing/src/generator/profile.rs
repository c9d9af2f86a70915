//! Profiles: what the programs of a test consist of.

/// Composition of generated programs: the frequency of each construct, and the depth.
#[derive(Debug, Clone, Copy)]
pub struct Profile {
    /// The names of the axes.
    pub axes: &'static [&'static str],
    /// The kinds that commands name.
    pub kinds: &'static [&'static str],
    /// Statements that may hold others, each with its weight.
    pub statements: &'static [(Shape, usize)],
    /// Statements where none may hold others.
    pub leaves: &'static [(Shape, usize)],
    /// Conditions.
    pub conditions: &'static [(Ask, usize)],
    /// The percentage of branches with `$ELSEIF`, and of those with `$ELSE`.
    pub branches: [usize; 2],
    /// Numbers of statements of the main program, at least and at most.
    pub program: [usize; 2],
    /// Numbers of statements that a statement holds.
    pub body: [usize; 2],
    /// Levels of statements in others.
    pub depth: [usize; 2],
    /// Numbers of subprograms that may be called anywhere, `A` and `B`.
    pub subprograms: [usize; 2],
    /// Machine variables of three values that are there from the beginning.
    pub shared: usize,
    /// Number of machine variables after which no statement holds others.
    pub variables: usize,
    /// The percentage of machine variables that were asked before.
    pub reuse: usize,
    /// Lines that begin the main program.
    pub heads: &'static [&'static str],
    /// The blocks after them.
    pub prelude: &'static [&'static str],
    /// Blocks that end it.
    pub ends: &'static [&'static str],
}

/// The shape of a statement, or of some that belong together.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Shape {
    /// A COMP command.
    Comp,
    /// A block of commands, motions and a comment that allows a message.
    Block,
    /// A motion.
    Move,
    /// A remark.
    Remark,
    /// `$IF`.
    If,
    /// `$SWITCH`.
    Switch,
    /// `$SWITCH` with one case.
    Case,
    /// `$IF` in which the program ends.
    End,
    /// A jump over blocks.
    JumpAhead,
    /// A jump back over blocks, as often as the machine says.
    JumpBack,
    /// A jump to one of several labels, one of which may be missing.
    JumpAnywhere,
    /// Blocks with a skip mark.
    Skipped,
    /// A control block with a skip mark on its first line, on its last one, or on both.
    SkippedIf,
    /// A call of a subprogram of its own.
    Call,
    /// Calls of a subprogram that asks its parameter.
    CallGiven,
    /// A call of a subprogram that is called anywhere.
    CallAgain,
    /// A subprogram that calls itself as often as the machine says.
    Recursion,
    /// A cycle after each motion.
    ModalCycle,
    /// Assignment to a parameter.
    Assign,
    /// Assignment to a machine variable.
    Write,
    /// A block in which the PLC acts by design.
    PlcActs,
    /// A wait for a value.
    WaitFor,
    /// A loop that waits for a value.
    WaitLoop,
    /// `$FOR` with a known end, which counts for itself.
    Times,
    /// `$FOR` with a known end, which counts a parameter that others ask.
    For,
    /// `$FOR` to an end that the machine knows.
    ForUnknown,
    /// `$WHILE` to such an end.
    WhileUnknown,
    /// `$REPEAT` to such an end.
    RepeatUnknown,
    /// A macro for a command.
    MacroOfCommand,
    /// A macro for a condition.
    MacroOfCondition,
    /// An M, T or G word of a number that the machine knows.
    UnknownWord,
    /// A coupling of axes.
    Coupling,
    /// A word that no document knows.
    Unread,
    /// A hostile line.
    HostileLine,
    /// A hostile control block.
    HostileFlow,
    /// Hostile declarations.
    Declarations,
    /// A description of a contour.
    Contour,
    /// Macros that use each other, and texts that grow.
    Growth,
}

/// The form of a condition.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Ask {
    /// Comparison of a number with 1.
    Fixed,
    /// Comparison of a machine variable with one of its values.
    AnyValue,
    /// Comparison of a machine variable with 1.
    One,
    /// Test that a machine variable is not 0.
    NotZero,
    /// Negation of a comparison of a machine variable with 1.
    NotOne,
    /// Comparison of two machine variables with 1.
    Both,
    /// Comparison of a parameter with a value.
    Parameter,
    /// Test that a parameter is greater than a value.
    Above,
    /// Test that the compensation of an axis is on.
    Active,
}

impl Profile {
    /// Programs for a machine with X, Y and Z: their conditions are plain and asked once.
    pub const ASKED_ONCE: Self = Self {
        axes: &["X", "Y", "Z"],
        kinds: &["FRICT"],
        statements: &[
            (Shape::Comp, 2),
            (Shape::If, 3),
            (Shape::Switch, 1),
            (Shape::End, 1),
            (Shape::JumpAhead, 1),
            (Shape::Skipped, 1),
            (Shape::Call, 1),
        ],
        leaves: &[(Shape::Comp, 1)],
        conditions: &[(Ask::NotOne, 1), (Ask::NotZero, 1), (Ask::One, 2)],
        branches: [33, 50],
        program: [2, 7],
        body: [1, 3],
        depth: [2, 3],
        subprograms: [0, 0],
        shared: 0,
        variables: 4,
        reuse: 0,
        heads: &["%MAIN"],
        prelude: &[],
        ends: &["M30"],
    };

    /// Programs for the same machine, which has programs of M6, T, G80 and G81, and `cycle.nc`: anything.
    pub const ASKED_AGAIN: Self = Self {
        statements: &[
            (Shape::Comp, 5),
            (Shape::If, 13),
            (Shape::Switch, 4),
            (Shape::End, 9),
            (Shape::JumpAhead, 5),
            (Shape::JumpBack, 5),
            (Shape::JumpAnywhere, 4),
            (Shape::Skipped, 6),
            (Shape::SkippedIf, 8),
            (Shape::Call, 5),
            (Shape::CallGiven, 5),
            (Shape::Recursion, 5),
            (Shape::ModalCycle, 5),
            (Shape::Assign, 2),
            (Shape::For, 5),
            (Shape::ForUnknown, 5),
            (Shape::WhileUnknown, 5),
            (Shape::RepeatUnknown, 5),
            (Shape::MacroOfCommand, 4),
            (Shape::MacroOfCondition, 5),
            (Shape::UnknownWord, 8),
            (Shape::Coupling, 3),
            (Shape::Unread, 2),
            (Shape::Write, 2),
            (Shape::PlcActs, 2),
        ],
        leaves: &[(Shape::Comp, 2), (Shape::Assign, 1)],
        conditions: &[
            (Ask::NotOne, 1),
            (Ask::NotZero, 1),
            (Ask::One, 2),
            (Ask::Both, 1),
            (Ask::Parameter, 1),
            (Ask::Above, 1),
            (Ask::Active, 1),
        ],
        branches: [36, 52],
        program: [3, 8],
        variables: 3,
        reuse: 42,
        prelude: &["P1 = 0", "P2 = 0", "P3 = 0"],
        ..Self::ASKED_ONCE
    };

    /// Programs that share two variables with the PLC.
    pub const SHARED: Self = Self {
        statements: &[
            (Shape::Write, 2),
            (Shape::PlcActs, 1),
            (Shape::Comp, 2),
            (Shape::WaitLoop, 1),
            (Shape::WaitFor, 1),
            (Shape::Case, 1),
            (Shape::If, 1),
        ],
        leaves: &[(Shape::Write, 2), (Shape::PlcActs, 1), (Shape::Comp, 2)],
        conditions: &[(Ask::AnyValue, 1)],
        branches: [0, 100],
        program: [1, 4],
        body: [1, 4],
        depth: [3, 3],
        shared: 2,
        variables: 3,
        reuse: 100,
        ..Self::ASKED_ONCE
    };

    /// Programs whose states and messages follow from the blocks that they execute.
    pub const EXECUTED: Self = Self {
        axes: &["X", "Y", "Z", "B"],
        kinds: &["FRICT", "LEAD", "CROSS"],
        statements: &[(Shape::Block, 5), (Shape::CallAgain, 1), (Shape::Times, 2)],
        leaves: &[(Shape::Block, 1)],
        program: [1, 6],
        body: [1, 4],
        depth: [1, 1],
        subprograms: [0, 1],
        heads: &["%PROGRAM"],
        ..Self::ASKED_ONCE
    };

    /// Programs of an archive, whose effect follows from their tree.
    pub const ARCHIVED: Self = Self {
        axes: &["X", "Y", "C"],
        statements: &[
            (Shape::Comp, 3),
            (Shape::Move, 4),
            (Shape::Remark, 1),
            (Shape::If, 2),
            (Shape::CallAgain, 1),
            (Shape::Times, 1),
        ],
        leaves: &[(Shape::Comp, 3), (Shape::Move, 4), (Shape::Remark, 1)],
        conditions: &[(Ask::Fixed, 1)],
        branches: [15, 25],
        program: [1, 5],
        body: [1, 5],
        depth: [2, 2],
        subprograms: [0, 2],
        heads: &["%PROGRAM"],
        ends: &["", "M02", "M30", "M30"],
        ..Self::ASKED_ONCE
    };

    /// Hostile programs: blocks that are nested or cut off, macros that use each other, calls in circles, missing
    /// labels, blocks that continue on the next line, unknown values, numbers and texts that are too large.
    pub const HOSTILE: Self = Self {
        statements: &[
            (Shape::HostileLine, 9),
            (Shape::HostileFlow, 5),
            (Shape::Declarations, 1),
            (Shape::Contour, 1),
        ],
        leaves: &[(Shape::HostileLine, 1)],
        program: [1, 12],
        depth: [4, 4],
        variables: 1,
        heads: &[
            "",
            "",
            "%MAIN",
            "\u{feff}",
            "%L A\nN1 X1\nM17\n%MAIN",
            "#VAR\nV.L.A=1\n#ENDVAR",
        ],
        ends: &[
            "",
            "",
            "M30",
            "M30",
            "M30",
            "M30",
            "M30\n%L A\nX1\nM17",
            "%L A\nP1=P1\nLL A",
        ],
        ..Self::ASKED_ONCE
    };

    /// Macros that use each other, and texts that grow.
    pub const GROWING: Self = Self {
        statements: &[(Shape::Growth, 1)],
        program: [1, 1],
        depth: [1, 1],
        variables: 1,
        heads: &[""],
        ends: &[""],
        ..Self::ASKED_ONCE
    };

    /// Returns whether programs call files that are not their own.
    pub fn calls_files(&self) -> bool {
        let mut leaves = self.leaves.iter();
        leaves.any(|(shape, _)| *shape == Shape::HostileLine)
    }
}
