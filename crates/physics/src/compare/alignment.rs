//! The assignment of blocks of the old version to blocks of the new version.

use std::collections::HashMap;
use std::ops::Range;

use crate::contour::BlockDeviation;

/// A block of each version; `None` if it is only in the other one.
pub(super) type AlignedBlocks = (Option<usize>, Option<usize>);

/// Key by which two blocks are the same: the file, unless it is that of the program, and the
/// number, or without one the text. The line is not part of it.
type BlockIdentity<'a> = (Option<&'a str>, Result<i64, &'a str>);

/// Positions of a block that is the same in both versions.
type Anchor = (usize, usize);

/// Aligns the blocks of two versions in the order of the new one. Blocks that occur only once in
/// each version hold the others in their places; between them blocks are the same by their
/// identity, and if equally many are left in both versions, these were changed.
pub(super) fn align(old: &[BlockDeviation], new: &[BlockDeviation]) -> Vec<AlignedBlocks> {
    let identities = [old, new].map(|blocks| {
        let program = blocks.first().map(|block| &block.file);
        let identity = |block| identity(block, program.map(|file| &**file));
        blocks.iter().map(identity).collect::<Vec<_>>()
    });
    let [old, new] = &identities;
    let mut aligned = Vec::with_capacity(old.len().max(new.len()));
    let mut from = (0, 0);
    let end = (old.len(), new.len());
    for anchor in anchors(old, new).into_iter().chain([end]) {
        between(
            (old, from.0..anchor.0),
            (new, from.1..anchor.1),
            &mut aligned,
        );
        if anchor != end {
            aligned.push((Some(anchor.0), Some(anchor.1)));
        }
        from = (anchor.0 + 1, anchor.1 + 1);
    }
    aligned
}

fn identity<'a>(block: &'a BlockDeviation, program: Option<&str>) -> BlockIdentity<'a> {
    let file = (Some(&*block.file) != program).then(|| {
        let name = block.file.rsplit(['/', '\\']).next();
        name.unwrap_or(&block.file)
    });
    (file, block.number.ok_or(&block.text))
}

/// Returns the blocks that occur once in each version, as many as keep their order.
fn anchors(old: &[BlockIdentity<'_>], new: &[BlockIdentity<'_>]) -> Vec<Anchor> {
    let old_places = once(old);
    let new_places = once(new);
    let pairs = (0..new.len()).filter_map(|at| {
        let identity = &new[at];
        new_places.get(identity).copied().flatten()?;
        Some((old_places.get(identity).copied().flatten()?, at))
    });
    longest_in_order(&pairs.collect::<Vec<Anchor>>())
}

/// Returns the position of each identity, `None` for one with several.
fn once<'a, 'b>(all: &'b [BlockIdentity<'a>]) -> HashMap<&'b BlockIdentity<'a>, Option<usize>> {
    let mut places = HashMap::new();
    for (at, identity) in all.iter().enumerate() {
        let place = places.entry(identity).or_insert(Some(at));
        if *place != Some(at) {
            *place = None;
        }
    }
    places
}

/// Returns the longest series of pairs that keeps the order of the old version, by patience sorting.
fn longest_in_order(pairs: &[Anchor]) -> Vec<Anchor> {
    // The last pair of the best series of each length, and the pair before each pair.
    let mut ends: Vec<usize> = Vec::new();
    let mut before: Vec<Option<usize>> = Vec::with_capacity(pairs.len());
    for (at, (old, _)) in pairs.iter().enumerate() {
        let length = ends.partition_point(|end| pairs[*end].0 < *old);
        before.push(length.checked_sub(1).map(|shorter| ends[shorter]));
        if length == ends.len() {
            ends.push(at);
        } else {
            ends[length] = at;
        }
    }
    let last = ends.last().copied();
    let mut series: Vec<Anchor> = std::iter::successors(last, |at| before[*at])
        .map(|at| pairs[at])
        .collect();
    series.reverse();
    series
}

/// Aligns the blocks between two anchors.
fn between(
    (old, old_range): (&[BlockIdentity<'_>], Range<usize>),
    (new, new_range): (&[BlockIdentity<'_>], Range<usize>),
    aligned: &mut Vec<AlignedBlocks>,
) {
    let mut places: HashMap<&BlockIdentity<'_>, Vec<usize>> = HashMap::new();
    for at in old_range.clone().rev() {
        places.entry(&old[at]).or_default().push(at);
    }
    let same: Vec<Option<usize>> = new_range
        .clone()
        .map(|at| places.get_mut(&new[at]).and_then(Vec::pop))
        .collect();
    let mut gone: Vec<usize> = places.into_values().flatten().collect();
    gone.sort_unstable();
    let come = same.iter().filter(|place| place.is_none()).count();
    let was_changed = come == gone.len();
    let mut changed = gone.iter().copied();
    for (at, place) in new_range.zip(same) {
        let place = place.or_else(|| changed.next().filter(|_| was_changed));
        aligned.push((place, Some(at)));
    }
    if !was_changed {
        aligned.extend(gone.into_iter().map(|at| (Some(at), None)));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn blocks(file: &str, texts: &[&str]) -> Vec<BlockDeviation> {
        let block = |(text, line): (&&str, u32)| BlockDeviation {
            file: file.into(),
            line,
            number: text
                .strip_prefix('N')
                .and_then(|rest| rest.split(' ').next()?.parse().ok()),
            text: (*text).to_owned(),
            stretches: Vec::new(),
            stretch_mm: 1.0,
            reversals: Vec::new(),
            more_reversals: (0, None),
        };
        texts.iter().zip(1..).map(block).collect()
    }

    fn aligned(old: &[&str], new: &[&str]) -> Vec<AlignedBlocks> {
        align(&blocks("old.nc", old), &blocks("new.nc", new))
    }

    #[test]
    fn blocks_are_the_same_wherever_they_stand() {
        // R9.83
        let both = |old, new| (Some(old), Some(new));
        assert_eq!(
            aligned(&["N10 X1", "N20 X2"], &["N10 X1", "N15 Y1", "N20 X3"]),
            [both(0, 0), (None, Some(1)), both(1, 2)]
        );
        // Without numbers a repeated text is identified by its neighbours.
        assert_eq!(
            aligned(
                &["A", "X1", "B", "X1", "C"],
                &["A", "X1", "X1", "B", "X1", "C"]
            ),
            [
                both(0, 0),
                both(1, 1),
                (None, Some(2)),
                both(2, 3),
                both(3, 4),
                both(4, 5)
            ]
        );
        // A changed text takes the place of the old one.
        assert_eq!(
            aligned(&["A", "X1 F100", "B"], &["A", "X1 F200", "B"]),
            [both(0, 0), both(1, 1), both(2, 2)]
        );
        assert_eq!(
            aligned(&["A", "X1", "X2", "B"], &["A", "B"]),
            [both(0, 0), (Some(1), None), (Some(2), None), both(3, 1)]
        );
        assert_eq!(aligned(&[], &["A"]), [(None, Some(0))]);
    }

    #[test]
    fn many_blocks_in_another_order_are_aligned_at_once() {
        let texts: Vec<String> = (0..100_000).map(|number| format!("N{number} X1")).collect();
        let texts: Vec<&str> = texts.iter().map(String::as_str).collect();
        let turned: Vec<&str> = texts.iter().rev().copied().collect();
        let found = aligned(&texts, &turned);
        assert_eq!(found.iter().filter(|it| it.1.is_some()).count(), 100_000);
    }
}
