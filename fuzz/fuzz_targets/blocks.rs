//! Blocks: the fast path yields the tree of the grammar, and every span lies in its block.
#![no_main]

use frictcomp::syntax::{BlockReader, FastPath, RawBlock, ast::Block};
use frictcomp::text::{Span, TextLines};
use frictcomp_fuzz::{Profile, text_of};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|input: &[u8]| {
    let Some(text) = text_of(input, &Profile::HOSTILE) else {
        return;
    };
    let reader = |path| BlockReader::new(TextLines::new(&text), 1, path);
    let (mut fast, mut grammar) = (reader(FastPath::On), reader(FastPath::Off));
    let (mut one, mut other) = (Block::default(), Block::default());
    loop {
        let (found, expected) = (fast.next(&mut one), grammar.next(&mut other));
        let (Some(raw), Some(meant)) = (found, expected) else {
            assert!(found.is_none() && expected.is_none());
            return;
        };
        let place = |raw: &RawBlock<'_>| (raw.stretch, raw.line, raw.offset);
        assert_eq!(place(&raw), place(&meant));
        assert_eq!((raw.text, raw.remark), (meant.text, meant.remark));
        // An invalid number is NaN, and equals nothing.
        assert!(
            one == other || format!("{one:?}") == format!("{other:?}"),
            "{one:#?}\n{other:#?}"
        );
        let inside = |span: &Span| assert!(raw.text.get(span.range()).is_some(), "{span:?}");
        one.spans.iter().for_each(inside);
        one.words.iter().for_each(|word| inside(&word.span));
        one.items.iter().for_each(|item| inside(&item.span()));
        one.faults.iter().for_each(|fault| inside(&fault.span));
    }
});
