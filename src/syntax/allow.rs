//! `; frictcomp: allow FC402 reason`: a user's statement that a message is known (R9.24).

use super::parse::Fault;
use crate::diagnostic::{Code, did_you_mean, nearest};
use crate::text::Span;

/// Mark of a comment addressed to this tool.
pub(crate) const MARK: &str = "frictcomp:";

/// The word that allows codes.
const ALLOW: &str = "allow";

/// Contents of a comment addressed to this tool.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub(crate) struct Allowance {
    /// The codes that it allows.
    pub(crate) codes: Vec<Code>,
    /// The reason that it gives.
    pub(crate) reason: Option<String>,
    /// Fault of the comment (FC491).
    pub(crate) fault: Option<AllowFault>,
}

/// Fault that keeps a comment from being understood.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct AllowFault {
    /// The word, or the mark where a word is missing.
    pub(crate) span: Span,
    /// The message in one sentence.
    pub(crate) message: String,
    /// Advice on it.
    pub(crate) help: Help,
}

/// Advice on the replacement of a word that is not understood.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum Help {
    /// Words of similar spelling.
    Near(Vec<&'static str>),
    /// The whole comment, in this form.
    How(&'static str),
}

/// A word after the mark.
struct AllowWord<'a> {
    text: &'a str,
    start: usize,
}

impl AllowWord<'_> {
    fn fault(&self, message: String, help: Help) -> AllowFault {
        AllowFault {
            span: Span::new(self.start, self.start + self.text.len()),
            message,
            help,
        }
    }
}

/// Reads a text addressed to this tool; the first word that is not a code and does not look like one begins
/// the reason.
pub(crate) fn allowed(text: &str) -> Allowance {
    let mut allowance = Allowance::default();
    let Some(mark) = text.find(MARK) else {
        return allowance;
    };
    let mut words = words(text, mark + MARK.len()).peekable();
    let Some(first) = words.next() else {
        return allowance;
    };
    if first.text != ALLOW {
        let near = did_you_mean(first.text, [ALLOW]).is_some();
        let speaks_of_code = words.peek().is_some_and(|word| looks_like_code(word.text));
        if near || speaks_of_code {
            let message = format!(
                "`{}` is not a word that frictcomp knows, so the code is not allowed",
                first.text
            );
            allowance.fault = Some(first.fault(message, Help::Near(vec![ALLOW])));
        }
        return allowance;
    }
    for word in words {
        let first = allowance.codes.is_empty() && allowance.fault.is_none();
        let code_like = looks_like_code(word.text);
        match word.text.parse() {
            Ok(code) => allowance.codes.push(code),
            Err(_) if first || code_like => {
                allowance.fault.get_or_insert_with(|| unknown(&word));
            }
            Err(_) => {
                allowance.reason = Some(reason(text, word.start).to_owned());
                break;
            }
        }
    }
    if allowance.codes.is_empty() && allowance.fault.is_none() {
        let message = "`allow` names no code".to_owned();
        allowance.fault = Some(first.fault(message, Help::How(HOW)));
    }
    allowance
}

/// Returns the text from a place to the end of its comment.
fn reason(text: &str, start: usize) -> &str {
    let rest = &text[start..];
    let opened = text[..start].rfind([';', '(']);
    let is_bracket = opened.is_some_and(|at| text[at..].starts_with('('));
    let ends = |letter: char| letter == '\n' || (is_bracket && letter == ')');
    rest.split(ends).next().unwrap_or(rest).trim_end()
}

/// Returns the comment of a text that is addressed to this tool, with the blanks before it, where it allows a single
/// code and nothing else of the text would go with it.
pub(crate) fn lone_comment(text: &str) -> Option<Span> {
    let mark = text.find(MARK)?;
    if allowed(text).codes.len() != 1 {
        return None;
    }
    let start = text[..mark].rfind([';', '('])?;
    let rest = &text[start..];
    let length = if rest.starts_with('(') {
        rest.find(')')? + 1
    } else {
        rest.find('\n').unwrap_or(rest.len())
    };
    let before = text[..start].trim_end_matches([' ', '\t']).len();
    Some(Span::new(before, start + length))
}

/// Returns the text that makes a line allow a code, and its place in the line.
pub(crate) fn insertion(line: &str, code: Code) -> (usize, String) {
    let known = line.find(MARK).and_then(|mark| {
        let first = words(line, mark + MARK.len()).next()?;
        (first.text == ALLOW).then_some(first.start + first.text.len())
    });
    match known {
        Some(after) => (after, format!(" {code}")),
        None => (line.trim_end().len(), format!(" ; {MARK} {ALLOW} {code}")),
    }
}

/// Returns the comment line above a block that allows a code.
pub(crate) fn line_above(code: Code) -> String {
    format!("; {MARK} {ALLOW} {code}\n")
}

/// Returns the fault of a comment line without a block directly below it: FC490, or FC491 where it is not
/// understood anyway.
pub(crate) fn lost(text: &str) -> Option<Fault> {
    let allowance = allowed(text);
    if let Some(fault) = allowance.fault {
        return Some(Fault::new(Code::Fc491, fault.span, fault.message));
    }
    let first = allowance.codes.first()?;
    let message = format!("`allow {first}` is not directly above a block, so it silences nothing");
    let fault = Fault::new(Code::Fc490, Span::new(0, text.len()), message);
    Some(fault.with_help("write it in the block, or on the line directly above it"))
}

/// Returns the words after a place, with their places.
fn words(text: &str, from: usize) -> impl Iterator<Item = AllowWord<'_>> {
    let separates = |letter: char| letter.is_whitespace() || matches!(letter, ',' | ')');
    let mut rest = from;
    std::iter::from_fn(move || {
        let after = text.get(rest..)?;
        let start = rest + after.find(|letter| !separates(letter))?;
        let length = text[start..].find(separates).unwrap_or(text.len() - start);
        rest = start + length;
        let text = &text[start..rest];
        Some(AllowWord { text, start })
    })
}

/// Returns whether a word resembles a code: letters of a code and a digit after them, as in `FC499`, `fc4O1`,
/// `P-ERR-1`.
fn looks_like_code(word: &str) -> bool {
    let upper = word.to_ascii_uppercase();
    let number = upper
        .strip_prefix("P-ERR-")
        .or_else(|| upper.strip_prefix("FC"));
    number.is_some_and(|number| number.starts_with(|letter: char| letter.is_ascii_digit()))
}

fn unknown(word: &AllowWord<'_>) -> AllowFault {
    let message = format!("`{}` is not a code, so it allows nothing", word.text);
    let codes = Code::ALL.iter().map(|code| code.as_str());
    let near = nearest(word.text, codes);
    let help = if near.is_empty() {
        Help::How(HOW)
    } else {
        Help::Near(near)
    };
    word.fault(message, help)
}

/// Form of the whole comment.
const HOW: &str = "write `frictcomp: allow`, the codes as the messages show them, and the reason";
