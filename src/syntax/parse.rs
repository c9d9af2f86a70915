//! Texts that are parsed by themselves: one command, one block, one expression.

use super::ast::{Address, Block, Item, Operand, Word};
use super::brackets::brackets;
use super::expression::lower_text;
use super::fault::Fault;
use super::lines::{BlockReader, FastPath};
use crate::comp::CompCommand;
use crate::diagnostic::{Code, Severity, nearest};
use crate::language::HashAction;
use crate::text::{Span, TextLines, lines_of};

/// Parses one COMP command, `X[COMP ON FRICT]`; `None` where the text is something else:
/// another bracket, an expression, or no bracket at all.
///
/// ```
/// use frictcomp::comp::{Kind, KindSet, Selection};
/// use frictcomp::syntax::parse_comp;
///
/// let command = parse_comp("X[COMP ON FRICT]").unwrap().expect("a COMP command");
/// assert_eq!(command.axis, "X");
/// assert_eq!(command.selection, Selection::On(KindSet::of(Kind::Frict)));
/// assert_eq!(parse_comp("X[INDP_ASYN G1 POS=5 FEED=100 SLOPE_TYPE=STEP]"), Ok(None));
/// assert_eq!(parse_comp("X[COMP ON FRIKT]").unwrap_err().code.as_str(), "FC202");
/// ```
///
/// # Errors
/// The first fault that keeps the control from accepting a COMP command, also one whose `COMP` is misspelt. The text is
/// more than one command or line, or has a skip mark, so that the machine decides whether it is executed.
pub fn parse_comp(text: &str) -> Result<Option<CompCommand>, Fault> {
    let mut block = Block::default();
    let mut reader = BlockReader::new(TextLines::new(text), 1, FastPath::On);
    let _ = reader.next(&mut block);
    let mut rest = String::new();
    reader.append_rest(&mut rest);
    let faulty = |message: &str, help: &'static str| {
        let fault = Fault::new(Code::Fc207, Span::new(0, text.len()), message);
        Err(fault.with_help(help))
    };
    if !rest.trim().is_empty() {
        return if lines_of(text).any(opens_comp) {
            faulty(
                "these are several lines, and one command is read at a time",
                "give each line by itself",
            )
        } else {
            Ok(None)
        };
    }
    let refused = |fault: &Fault| fault.code.severity() == Severity::Error;
    if let Some(at) = block.faults.iter().position(refused) {
        let fault = block.faults.swap_remove(at);
        return if opens_comp(text) {
            Err(fault)
        } else {
            Ok(None)
        };
    }
    let is_alone = block.items.len() == 1 && block.words.is_empty();
    let is_comp = |item: &Item| matches!(item, Item::Comp(_));
    match block.items.into_iter().find(is_comp) {
        Some(Item::Comp(_)) if block.skip.is_some() => faulty(
            "a skip mark leaves it to the machine whether the command is executed",
            "decide that, and give the command without the mark",
        ),
        Some(Item::Comp(command)) if is_alone => Ok(Some(command)),
        None => Ok(None),
        Some(_) => faulty(
            "there is more here than one COMP command",
            "give the command by itself",
        ),
    }
}

/// Whether the first bracket of a text begins with `COMP`, or nearly so.
fn opens_comp(text: &str) -> bool {
    let Some((_, inside)) = text.split_once('[') else {
        return false;
    };
    let inside = inside.trim_start();
    let word = inside.split(|letter: char| !letter.is_ascii_alphanumeric() && letter != '_');
    word.take(1).any(|word| !nearest(word, ["COMP"]).is_empty())
}

/// Parses the first block of a text; an empty block where there is none.
pub fn parse_block(text: &str) -> Block {
    let mut block = Block::default();
    let _ = BlockReader::new(TextLines::new(text), 1, FastPath::On).next(&mut block);
    block
}

/// Whether a block is only an M word, `N90 M30 ; end`, `M 2`, `M=P1`, or only `#ERROR`, so that another block can be
/// put before it (R1.59). A jump label is more: a jump to it would skip the other block.
pub fn is_lone_end(text: &str) -> bool {
    let block = parse_block(text);
    let is_m = |word: &Word| word.address == Address::Letter(b'M');
    let is_label = block.number.is_some_and(|number| number.label);
    let is_refused = |fault: &Fault| fault.code.severity() == Severity::Error;
    let is_error = |item: &Item| matches!(item, Item::Hash(hash) if hash.command.action == HashAction::ReportError);
    let is_end = match (block.words.as_slice(), block.items.as_slice()) {
        ([word], []) => is_m(word),
        ([], [item]) => is_error(item),
        _ => false,
    };
    is_end && block.skip.is_none() && !is_label && !block.faults.iter().any(is_refused)
}

/// Parses a text that is one expression into an empty block; `None` where it is not, or
/// nests too deeply.
pub fn parse_expression(text: &str, block: &mut Block) -> Option<Operand> {
    lower_text(&brackets(text).ok()?.read, block)
}
