//! The main programs that reach a message in a called program (R17.1).

use std::fmt;
use std::sync::Arc;

/// Number of programs kept by name; further ones are only counted.
const MAX_NAMED: usize = 20;

/// Number of programs that a sentence names.
const MAX_IN_SENTENCE: usize = 5;

/// The main programs that reach the place of a message in a called program, in the order in which
/// they ran (R17.1). Empty if the message is about the main program itself.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct ReachedFrom {
    named: Vec<Arc<str>>,
    count: usize,
}

impl ReachedFrom {
    /// Returns the files of the first 20 programs.
    pub fn programs(&self) -> &[Arc<str>] {
        &self.named
    }

    /// Returns the number of programs, including those that are not kept by name.
    pub fn count(&self) -> usize {
        self.count
    }

    /// Whether no other program reaches the place.
    pub fn is_empty(&self) -> bool {
        self.count == 0
    }

    /// Returns the number of programs if [`programs`](Self::programs) does not contain all of them.
    pub fn count_beyond_names(&self) -> Option<usize> {
        (self.count > self.named.len()).then_some(self.count)
    }

    /// Adds a program, unless it is named already.
    pub fn add(&mut self, file: &Arc<str>) {
        if self.named.contains(file) {
            return;
        }
        self.count += 1;
        if self.named.len() < MAX_NAMED {
            self.named.push(Arc::clone(file));
        }
    }

    /// Adds the programs of another message about the same cause.
    pub(crate) fn append(&mut self, other: &Self) {
        other.named.iter().for_each(|file| self.add(file));
        self.count += other.count - other.named.len();
    }
}

/// `reached from a.nc`, `reached from 7 programs: a.nc, b.nc, c.nc, d.nc, e.nc, …`.
impl fmt::Display for ReachedFrom {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("reached from ")?;
        if self.count != 1 {
            write!(f, "{} programs: ", self.count)?;
        }
        for (at, file) in self.named.iter().take(MAX_IN_SENTENCE).enumerate() {
            if at > 0 {
                f.write_str(", ")?;
            }
            f.write_str(file)?;
        }
        if self.count > MAX_IN_SENTENCE {
            f.write_str(", …")?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn many_programs_are_counted() {
        // R17.1
        let mut reached = ReachedFrom::default();
        let add = |reached: &mut ReachedFrom, numbers: std::ops::Range<usize>| {
            for number in numbers {
                reached.add(&Arc::from(format!("{number}.nc")));
            }
        };
        add(&mut reached, 0..1);
        assert_eq!(reached.to_string(), "reached from 0.nc");
        let mut more = ReachedFrom::default();
        add(&mut more, 0..30);
        reached.append(&more);
        assert_eq!(
            reached.to_string(),
            "reached from 30 programs: 0.nc, 1.nc, 2.nc, 3.nc, 4.nc, …"
        );
        assert_eq!((reached.programs().len(), reached.count()), (20, 30));
        assert_eq!(reached.count_beyond_names(), Some(30));
    }
}
