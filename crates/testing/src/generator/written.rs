//! Programs as text.

use std::fmt::{self, Display, Formatter, Write as _};

use super::Choices;
use super::tree::{
    CompBlock, CompSwitch, Condition, Form, NcProgram, Operand, Pace, SkipMarks, Statement,
    Subprogram, Variable,
};

/// The way in which a program is written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Style {
    /// The number of the first block, and the step to the next ones.
    pub numbers: Option<(usize, usize)>,
    /// The digits of a block number, with zeros before it.
    pub digits: usize,
    /// The end of a line.
    pub line_end: &'static str,
    /// The end of the text after the last line.
    pub text_end: TextEnd,
    /// The place of local subprograms.
    pub subprograms: SubprogramPlace,
}

/// The place of local subprograms.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SubprogramPlace {
    /// Subprograms before the main program.
    First,
    /// Subprograms after the main program.
    Last,
}

/// The end of a text after its last line.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TextEnd {
    /// The end of the line.
    Line,
    /// No line end after the last line.
    Cut,
    /// An empty line.
    Blank,
}

impl Default for Style {
    fn default() -> Self {
        Self {
            numbers: None,
            digits: 0,
            line_end: "\n",
            text_end: TextEnd::Line,
            subprograms: SubprogramPlace::First,
        }
    }
}

impl Style {
    /// Chooses a style for hostile programs.
    pub fn hostile(choices: &mut Choices<'_>) -> Self {
        Self {
            line_end: choices.one_of(&["\n", "\n", "\n", "\r\n", "\r"]),
            subprograms: SubprogramPlace::Last,
            ..Self::default()
        }
    }

    /// Chooses a style that leaves the meaning of a program as it is.
    pub fn choose(choices: &mut Choices<'_>) -> Self {
        let numbers = choices.chance(70);
        Self {
            numbers: numbers.then(|| (choices.between([1, 20]), choices.between([1, 10]))),
            digits: if choices.chance(30) { 5 } else { 0 },
            line_end: if choices.chance(40) { "\r\n" } else { "\n" },
            text_end: choices.weighted(&[
                (TextEnd::Line, 2),
                (TextEnd::Cut, 1),
                (TextEnd::Blank, 1),
            ]),
            subprograms: SubprogramPlace::First,
        }
    }
}

/// The character before the first line of some texts.
const BYTE_ORDER_MARK: &str = "\u{feff}";

impl NcProgram {
    /// Writes the program, and its lines into the tree.
    pub fn write(&mut self, style: Style) -> String {
        let mut pen = Pen {
            axes: self.axes,
            style,
            number: style.numbers.map_or(0, |(first, _)| first),
            text: String::new(),
            line: 1,
        };
        if style.subprograms == SubprogramPlace::First {
            pen.subprograms(&mut self.subprograms);
        }
        match self.head {
            BYTE_ORDER_MARK => pen.text.push_str(self.head),
            head => pen.lines(head),
        }
        pen.body(&mut self.body);
        pen.lines(self.end);
        if style.subprograms == SubprogramPlace::Last {
            pen.subprograms(&mut self.subprograms);
        }
        match style.text_end {
            TextEnd::Line => {}
            TextEnd::Cut => pen.text.truncate(pen.text.len() - style.line_end.len()),
            TextEnd::Blank => pen.text.push_str(style.line_end),
        }
        pen.text
    }
}

struct Pen {
    axes: &'static [&'static str],
    style: Style,
    number: usize,
    text: String,
    line: u32,
}

impl Pen {
    fn subprograms(&mut self, subprograms: &mut [Subprogram]) {
        for subprogram in subprograms {
            self.line(format_args!("%L {}", subprogram.name));
            self.body(&mut subprogram.body);
            self.line("M17");
        }
    }

    /// Writes the lines of a text, which may have none.
    fn lines(&mut self, text: &str) {
        text.lines().for_each(|line| self.line(line));
    }

    fn line(&mut self, text: impl Display) {
        self.marked("", text);
    }

    fn marked(&mut self, mark: &str, text: impl Display) {
        let text = text.to_string();
        self.text.push_str(mark);
        // Names of programs, remarks and labels have no block number.
        let is_block = !text.starts_with(['%', ';', 'N']) && !text.is_empty();
        if let Some((_, step)) = self.style.numbers
            && is_block
        {
            let (number, digits) = (self.number, self.style.digits);
            let _ = write!(self.text, "N{number:0digits$} ");
            self.number += step;
        }
        let lines = text.matches('\n').count() + 1;
        self.line += u32::try_from(lines).expect("a short text");
        self.text.push_str(&text);
        self.text.push_str(self.style.line_end);
    }

    fn body(&mut self, body: &mut [Statement]) {
        for statement in body {
            self.statement(statement);
        }
    }

    fn statement(&mut self, statement: &mut Statement) {
        statement.line = self.line;
        let is_marked = |of: [SkipMarks; 2]| of.contains(&statement.marks);
        let first = is_marked([SkipMarks::First, SkipMarks::Both]);
        let last = is_marked([SkipMarks::Last, SkipMarks::Both]);
        let [first, last] = [first, last].map(|is_marked| if is_marked { "/" } else { "" });
        match &mut statement.form {
            Form::Block(block) => {
                let text = block.written(self.axes, self.line);
                self.marked(first, text);
            }
            Form::Assign(variable, value) => {
                self.marked(first, format_args!("{variable} = {value}"));
            }
            Form::If(branches, otherwise) => {
                for (at, (condition, body)) in branches.iter_mut().enumerate() {
                    let [mark, word] = [[first, "$IF"], ["", "$ELSEIF"]][usize::from(at > 0)];
                    self.marked(mark, format_args!("{word} {condition}"));
                    self.body(body);
                }
                if let Some(body) = otherwise {
                    self.line("$ELSE");
                    self.body(body);
                }
                self.marked(last, "$ENDIF");
            }
            Form::Switch(subject, cases, otherwise) => {
                self.marked(first, format_args!("$SWITCH {subject}"));
                for case in cases {
                    self.line(format_args!("$CASE {}", case.number));
                    self.body(&mut case.body);
                    if case.has_break {
                        self.line("$BREAK");
                    }
                }
                if let Some(body) = otherwise {
                    self.line("$DEFAULT");
                    self.body(body);
                }
                self.marked(last, "$ENDSWITCH");
            }
            Form::For(counter, end, body) => {
                let open = format!("$FOR {counter} = 1, {end}, 1");
                self.around([first, last], body, [&open, "$ENDFOR"]);
            }
            Form::While(condition, body) => {
                let open = format!("$WHILE {condition}");
                self.around([first, last], body, [&open, "$ENDWHILE"]);
            }
            Form::Repeat(body, until) => {
                let close = format!("$UNTIL {until}");
                self.around([first, last], body, ["$REPEAT", &close]);
            }
            Form::JumpIf(condition, label) => {
                self.marked(first, format_args!("$IF {condition} $GOTO N{label}"));
            }
            Form::Goto(label, value) => {
                self.marked(first, format_args!("$GOTO N[{label} + {value}]"));
            }
            Form::Label(label) => self.marked(first, format_args!("N{label}:")),
            Form::Call(name, None) => self.marked(first, format_args!("LL {name}")),
            Form::Call(name, Some(value)) => {
                self.marked(first, format_args!("LL CYCLE [NAME={name} @P1={value}]"));
            }
            Form::WaitFor(condition) => self.marked(first, format_args!("#WAIT FOR {condition}")),
            Form::Around(open, body, close) => self.around([first, last], body, [open, close]),
            Form::Text(text) => self.marked(first, text),
        }
    }

    fn around(&mut self, [first, last]: [&str; 2], body: &mut [Statement], lines: [&str; 2]) {
        self.marked(first, lines[0]);
        self.body(body);
        self.marked(last, lines[1]);
    }
}

impl CompBlock {
    fn written(&self, axes: &[&str], line: u32) -> String {
        let mut words: Vec<String> = self.commands.iter().map(|it| it.written(axes)).collect();
        match self.pace {
            Pace::Modal => {}
            Pace::Rapid => words.push("G00".to_owned()),
            Pace::Feed => words.push("G01 F500".to_owned()),
        }
        let place = match self.pace {
            Pace::Modal => 1,
            Pace::Rapid | Pace::Feed => line % 7,
        };
        let moves = self.moves.iter();
        words.extend(moves.map(|axis| format!("{}{place}", axes[*axis])));
        if words.is_empty() {
            words.push("G90".to_owned());
        }
        words.extend(self.allows.map(|code| format!("; frictcomp: allow {code}")));
        words.join(" ")
    }
}

impl CompSwitch {
    fn written(&self, axes: &[&str]) -> String {
        let name = axes[self.axis];
        if self.kinds.is_empty() {
            return format!("{name}[COMP OFF_ALL]");
        }
        let word = if self.is_on { "ON" } else { "OFF" };
        format!("{name}[COMP {word} {}]", self.kinds.join(" "))
    }
}

impl Display for Variable {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        match self {
            Self::Machine(number) => write!(f, "V.E.C{number}"),
            Self::Parameter(number) => write!(f, "P{number}"),
            Self::Given => f.write_str("@P1"),
            Self::Active(axis) => write!(f, "V.A.FRICT_COMP_ACTIVE.{axis}"),
        }
    }
}

impl Display for Operand {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        match self {
            Self::Number(number) => write!(f, "{number}"),
            Self::Of(variable, 0) => write!(f, "{variable}"),
            Self::Of(variable, added) => write!(f, "{variable} + {added}"),
        }
    }
}

impl Display for Condition {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        match self {
            Self::Fixed(holds) => write!(f, "{} == 1", u8::from(*holds)),
            Self::Compare(variable, relation, value) => write!(f, "{variable} {relation} {value}"),
            Self::Not(condition) => write!(f, "NOT [{condition}]"),
            Self::Both(both) => write!(f, "{} && {}", both[0], both[1]),
            Self::Text(text) => f.write_str(text),
        }
    }
}
