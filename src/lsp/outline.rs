//! The names of a program: its subprograms and jump labels, where they stand and where they are used
//! (R12.6). A look over the text is enough for it.

use std::collections::BTreeMap;

use crate::text::{LineSource, Span, TextLines};

/// What has a name.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Name {
    /// `%NAME`, or `%L NAME` and `LL NAME`.
    Program(String),
    /// `[NAME]` or `N100:` with the program in which it holds, counted from 0.
    Label(usize, String),
    /// `L file.nc`.
    File(String),
}

/// Where a name stands.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Role {
    /// What has the name is here.
    Definition,
    /// It is called, or jumped to.
    Use,
}

/// A name in the text.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Mention {
    /// The name that is defined or used.
    pub(super) name: Name,
    /// What it does here.
    pub(super) role: Role,
    /// Where it stands.
    pub(super) span: Span,
}

/// Lines that can be folded, from 0.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Fold {
    /// The first.
    pub(super) first: u32,
    /// The last that is hidden.
    pub(super) last: u32,
}

/// The names and the structure of a program.
#[derive(Debug, Default)]
pub(super) struct Outline {
    /// Every name, in the order of the text.
    pub(super) mentions: Vec<Mention>,
    /// Programs and control blocks.
    pub(super) folds: Vec<Fold>,
}

/// Statements that open a control block, and those that close it.
const BLOCKS: [(&str, &str); 6] = [
    ("$IF", "$ENDIF"),
    ("$WHILE", "$ENDWHILE"),
    ("$FOR", "$ENDFOR"),
    ("$DO", "$ENDDO"),
    ("$REPEAT", "$UNTIL"),
    ("$SWITCH", "$ENDSWITCH"),
];

impl Outline {
    /// The outline of a text.
    pub(super) fn of(text: &str) -> Self {
        let mut outline = Self::default();
        let mut lines = TextLines::starting_at(text, 0);
        let (mut section, mut begin) = (0, None);
        let mut open: Vec<(&str, u32)> = Vec::new();
        let mut last = 0;
        for number in 0_u32.. {
            if !lines.advance() {
                break;
            }
            let line = lines.line();
            let code = without_comments(line.text);
            if code.trim_start().starts_with('%') {
                outline.fold(begin.replace(number), number);
                section += usize::from(number > 0);
            }
            outline.names(&code, (line.offset, section));
            let word = statement(&code);
            if let Some((_, close)) = BLOCKS.iter().find(|(open, _)| *open == word) {
                open.push((close, number));
            } else if let Some(at) = open.iter().rposition(|(close, _)| *close == word) {
                outline.fold(Some(open[at].1), number);
                open.truncate(at);
            }
            last = number;
        }
        outline.fold(begin, last.saturating_add(1));
        outline
    }

    /// The name at an offset of the text.
    pub(super) fn at(&self, offset: usize) -> Option<&Mention> {
        let mut mentions = self.mentions.iter();
        mentions.find(|it| it.span.range().contains(&offset) || it.span.end as usize == offset)
    }

    /// Every place of a name.
    pub(super) fn all<'a>(&'a self, name: &'a Name) -> impl Iterator<Item = &'a Mention> {
        self.mentions.iter().filter(move |it| it.name == *name)
    }

    /// Lines from one that begins something to the one before its end.
    fn fold(&mut self, first: Option<u32>, end: u32) {
        if let Some(first) = first
            && end > first + 1
        {
            self.folds.push(Fold {
                first,
                last: end - 1,
            });
        }
    }

    fn add(&mut self, (name, role): (Name, Role), (at, word): (usize, &str)) {
        let span = Span::new(at, at + word.len());
        self.mentions.push(Mention { name, role, span });
    }

    /// The names of a line without its comments, which begins at an offset of the text.
    fn names(&mut self, code: &str, (offset, section): (usize, usize)) {
        let trimmed = code.trim_start();
        if let Some(header) = trimmed.strip_prefix('%') {
            let header = match header.strip_prefix('L') {
                Some(rest) if rest.starts_with([' ', '\t']) => rest,
                _ => header,
            };
            let header = header.trim_start();
            let name = header.split([' ', '\t']).next().unwrap_or_default();
            if !name.is_empty() {
                let at = offset + code.len() - header.len();
                self.add(
                    (Name::Program(name.to_owned()), Role::Definition),
                    (at, name),
                );
            }
            return;
        }
        let mut words = words(code);
        words.retain(|(_, word)| !word.is_empty());
        let mut is_jump = false;
        for (at, (start, word)) in words.iter().enumerate() {
            let after = code[start + word.len()..].trim_start();
            let before = code[..*start].trim_end();
            let next = words
                .get(at + 1)
                .filter(|(next, _)| code[start + word.len()..*next].trim().is_empty());
            let place = (offset + start, *word);
            if *word == "LL" || *word == "L" {
                let Some((start, name)) =
                    next.filter(|(_, name)| *name != "CYCLE" && *name != "SEQUENCE")
                else {
                    continue;
                };
                let name = file_name(code, *start, name);
                let called = match *word {
                    "LL" => Name::Program(name.to_owned()),
                    _ => Name::File(name.to_owned()),
                };
                self.add((called, Role::Use), (offset + start, name));
            } else if *word == "GOTO" {
                is_jump = true;
            } else if let Some(number) = word.strip_prefix('N').filter(|it| is_number(it)) {
                let name = Name::Label(section, format!("N{}", number.trim_start_matches('0')));
                if is_jump {
                    self.add((name, Role::Use), place);
                } else if before.is_empty() && after.starts_with(':') {
                    self.add((name, Role::Definition), place);
                }
            } else if before.ends_with('[') && after.starts_with(']') {
                let opens = before[..before.len() - 1].trim_end();
                let name = Name::Label(section, (*word).to_owned());
                let is_block = opens.is_empty() || opens.strip_prefix('N').is_some_and(is_number);
                if is_jump || is_block {
                    let role = if is_jump { Role::Use } else { Role::Definition };
                    self.add((name, role), place);
                }
            }
        }
    }
}

/// The places of the definitions of names.
pub(super) fn definitions(outline: &Outline) -> BTreeMap<&Name, &Mention> {
    let mentions = outline.mentions.iter();
    let defined = mentions.filter(|it| it.role == Role::Definition);
    defined.map(|it| (&it.name, it)).collect()
}

/// A line with blanks in place of its comments and texts, byte by byte.
fn without_comments(line: &str) -> String {
    let (mut depth, mut is_text, mut ended) = (0_u32, false, false);
    let mut code = String::with_capacity(line.len());
    for letter in line.chars() {
        match letter {
            '"' if depth == 0 => is_text = !is_text,
            '(' if !is_text => depth += 1,
            ';' if depth == 0 && !is_text => ended = true,
            _ => {}
        }
        if depth > 0 || ended || !letter.is_ascii() {
            code.extend(std::iter::repeat_n(' ', letter.len_utf8()));
        } else {
            code.push(letter);
        }
        if letter == ')' && !is_text {
            depth = depth.saturating_sub(1);
        }
    }
    code
}

/// The words of letters, digits and `_`, each with its offset.
fn words(code: &str) -> Vec<(usize, &str)> {
    let mut offset = 0;
    let is_part = |letter: char| letter.is_ascii_alphanumeric() || letter == '_';
    let pieces = code.split(|letter: char| !is_part(letter));
    let words = pieces.map(|word| {
        let at = offset;
        offset += word.len() + 1;
        (at, word)
    });
    words.collect()
}

/// The name of a file, which may hold dots and slashes, from where its first word begins.
fn file_name<'a>(code: &'a str, start: usize, word: &'a str) -> &'a str {
    let rest = &code[start..];
    let is_part = |letter: char| letter.is_ascii_alphanumeric() || "_.-/\\".contains(letter);
    let end = rest.find(|letter: char| !is_part(letter));
    rest.get(..end.unwrap_or(rest.len())).unwrap_or(word)
}

fn is_number(text: &str) -> bool {
    !text.is_empty() && text.bytes().all(|byte| byte.is_ascii_digit())
}

/// The `$` statement of a line, in capital letters.
fn statement(code: &str) -> String {
    let Some(at) = code.find('$') else {
        return String::new();
    };
    let word = code[at + 1..].split(|letter: char| !letter.is_ascii_alphabetic());
    format!(
        "${}",
        word.into_iter()
            .next()
            .unwrap_or_default()
            .to_ascii_uppercase()
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    use Role::{Definition, Use};

    const TEXT: &str = "\
%MAIN (L none)
N10 $IF P1 == 1
N20 LL SUB
N30: G1 X1 ; LL other
[AGAIN] X2
N40 $GOTO [AGAIN]
N50 $ENDIF
N60 $GOTO N30
N70 L cycles/drill.nc
N80 M30
%L SUB
N30: M17
";

    #[test]
    fn names_are_found_where_they_stand() {
        // R12.6
        let outline = Outline::of(TEXT);
        let shown: Vec<_> = outline
            .mentions
            .iter()
            .map(|it| (it.span.of(TEXT), it.role, &it.name))
            .collect();
        let label = |section, name: &str| Name::Label(section, name.to_owned());
        let program = |name: &str| Name::Program(name.to_owned());
        assert_eq!(
            shown,
            [
                ("MAIN", Definition, &program("MAIN")),
                ("SUB", Use, &program("SUB")),
                ("N30", Definition, &label(0, "N30")),
                ("AGAIN", Definition, &label(0, "AGAIN")),
                ("AGAIN", Use, &label(0, "AGAIN")),
                ("N30", Use, &label(0, "N30")),
                (
                    "cycles/drill.nc",
                    Use,
                    &Name::File("cycles/drill.nc".to_owned())
                ),
                ("SUB", Definition, &program("SUB")),
                ("N30", Definition, &label(1, "N30")),
            ]
        );
        let at = TEXT.find("AGAIN] X2").expect("a label");
        assert_eq!(
            outline.at(at + 2).map(|it| &it.name),
            Some(&label(0, "AGAIN"))
        );
        assert_eq!(outline.all(&label(0, "N30")).count(), 2);
        assert_eq!(definitions(&outline).len(), 5);
    }

    #[test]
    fn programs_and_control_blocks_fold() {
        // R12.6
        let folds: Vec<_> = Outline::of(TEXT)
            .folds
            .iter()
            .map(|it| (it.first, it.last))
            .collect();
        assert_eq!(folds, [(1, 5), (0, 9), (10, 11)]);
        for text in [
            "",
            "\n",
            "%",
            "$ENDIF\n$IF\n",
            "LL",
            "\u{dc}[\u{dc}]:",
            "N:",
            "$GOTO",
        ] {
            let _ = Outline::of(text);
        }
    }
}
