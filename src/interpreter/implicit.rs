//! Words that call a program: G80 to G89, G800 and on, M, T and D words (R2.14, R2.75).

use std::collections::BTreeMap;
use std::sync::Arc;

use super::at::At;
use super::block::Intent;
use super::call::Wanted;
use super::chain;
use super::run::Interpreter;
use super::unknown::Scan;
use super::value::Value;
use crate::diagnostic::Code;
use crate::syntax::Fault;
use crate::syntax::ast::{Block, CallScope, GCall, Hash};
use crate::text::Span;

/// What a word calls.
enum Configured {
    /// Nothing.
    None,
    /// A program.
    Program(String),
    /// A program, or none; the name depends on a value that only the machine knows.
    Unknown(Arc<str>),
}

impl Interpreter {
    /// The program for a word, `G80`, `M6`, else for its letter.
    fn configured(&self, letter: char, number: Option<i64>) -> Configured {
        let word = number.map(|number| format!("{letter}{number}"));
        let words = word.into_iter().chain([letter.to_string()]);
        for word in words {
            match self.state.named.get(&word) {
                Some(Value::Text(name)) if name.is_empty() => return Configured::None,
                Some(Value::Text(name)) => return Configured::Program(name.to_string()),
                Some(Value::Unknown(cause)) => return Configured::Unknown(cause.clone()),
                Some(Value::Number(_)) | None => {}
            }
            if let Some(name) = self.machine.programs.word(&word) {
                return Configured::Program(name.to_owned());
            }
        }
        Configured::None
    }

    /// Whether any word calls a program.
    #[inline]
    fn calls_by_words(&self) -> bool {
        !self.machine.programs.words.is_empty() || !self.state.named.is_empty()
    }

    /// An M, T or D word. A number that is not known offline may be any.
    pub(super) fn function_word(
        &mut self,
        (letter, number): (u8, Option<i64>),
        (span, at): (Span, &At<'_>),
        intent: &mut Intent,
    ) {
        if letter == b'M' {
            match number {
                None => return self.unknown_word("M", (span, at)),
                Some(number) if !chain::is_named_m(number) => {
                    let called = self.call_word(b'M', Some(number), (span, at), intent);
                    if !called && !self.machine.harmless.has_function(number) {
                        self.state.modal.note_transformed(&format!("M{number}"));
                    }
                    return;
                }
                Some(_) => {}
            }
        }
        if !self.calls_by_words() {
            return;
        }
        self.call_word(letter, number, (span, at), intent);
        if letter == b'T' && self.machine.programs.data_with_tool {
            // P-CHAN-00014: T selects the tool data, too.
            self.call_word(b'D', number, (span, at), intent);
        }
    }

    /// Calls what a word calls; whether there was anything.
    fn call_word(
        &mut self,
        letter: u8,
        number: Option<i64>,
        (span, at): (Span, &At<'_>),
        intent: &mut Intent,
    ) -> bool {
        match self.configured(char::from(letter), number) {
            Configured::None => return false,
            Configured::Program(name) => {
                let wanted = Wanted::program(CallScope::Global, name, at.in_block(span));
                intent.calls.push(wanted);
            }
            Configured::Unknown(cause) => self.unknown_program(&cause, (span, at)),
        }
        true
    }

    /// A word whose number is not known: it may call any program.
    pub(super) fn unknown_word(&mut self, letter: &str, (span, at): (Span, &At<'_>)) {
        self.forget_all(&letter.into());
        self.state.modal.note_transformed(letter);
        if self.work.unread.get() {
            return;
        }
        let fault = Fault::new(
            Code::Fc902,
            at.in_block(span),
            format!(
                "only the machine knows which {letter} function this is; it is passed over, \
                 everything that a program could change becomes unknown"
            ),
        );
        self.work.diagnostics.push(at.diagnostic(fault));
    }

    pub(super) fn unknown_program(&mut self, cause: &str, (span, at): (Span, &At<'_>)) {
        self.forget_all(&cause.into());
        let fault = Fault::new(
            Code::Fc902,
            at.in_block(span),
            format!("which program is called depends on {}; the call is passed over, and everything that a program could change becomes unknown", super::cause::unknown_value(cause)),
        )
        .with_help(super::cause::how_to_set(cause));
        self.work.diagnostics.push(at.diagnostic(fault));
    }

    /// A G function outside the groups: whether it calls a program.
    pub(super) fn g_program(
        &mut self,
        number: u32,
        (span, at): (Span, &At<'_>),
        intent: &mut Intent,
    ) -> bool {
        if self.calls_by_words()
            && self.call_word(b'G', Some(i64::from(number)), (span, at), intent)
        {
            return true;
        }
        if chain::is_implicit_call(number) {
            self.pass_over_implicit(number);
        } else if !chain::is_named_g(number) {
            self.state.modal.note_transformed(&format!("G{number}"));
        }
        false
    }

    /// An implicit call without a program (R2.82): it may have moved axes.
    fn pass_over_implicit(&mut self, number: u32) {
        self.state.modal.forget_positions();
        self.state.modal.note_transformed(&format!("G{number}"));
    }

    pub(super) fn g_call(
        &mut self,
        call: &GCall,
        block: &Block,
        at: &At<'_>,
        intent: &mut Intent,
    ) -> Result<(), Box<Fault>> {
        let mut own = BTreeMap::new();
        for (place, operand) in (1..).zip(&call.arguments) {
            if let Some(operand) = operand {
                own.insert(place, self.value(*operand, block, at)?);
            }
        }
        let number = i64::from(call.number);
        match self.configured('G', Some(number)) {
            Configured::Program(name) => {
                let wanted = Wanted::program(CallScope::Global, name, at.in_block(call.span));
                intent.calls.push(Wanted { own, ..wanted });
            }
            Configured::Unknown(cause) => self.unknown_program(&cause, (call.span, at)),
            Configured::None => {
                self.pass_over_implicit(call.number);
                self.pass_over(&format!("G{number}"), call.span, at);
            }
        }
        Ok(())
    }

    /// `#FILE NAME [ G80="part.nc" M6 "change.nc" ]` (PM/207504523).
    pub(super) fn name_programs(&mut self, hash: &Hash, at: &At<'_>) {
        for (word, name) in file_names(hash.rest.of(at.text)) {
            let value = match name {
                FileName::Written(name) => Value::Text(name.into()),
                FileName::Elsewhere(name) => self.named_elsewhere(name),
            };
            self.state.named.insert(word, value);
            self.work.wrote = true;
        }
    }

    /// The macros of the channel list, which no program takes away (TF5200 Programming manual,
    /// 208400267).
    pub(super) fn define_machine_macros(&mut self) {
        for (name, code) in &self.machine.programs.macros {
            self.state.memory.define_macro(name, code);
        }
    }

    /// The text of a variable, or that it is not known.
    fn named_elsewhere(&mut self, name: &str) -> Value {
        match self.state.memory.variable(name) {
            Some(value @ Value::Text(_)) => value,
            _ => Value::Unknown(name.into()),
        }
    }

    /// A word in a region that may or may not be executed.
    pub(super) fn forget_function(
        &mut self,
        (letter, number): (u8, Option<i64>),
        unit: usize,
        cause: &Arc<str>,
    ) {
        let letter = char::from(letter);
        let mut configured = vec![self.configured(letter, number)];
        if letter == 'T' && self.machine.programs.data_with_tool {
            configured.push(self.configured('D', number));
        }
        for configured in configured {
            match configured {
                Configured::None => {}
                Configured::Unknown(_) => self.forget_all(cause),
                Configured::Program(name) => self.pending.push(Scan {
                    call: Wanted::program(CallScope::Global, name, Span::default()),
                    cause: cause.clone(),
                    unit,
                    region: None,
                }),
            }
        }
        match (letter, number) {
            (_, Some(number)) => {
                let number = u32::try_from(number).unwrap_or(u32::MAX);
                let known = match letter {
                    'M' => chain::is_named_m(i64::from(number)),
                    'G' => {
                        super::Group::of(number).is_some()
                            || matches!(number, 20..=23 | 150 | 151)
                            || chain::is_named_g(number)
                    }
                    _ => true,
                };
                if letter == 'G' && chain::is_implicit_call(number) {
                    self.pass_over_implicit(number);
                } else if !known {
                    let word = format!("{letter}{number}");
                    self.state.modal.note_transformed(&word);
                }
            }
            ('M', None) => self.forget_all(cause),
            ('G', None) if self.calls_by_words() => self.forget_all(cause),
            (_, None) => {}
        }
    }
}

/// Whether a command names programs; the older manuals write one word.
pub(super) fn is_file_name(name: &str) -> bool {
    matches!(name, "#FILE NAME" | "#FILENAME")
}

/// The words that get a program after `#FILE NAME`.
pub(super) fn named_words(text: &str) -> impl Iterator<Item = String> {
    file_names(text).into_iter().map(|(word, _)| word)
}

/// The name of a program after `#FILE NAME`.
enum FileName<'a> {
    /// It stands there.
    Written(&'a str),
    /// It is the value of a variable, or of something that is not followed here.
    Elsewhere(&'a str),
}

/// The words and program names of `[ G80="part.nc" M6 "change.nc" ]`; the equals sign is optional.
fn file_names(text: &str) -> Vec<(String, FileName<'_>)> {
    let mut names = Vec::new();
    let mut rest = text.trim_start().strip_prefix('[').unwrap_or(text);
    loop {
        rest = rest.trim_start_matches([' ', '\t', '\n', ',', '\\']);
        let length = rest
            .find(|c: char| !c.is_ascii_alphanumeric() && c != '_')
            .unwrap_or(rest.len());
        if length == 0 {
            return names;
        }
        let (word, behind) = rest.split_at(length);
        let behind = behind.trim_start();
        let behind = behind.strip_prefix('=').unwrap_or(behind).trim_start();
        let word = crate::machine::canonical_word(word);
        if let Some((name, behind)) = behind.strip_prefix('"').and_then(|it| it.split_once('"')) {
            names.push((word, FileName::Written(name.trim())));
            rest = behind;
        } else {
            let end = behind
                .find([' ', '\t', '\n', ']', ','])
                .unwrap_or(behind.len());
            names.push((word, FileName::Elsewhere(&behind[..end])));
            rest = &behind[end..];
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn file_names_are_read_with_and_without_an_equals_sign() {
        // R2.75
        let shown = |text| {
            let names = file_names(text).into_iter();
            let names = names.map(|(word, name)| match name {
                FileName::Written(name) => format!("{word}={name}"),
                FileName::Elsewhere(name) => format!("{word}?{name}"),
            });
            names.collect::<Vec<_>>().join(" ")
        };
        let text = " [ G080=\"a b.nc\" m06 \"c.nc\",T = \"\" D=V.P.NAME ] (x)";
        assert_eq!(shown(text), "G80=a b.nc M6=c.nc T= D?V.P.NAME");
        assert_eq!(shown(""), "");
        assert_eq!(shown("[G80=\"open"), "G80?\"open");
    }
}
