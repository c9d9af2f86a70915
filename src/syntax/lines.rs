//! Physical lines to blocks: comments, continuations, comment regions (R2.2, R2.6, R2.7).
//!
//! What a block's parser sees is its *code*: the text with comments, continuation signs and the
//! block numbers of continued lines blanked out byte for byte, so that spans fit both.

use super::allow::MARK;
use super::ast::Block;
use super::hidden_code::{
    command_after_name, faults_of_lines, open_region, reordered, words_without_value,
};
use super::keywords::opening_command;
use super::parse::Fault;
use super::pieces::{Masked, is_blank, mask, mask_number};
use super::raw::{Comments, LatestRemarks, LostRemarks, MAX_LINE, RawBlock, Remark, Stretch};
use super::{fast, lower};
use crate::diagnostic::{Code, Severity};
use crate::language::{HashAction, HashWords};
use crate::text::{LineSource, PhysicalLine, Span};

/// Bytes that one continued block, or one `#VAR` region, may have. The documents state no bound;
/// without one a damaged file would be read into memory whole.
const MAX_REGION: usize = 1 << 20;

/// Faults of one block that are reported one by one (R2.85).
const MAX_FAULTS: usize = 1000;

/// Use of a parser by hand for blocks where that is possible, with a shorter execution of blocks that only move or
/// compute.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[non_exhaustive]
pub enum FastPath {
    /// Blocks are parsed by hand where possible; the rest is parsed by the grammar and executed step by step.
    #[default]
    On,
    /// No fast path: every block is parsed by the grammar and executed step by step, as the reference.
    Off,
}

/// Reads blocks one after another.
#[derive(Debug)]
pub struct BlockReader<S> {
    source: S,
    fast_path: FastPath,
    /// The number of the current line of `source`.
    line: u32,
    /// Number and offset of the first line of the block that is read.
    start: (u32, usize),
    text: String,
    /// The code of the last block that was not parsed by hand.
    pub(super) code: String,
    remarks: LatestRemarks,
    /// Kind of the last stretch.
    stretch: Stretch,
    /// The comments of the last block, where it was parsed by hand.
    plain: Option<Comments>,
}

impl<S: LineSource> BlockReader<S> {
    /// Returns a reader whose first line has the number `first_line`.
    pub fn new(source: S, first_line: u32, fast_path: FastPath) -> Self {
        Self {
            source,
            fast_path,
            line: first_line - 1,
            start: (first_line, 0),
            text: String::new(),
            code: String::new(),
            remarks: LatestRemarks::default(),
            stretch: Stretch::Block,
            plain: None,
        }
    }

    /// Returns the source of the lines, to ask it about errors.
    pub fn source(&self) -> &S {
        &self.source
    }

    /// Returns the remarks so far that are not directly above a block.
    pub fn lost_remarks(&self) -> &LostRemarks {
        self.remarks.lost()
    }

    /// Appends the lines that were not read yet, each with a line end. No block follows the remarks before them.
    pub fn append_rest(&mut self, text: &mut String) {
        self.remarks.end();
        self.source.append_rest(text);
    }

    /// Parses the next block into `block`, or finds the next `%` line. Blank lines, comment lines
    /// and `#COMMENT` regions are passed over (R9.11).
    pub fn next(&mut self, block: &mut Block) -> Option<RawBlock<'_>> {
        block.clear();
        loop {
            if self.fast_path == FastPath::On
                && let Some(plain) = fast::parse(self.source.ahead(), block)
            {
                self.line += 1;
                self.plain = Some(plain.comments);
                let remark = self.remarks.above(self.line);
                let line = self.source.take(plain.length);
                return Some(plain_block(line, self.line, plain.comments, remark));
            }
            if !self.source.advance() {
                self.remarks.end();
                self.plain = None;
                return None;
            }
            self.line += 1;
            if let Some(stretch) = self.slow(block) {
                (self.stretch, self.plain) = (stretch, None);
                match stretch {
                    Stretch::Block => _ = self.remarks.above(self.start.0),
                    Stretch::Program { .. } => self.remarks.end(),
                }
                return Some(self.last());
            }
        }
    }

    /// Returns the number of the first line that was not read.
    pub(crate) fn next_line(&self) -> u32 {
        self.line.saturating_add(1)
    }

    /// Returns the stretch read last.
    pub(crate) fn last(&self) -> RawBlock<'_> {
        let remark = self.remarks.heard();
        if let Some(comments) = self.plain {
            return plain_block(self.source.line(), self.line, comments, remark);
        }
        let (line, offset) = self.start;
        RawBlock {
            stretch: self.stretch,
            text: &self.text,
            line,
            offset,
            comments: Comments::of(&self.text),
            plain: false,
            remark,
        }
    }

    /// Reads the current line, and those that belong to it.
    fn slow(&mut self, block: &mut Block) -> Option<Stretch> {
        let cut = self.source.line().cut;
        let masked = self.begin_block();
        let start = self.code.trim_ascii_start();
        if start.is_empty() {
            if self.text.contains(MARK) {
                self.remarks.take(&self.text, self.line);
            }
            self.remarks
                .note(&self.text, self.line, faults_of_lines(&self.text));
            if !masked.continues {
                return None;
            }
        }
        if let Some(name) = start.strip_prefix('%') {
            let stretch = program_line(&self.code, &self.text, name, masked.foreign);
            block
                .faults
                .extend(masked.foreign.map(|span| outside_ascii(span, &self.text)));
            block.faults.extend(faults_of_lines(&self.text));
            block.faults.extend(command_after_name(&self.code));
            return Some(stretch);
        }
        let mut foreign = masked.foreign;
        if masked.continues {
            foreign = foreign.or(self.take_continuation(block));
            if self.code.trim_ascii().is_empty() && block.faults.is_empty() {
                return None;
            }
        }
        if let Some(opening) = opening_command(&self.code) {
            let is_alone = opening.is_alone();
            let is_comment = opening.action() == Some(HashAction::Comment);
            let region_end = opening.name.command.and_then(HashWords::region_end);
            if is_comment && self.skip_comment_region(is_alone, block) {
                return None;
            }
            if let Some(end) = region_end {
                self.take_region(end, block);
            }
        }
        if cut || (self.text.len() > MAX_LINE && self.text.lines().any(too_long)) {
            block.faults.push(
                Fault::new(
                    Code::Fc206,
                    Span::new(0, self.text.len().min(MAX_LINE)),
                    format!("a block has at most {MAX_LINE} characters"),
                )
                .with_help("split the block, or continue it on the next line with `\\`"),
            );
            return Some(Stretch::Block);
        }
        block
            .faults
            .extend(foreign.map(|span| outside_ascii(span, &self.text)));
        block.faults.extend(faults_of_lines(&self.text));
        lower::block(&self.code, block);
        words_without_value(&self.text, block);
        block.faults.sort_by_key(|fault| fault.span.start);
        cap_faults(&mut block.faults);
        Some(Stretch::Block)
    }

    /// Takes the source's line as the first one of a block.
    fn begin_block(&mut self) -> Masked {
        self.text.clear();
        self.code.clear();
        self.start = (self.line, self.source.line().offset);
        self.take_line()
    }

    /// Appends the source's line to text and code, without trailing blanks.
    fn take_line(&mut self) -> Masked {
        let line = trimmed(self.source.line().text);
        let from = self.code.len();
        self.text.push_str(line);
        let masked = mask(line, &mut self.code);
        Masked {
            continues: masked.continues,
            foreign: masked
                .foreign
                .map(|span| span.shifted(Span::new(from, from).start)),
        }
    }

    /// Appends the lines that a `\` continues on; blank and comment lines in between are free.
    fn take_continuation(&mut self, block: &mut Block) -> Option<Span> {
        let mut foreign = None;
        while self.text.len() <= MAX_REGION {
            if !self.source.advance() {
                return foreign;
            }
            self.line += 1;
            self.text.push('\n');
            self.code.push('\n');
            let from = self.code.len();
            let masked = self.take_line();
            foreign = foreign.or(masked.foreign);
            let blank = self.code[from..].trim_ascii().is_empty();
            mask_number(&mut self.code, from);
            if !blank && !masked.continues {
                return foreign;
            }
        }
        self.pass_over(|code, continues| !continues && !code.trim_ascii().is_empty());
        // A text that was cut off cannot be understood.
        self.code.clear();
        block.faults.push(Fault::new(
            Code::Fc206,
            Span::new(0, self.text.find('\n').unwrap_or_default()),
            format!("this continued block has more than {MAX_REGION} bytes"),
        ));
        foreign
    }

    /// Skips the lines up to the last one of a text that is too long to keep. Whether it was found.
    fn pass_over(&mut self, is_last: impl Fn(&str, bool) -> bool) -> bool {
        let mut code = String::new();
        while self.source.advance() {
            self.line += 1;
            code.clear();
            let masked = mask(trimmed(self.source.line().text), &mut code);
            if is_last(&code, masked.continues) {
                return true;
            }
        }
        false
    }

    /// Skips a comment region, whose opener is the block being read. Returns whether opener and end are
    /// alone in their blocks (R2.6). Where the end is not, it is the block from here on.
    fn skip_comment_region(&mut self, opener_is_alone: bool, block: &mut Block) -> bool {
        let opened = self.line;
        let mut code = String::new();
        while self.source.advance() {
            self.line += 1;
            code.clear();
            let line = trimmed(self.source.line().text);
            self.remarks.note(line, self.line, reordered(line));
            mask(line, &mut code);
            let opening = opening_command(&code);
            if let Some(end) = opening.filter(|it| it.action() == Some(HashAction::EndComment)) {
                if opener_is_alone && !end.is_alone() {
                    self.begin_block();
                    return false;
                }
                return opener_is_alone;
            }
        }
        let fault = open_region(&self.text);
        if opener_is_alone {
            self.remarks.note(&self.text, opened, [fault]);
        } else {
            block.faults.push(fault);
        }
        opener_is_alone
    }

    /// Appends lines up to the end of a region of declarations.
    fn take_region(&mut self, end: &str, block: &mut Block) {
        let opener = Span::new(0, self.text.len());
        let mut continued = false;
        let mut is_whole = true;
        while self.text.len() <= MAX_REGION {
            if !self.source.advance() {
                is_whole = false;
                break;
            }
            self.line += 1;
            self.text.push('\n');
            // A continued declaration is one line to the parser.
            self.code.push(if continued { ' ' } else { '\n' });
            let from = self.code.len();
            continued = self.take_line().continues;
            if ends(&self.code[from..], end) {
                return;
            }
        }
        let is_end = |code: &str, _| ends(code, end);
        let name = opener.of(&self.text).trim().to_owned();
        block.faults.push(if is_whole && self.pass_over(is_end) {
            self.code.clear();
            Fault::new(
                Code::Fc206,
                opener,
                format!("the region from `{name}` to `{end}` has more than {MAX_REGION} bytes"),
            )
            .with_help("split it into several")
        } else {
            Fault::new(Code::Fc208, opener, format!("`{name}` has no `{end}`"))
                .with_help(format!("write `{end}` in a separate block"))
        });
    }
}

/// Returns a block that was parsed by hand.
#[inline]
fn plain_block<'a>(
    line: PhysicalLine<'a>,
    number: u32,
    comments: Comments,
    remark: Option<&'a Remark>,
) -> RawBlock<'a> {
    RawBlock {
        stretch: Stretch::Block,
        text: trimmed(line.text),
        line: number,
        offset: line.offset,
        comments,
        plain: true,
        remark,
    }
}

/// Returns whether a line begins with the command that ends a region.
fn ends(code: &str, end: &str) -> bool {
    opening_command(code).is_some_and(|command| command.name.name == end)
}

/// Returns FC101: a character that programs have only in comments and strings.
fn outside_ascii(span: Span, text: &str) -> Fault {
    let found = span.of(text);
    let blank = found.chars().find(|letter| letter.is_whitespace());
    let shown = blank.map_or_else(
        || found.to_owned(),
        |letter| format!("U+{:04X}", u32::from(letter)),
    );
    if let Some(control) = found.chars().next().filter(char::is_ascii) {
        let message = format!(
            "`U+{:04X}` is a control character within a block",
            u32::from(control)
        );
        let fault = Fault::new(Code::Fc101, span, message);
        return fault.with_help("delete it, or write a blank in its place");
    }
    let message =
        format!("`{shown}` is outside ASCII; programs are ASCII except in comments and strings");
    let fault = Fault::new(Code::Fc101, span, message);
    if blank.is_none() {
        return fault;
    }
    fault.with_help("it looks like a blank but is a different character; replace it with a blank")
}

/// Keeps the first faults of a block and says how many more there are. An error stays one.
fn cap_faults(faults: &mut Vec<Fault>) {
    if faults.len() <= MAX_FAULTS {
        return;
    }
    let is_error = |fault: &Fault| fault.code.severity() == Severity::Error;
    let rest = faults.split_off(MAX_FAULTS);
    let more = rest.len();
    let place = rest.first().map_or(Span::default(), |fault| fault.span);
    if !faults.iter().any(is_error) {
        faults.extend(rest.into_iter().find(is_error));
    }
    faults.push(Fault::new(
        Code::Fc905,
        place,
        format!(
            "the first {MAX_FAULTS} messages about this block are shown; there are {more} more"
        ),
    ));
}

/// Returns a line without the blanks at its end.
#[inline]
fn trimmed(line: &str) -> &str {
    let line = line.trim_ascii_end();
    if line.ends_with(is_blank) {
        // Characters left by editors are rare, so they are looked for only in lines that end in one.
        return line.trim_end_matches(is_blank);
    }
    line
}

fn too_long(line: &str) -> bool {
    line.len() > MAX_LINE && line.chars().count() > MAX_LINE
}

/// Returns `%NAME`, `% NAME`, `%L NAME` (R2.10). In the code a letter outside ASCII is a blank, and `foreign` is the
/// first: `%Läufer` is a main program.
fn program_line(code: &str, text: &str, after: &str, foreign: Option<Span>) -> Stretch {
    let separators = ['(', ';', '"', ']', ',', '#', '$'];
    let at = |part: &str| code.len() - part.len();
    let letter = foreign
        .filter(|span| !span.of(text).starts_with(char::is_whitespace))
        .map(|span| span.range().start);
    let rest = after.trim_start_matches(is_blank);
    let (local, name) = match rest.strip_prefix(['L', 'l']) {
        Some(name)
            if name.starts_with([' ', '\t']) && letter.is_none_or(|letter| letter > at(name)) =>
        {
            (true, name.trim_start_matches(is_blank))
        }
        _ => (false, rest),
    };
    let start = letter.map_or(at(name), |letter| letter.min(at(name)));
    let name = &text[start..];
    let ends = |c: char| separators.contains(&c) || is_blank(c) || c.is_whitespace();
    let length = name.find(ends).unwrap_or(name.len());
    Stretch::Program {
        name: Span::new(start, start + length),
        local,
    }
}
