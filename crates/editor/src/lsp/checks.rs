//! The schedule of checks: the texts that are due, and their times (R12.7).

use std::collections::{BTreeMap, BTreeSet};
use std::time::{Duration, Instant};

use super::worker::Cancel;

/// Pause in typing before a text is checked: shorter than between two keystrokes, longer than
/// between the changes of one.
const PAUSE: Duration = Duration::from_millis(20);

/// Reason why a text has to be checked.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Outdated {
    /// New text.
    Now,
    /// Changed text, which may change again at once.
    ByTyping,
    /// A file that it uses was changed.
    ByOthers,
}

/// The texts that have to be checked, by their URIs.
#[derive(Debug, Default)]
pub(super) struct Checks {
    due: BTreeMap<String, Instant>,
    /// The same texts in the order in which they are due.
    order: BTreeSet<(Instant, String)>,
    running: Option<(String, Cancel)>,
}

impl Checks {
    /// Schedules the check of a text. A running check is cancelled if its text is out of date, or the user
    /// types in another one.
    pub(super) fn expect(&mut self, uri: &str, why: Outdated) {
        let now = Instant::now();
        let pause = match why {
            Outdated::Now => Duration::ZERO,
            Outdated::ByTyping => PAUSE,
            Outdated::ByOthers => 2 * PAUSE,
        };
        self.set(uri, now + pause);
        if let Some((running, cancel)) = &self.running
            && (running == uri || why == Outdated::ByTyping)
        {
            cancel.set();
            let again = now + 2 * PAUSE;
            if !self.due.contains_key(running) {
                let running = running.clone();
                self.set(&running, again);
            }
        }
    }

    fn set(&mut self, uri: &str, at: Instant) {
        self.take(uri);
        self.due.insert(uri.to_owned(), at);
        self.order.insert((at, uri.to_owned()));
    }

    fn take(&mut self, uri: &str) {
        if let Some(at) = self.due.remove(uri) {
            self.order.remove(&(at, uri.to_owned()));
        }
    }

    /// Removes a text that need not be checked any more.
    pub(super) fn forget(&mut self, uri: &str) {
        self.take(uri);
        if let Some((running, cancel)) = &self.running
            && running == uri
        {
            cancel.set();
        }
    }

    /// Removes all texts.
    pub(super) fn stop(&mut self) {
        self.due.clear();
        self.order.clear();
        if let Some((_, cancel)) = &self.running {
            cancel.set();
        }
    }

    /// Returns the text that is to be checked now.
    pub(super) fn due(&mut self, now: Instant) -> Option<String> {
        if self.running.is_some() {
            return None;
        }
        let first = self.order.first();
        let uri = first.filter(|(at, _)| *at <= now)?.1.clone();
        self.take(&uri);
        Some(uri)
    }

    /// Returns the time until a text is due; `None` where none is, or another one comes first.
    pub(super) fn wait(&self, now: Instant) -> Option<Duration> {
        if self.running.is_some() {
            return None;
        }
        let (first, _) = self.order.first()?;
        Some(first.saturating_duration_since(now))
    }

    /// Marks the check of a text as begun.
    pub(super) fn begin(&mut self, uri: &str) -> Cancel {
        let cancel = Cancel::default();
        self.running = Some((uri.to_owned(), cancel.clone()));
        cancel
    }

    /// Marks the check as ended; returns its text.
    pub(super) fn end(&mut self) -> Option<String> {
        self.running.take().map(|(uri, _)| uri)
    }

    /// Returns the text whose check is running.
    pub(super) fn running(&self) -> Option<&str> {
        self.running.as_ref().map(|(uri, _)| uri.as_str())
    }

    /// Returns whether no check is running or due.
    pub(super) fn are_done(&self) -> bool {
        self.running.is_none() && self.due.is_empty()
    }

    /// Returns whether a check of a text is still to come.
    pub(super) fn is_awaited(&self, uri: &str) -> bool {
        self.running() == Some(uri) || self.due.contains_key(uri)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_check_that_is_out_of_date_gives_way() {
        // R12.7
        let mut checks = Checks::default();
        let later = Instant::now() + Duration::from_secs(9);
        checks.expect("a", Outdated::Now);
        assert_eq!(checks.due(Instant::now()).as_deref(), Some("a"));
        let first = checks.begin("a");
        assert_eq!(checks.due(later), None);
        checks.expect("b", Outdated::ByOthers);
        assert!(!first.is_set() && checks.is_awaited("a"));
        checks.expect("b", Outdated::ByTyping);
        assert!(first.is_set(), "who types need not wait");
        assert_eq!(checks.end().as_deref(), Some("a"));
        let order = [checks.due(later), checks.due(later), checks.due(later)];
        assert_eq!(order, [Some("b".to_owned()), Some("a".to_owned()), None]);
        assert_eq!(checks.wait(later), None);
        checks.expect("a", Outdated::Now);
        checks.forget("a");
        assert!(!checks.is_awaited("a"));
    }
}
