//! Reports in the format of `JUnit`, which CI servers show as tests: a file is a test, and an error or a warning in it a
//! failure (R18.29).

use std::collections::BTreeMap;
use std::fmt::Write as _;

use frictcomp::diagnostic::{Diagnostic, Severity};

use super::message_format::MessageFormat;
use super::tally::Tally;
use crate::wording::{push_escaped, visible_line};

/// The messages of each examined file.
#[derive(Debug, Default)]
pub(super) struct JUnit {
    files: BTreeMap<String, Vec<FailedTest>>,
}

#[derive(Debug)]
struct FailedTest {
    severity: Severity,
    code: &'static str,
    words: String,
    place: String,
}

impl MessageFormat for JUnit {
    fn program(&mut self, name: &str) {
        self.files.entry(name.replace('\\', "/")).or_default();
    }

    fn message(&mut self, _out: &mut Vec<u8>, diagnostic: &Diagnostic) {
        let file = diagnostic.place.file.replace('\\', "/");
        let start = diagnostic.place.start();
        let mut place = format!("{}:{}:{}", visible_line(&file), start.line, start.column);
        if !diagnostic.reached_from.is_empty() {
            let _ = write!(
                place,
                "\nnote: {}",
                visible_line(&diagnostic.reached_from.to_string())
            );
        }
        for advice in &diagnostic.advice {
            let _ = write!(place, "\nhelp: {}", visible_line(&advice.to_string()));
        }
        let messages = self.files.entry(file).or_default();
        messages.push(FailedTest {
            severity: diagnostic.severity,
            code: diagnostic.code.as_str(),
            words: visible_line(&diagnostic.message).into_owned(),
            place,
        });
    }

    fn close(&mut self, out: &mut Vec<u8>, _tally: &Tally) {
        let fails = |message: &&FailedTest| message.severity > Severity::Info;
        let has_failed = |messages: &&Vec<FailedTest>| messages.iter().any(|it| fails(&it));
        let (tests, failures) = (
            self.files.len(),
            self.files.values().filter(has_failed).count(),
        );
        let mut text = format!(
            "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites>\n<testsuite name=\"frictcomp\" tests=\"{tests}\" \
             failures=\"{failures}\">\n"
        );
        for (file, messages) in &self.files {
            text.push_str("<testcase classname=\"frictcomp\" name=\"");
            push_escaped(&mut text, &visible_line(file));
            text.push_str("\">\n");
            for message in messages.iter().filter(fails) {
                text.push_str("<failure type=\"");
                push_escaped(&mut text, message.code);
                text.push_str("\" message=\"");
                push_escaped(&mut text, &message.words);
                text.push_str("\">");
                push_escaped(&mut text, &message.place);
                text.push_str("</failure>\n");
            }
            text.push_str("</testcase>\n");
        }
        text.push_str("</testsuite>\n</testsuites>\n");
        out.extend_from_slice(text.as_bytes());
    }
}
