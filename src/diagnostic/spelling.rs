//! Known words that resemble an unknown one.

/// The most letters of a word that is compared; a longer one is not a misspelling.
const MAX_WORD: usize = 64;

/// The most equally similar words that are worth naming.
const MAX_EQUALLY_NEAR: usize = 4;

/// Returns the most similar of several known words, if it is similar enough to be meant; the first one of several that
/// are equally similar. Code that offers a change uses [`nearest`].
pub fn did_you_mean<'a>(found: &str, known: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    candidates(found, known).first().copied()
}

/// Returns the most similar words, in their order: a tool cannot decide which of several is meant (R1.60). Empty if
/// there are many.
pub fn nearest<'a>(found: &str, known: impl IntoIterator<Item = &'a str>) -> Vec<&'a str> {
    let mut near = candidates(found, known);
    near.truncate(if near.len() > MAX_EQUALLY_NEAR {
        0
    } else {
        MAX_EQUALLY_NEAR
    });
    near
}

/// Returns the known words at the smallest distance: at most a third of the letters differ, swapped neighbours count
/// once; or one word is the beginning of the other.
fn candidates<'a>(found: &str, known: impl IntoIterator<Item = &'a str>) -> Vec<&'a str> {
    if found.is_empty() || found.len() > MAX_WORD {
        return Vec::new();
    }
    let found = found.to_ascii_uppercase();
    let letters = found.chars().count();
    // In a single letter only the case can be wrong.
    let allowed = if letters > 1 { (letters / 3).max(1) } else { 0 };
    let near = known
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
            let distance = if look_alike(&found) == look_alike(&upper) {
                0
            } else {
                strsim::damerau_levenshtein(&found, &upper)
            };
            (distance <= allowed || begins).then_some((distance, word))
        });
    let mut smallest = usize::MAX;
    let mut words = Vec::new();
    for (distance, word) in near {
        if distance < smallest {
            smallest = distance;
            words.clear();
        }
        if distance == smallest && !words.contains(&word) && words.len() <= MAX_EQUALLY_NEAR {
            words.push(word);
        }
    }
    words
}

/// Returns a word in capitals with digits in place of letters that look like them: `FC4O2` means `FC402`.
fn look_alike(word: &str) -> String {
    word.replace('O', "0").replace(['I', 'L'], "1")
}

/// An unknown name, and the known ones.
#[derive(Debug, Clone, PartialEq, Eq)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct UnknownName {
    /// The name as it was given.
    pub name: String,
    /// The known name that is probably intended.
    pub near: Option<String>,
    /// The known names.
    pub known: Vec<String>,
}

impl UnknownName {
    /// Creates an unknown name.
    pub fn new<'a>(name: &str, known: impl Iterator<Item = &'a str> + Clone) -> Self {
        Self {
            name: name.to_owned(),
            near: did_you_mean(name, known.clone()).map(str::to_owned),
            known: known.map(str::to_owned).collect(),
        }
    }

    /// Returns help: the name that is probably intended, else the known ones: `its axes are X, Y`.
    pub fn help(&self, known: &str) -> Option<String> {
        match &self.near {
            Some(near) => Some(format!("did you mean `{near}`?")),
            None if self.known.is_empty() => None,
            None => Some(format!("{known} {}", self.known.join(", "))),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_that_are_equally_near_are_all_named() {
        // R1.60
        assert_eq!(nearest("FRIKT", ["LEAD", "FRICT"]), ["FRICT"]);
        assert_eq!(nearest("X3", ["X1", "X2", "X1", "Y2"]), ["X1", "X2"]);
        assert_eq!(nearest("FC4O2", ["FC412", "FC402"]), ["FC402"]);
        assert_eq!(nearest("X9", ["X1", "X2", "X3", "X4", "X5"]), [""; 0]);
        assert_eq!(
            did_you_mean("X9", ["X1", "X2", "X3", "X4", "X5"]),
            Some("X1")
        );
    }
}
