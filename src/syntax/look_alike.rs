//! Texts that read as NC programs, whatever their files are called (R18.5).

use super::ast::{Address, Block, Item};
use super::lines::{BlockReader, FastPath};
use super::no_program::no_program;
use super::raw::Stretch;
use crate::text::TextLines;

/// Number of blocks at the head of a text that are looked at.
const MAX_BLOCKS: usize = 400;

/// Number of blocks after which a text that hardly has any is given up.
const FIRST_BLOCKS: usize = 24;

/// Whether more than two thirds of the lines at the head of a text are blocks, and one of them is of a kind that only NC programs have: R2.97
/// turned round.
pub fn reads_as_program(text: &str) -> bool {
    if no_program(text).is_some() {
        return false;
    }
    let mut reader = BlockReader::new(TextLines::new(text), 1, FastPath::On);
    let mut block = Block::default();
    let (mut all, mut good, mut is_told) = (0, 0, false);
    while let Some(raw) = reader.next(&mut block) {
        if raw.text.starts_with("```") {
            return false;
        }
        if raw.stretch != Stretch::Block {
            continue;
        }
        all += 1;
        if block.faults.is_empty() {
            good += 1;
            is_told |= tells(&block);
        }
        if all == MAX_BLOCKS || (all == FIRST_BLOCKS && good * 4 < all) {
            break;
        }
    }
    is_told && good * 3 > all * 2
}

/// Whether other texts hardly have such a block: a block number, a G or M function, a command, a statement.
fn tells(block: &Block) -> bool {
    let is_function = |address: &Address| matches!(address, Address::Letter(b'G' | b'M'));
    block.number.is_some()
        || block.words.iter().any(|word| is_function(&word.address))
        || block.items.iter().any(|item| match item {
            Item::Word(word) => is_function(&word.address),
            Item::Comp(_) | Item::Bracket { .. } | Item::Flow(..) | Item::Hash(_) => true,
            _ => false,
        })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn programs_are_known_by_their_blocks() {
        // R18.5
        for text in [
            "X[COMP OFF FRICT]\r\nG1 X5 F100\r\nM30\r\n",
            "; a part\n%PART\n\nN10 G0 X0 Y0\nN20 L SUB.nc\nsomething else\nN30 M30\n",
            "$IF P1 == 1\nX5\n$ENDIF\n",
            "M17",
            "[LOOP]\nP1 = P1 + 1\nX=P1\n$GOTO [LOOP]\n",
        ] {
            assert!(reads_as_program(text), "{text}");
        }
        for text in [
            "",
            "; only a comment\n",
            "# Title\n\nThe axis is switched by a command:\n\n```nc\nX[COMP OFF FRICT]\nM30\n```\n\nThen it moves.\nMore text.\n",
            "```nc\nX[COMP OFF FRICT]\nX1\nX2\nM30\n```\n",
            "An example follows.\nIt ends the program.\nX[COMP OFF FRICT]\nG1 X5\nM30\n",
            "t,line,X\n0.000,2,0\n0.001,2,1\n",
            "0.000 2 0\n0.001 2 1\n",
            "Dear colleague,\nG54 is set. M30 ends it.\nRegards\n",
            "PROGRAM MAIN\nVAR\n  x : INT;\nEND_VAR\nx := 5;\nIF x > 3 THEN\n  y := 1;\nEND_IF\n",
            "fn main() {\n    let x = 5;\n    println!(\"X[COMP OFF FRICT]\");\n}\n",
            "kopf.achs_nr   1\nlr_param.frict_comp.enable 1\n",
            "all:\n\tcargo build\n\nclean:\n\trm -rf out\n",
            "a = 5\nb = 7\n",
            "*.o\n/build\n!keep\n",
        ] {
            assert!(!reads_as_program(text), "{text}");
        }
    }
}
