//! Text that looks like part of a program and is not executed: what comments hide, and axis words without a
//! value (R18.7, R9.94).

use super::ast::{Address, Block, Operand, Word};
use super::parse::Fault;
use super::pieces::{PieceKind, is_blank, is_open_comment, pieces};
use crate::diagnostic::{Code, Fix};
use crate::language::GFunction;
use crate::text::{Span, changed_direction};

/// The keyword whose commands are looked for.
const COMP: &str = "COMP";

/// Returns the faults of lines, whatever is on them: FC102 for characters that change the order in which a line is
/// shown (R9.94), FC414 for a comment that is not closed and takes in a COMP command (R18.7).
pub(super) fn faults_of_lines(text: &str) -> impl Iterator<Item = Fault> {
    reordered(text).into_iter().chain(open_comment(text))
}

/// Returns FC102: characters that change the order in which a line is shown (R9.94).
pub(super) fn reordered(text: &str) -> Option<Fault> {
    let (span, message) = changed_direction(text)?;
    Some(Fault::new(Code::Fc102, span, message).with_help("delete these characters"))
}

/// Returns FC414: an unclosed `(` makes a comment of the rest of its line (R2.6).
fn open_comment(text: &str) -> Option<Fault> {
    if !text.contains('(') || comps(text).next().is_none() {
        return None;
    }
    let mut from = 0;
    for line in text.split('\n') {
        let comment = pieces(line).last().filter(|piece| {
            let comment = &line[piece.range.clone()];
            piece.kind == PieceKind::Comment && is_open_comment(comment) && holds_command(comment)
        });
        if let Some(comment) = comment {
            let span = Span::new(from + comment.range.start, from + comment.range.end);
            let message = "this comment is not closed: the control executes nothing up to the end of the line, and \
                           the COMP command in it switches nothing";
            let fault = Fault::new(Code::Fc414, span, message);
            return Some(fault.with_help("close the comment with `)` before the command"));
        }
        from += line.len() + 1;
    }
    None
}

/// Returns FC414: a `#COMMENT BEGIN` without an end makes a comment of the rest of the file (R2.6).
pub(super) fn open_region(opener: &str) -> Fault {
    let start = opener.len() - opener.trim_start_matches(is_blank).len();
    let message = "`#COMMENT BEGIN` has no `#COMMENT END`: everything from here to the end of the file is a comment \
                   and is never executed";
    Fault::new(Code::Fc414, Span::new(start, opener.len()), message)
        .with_help("write `#COMMENT END` in a separate block")
}

/// Returns FC414: a COMP command after the name in a `%` line, of which the control reads nothing more (R2.10).
pub(super) fn command_after_name(code: &str) -> Option<Fault> {
    let at = comps(code).next().filter(|_| holds_command(code))?;
    let message = "after the name of a program the control reads nothing in its line: this COMP command switches nothing";
    let fault = Fault::new(Code::Fc414, Span::new(at, at + COMP.len()), message);
    Some(fault.with_help("write the command in a separate block"))
}

/// Reports FC414 or FC211 for each axis word of a block that has no value (R18.7).
pub(super) fn words_without_value(text: &str, block: &mut Block) {
    if !block.all_words().any(|word| word.value.is_none()) {
        return;
    }
    let takes_names = block.all_words().any(takes_names);
    let bare = block.all_words().filter(|word| word.value.is_none());
    let faults = bare.filter_map(|word| {
        let no_value = || {
            (!takes_names && !matches!(word.address, Address::Lower(_)))
                .then(|| without_value(text, word))
        };
        command_in_comment(text, word).or_else(no_value)
    });
    let mut faults: Vec<Fault> = faults.collect();
    block.faults.append(&mut faults);
}

/// Returns whether a word is a G function with which axes may be named without a value: homing, measuring, manual mode,
/// weights, mirroring (PM/206138635, 206177803, 206633483, 206266379). With those of the groups, with G04 and G92 an
/// axis word is a number.
fn takes_names(word: &Word) -> bool {
    let is_g = word.address == Address::Letter(b'G');
    let takes_numbers = |number| GFunction::of_value(number).is_some_and(GFunction::takes_numbers);
    is_g && !matches!(word.value, Some(Operand::Number(number)) if takes_numbers(number))
}

/// Returns FC211: the control has no documented meaning for the word.
fn without_value(text: &str, word: &Word) -> Fault {
    let name = word.span.of(text).trim();
    let message = format!("`{name}` has no value; what the control does with it is not documented");
    Fault::new(Code::Fc211, word.span, message).with_help(format!(
        "write a coordinate, `{name}10`, or a command, `{name}[COMP ON FRICT]`"
    ))
}

/// Returns FC414: `X(COMP OFF FRICT)`, where a comment stands in place of a bracket.
fn command_in_comment(text: &str, word: &Word) -> Option<Fault> {
    let after = &text[word.span.end as usize..];
    let comment = after.trim_start_matches([' ', '\t']);
    let start = text.len() - comment.len();
    let first = pieces(comment.lines().next()?).next()?;
    let comment = &comment[first.range];
    if first.kind != PieceKind::Comment || comps(comment).next().is_none() {
        return None;
    }
    let name = word.span.of(text).trim();
    let span = Span::new(word.span.start as usize, start + comment.len());
    let message = format!("what follows `{name}` is a comment: the control switches nothing here");
    let fault = Fault::new(Code::Fc414, span, message);
    let words = comment
        .strip_prefix('(')
        .and_then(|rest| rest.strip_suffix(')'));
    let command = words.filter(|words| {
        !words.contains(['(', ')', '[', ']'])
            && comps(words).next() == Some(words.len() - words.trim_start().len())
    });
    let Some(command) = command else {
        return Some(fault.with_help(format!(
            "a command stands in brackets: `{name}[COMP OFF FRICT]`"
        )));
    };
    let command = format!("{name}[{}]", command.trim());
    let fix = Fix::guess(span, command.clone());
    Some(
        fault
            .with_help(format!("a command stands in brackets: `{command}`"))
            .with_fix(fix),
    )
}

/// Returns the places of the word `COMP`, in any case.
fn comps(text: &str) -> impl Iterator<Item = usize> {
    let bytes = text.as_bytes();
    let is_name =
        |byte: Option<&u8>| byte.is_some_and(|it| it.is_ascii_alphanumeric() || *it == b'_');
    memchr::memchr2_iter(b'C', b'c', bytes).filter(move |at| {
        let found = bytes.get(*at..at + COMP.len());
        found.is_some_and(|found| found.eq_ignore_ascii_case(COMP.as_bytes()))
            && !is_name(at.checked_sub(1).and_then(|before| bytes.get(before)))
            && !is_name(bytes.get(at + COMP.len()))
    })
}

/// Returns whether a text holds a COMP command: the word after the bracket of a name.
fn holds_command(text: &str) -> bool {
    comps(text).any(|at| {
        let before = text[..at].trim_end_matches(is_blank).strip_suffix('[');
        let name = before.map(|before| before.trim_end_matches(is_blank));
        name.is_some_and(|name| name.ends_with(|it: char| it.is_ascii_alphanumeric() || it == '_'))
    })
}
