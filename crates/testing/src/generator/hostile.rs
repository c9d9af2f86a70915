//! Hostile statements as text.

use std::fmt::Write as _;

use super::phrases::{CALLED, COMP, MACROS, OPERATORS, TARGETS, WORDS};
use super::phrases::{COMMANDS, COMMENTS, ENDS, FUNCTIONS, NAMES, NUMBERS, PARAMETERS, TEXTS};
use super::{Choices, Form, Generator, Statement};

/// The nesting depth of expressions.
const DEPTH: usize = 4;

impl Generator<'_, '_> {
    fn words(&mut self, words: &[&'static str]) -> &'static str {
        self.choices.one_of(words)
    }

    /// Makes definitions, and a loop that uses them.
    pub(super) fn growth(&mut self) -> Vec<Statement> {
        let mut made = Vec::new();
        for _ in 0..self.choices.between([1, 4]) {
            made.push(Statement::text(definition(self.choices)));
        }
        made.push(Statement::text("P1=\"ab\""));
        let [open, close] = self.choices.one_of(&[
            ["$WHILE 1", "$ENDWHILE"],
            ["$FOR P2=1,50,1", "$ENDFOR"],
            ["$IF V.E.X", "$ENDIF"],
            ["$REPEAT", "$UNTIL 0"],
        ]);
        let mut body = Vec::new();
        for _ in 0..self.choices.between([1, 5]) {
            let text = match self.choices.below(5) {
                0 => "P1=P1+P1".to_owned(),
                1 => format!("P3={}", self.words(MACROS)),
                2 => {
                    let grown = [
                        "V.P.T=V.P.T+P1",
                        "P[P2]=P1",
                        "V.L.N[P2]=P1+P1",
                        "V.S.T=P1+P1",
                    ];
                    self.words(&grown).to_owned()
                }
                3 => definition(self.choices),
                _ => self.words(MACROS).to_owned(),
            };
            body.push(Statement::text(text));
        }
        made.push(Form::Around(open.to_owned(), body, close.to_owned()).into());
        made
    }

    pub(super) fn contour(&mut self, depth: usize) -> Statement {
        let id = self.words(&["ID1]", "ID=P1]", "", "ID9999999999]"]);
        let body = self.statement(depth - 1);
        let close = self.words(&["#CONTOUR END", "", "M30"]);
        Form::Around(format!("#CONTOUR BEGIN[{id}"), body, close.to_owned()).into()
    }

    pub(super) fn declarations(&mut self) -> String {
        let mut text = "#VAR\n".to_owned();
        for _ in 0..self.choices.between([1, 3]) {
            text += self.words(&[
                "V.L.A",
                "V.P.LIST[3]",
                "V.S.B",
                "V.L.A[99999][99999]",
                "V.P.T[2][2]",
            ]);
            text += self.words(&[" = ", "="]);
            match self.choices.below(3) {
                0 => expression(self.choices, &mut text, 2),
                1 => text += "[1,2,3]",
                _ => text += "[1,\\\n2]",
            }
            text.push('\n');
        }
        text + self.words(&["#ENDVAR", "#ENDVAR", "#ENDVAR", ""])
    }

    /// Makes a control block, sometimes without its end or with the end of another kind.
    pub(super) fn hostile_flow(&mut self, depth: usize) -> Statement {
        let [mut open, mut close] = [String::new(), String::new()];
        let [word, own] = self.choices.one_of(&[
            ["$IF ", "$ENDIF"],
            ["$FOR ", "$ENDFOR"],
            ["$WHILE ", "$ENDWHILE"],
            ["$SWITCH ", "$ENDSWITCH"],
            ["$REPEAT", "$UNTIL 1"],
            ["#IF ", "#ENDIF"],
            ["$DO", "$ENDDO 1"],
        ]);
        open += word;
        match word {
            "$FOR " => {
                open = open + self.words(TARGETS) + "=";
                let counts = ["1,3,1", "1,3,0", "3,1,-1", "P1,P2,V.E.A", "1,1e9,1", "0,1"];
                open += self.words(&counts);
            }
            "$REPEAT" | "$DO" => {}
            _ => expression(self.choices, &mut open, 1),
        }
        if word == "$SWITCH " {
            open += "\n$CASE ";
            expression(self.choices, &mut open, 2);
        }
        let mut body = Vec::new();
        for _ in 0..self.choices.between([1, 3]) {
            body.extend(self.statement(depth - 1));
            let middle = match self.choices.below(8) {
                0 => self.words(&["$ELSE", "$ELSEIF P1==2", "$DEFAULT", "#ELSE", "$CASE V.E.A"]),
                1 => self.words(&["$BREAK", "$CONTINUE"]),
                _ => continue,
            };
            body.push(Statement::text(middle));
        }
        close += match self.choices.below(12) {
            0 => "",
            1 => self.words(ENDS),
            _ => own,
        };
        Form::Around(open, body, close).into()
    }

    pub(super) fn hostile_line(&mut self) -> String {
        let mut text = String::new();
        match self.choices.below(10) {
            0 => {
                text += self.words(&[
                    "N10 ",
                    "N10: ",
                    "/",
                    "/2 ",
                    "[LABEL] ",
                    "N99999999999999999999: ",
                    "N-1 ",
                ]);
            }
            1 => text += self.words(&["N20 ", "  ", "\t"]),
            _ => {}
        }
        let parts = 1 + self.choices.below(2) * self.choices.below(3);
        for part in 0..parts {
            if part > 0 {
                text += self.words(&[" ", " ", "", " \\\n", " \\\r\n", "\\\n\\\n"]);
            }
            self.part(&mut text);
        }
        if self.choices.below(8) == 0 {
            text += self.words(COMMENTS);
        }
        text
    }

    fn part(&mut self, text: &mut String) {
        match self.choices.below(18) {
            0..=2 => *text += self.words(COMP),
            3..=4 => *text += self.words(WORDS),
            5 => {
                *text += self.words(&["X", "Y", "Z", "G", "F", "M", "T", "D", "X=", "B"]);
                expression(self.choices, text, 2);
            }
            6..=8 => {
                *text += self.words(TARGETS);
                *text += self.words(&["=", "=", " = ", "=="]);
                expression(self.choices, text, 1);
            }
            9 => self.hostile_call(text),
            10 => *text += self.words(MACROS),
            11 => *text += &definition(self.choices),
            12 => {
                *text += self.words(&[
                    "$GOTO N10",
                    "$GOTO [LABEL]",
                    "$GOTO N11",
                    "$GOTO [NONE]",
                    "$GOTO N",
                    "$IF P1==1 $GOTO N10",
                ]);
            }
            13..=14 => *text += self.words(COMMANDS),
            15 => {
                let kind = self.words(TEXTS);
                let _ = write!(text, "X[COMP ON {kind}]");
            }
            16 => {
                let said = self.words(TEXTS);
                let _ = write!(text, "#MSG [{said}]");
            }
            _ => *text += self.words(TEXTS),
        }
    }

    fn hostile_call(&mut self, text: &mut String) {
        *text += self.words(CALLED);
        match self.choices.below(4) {
            0 => *text += " [@P1=P1 @P2=\"T\"]",
            1 => {
                *text += " [@P1=";
                expression(self.choices, text, 2);
                text.push(']');
            }
            _ => {}
        }
    }
}

/// Makes the definition of a macro that uses others.
fn definition(choices: &mut Choices<'_>) -> String {
    let mut text = format!("{}=\"", choices.one_of(MACROS));
    for _ in 0..choices.between([1, 6]) {
        if choices.below(4) == 0 {
            text += choices.one_of(&["X1", "P1+1", "X[COMP OFF FRICT]", "LL A", "P1=P1+P1", "M30"]);
        } else {
            let name = choices.one_of(MACROS).trim_matches('"');
            let _ = write!(text, "\\\"{name}\\\"");
        }
        text.push(' ');
    }
    text + "\""
}

fn expression(choices: &mut Choices<'_>, text: &mut String, depth: usize) {
    match choices.below(12) {
        0..=2 => *text += choices.one_of(NUMBERS),
        3..=5 => *text += choices.one_of(PARAMETERS),
        6 => *text += choices.one_of(NAMES),
        7 => *text += choices.one_of(TEXTS),
        8 if depth < DEPTH => {
            *text += choices.one_of(FUNCTIONS);
            text.push('[');
            expression(choices, text, depth + 1);
            if choices.below(2) == 0 {
                text.push(',');
                expression(choices, text, depth + 1);
            }
            *text += choices.one_of(&["]", "]", "]", ""]);
        }
        9..=10 if depth < DEPTH => {
            expression(choices, text, depth + 1);
            *text += choices.one_of(OPERATORS);
            expression(choices, text, depth + 1);
        }
        11 if depth < DEPTH => {
            *text += choices.one_of(&["[", "-[", "(", "[["]);
            expression(choices, text, depth + 1);
            *text += choices.one_of(&["]", "]", ")", ""]);
        }
        _ => *text += choices.one_of(&["1", "0"]),
    }
}
