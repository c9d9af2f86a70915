//! The words of a COMP bracket: which kinds, switched how (R1.1 to R1.6).

use super::keywords::in_upper_case;
use super::parse::Fault;
use crate::comp::{CompCommand, Kind, KindSet, Selection};
use crate::diagnostic::{Code, nearest};
use crate::text::Span;

/// The words that may follow `COMP` in its bracket.
const KEYWORDS: [&str; 11] = [
    "ON",
    "OFF",
    "OFF_ALL",
    "NO_MOVE",
    "BACKLASH",
    "CROSS",
    "PLANE",
    "LEAD",
    "TEMP",
    "FRICT",
    "CROSSTALK",
];

/// The words of a bracket whose first keyword is COMP, as spans into the block's text.
pub(super) struct CompWords<'a> {
    pub(super) text: &'a str,
    pub(super) axis: Span,
    /// Span from the axis name to the closing bracket.
    pub(super) whole: Span,
    /// `COMP` and everything after it.
    pub(super) words: &'a [Span],
}

impl CompWords<'_> {
    /// Reads the command. Mistakes go into `faults`; a command that the control would refuse is
    /// `None`.
    pub(super) fn lower(&self, faults: &mut Vec<Fault>) -> Option<CompCommand> {
        self.lint_case(faults);
        let mut selection: Option<(Span, &str)> = None;
        let mut kinds = KindSet::NONE;
        let mut no_move = false;
        let mut repeated = false;
        for &span in &self.words[1..] {
            let word = span.of(self.text);
            let upper = word.to_ascii_uppercase();
            match upper.as_str() {
                "ON" | "OFF" | "OFF_ALL" => {
                    if let Some((_, first)) = selection {
                        faults.push(second_selection(span, word, first));
                        return None;
                    }
                    if !kinds.is_empty() {
                        faults.push(self.incomplete("a kind comes before `ON` or `OFF`"));
                        return None;
                    }
                    selection = Some((span, word));
                }
                "NO_MOVE" => no_move = true,
                _ => match (word.parse::<Kind>(), selection) {
                    (Ok(kind), Some((_, by))) if by.eq_ignore_ascii_case("OFF_ALL") => {
                        faults.push(kind_after_off_all(span, kind));
                        return None;
                    }
                    (Ok(kind), _) => {
                        if kinds.contains(kind) && !repeated {
                            repeated = true;
                            faults.push(named_twice(span, kind));
                        }
                        kinds.insert(kind);
                    }
                    (Err(_), _) => {
                        faults.push(match (upper.replace('_', "").as_str(), selection) {
                            ("ALL", Some((off, by))) if by.eq_ignore_ascii_case("OFF") => {
                                let both = off.to(span);
                                unknown_word(span, word).with_near(both, &["OFF_ALL"])
                            }
                            ("ALLOFF", _) => unknown_word(span, word).with_near(span, &["OFF_ALL"]),
                            ("ALL" | "ONALL" | "ALLON", _) => every_kind(span, word),
                            _ => unknown_word(span, word),
                        });
                        return None;
                    }
                },
            }
        }
        let selection = match selection {
            None if kinds.is_empty() => {
                faults.push(self.incomplete("nothing follows `COMP`"));
                return None;
            }
            None => {
                faults.push(self.incomplete("neither `ON` nor `OFF` follows `COMP`"));
                return None;
            }
            Some((_, by)) if by.eq_ignore_ascii_case("OFF_ALL") => Selection::OffAll,
            Some((_, by)) if kinds.is_empty() => {
                let found = format!("no kind follows `{by}`");
                faults.push(self.incomplete(&found));
                return None;
            }
            Some((_, by)) if by.eq_ignore_ascii_case("ON") => Selection::On(kinds),
            Some(_) => Selection::Off(kinds),
        };
        Some(CompCommand {
            axis: self.axis.of(self.text).to_owned(),
            selection,
            no_move,
            span: self.whole,
        })
    }

    /// Remarks once per bracket on its first word that is not in upper case (R1.8).
    fn lint_case(&self, faults: &mut Vec<Fault>) {
        let known = |word: &str| {
            word.eq_ignore_ascii_case("COMP")
                || KEYWORDS.iter().any(|k| k.eq_ignore_ascii_case(word))
        };
        let lower = self.words.iter().copied().filter(|span| {
            let word = span.of(self.text);
            known(word) && word.bytes().any(|byte| byte.is_ascii_lowercase())
        });
        let lower: Vec<Span> = lower.collect();
        if let (Some(span), Some(fix)) = (lower.first(), in_upper_case(self.text, &lower)) {
            let word = span.of(self.text);
            faults.push(
                Fault::new(
                    Code::Fc404,
                    *span,
                    format!("keyword `{word}` is not in upper case"),
                )
                .with_help(format!("write `{}`", word.to_ascii_uppercase()))
                .with_fix(fix),
            );
        }
    }

    fn incomplete(&self, found: &str) -> Fault {
        let axis = self.axis.of(self.text);
        Fault::new(
            Code::Fc201,
            self.whole,
            format!("incomplete COMP command: {found}"),
        )
        .with_help(format!(
            "write `{axis}[COMP ON FRICT]`, `{axis}[COMP OFF FRICT]` or `{axis}[COMP OFF_ALL]`"
        ))
    }
}

/// Returns the end of a COMP command whose bracket is not closed: after the last of its words.
pub(super) fn end_of_command(code: &str, start: usize) -> Option<usize> {
    let is_letter = |letter: char| letter.is_ascii_alphabetic() || letter == '_';
    let mut end = None;
    let mut at = start;
    for count in 0.. {
        let rest = code.get(at..)?;
        let word_start = at
            + rest
                .find(|letter| letter != ' ' && letter != '\t')
                .unwrap_or(rest.len());
        let rest = &code[word_start..];
        let word = &rest[..rest.find(|letter| !is_letter(letter)).unwrap_or(rest.len())];
        let known = match count {
            0 => word.eq_ignore_ascii_case("COMP"),
            _ => KEYWORDS
                .iter()
                .any(|keyword| keyword.eq_ignore_ascii_case(word)),
        };
        if !known {
            break;
        }
        at = word_start + word.len();
        end = (count > 0).then_some(at);
    }
    end
}

fn second_selection(span: Span, word: &str, first: &str) -> Fault {
    Fault::new(
        Code::Fc204,
        span,
        format!("`{word}` after `{first}`: a bracket has one selection"),
    )
    .with_help("give each selection its own bracket, `X[COMP ON FRICT] X[COMP OFF LEAD]`")
}

fn kind_after_off_all(span: Span, kind: Kind) -> Fault {
    let keyword = kind.as_str();
    Fault::new(
        Code::Fc203,
        span,
        format!("kind `{keyword}` after `OFF_ALL`, which takes no kind"),
    )
    .with_help(format!(
        "write `OFF {keyword}` for this kind alone, `OFF_ALL` alone for every kind"
    ))
}

fn named_twice(span: Span, kind: Kind) -> Fault {
    let keyword = kind.as_str();
    Fault::new(
        Code::Fc406,
        span,
        format!("kind `{keyword}` is named twice in this bracket; it counts once"),
    )
}

fn unknown_word(span: Span, word: &str) -> Fault {
    let kinds = Kind::ALL.map(Kind::as_str).join(", ");
    let fault = Fault::new(
        Code::Fc202,
        span,
        format!("unknown compensation kind `{word}`"),
    );
    if word.contains(',') {
        return fault.with_help("separate the kinds with blanks, not commas");
    }
    let near = meant(word);
    if near.is_empty() {
        return fault.with_help(format!("the kinds are {kinds}"));
    }
    fault.with_near(span, &near)
}

/// Returns `ON_ALL`: only `OFF_ALL` is about every kind (R1.3, R18.7).
fn every_kind(span: Span, word: &str) -> Fault {
    let kinds = Kind::ALL.map(Kind::as_str).join(", ");
    let message = format!("`{word}` does not exist: `ON` takes each kind by its name");
    Fault::new(Code::Fc202, span, message).with_help(format!(
        "name the kinds to switch on, as in `ON FRICT`: {kinds}"
    ))
}

/// Returns the keywords that a word may mean. Of the selections only one whose own letter the word has, `F` or `N`: no
/// slip of the pen turns a selection into its opposite (R1.60).
fn meant(word: &str) -> Vec<&'static str> {
    let near = nearest(word, KEYWORDS);
    let is_off = |word: &&str| word.starts_with("OFF");
    if !near.iter().any(|word| is_off(word) || *word == "ON") {
        return near;
    }
    let upper = word.to_ascii_uppercase();
    let open = vec!["ON", "OFF"];
    match (upper.contains('N'), upper.contains('F')) {
        // A swapped `ON`, or the word for not.
        (true, false) if upper == "NO" => open,
        (true, false) => nearest(word, KEYWORDS.into_iter().filter(|word| !is_off(word))),
        (false, true) => nearest(word, KEYWORDS.into_iter().filter(|word| *word != "ON")),
        (true, true) if !upper.starts_with("ON") => near,
        _ => open,
    }
}
