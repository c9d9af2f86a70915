//! The names of a program: its subprograms and jump labels, with their definitions and uses
//! (R12.6).

use std::collections::BTreeMap;

use frictcomp::syntax::ast::Block;
use frictcomp::syntax::{
    BlockReader, ControlBlock, FastPath, Named, Part, RawBlock, Stretch, control_part, names_in,
};
use frictcomp::text::{LineIndex, Span, TextLines};

pub(super) use frictcomp::syntax::NameRole;

/// A name by its kind.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Name {
    /// `%NAME`, or `%L NAME` and `LL NAME`.
    Program(String),
    /// `[NAME]` or `N100:` with the program that it belongs to, counted from 0.
    Label(usize, String),
    /// `L file.nc`.
    File(String),
}

/// A name in the text.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Mention {
    /// The name that is defined or used.
    pub(super) name: Name,
    /// Role at this place.
    pub(super) role: NameRole,
    /// Span of the name.
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
pub(super) struct ProgramOutline {
    /// Every name, in the order of the text.
    pub(super) mentions: Vec<Mention>,
    /// Programs and control blocks.
    pub(super) folds: Vec<Fold>,
}

impl ProgramOutline {
    /// Returns the outline of a text.
    pub(super) fn of(text: &str) -> Self {
        let lines = LineIndex::new(text);
        let mut outline = Self::default();
        let mut reader = BlockReader::new(TextLines::new(text), lines.first(), FastPath::On);
        let mut block = Block::default();
        let (mut section, mut begin) = (0, None);
        let mut open: Vec<(ControlBlock, u32)> = Vec::new();
        while let Some(raw) = reader.next(&mut block) {
            let number = raw.line - lines.first();
            let span_of = |span: Span| {
                let place = |at: u32| place_in(&raw, at, |line| lines.line_span(text, line));
                Span::new(place(span.start), place(span.end))
            };
            match raw.stretch {
                Stretch::Program { name, .. } => {
                    outline.fold(begin.replace(number), number);
                    section += usize::from(number > 0);
                    let (role, shown) = (NameRole::Definition, name.of(raw.text).to_owned());
                    let (name, span) = (Name::Program(shown), span_of(name));
                    if span.start < span.end {
                        outline.mentions.push(Mention { name, role, span });
                    }
                }
                Stretch::Block => {
                    for found in names_in(&block, raw.text) {
                        let name = match found.named {
                            Named::Program => Name::Program(found.name),
                            Named::Label => Name::Label(section, found.name),
                            Named::File => Name::File(found.name),
                        };
                        let (role, span) = (found.role, span_of(found.span));
                        outline.mentions.push(Mention { name, role, span });
                    }
                }
            }
            for item in &block.items {
                match control_part(&block, item) {
                    Some((kind, Part::Opener)) => open.push((kind, number)),
                    Some((kind, Part::Closer)) => {
                        if let Some(at) = open.iter().rposition(|(opened, _)| *opened == kind) {
                            outline.fold(Some(open[at].1), number);
                            open.truncate(at);
                        }
                    }
                    Some((_, Part::Branch)) | None => {}
                }
            }
        }
        let ends_line = text.ends_with(['\n', '\r']);
        let count = lines.lines() - usize::from(ends_line);
        outline.fold(begin, u32::try_from(count).unwrap_or(u32::MAX));
        outline
    }

    /// Returns the name at an offset of the text.
    pub(super) fn at(&self, offset: usize) -> Option<&Mention> {
        let mut mentions = self.mentions.iter();
        mentions.find(|it| it.span.range().contains(&offset) || it.span.end as usize == offset)
    }

    /// Returns every place of a name.
    pub(super) fn all<'a>(&'a self, name: &'a Name) -> impl Iterator<Item = &'a Mention> {
        self.mentions.iter().filter(move |it| it.name == *name)
    }

    /// Folds the lines from the first one to the one before its end.
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
}

/// Returns the places of the definitions of names.
pub(super) fn definitions(outline: &ProgramOutline) -> BTreeMap<&Name, &Mention> {
    let mentions = outline.mentions.iter();
    let defined = mentions.filter(|it| it.role == NameRole::Definition);
    defined.map(|it| (&it.name, it)).collect()
}

/// Returns the offset in the text of an offset in a block, which drops only the line ends.
fn place_in(raw: &RawBlock<'_>, at: u32, line_span: impl Fn(u32) -> Span) -> usize {
    let before = &raw.text[..at as usize];
    let Some(end) = before.rfind('\n') else {
        return raw.offset + before.len();
    };
    let lines = before.bytes().filter(|byte| *byte == b'\n').count();
    let line = raw.line + u32::try_from(lines).unwrap_or(u32::MAX);
    line_span(line).range().start + before.len() - end - 1
}

#[cfg(test)]
mod tests {
    use super::*;

    use NameRole::{Definition, Use};

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
        let outline = ProgramOutline::of(TEXT);
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

    /// Returns the names in the order of the text, definitions with a colon, files with an exclamation mark.
    fn mentions(text: &str) -> String {
        let shown = ProgramOutline::of(text).mentions.into_iter().map(|it| {
            let mark = if it.role == Definition { ":" } else { "" };
            let name = match it.name {
                Name::Program(name) => format!("%{name}"),
                Name::Label(_, name) => name,
                Name::File(name) => format!("{name}!"),
            };
            let written = it.span.of(text).replace("N0", "N");
            assert!(name.contains(&written), "{text}: {written}");
            name + mark
        });
        shown.collect::<Vec<_>>().join(" ")
    }

    #[test]
    fn names_are_those_that_the_parser_reads() {
        // R12.6
        for (text, names) in [
            ("n10 ll sub", "%sub"),
            ("l a.nc", "a.nc!"),
            ("N10LL SUB", "%SUB"),
            ("LUP1.nc", "UP1.nc!"),
            ("L4712", "4712!"),
            ("L \"my part.nc\"", "my part.nc!"),
            ("LL CYCLE [NAME=DRILL @P1=1]", "%DRILL"),
            ("#MSG [\"LL SUB\"]", ""),
            ("V.P.A = \"\\\"[A] LL SUB\"", ""),
            ("X1 (LL SUB)", ""),
            ("V.P.A=\"(\" LL SUB", "%SUB"),
            ("#COMMENT BEGIN\nLL SUB\n[A]\n#COMMENT END\n[B]", "B:"),
            ("$goto [A]", "A"),
            ("$GOTON030", "N30"),
            ("$IF P1 == 1 $GOTO N30:", "N30"),
            ("N030 : X1", "N30:"),
            ("L SEQUENCE [N10 [A]]", "N10 A"),
            ("L SEQUENCE [NAME=a.nc N10]", "a.nc!"),
            ("%l SUB ; LL A", "%SUB:"),
            ("  %L SUB\r\nLL \\\r\n  SUB", "%SUB: %SUB"),
            ("P1 = V.P.A[N] X[COMP ON FRICT]", ""),
            ("LL V.P.NAME", ""),
        ] {
            assert_eq!(mentions(text), names, "{text}");
        }
    }

    #[test]
    fn folds_are_those_of_the_parser() {
        // R12.6
        let folds = |text: &str| {
            let folds = ProgramOutline::of(text).folds.into_iter();
            folds.map(|it| (it.first, it.last)).collect::<Vec<_>>()
        };
        for (text, lines) in [
            ("#MSG [\"$IF\"]\n\nX1\n$ENDIF\n", vec![]),
            ("$IF P1 $GOTO N10\n\nX1\n$ENDIF\n", vec![]),
            ("#if P1\nX1\n#endif\n", vec![(0, 1)]),
            ("#RT WHILE P1\nX1\n#RT ENDWHILE\n", vec![(0, 1)]),
            ("N10 $while P1 ; $FOR\nX1\nX2\n$EndWhile\n", vec![(0, 2)]),
            ("#COMMENT BEGIN\n$IF\n#COMMENT END\nX1\n$ENDIF\n", vec![]),
            ("$IF P1 \\\n > 2\nX1\n$ENDIF", vec![(0, 2)]),
        ] {
            assert_eq!(folds(text), lines, "{text}");
        }
    }

    #[test]
    fn programs_and_control_blocks_fold() {
        // R12.6
        let folds: Vec<_> = ProgramOutline::of(TEXT)
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
            let _ = ProgramOutline::of(text);
        }
    }
}
