//! The shortcuts against the grammar without any: block by block, the fast path, the grammar, and the
//! grammar without its words in one token yield the same tree, on generated blocks and on blocks that
//! were damaged afterwards.
//!
//! `cargo test --release --lib reference -- --ignored` compares ten million blocks.

use fastrand::Rng;

use super::ast::Block;
use super::grammar::Rule;
use super::lines::{BlockReader, FastPath};
use super::lower;
use super::pieces::brackets;
use super::raw::Stretch;
use crate::diagnostic::Code;
use crate::text::TextLines;

/// Stretches of a program that are more than words.
const PIECES: [&str; 60] = [
    "X[COMP ON FRICT]",
    "Y[COMP OFF FRICT]",
    "X[COMP OFF_ALL]",
    "X[COMP ON FRIKT]",
    "[COMP",
    "P1=3",
    "P2 = P1 * 2",
    "P1",
    "V.E.A = 1",
    "X[P1+1]",
    "XP1",
    "X=-5",
    "X=1",
    "X+.5",
    "X5.",
    "X.",
    "X-",
    "X",
    "M30",
    "M17",
    "#TIME 1",
    "#HSC ON",
    "[LABEL]",
    "\"M\"=\"X1\"",
    "\"M\"",
    "L SUB.nc",
    "LL A",
    "G800[1,,2]",
    "/1",
    "/",
    "MOD",
    "XOR",
    "X1 MOD 2",
    "X1 AND P2",
    "X1 OR-2",
    "OR",
    "X1 ^ 2",
    "; frictcomp: allow FC402",
    ";",
    "(a (b) c)",
    "(plain)",
    "(",
    ")",
    "\\",
    "%A",
    "%L SUB",
    "$IF P1 > 2",
    "$ENDIF",
    "$GOTO N10",
    "N10:",
    "N-1",
    "N1.5",
    "1E5",
    "X1e2",
    "X000000000000001.5",
    "X1234567890123456",
    "X0.0000000000000001",
    "ÜX1",
    "X１",
    "\u{feff}",
];

/// Characters that open, close and hide brackets.
const BRACKETS: [&str; 48] = [
    "X[",
    "X[COMP ON FRICT",
    "AB[",
    "ABS[",
    "[",
    "[",
    "]",
    "]",
    "]",
    "P1[",
    "V.P.A[",
    "G1[",
    "N[",
    "F[",
    "M17 [",
    "S.POS[",
    "S1000.X[",
    "LC[",
    "L CYCLE[",
    "L SEQUENCE[",
    "L a[b",
    "L a[b]c",
    "NAME=a[b",
    "@P1=",
    "[A",
    "'",
    "'",
    "'16#A'",
    "\"",
    "\"",
    "\\\"",
    "$IF ",
    "$SWITCH ",
    "$GOTO ",
    "#IF ",
    "#VAR\nV.P.A[",
    "#TIME ",
    "#SET P1[",
    "#DELETE V.P.A[",
    "1",
    "-",
    "=",
    ",",
    " ",
    "\n",
    "P1=",
    "X10Y",
    "\u{1}",
];

/// Bytes that change the meaning of their neighbours.
const BYTES: [char; 26] = [
    ' ', '\t', '.', '-', '+', '*', '/', '=', '[', ']', '(', ')', '"', ';', ',', '\\', '%', '$',
    '#', 'N', 'P', 'L', 'x', '0', '\u{0}', '\u{3}',
];

/// Lines of one program: an open bracket or comment takes only these with it.
const LINES: usize = 16;

const LINE_ENDS: [&str; 6] = ["\n", "\n", "\n", "\r\n", "\r", ""];

/// Writes a word whose number has any of the shapes that a number may have.
fn push_word(line: &mut String, rng: &mut Rng) {
    line.push(rng.char('A'..='Z'));
    line.push_str(["", "", "", "-", "+"][rng.usize(..5)]);
    // More than 308 digits before the point are not a number.
    let digits = match rng.u16(..500) {
        0 => 400,
        _ => rng.usize(..10),
    };
    for _ in 0..digits {
        line.push(rng.char('0'..='9'));
    }
    if rng.bool() {
        line.push('.');
        for _ in 0..rng.usize(..8) {
            line.push(rng.char('0'..='9'));
        }
    }
}

fn push_line(line: &mut String, rng: &mut Rng) {
    if rng.u8(..3) == 0 {
        line.push('N');
        line.push_str(&rng.u16(..).to_string());
    }
    for _ in 0..rng.usize(..7) {
        line.push_str(["", " ", "\t", "  "][rng.usize(..4)]);
        if rng.u8(..8) == 0 {
            line.push_str(PIECES[rng.usize(..PIECES.len())]);
        } else {
            push_word(line, rng);
        }
    }
    if rng.u8(..3) == 0 {
        damage(line, rng);
    }
}

/// Puts a character in, takes one out, or puts one in the place of another.
fn damage(line: &mut String, rng: &mut Rng) {
    let at = line.char_indices().nth(rng.usize(..=line.len()));
    let (at, length) = at.map_or((line.len(), 0), |(at, letter)| (at, letter.len_utf8()));
    let removed = if rng.bool() { length } else { 0 };
    let put = match rng.u8(..4) {
        0 => String::new(),
        1 => rng.char(..).to_string(),
        _ => BYTES[rng.usize(..BYTES.len())].to_string(),
    };
    line.replace_range(at..at + removed, &put);
}

/// Returns the number of blocks of a program; both readers must find the same ones.
fn compare(program: &str) -> u64 {
    let reader = |path| BlockReader::new(TextLines::new(program), 1, path);
    let (mut fast, mut grammar) = (reader(FastPath::On), reader(FastPath::Off));
    let (mut one, mut other) = (Block::default(), Block::default());
    let mut blocks = 0;
    loop {
        let (found, expected) = (fast.next(&mut one), grammar.next(&mut other));
        let (Some(found), Some(expected)) = (found, expected) else {
            assert!(found.is_none() && expected.is_none(), "{program:?}");
            return blocks;
        };
        let seen = (
            found.stretch,
            found.text,
            found.line,
            found.offset,
            found.remark,
        );
        let meant = (
            expected.stretch,
            expected.text,
            expected.line,
            expected.offset,
            expected.remark,
        );
        assert_eq!(seen, meant, "{program:?}");
        assert_same(found.text, &one, &other);
        compare_with_reference(&grammar.code);
        blocks += 1;
    }
}

/// Compares the tree of a block's code by the grammar with that by the grammar without its shortcuts.
fn compare_with_reference(code: &str) {
    let (mut tree, mut reference) = (Block::default(), Block::default());
    lower::block(code, &mut tree);
    lower::block_as(Rule::reference_block, code, &mut reference);
    assert_same(code, &tree, &reference);
}

fn assert_same(text: &str, one: &Block, other: &Block) {
    // An invalid number is NaN, and equals nothing.
    let same = one == other || format!("{one:?}") == format!("{other:?}");
    assert!(same, "{text:?}\n{one:#?}\n{other:#?}");
}

fn compare_blocks(count: u64, seed: u64) {
    let mut rng = Rng::with_seed(seed);
    let (mut program, mut line) = (String::new(), String::new());
    let mut blocks = 0;
    while blocks < count {
        program.clear();
        for _ in 0..LINES {
            line.clear();
            push_line(&mut line, &mut rng);
            program.push_str(&line);
            program.push_str(LINE_ENDS[rng.usize(..LINE_ENDS.len())]);
        }
        blocks += compare(&program);
    }
}

/// Blocks of which brackets stay open are read as if their ends had been looked for.
fn compare_brackets(count: u64, seed: u64) {
    let mut rng = Rng::with_seed(seed);
    let mut code = String::new();
    for _ in 0..count {
        code.clear();
        for _ in 0..rng.usize(1..12) {
            code.push_str(BRACKETS[rng.usize(..BRACKETS.len())]);
        }
        let Ok(found) = brackets(&code) else {
            continue;
        };
        let (mut marked, mut plain) = (Block::default(), Block::default());
        lower::block(&code, &mut marked);
        let unmarked = code.replace('\u{1}', "\u{2}");
        lower::read_as(Rule::block, &code, (&unmarked, found.unclosed), &mut plain);
        assert_same(&code, &marked, &plain);
    }
}

#[test]
fn a_bracket_that_is_never_closed_is_read_as_before() {
    // R9.90
    compare_brackets(20_000, 3);
}

#[test]
#[ignore = "ten million blocks take minutes"]
fn a_bracket_that_is_never_closed_is_read_as_before_at_length() {
    // R9.90
    compare_brackets(10_000_000, 4);
}

#[test]
fn every_shortcut_is_the_grammar() {
    compare_blocks(20_000, 1);
}

#[test]
fn what_editors_leave_at_the_end_of_a_comment_is_no_text() {
    // R2.1
    for end in ["\u{0}\u{0}", " \u{3}", "\u{1a}\t", "\u{0} \u{3} "] {
        assert_eq!(compare(&format!("N10 X1 ; a{end}\nN20 X2 (b){end}\n")), 2);
    }
}

#[test]
fn a_name_with_a_letter_outside_ascii_begins_a_main_program() {
    // R2.10, R2.1
    for (line, name, is_local) in [
        ("%Läufer", "Läufer", false),
        ("% Läufer", "Läufer", false),
        ("%äL B", "äL", false),
        ("%L äufer", "äufer", true),
        ("%L (für) A", "A", true),
        ("%L A (für)", "A", true),
        ("%A\u{a0}B", "A", false),
    ] {
        let mut reader = BlockReader::new(TextLines::new(line), 1, FastPath::On);
        let mut block = Block::default();
        let raw = reader.next(&mut block).expect("a program begins");
        let Stretch::Program { name: found, local } = raw.stretch else {
            panic!("{line} is a block");
        };
        assert_eq!((found.of(raw.text), local), (name, is_local), "{line}");
        let says_so = block.faults.iter().any(|fault| fault.code == Code::Fc101);
        assert_eq!(says_so, !line.contains("(für)"), "{line}");
    }
}

#[test]
#[ignore = "ten million blocks take minutes"]
fn every_shortcut_is_the_grammar_at_length() {
    compare_blocks(10_000_000, 2);
}
