//! `#` commands, with the declarations of `#VAR`.

use pest::Parser;
use pest::iterators::Pair;

use super::block::{BlockLowering, not_closed, not_understood, span_of, trimmed};
use crate::diagnostic::{Code, nearest};
use crate::language::{
    BlockSharing, FurtherWord, HashAction, HashArguments, HashCommand, HashWords, Touches,
};
use crate::syntax::ast::{BracketArguments, Declaration, Effect, Hash, Item, Operand, Target};
use crate::syntax::expression;
use crate::syntax::grammar::{NcParser, Rule};
use crate::syntax::keywords::{
    CommandName, command_name, goes_on, hash_name, not_known, opening_command,
};
use crate::syntax::parse::Fault;
use crate::syntax::pieces::is_blank;
use crate::text::Span;

impl BlockLowering<'_> {
    /// Words before a `#` command, which must be alone in its block (R2.47; TF5200 Diagnosis, error 20207).
    pub(super) fn words_before(&mut self, span: Span) {
        let words = self.block.words.iter().map(|word| word.span);
        let items = self.block.items.iter();
        let items = items.filter(|item| !matches!(item, Item::Label(_) | Item::Flow(..)));
        let Some(first) = words.chain(items.map(Item::span)).next() else {
            return;
        };
        let found = command_name(span.of(self.code));
        let is_alone = |command: HashWords| command.sharing == BlockSharing::None;
        if found.command.is_some_and(is_alone) {
            let words = Span::new(first.start as usize, span.start as usize);
            self.beside(&format!("`{}`", found.name), words);
            self.block.items.sort_by_key(|item| item.span().start);
        }
    }

    /// Adds a command that may be among words.
    pub(super) fn hash_word(&mut self, span: Span) {
        self.hash(span);
        if let Some(Item::Hash(hash)) = self.block.items.last_mut() {
            hash.sharing = BlockSharing::Words;
        }
    }

    pub(super) fn hash(&mut self, span: Span) {
        let code = span.of(self.code);
        let CommandName {
            name,
            length,
            command,
        } = command_name(code);
        let name_end = span.start as usize + length;
        self.note_case(Span::new(span.start as usize, name_end));
        let command = command.filter(|_| !goes_on(code, &name));
        let Some(command) = command else {
            let (name, length) = hash_name(code);
            return self.unknown_hash(&name, length, span);
        };
        let behind = Span::new(name_end, span.end as usize);
        let is_region = command.region_end().is_some();
        let rest = if is_region {
            behind
        } else {
            self.arguments(command, behind)
        };
        // A correctly opened comment is not a block (R2.6).
        if command.action == HashAction::Comment && rest.end == span.end {
            return self.beside("other words", span);
        }
        self.command((command, name.clone()), rest, span);
        if is_region {
            self.region_end(rest);
        } else {
            let behind = Span::new(rest.end as usize, span.end as usize);
            self.beside(&format!("`{name}`"), behind);
        }
    }

    fn command(&mut self, (command, name): (HashWords, String), rest: Span, span: Span) {
        let arguments = match command.arguments {
            HashArguments::Expressions => self.expressions_in(rest),
            HashArguments::RemedyClass => self.remedy_class(rest).into_iter().collect(),
            _ => Vec::new(),
        };
        let declarations = match command.arguments {
            HashArguments::Declarations => self.declarations(rest),
            _ => Vec::new(),
        };
        let brackets = if command.reads_brackets() {
            self.arguments_in(rest)
        } else {
            BracketArguments::default()
        };
        let written = match command.touches {
            Touches::Values => self.places_in(rest),
            _ => Vec::new(),
        };
        self.block.items.push(Item::Hash(Hash {
            command,
            name,
            sharing: command.sharing,
            brackets,
            rest,
            arguments,
            declarations,
            written,
            span: Span::new(span.start as usize, rest.end as usize),
        }));
    }

    /// Returns the arguments at the start of the text after the words of a command.
    fn arguments(&self, command: HashWords, behind: Span) -> Span {
        let is_argument = |pair: &Pair<'_, Rule>| match pair.as_rule() {
            Rule::hash_coordinate => command.arguments == HashArguments::Coordinates,
            Rule::hash_further => FurtherWord::of(pair.as_str()).is_some(),
            _ => true,
        };
        let read = NcParser::parse(Rule::hash_arguments, behind.of(self.read));
        let pairs = read.into_iter().flatten().flat_map(Pair::into_inner);
        let last = pairs.take_while(is_argument).last();
        let length = last.map_or(0, |pair| pair.as_span().end());
        let start = behind.start as usize;
        trimmed(Span::new(start, start + length), self.code)
    }

    /// Reports text in the same block as a command, which must be alone there (R2.47): the control may execute it.
    fn beside(&mut self, what: &str, span: Span) {
        let text = span.of(self.code);
        let from = span.start as usize + text.len() - text.trim_start_matches(is_blank).len();
        let span = trimmed(Span::new(from, span.end as usize), self.code);
        if span.start == span.end {
            return;
        }
        if let Some(at) = self.unclosed.take() {
            return self.refuse(not_closed(at), span);
        }
        let shown: String = span.of(self.code).chars().take(40).collect();
        let message = format!(
            "`{shown}` is in the same block as {what}; whether the control executes it is not known, and whatever it \
             could change is unknown from here on"
        );
        let fault = Fault::new(Code::Fc210, span, message)
            .with_help("write it in a separate block: a `#` command must be alone in its block");
        self.block.faults.push(fault);
        self.block
            .items
            .push(Item::Unread(Effect::Everything, span));
    }

    /// Checks that the command that ends a region is alone, too.
    fn region_end(&mut self, region: Span) {
        let text = region.of(self.code);
        let Some(start) = text.rfind('\n') else {
            return;
        };
        let command = opening_command(&text[start..]).filter(|command| !command.is_alone());
        if let Some(command) = command {
            let end = region.end as usize;
            self.beside(
                &format!("`{}`", command.name.name),
                Span::new(end - command.rest.len(), end),
            );
        }
    }

    /// Records a `#` command that is in no table: it could do anything (R2.70).
    fn unknown_hash(&mut self, name: &str, length: usize, span: Span) {
        let mut fault = not_known(name, span);
        let start = span.start as usize;
        let near = nearest(name, HashCommand::all_words());
        fault = fault.with_near(Span::new(start, start + length), &near);
        fault = fault.with_help(format!(
            "if it affects nothing that frictcomp follows, add `harmless = [\"{name}\"]` to `[machine]` in frictcomp.toml"
        ));
        self.block.faults.push(fault);
        self.block
            .items
            .push(Item::Unread(Effect::Everything, span));
        // A user who says that the command does nothing says so of its own arguments only.
        let code = span.of(self.code);
        if let Some(other) = other_command(&code[1..]) {
            let (own, _) = hash_name(&code[..=other]);
            let behind = Span::new(start + 1 + other, span.end as usize);
            self.beside(&format!("`{own}`"), behind);
        }
    }

    fn expressions_in(&mut self, rest: Span) -> Vec<Operand> {
        let Ok(pairs) = NcParser::parse(Rule::spaced_expressions, rest.of(self.read)) else {
            return Vec::new();
        };
        let values = pairs.flat_map(Pair::into_inner);
        values
            .map(|value| expression::lower(value, rest.start, self.block))
            .collect()
    }

    /// Returns the value of `RC` among the words of `#ERROR`.
    fn remedy_class(&mut self, rest: Span) -> Option<Operand> {
        let words = NcParser::parse(Rule::error_words, rest.of(self.read)).ok()?;
        let mut words = words.flat_map(Pair::into_inner);
        let class = words.find(|word| word.as_rule() == Rule::error_class)?;
        let value = class.into_inner().next()?;
        Some(expression::lower(value, rest.start, self.block))
    }

    /// Returns the parameters and variables that a text names.
    fn places_in(&mut self, rest: Span) -> Vec<Target> {
        let text = rest.of(self.read);
        let mut places = Vec::new();
        let mut from = 0;
        while let Some(start) = next_place(text, from) {
            let found = NcParser::parse(Rule::written_place, &text[start..]).ok();
            let pair = found.and_then(|mut pairs| pairs.next()?.into_inner().next());
            from = start + pair.as_ref().map_or(1, |pair| pair.as_str().len());
            if let Some(pair) = pair {
                let base = rest.start + Span::new(start, start).start;
                let span = trimmed(span_of(&pair).shifted(base), self.code);
                let place = expression::place(pair, base, self.block);
                places.push(Target { place, span });
            }
        }
        places
    }
}

/// Returns where the arguments of an unknown command end and something begins that the control would execute: a COMP
/// command, a call, a jump, a macro or another command.
fn other_command(text: &str) -> Option<usize> {
    let mut depth = 0_u32;
    let mut word = 0;
    for (at, letter) in text.char_indices() {
        let before = text[..at].chars().next_back();
        let is_in_word = |it: char| it.is_ascii_alphanumeric() || it == '_';
        if is_in_word(letter) && !before.is_some_and(is_in_word) {
            word = at;
            let rest = &text[at..];
            let name = rest.trim_start_matches(['L', 'l']);
            let calls = matches!(rest.len() - name.len(), 1 | 2)
                && name
                    .trim_start_matches(is_blank)
                    .starts_with(|it: char| it.is_alphabetic() || it == '"')
                && name.starts_with(|it: char| is_blank(it) || it == '"');
            if depth == 0 && calls {
                return Some(at);
            }
        }
        match letter {
            '[' => {
                let inner = text[at + 1..].trim_start_matches(is_blank);
                if inner
                    .get(..4)
                    .is_some_and(|it| it.eq_ignore_ascii_case("COMP"))
                {
                    return Some(word);
                }
                depth += 1;
            }
            ']' => depth = depth.saturating_sub(1),
            '$' | '"' if depth == 0 => return Some(at),
            '#' if depth == 0
                && text[at + 1..].starts_with(|it: char| it.is_ascii_alphabetic()) =>
            {
                return Some(at);
            }
            _ => {}
        }
    }
    None
}

/// Returns the start of the next name that may be one of a parameter or variable.
fn next_place(text: &str, from: usize) -> Option<usize> {
    let bytes = text.as_bytes();
    let begins = |at: &usize| {
        let alone = *at == 0 || !(bytes[at - 1].is_ascii_alphanumeric() || bytes[at - 1] == b'_');
        alone && matches!(bytes[*at], b'P' | b'p' | b'V' | b'v' | b'@')
    };
    (from..bytes.len()).find(begins)
}

impl BlockLowering<'_> {
    pub(super) fn declarations(&mut self, rest: Span) -> Vec<Declaration> {
        let mut declarations = Vec::new();
        let mut start = rest.start as usize;
        let mut left = rest.of(self.code);
        let read = self.read;
        let last_bracket = start + left.rfind(']').unwrap_or_default();
        while !left.is_empty() {
            let line = &left[..declaration_end(left, last_bracket.saturating_sub(start))];
            left = left.get(line.len() + 1..).unwrap_or_default();
            let span = Span::new(start, start + line.len());
            start += line.len() + 1;
            let code = line.trim_matches(is_blank);
            if code.is_empty() {
                continue;
            }
            if opening_command(line).is_some() {
                continue;
            }
            if let Ok(pairs) = NcParser::parse(Rule::declaration_line, span.of(read)) {
                let parts = pairs
                    .flat_map(Pair::into_inner)
                    .filter_map(|part| (part.as_rule() == Rule::declaration).then_some(part));
                for part in parts {
                    declarations.extend(self.declaration(part, span.start));
                }
            } else {
                let fault = not_understood(trimmed(span, self.code), self.code)
                    .with_help("declare as in `V.P.COUNT : UNS32 = 3`");
                self.block.faults.push(fault);
            }
        }
        declarations
    }

    fn declaration(&mut self, pair: Pair<'_, Rule>, base: u32) -> Option<Declaration> {
        let mut target = None;
        let (mut kind, mut length) = (None, None);
        let mut initial = Vec::new();
        for part in pair.into_inner() {
            match part.as_rule() {
                Rule::variable_or_array => {
                    let span = trimmed(span_of(&part).shifted(base), self.code);
                    let place = expression::place(part, base, self.block);
                    target = Some(Target { place, span });
                }
                Rule::type_name => {
                    let mut parts = part.into_inner();
                    kind = parts.next().map(|word| word.as_str().to_ascii_uppercase());
                    let number = parts.next();
                    length = number.map(|number| expression::lower(number, base, self.block));
                }
                Rule::initial => self.initial(part, base, &mut initial),
                _ => {}
            }
        }
        Some(Declaration {
            target: target?,
            kind,
            length,
            initial,
        })
    }

    /// Adds initial values in row order; nested brackets only group them.
    fn initial(&mut self, pair: Pair<'_, Rule>, base: u32, values: &mut Vec<Operand>) {
        for part in pair.into_inner() {
            match part.as_rule() {
                Rule::expression => values.push(expression::lower(part, base, self.block)),
                _ => self.initial(part, base, values),
            }
        }
    }
}

/// Returns the length of the first declaration of a region: one line, or more where a bracket stays open, as
/// the values of an array may. A bracket after the last `]` is never closed and ends with its line.
fn declaration_end(text: &str, last_bracket: usize) -> usize {
    let mut depth = 0_usize;
    for (at, byte) in text.bytes().enumerate() {
        match byte {
            b'[' => depth += 1,
            b']' => depth = depth.saturating_sub(1),
            b'\n' if depth == 0 || at > last_bracket => return at,
            _ => {}
        }
    }
    text.len()
}
