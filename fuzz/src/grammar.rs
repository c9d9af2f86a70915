//! Hostile programs in the control's language: blocks that are nested or cut off, macros that use
//! each other, calls in circles, missing labels, blocks that continue on the next line, unknown
//! values, numbers and texts that are too large.

use std::fmt::Write as _;

use crate::Dice;
use crate::files::SEPARATOR;
use crate::phrases::{CALLED, COMP, MACROS, OPERATORS, TARGETS, WORDS};
use crate::phrases::{COMMANDS, COMMENTS, ENDS, FUNCTIONS, NAMES, NUMBERS, PARAMETERS, TEXTS};

/// The number of blocks of a program, not counting those nested in them.
const BLOCKS: usize = 12;

/// The nesting depth of blocks and expressions.
const DEPTH: usize = 4;

/// The theme of a program.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Theme {
    /// Everything.
    Any,
    /// Macros that use each other, and texts that grow.
    Growth,
}

/// Returns a program, and often one that it calls.
pub fn program(dice: &mut Dice<'_>, theme: Theme) -> String {
    let mut writer = Writer {
        dice,
        text: String::new(),
        theme,
        line_end: "\n",
    };
    writer.line_end = writer.dice.one_of(&["\n", "\n", "\n", "\r\n", "\r"]);
    if writer.theme == Theme::Growth {
        writer.growing();
    } else {
        writer.file();
        if writer.dice.below(3) > 0 {
            writer.text.push(SEPARATOR);
            writer.file();
        }
    }
    writer.text
}

struct Writer<'a, 'b> {
    dice: &'a mut Dice<'b>,
    text: String,
    theme: Theme,
    line_end: &'static str,
}

impl Writer<'_, '_> {
    fn end(&mut self) {
        let end = self.line_end;
        self.text.push_str(end);
    }

    fn put(&mut self, text: &str) {
        self.text.push_str(text);
    }

    fn any(&mut self, words: &[&str]) {
        let word = self.dice.one_of(words);
        self.put(word);
    }

    fn file(&mut self) {
        let opener = [
            "",
            "",
            "%MAIN\n",
            "\u{feff}",
            "%L A\nN1 X1\nM17\n%MAIN\n",
            "#VAR\nV.L.A=1\n#ENDVAR\n",
        ];
        self.any(&opener);
        let blocks = 1 + self.dice.below(BLOCKS);
        for _ in 0..blocks {
            if self.dice.is_used_up() {
                break;
            }
            self.statement(0);
        }
        if self.dice.below(3) > 0 {
            self.put("M30");
            self.end();
        }
        if self.dice.below(4) == 0 {
            self.put("%L A\n");
            self.statement(1);
            self.any(&["M17\n", "", "LL A\n"]);
        }
    }

    /// Writes definitions, and a loop that uses them.
    fn growing(&mut self) {
        for _ in 0..1 + self.dice.below(4) {
            self.define();
            self.end();
        }
        self.put("P1=\"ab\"");
        self.end();
        let opener = self
            .dice
            .one_of(&["$WHILE 1", "$FOR P2=1,50,1", "$IF V.E.X", "$REPEAT"]);
        self.put(opener);
        self.end();
        for _ in 0..1 + self.dice.below(5) {
            match self.dice.below(5) {
                0 => self.put("P1=P1+P1"),
                1 => {
                    self.put("P3=");
                    self.any(MACROS);
                }
                2 => self.any(&[
                    "V.P.T=V.P.T+P1",
                    "P[P2]=P1",
                    "V.L.N[P2]=P1+P1",
                    "V.S.T=P1+P1",
                ]),
                3 => self.define(),
                _ => self.any(MACROS),
            }
            self.end();
        }
        let closer = match &opener[..3] {
            "$WH" => "$ENDWHILE",
            "$FO" => "$ENDFOR",
            "$IF" => "$ENDIF",
            _ => "$UNTIL 0",
        };
        self.put(closer);
        self.end();
    }

    fn define(&mut self) {
        self.any(MACROS);
        self.put("=\"");
        for _ in 0..1 + self.dice.below(6) {
            match self.dice.below(4) {
                0 => self.any(&["X1", "P1+1", "X[COMP OFF FRICT]", "LL A", "P1=P1+P1", "M30"]),
                _ => {
                    let name = self.dice.one_of(MACROS).trim_matches('"');
                    let _ = write!(self.text, "\\\"{name}\\\"");
                }
            }
            self.put(" ");
        }
        self.put("\"");
    }

    fn statement(&mut self, depth: usize) {
        match self.dice.below(16) {
            _ if depth >= DEPTH => self.line(),
            0..=8 => self.line(),
            9..=13 => self.flow(depth),
            14 => self.declarations(),
            _ => {
                self.put("#CONTOUR BEGIN[");
                self.any(&["ID1]", "ID=P1]", "", "ID9999999999]"]);
                self.end();
                self.statement(depth + 1);
                self.any(&["#CONTOUR END", "", "M30"]);
                self.end();
            }
        }
    }

    fn declarations(&mut self) {
        self.put("#VAR");
        self.end();
        for _ in 0..1 + self.dice.below(3) {
            self.any(&[
                "V.L.A",
                "V.P.LIST[3]",
                "V.S.B",
                "V.L.A[99999][99999]",
                "V.P.T[2][2]",
            ]);
            self.any(&[" = ", "="]);
            match self.dice.below(3) {
                0 => self.expression(2),
                1 => self.put("[1,2,3]"),
                _ => self.put("[1,\\\n2]"),
            }
            self.end();
        }
        self.any(&["#ENDVAR", "#ENDVAR", "#ENDVAR", ""]);
        self.end();
    }

    /// Writes a control block, sometimes without its end or with the end of another kind.
    fn flow(&mut self, depth: usize) {
        let kind = self.dice.below(7);
        let closer = match kind {
            0 => {
                self.put("$IF ");
                self.expression(1);
                "$ENDIF"
            }
            1 => {
                self.put("$FOR ");
                self.any(TARGETS);
                self.put("=");
                self.any(&["1,3,1", "1,3,0", "3,1,-1", "P1,P2,V.E.A", "1,1e9,1", "0,1"]);
                "$ENDFOR"
            }
            2 => {
                self.put("$WHILE ");
                self.expression(1);
                "$ENDWHILE"
            }
            3 => {
                self.put("$SWITCH ");
                self.expression(1);
                self.end();
                self.put("$CASE ");
                self.expression(2);
                "$ENDSWITCH"
            }
            4 => {
                self.put("$REPEAT");
                "$UNTIL 1"
            }
            5 => {
                self.put("#IF ");
                self.expression(2);
                "#ENDIF"
            }
            _ => {
                self.put("$DO");
                "$ENDDO 1"
            }
        };
        self.end();
        for _ in 0..1 + self.dice.below(3) {
            self.statement(depth + 1);
            match self.dice.below(8) {
                0 => self.any(&["$ELSE", "$ELSEIF P1==2", "$DEFAULT", "#ELSE", "$CASE V.E.A"]),
                1 => self.any(&["$BREAK", "$CONTINUE"]),
                _ => continue,
            }
            self.end();
        }
        match self.dice.below(12) {
            0 => {}
            1 => self.any(ENDS),
            _ => self.put(closer),
        }
        self.end();
    }

    fn line(&mut self) {
        match self.dice.below(10) {
            0 => self.any(&[
                "N10 ",
                "N10: ",
                "/",
                "/2 ",
                "[LABEL] ",
                "N99999999999999999999: ",
                "N-1 ",
            ]),
            1 => self.any(&["N20 ", "  ", "\t"]),
            _ => {}
        }
        let parts = 1 + self.dice.below(2) * self.dice.below(3);
        for part in 0..parts {
            if part > 0 {
                self.any(&[" ", " ", "", " \\\n", " \\\r\n", "\\\n\\\n"]);
            }
            self.part();
        }
        if self.dice.below(8) == 0 {
            self.any(COMMENTS);
        }
        self.end();
    }

    fn part(&mut self) {
        match self.dice.below(18) {
            0..=2 => self.any(COMP),
            3..=4 => self.any(WORDS),
            5 => {
                self.any(&["X", "Y", "Z", "G", "F", "M", "T", "D", "X=", "B"]);
                self.expression(2);
            }
            6..=8 => {
                self.any(TARGETS);
                self.any(&["=", "=", " = ", "=="]);
                self.expression(1);
            }
            9 => self.call(),
            10 => self.any(MACROS),
            11 => self.define(),
            12 => self.any(&[
                "$GOTO N10",
                "$GOTO [LABEL]",
                "$GOTO N11",
                "$GOTO [NONE]",
                "$GOTO N",
                "$IF P1==1 $GOTO N10",
            ]),
            13..=14 => self.any(COMMANDS),
            15 => {
                self.put("X[COMP ON ");
                self.any(TEXTS);
                self.put("]");
            }
            16 => {
                self.put("#MSG [");
                self.any(TEXTS);
                self.put("]");
            }
            _ => self.any(TEXTS),
        }
    }

    fn call(&mut self) {
        self.any(CALLED);
        match self.dice.below(4) {
            0 => self.put(" [@P1=P1 @P2=\"T\"]"),
            1 => {
                self.put(" [@P1=");
                self.expression(2);
                self.put("]");
            }
            _ => {}
        }
    }

    fn expression(&mut self, depth: usize) {
        match self.dice.below(12) {
            0..=2 => self.any(NUMBERS),
            3..=5 => self.any(PARAMETERS),
            6 => self.any(NAMES),
            7 => self.any(TEXTS),
            8 if depth < DEPTH => {
                self.any(FUNCTIONS);
                self.put("[");
                self.expression(depth + 1);
                if self.dice.below(2) == 0 {
                    self.put(",");
                    self.expression(depth + 1);
                }
                self.any(&["]", "]", "]", ""]);
            }
            9..=10 if depth < DEPTH => {
                self.expression(depth + 1);
                self.any(OPERATORS);
                self.expression(depth + 1);
            }
            11 if depth < DEPTH => {
                self.any(&["[", "-[", "(", "[["]);
                self.expression(depth + 1);
                self.any(&["]", "]", ")", ""]);
            }
            _ => self.any(&["1", "0"]),
        }
    }
}
