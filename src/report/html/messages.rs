//! What there is to say about the programs and lists.

use std::fmt::Write as _;

use super::assumptions::with_code;
use super::page::Page;
use super::story::{Message, RunStory};
use crate::report::markup::escaped;

/// Writes the table of all messages, in the order in which they were said.
pub(super) fn render(page: &mut Page<'_>, story: &RunStory) -> std::io::Result<()> {
    if story.messages.is_empty() {
        page.paragraph("There are no messages about these programs.");
        return Ok(());
    }
    page.open_table("Messages", &["code", "severity", "where", "what"]);
    for (number, message) in story.messages.iter().enumerate() {
        let diagnostic = &message.diagnostic;
        let place = format!("{}:{}", diagnostic.place.file, diagnostic.place.start());
        let place = match message.shown {
            Some(at) => format!("<a href=\"#{}\">{}</a>", line_id(at), escaped(&place)),
            None => escaped(&place),
        };
        let severity = diagnostic.severity.word();
        let mut what = with_code(&diagnostic.message);
        if message.shown.is_none() {
            help(&mut what, message);
        }
        if message.times > 1 {
            let _ = write!(
                what,
                " <span class=\"quiet\">({} times)</span>",
                message.times
            );
        }
        let cells = [
            format!("<span class=\"sev {severity}\">{severity}</span>"),
            place,
            format!("<span id=\"m{number}\">{what}</span>"),
        ];
        page.row(diagnostic.code.text(), &cells);
        page.settle()?;
    }
    page.close_table();
    if story.more_messages > 0 {
        page.paragraph(&format!(
            "{} more messages are left out: `frictcomp check` prints all of them.",
            story.more_messages
        ));
    }
    Ok(())
}

/// Appends a message as an item of the list below its line.
pub(super) fn push_item(out: &mut String, message: &Message) {
    let diagnostic = &message.diagnostic;
    let severity = diagnostic.severity.word();
    let start = diagnostic.place.start();
    let _ = write!(
        out,
        "<li class=\"{severity}\"><span class=\"sev\">{severity}[{}]</span> column {}: {}",
        diagnostic.code.text(),
        start.column,
        with_code(&diagnostic.message)
    );
    if message.times > 1 {
        let _ = write!(
            out,
            " <span class=\"quiet\">({} times)</span>",
            message.times
        );
    }
    help(out, message);
    out.push_str("</li>\n");
}

fn help(out: &mut String, message: &Message) {
    let diagnostic = &message.diagnostic;
    if diagnostic.help.is_empty() && diagnostic.labels.is_empty() {
        return;
    }
    out.push_str("<ul>");
    for label in &diagnostic.labels {
        let place = format!("{}:{}", label.place.file, label.place.start());
        let _ = write!(
            out,
            "<li>{}: {}</li>",
            escaped(&place),
            with_code(&label.text)
        );
    }
    for help in &diagnostic.help {
        let _ = write!(out, "<li>help: {}</li>", with_code(help));
    }
    out.push_str("</ul>");
}

/// The identifier of a line of source in the page.
pub(super) fn line_id((file, line): (usize, u32)) -> String {
    format!("f{file}l{line}")
}
