//! Known words that resemble an unknown one.

/// Letters beyond which a word is no slip of the pen, and not compared.
const MAX_WORD: usize = 64;

/// The nearest of several known words, close enough to be meant: at most a third of the letters
/// differ, swapped neighbours count once; or one is the beginning of the other.
pub(crate) fn did_you_mean<'a>(
    found: &str,
    known: impl IntoIterator<Item = &'a str>,
) -> Option<&'a str> {
    if found.len() > MAX_WORD {
        return None;
    }
    let found = found.to_ascii_uppercase();
    let letters = found.chars().count();
    // Of a single letter only the case can be wrong.
    let allowed = if letters > 1 { (letters / 3).max(1) } else { 0 };
    known
        .into_iter()
        .filter(|word| word.len() <= MAX_WORD)
        .filter_map(|word| {
            let upper = word.to_ascii_uppercase();
            let begins = letters.min(upper.len()) > 2
                && (found.starts_with(&upper) || upper.starts_with(&found));
            let near = letters.abs_diff(upper.chars().count()) <= allowed;
            if !near && !begins {
                return None;
            }
            let distance = strsim::damerau_levenshtein(&found, &upper);
            (distance <= allowed || begins).then_some((distance, word))
        })
        .min_by_key(|&(distance, _)| distance)
        .map(|(_, word)| word)
}
