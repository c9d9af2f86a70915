//! Lists within TwinCAT projects: places in them as item and line of the list (R3.42).

use std::sync::Arc;

use crate::diagnostic::{Diagnostic, Fix};
use crate::drive_interface::{DriveReport, Presence};
use crate::lists::Origin;
use crate::text::Place;

/// The lists that are parts of project files.
#[derive(Debug, Clone, Default)]
pub struct EmbeddedLists(Vec<EmbeddedList>);

/// A list within a project file.
#[derive(Debug, Clone)]
pub(super) struct EmbeddedList {
    /// The project file.
    pub(super) file: Arc<str>,
    /// The item, and the element of the list.
    pub(super) item: String,
    pub(super) element: String,
    /// The lines of the file that the list takes.
    pub(super) lines: std::ops::RangeInclusive<u32>,
}

impl EmbeddedLists {
    /// Returns the number of lists.
    pub fn count(&self) -> usize {
        self.0.len()
    }

    pub(super) fn add(&mut self, list: EmbeddedList) {
        self.0.push(list);
    }

    fn list(&self, file: &str, line: u32) -> Option<(&EmbeddedList, u32)> {
        let mut lists = self.0.iter();
        let found = lists.find(|list| &*list.file == file && list.lines.contains(&line))?;
        Some((found, line - found.lines.start() + 1))
    }

    fn words(&self, place: &Place) -> Option<String> {
        let (list, line) = self.list(&place.file, place.start().line)?;
        let EmbeddedList { item, element, .. } = list;
        Some(format!("item `{item}`, line {line} of `{element}`"))
    }

    /// Whether a place is in one of these lists, where nothing is written.
    pub(super) fn holds(&self, place: &Place) -> bool {
        self.words(place).is_some()
    }

    /// Names in diagnostics the item and the line within the list, and shows the lines to change in place of fixes:
    /// nothing is written into a project.
    pub fn explain(&self, diagnostics: &mut [Diagnostic]) {
        for said in diagnostics.iter_mut().filter(|_| !self.0.is_empty()) {
            let (within, plain) = std::mem::take(&mut said.fixes)
                .into_iter()
                .partition(|fix| self.holds(&fix.place));
            said.fixes = plain;
            let within: Vec<Fix> = within;
            let lines = within.iter().filter_map(|fix| self.line_to_write(fix));
            said.advice.extend(lines.map(Into::into));
            if let Some(words) = self.words(&said.place)
                && !said.message.contains(&words)
            {
                said.message = format!("{} ({words})", said.message);
            }
            for label in &mut said.labels {
                if let Some(words) = self.words(&label.place)
                    && !label.text.ends_with(&words)
                {
                    label.text = format!("{}; {words}", label.text);
                }
            }
        }
    }

    /// Returns the line that a fix would write, in words.
    fn line_to_write(&self, fix: &Fix) -> Option<String> {
        let (_, line) = self.list(&fix.place.file, fix.place.start().line)?;
        if let Some(added) = fix.text.strip_prefix('\n') {
            return Some(format!("add `{added}` after line {line} of the list"));
        }
        let mut written = fix.place.text.to_string();
        written.replace_range(fix.place.span.range(), &fix.text);
        Some(format!(
            "write line {line} of the list as `{}`",
            written.trim()
        ))
    }

    /// Names the items and the lines within the lists in place of those of the file in what is known about a drive.
    pub fn rename_evidence(&self, drive: &mut DriveReport) {
        for presence in [&mut drive.additive_torque, &mut drive.actual_torque] {
            if let Presence::Present { evidence } | Presence::Missing { evidence } = presence {
                self.rename(&mut evidence.origin);
            }
        }
    }

    /// Names the item and the line within the list in place of those of the file.
    pub(super) fn rename(&self, origin: &mut Origin) {
        if let Origin::File { file, line } = origin
            && let Some((list, within)) = self.list(file, *line)
        {
            *file = format!("{file}, {}", list.item);
            *line = within;
        }
    }
}
