//! From text to blocks.
//!
//! This is the only place that knows pest. Parsing never fails: a block comes back with what was
//! understood and with the faults of the rest. Nothing here knows a machine.

pub(crate) mod allow;
pub mod ast;
mod axes;
mod comp;
mod expression;
mod fast;
mod flow_scan;
mod grammar;
mod known;
mod lines;
mod lower;
mod unread;

pub use axes::{AxisUse, axis_uses};
pub use flow_scan::FlowScan;
pub(crate) use known::is_letter;
pub use lines::{BlockReader, Comments, FastPath, MAX_LINE, RawBlock, Remark, Stretch};
pub(crate) use lower::is_statement;
pub(crate) use unread::not_known;

use crate::comp::CompCommand;
use crate::diagnostic::Code;
use crate::text::{Span, TextLines};

/// How deep brackets may nest (R2.60).
pub const MAX_BRACKETS: usize = 64;

/// A statement about the text of one block: a diagnostic whose span counts from the block's start.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{message}")]
pub struct Fault {
    /// The code.
    pub code: Code,
    /// The bytes of the block's text that are meant.
    pub span: Span,
    /// One sentence in lower case.
    pub message: String,
    /// What to do.
    pub help: Vec<String>,
}

impl Fault {
    /// A fault without advice.
    pub fn new(code: Code, span: Span, message: impl Into<String>) -> Self {
        Self {
            code,
            span,
            message: message.into(),
            help: Vec::new(),
        }
    }

    /// The same with one more piece of advice.
    pub fn with_help(mut self, help: impl Into<String>) -> Self {
        self.help.push(help.into());
        self
    }
}

/// Parses one COMP command, `X[COMP ON FRICT]`, and nothing else.
///
/// ```
/// use frictcomp::comp::{Kind, KindSet, Selection};
/// use frictcomp::syntax::parse_comp;
///
/// let command = parse_comp("X[COMP ON FRICT]").unwrap();
/// assert_eq!(command.axis, "X");
/// assert_eq!(command.selection, Selection::On(KindSet::of(Kind::Frict)));
/// assert_eq!(parse_comp("X[COMP ON FRIKT]").unwrap_err().code.text(), "FC202");
/// ```
///
/// # Errors
/// The first fault that keeps the control from taking the command.
pub fn parse_comp(text: &str) -> Result<CompCommand, Fault> {
    let block = parse_block(text);
    let refused = |fault: &Fault| fault.code.severity() == crate::diagnostic::Severity::Error;
    if let Some(fault) = block.faults.into_iter().find(refused) {
        return Err(fault);
    }
    let mut items = block.items.into_iter();
    match (items.next(), items.next()) {
        (Some(ast::Item::Comp(command)), None) if block.words.is_empty() => Ok(command),
        _ => Err(Fault::new(
            Code::Fc207,
            Span::new(0, text.len()),
            "this is no single COMP command",
        )
        .with_help("write `X[COMP ON FRICT]`")),
    }
}

/// Parses the first block of a text; an empty block where there is none.
pub fn parse_block(text: &str) -> ast::Block {
    let mut block = ast::Block::default();
    let _ = BlockReader::new(TextLines::new(text), 1, FastPath::On).next(&mut block);
    block
}

/// Parses a text that is one expression into an empty block; `None` where it is none, or nests too
/// deeply.
pub(crate) fn parse_expression(text: &str, block: &mut ast::Block) -> Option<ast::Operand> {
    lower::brackets(text).ok()?;
    expression::lower_text(text, block)
}

/// The words of a `#` command in upper case, and how many bytes they take.
pub(crate) fn hash_name(code: &str) -> (String, usize) {
    let mut name = String::from("#");
    let mut end = 1;
    let mut rest = &code[1..];
    loop {
        let trimmed = rest.trim_start_matches([' ', '\t']);
        let length = trimmed
            .find(|c: char| !(c.is_ascii_alphanumeric() || c == '_'))
            .unwrap_or(trimmed.len());
        let (word, behind) = trimmed.split_at(length);
        let is_word = word.starts_with(|c: char| c.is_ascii_alphabetic());
        let is_parameter = word.len() > 1
            && word.starts_with(['P', 'p'])
            && word[1..].bytes().all(|byte| byte.is_ascii_digit());
        let is_value = is_parameter || behind.starts_with('.');
        if !is_word || is_value || behind.trim_start().starts_with('=') {
            return (name, end);
        }
        if name.len() > 1 {
            name.push(' ');
        }
        name.push_str(&word.to_ascii_uppercase());
        end = code.len() - behind.len();
        rest = behind;
    }
}

#[cfg(test)]
mod reference;
