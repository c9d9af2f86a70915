//! Messages of a program so far: a message in a loop is reported once per place, with the number of its
//! repetitions, and the messages of a file are limited (R2.85).

use std::collections::HashMap;
use std::hash::{DefaultHasher, Hash, Hasher};
use std::sync::Arc;

use crate::diagnostic::{Code, Diagnostic};
use crate::text::{Place, Position, StartsInOrder};
use crate::timeline::{EndNote, Repeat};

/// Different messages of one code at one place; further ones count with the last.
const MAX_AT_A_PLACE: usize = 16;

/// Whether a message is written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum DedupVerdict {
    /// It is new.
    Say,
    /// It was reported at this place before.
    Repeated,
    /// Its file has reached its limit; the message is only counted.
    TooMany,
}

type SayingKey = (Code, Arc<str>, Position);

/// A message that was reported.
struct Saying {
    /// A hash of its text.
    hash: u64,
    times: u64,
    /// Its text, from the second time on.
    message: String,
}

/// Messages of one file.
#[derive(Default)]
struct PerFile {
    said: usize,
    /// Number of messages left out, and the place of the first of them.
    more: u64,
    place: Option<Place>,
}

/// Messages of a program so far.
pub(super) struct MessageDedup {
    /// Limit of messages of a file.
    most: usize,
    places: HashMap<SayingKey, Vec<Saying>>,
    files: HashMap<Arc<str>, PerFile>,
    starts: StartsInOrder,
}

impl MessageDedup {
    /// No message yet, with a limit of messages for each file.
    pub(super) fn at_most(most: usize) -> Self {
        Self {
            most,
            places: HashMap::new(),
            files: HashMap::new(),
            starts: StartsInOrder::default(),
        }
    }

    /// Takes a message about an executed block; best in the order of their places.
    pub(super) fn take(&mut self, diagnostic: &Diagnostic) -> DedupVerdict {
        let place = &diagnostic.place;
        let start = self.starts.start(place);
        let mut hasher = DefaultHasher::new();
        diagnostic.message.hash(&mut hasher);
        let hash = hasher.finish();
        let key = (diagnostic.code, place.file.clone(), start);
        let sayings = self.places.get_mut(&key);
        if let Some(sayings) = sayings {
            let full = sayings.len() >= MAX_AT_A_PLACE;
            let known = sayings.iter().position(|saying| saying.hash == hash);
            let known = known.or(full.then(|| sayings.len() - 1));
            if let Some(saying) = known.and_then(|known| sayings.get_mut(known)) {
                if saying.times == 1 {
                    saying.message.clone_from(&diagnostic.message);
                }
                saying.times += 1;
                return DedupVerdict::Repeated;
            }
        }
        if !self.has_room(place) {
            return DedupVerdict::TooMany;
        }
        self.places.entry(key).or_default().push(Saying {
            hash,
            times: 1,
            message: String::new(),
        });
        DedupVerdict::Say
    }

    /// Takes a message at the end, where none is repeated.
    pub(super) fn take_last(&mut self, diagnostic: &Diagnostic) -> DedupVerdict {
        if self.has_room(&diagnostic.place) {
            DedupVerdict::Say
        } else {
            DedupVerdict::TooMany
        }
    }

    /// Counts a message against the limit of its file.
    fn has_room(&mut self, place: &Place) -> bool {
        let file = match self.files.get_mut(&place.file) {
            Some(file) => file,
            None => self.files.entry(place.file.clone()).or_default(),
        };
        if file.said < self.most {
            file.said += 1;
            return true;
        }
        file.more += 1;
        if file.place.is_none() {
            file.place = Some(place.clone());
        }
        false
    }

    /// Returns the messages that applied more often than they were said, in the order of their places.
    pub(super) fn repeats(&self) -> Vec<Repeat> {
        let mut repeated = Vec::new();
        for ((code, file, start), sayings) in &self.places {
            for saying in sayings.iter().filter(|saying| saying.times > 1) {
                repeated.push(Repeat {
                    code: *code,
                    file: file.to_string(),
                    line: start.line,
                    times: saying.times,
                    start: *start,
                    message: saying.message.clone(),
                });
            }
        }
        repeated.sort_by(|a, b| {
            let order = (&a.file, a.line, a.code).cmp(&(&b.file, b.line, b.code));
            let places = (a.start.line, a.start.column).cmp(&(b.start.line, b.start.column));
            order.then(places).then_with(|| a.message.cmp(&b.message))
        });
        repeated
    }

    /// FC905 for each file with more messages; `unsaid` messages about the program's own file
    /// were counted before they came here.
    pub(super) fn rest(&mut self, unsaid: u64, seq: u64) -> Vec<EndNote> {
        let mut full: Vec<(&Arc<str>, &mut PerFile)> = self
            .files
            .iter_mut()
            .filter(|(_, file)| file.place.is_some())
            .collect();
        full.sort_by_key(|(name, _)| Arc::clone(name));
        if let Some((_, first)) = full.first_mut() {
            first.more = first.more.saturating_add(unsaid);
        }
        let most = self.most;
        let notes = full.into_iter().filter_map(|(_, file)| {
            let more = file.more;
            let messages = if more == 1 { "message" } else { "messages" };
            let message = format!(
                "{most} messages about this file are shown; {more} more {messages}, from here on, are only counted"
            );
            Some(EndNote {
                seq,
                diagnostic: Diagnostic::new(Code::Fc905, file.place.clone()?, message)
                    .with_help("correct what is shown and run again"),
            })
        });
        notes.collect()
    }
}
