//! The messages on the programs and lists.

use maud::{Markup, html};

use super::digest::{Message, RunDigest};
use super::parts::{Caption, ColumnHeading, HtmlRow, HtmlTable, line_id, linked, times, with_code};

/// Returns the table of all messages, in the order in which they were given.
pub(super) fn render(digest: &RunDigest) -> Markup {
    if digest.messages.is_empty() {
        return html! { p { "There are no messages about these programs." } };
    }
    let table = HtmlTable {
        caption: Caption::Heard("Messages"),
        columns: &[
            ColumnHeading::Text("code"),
            ColumnHeading::Text("severity"),
            ColumnHeading::Text("where"),
            ColumnHeading::Text("what"),
        ],
    };
    html! {
        (table.render(digest.messages.iter().map(row)))
        @if digest.more_messages > 0 {
            p {
                (digest.more_messages) " more messages are left out: "
                code { "frictcomp check" } " prints all of them."
            }
        }
    }
}

fn row(message: &Message) -> HtmlRow {
    let diagnostic = &message.diagnostic;
    let severity = diagnostic.severity.as_str();
    let place = format!("{}:{}", diagnostic.place.file, diagnostic.place.start());
    let link = message
        .shown
        .map(|at| format!("#{}", line_id(at.file, at.line)));
    let cells = [
        html! { span.sev.(severity) { (severity) } },
        linked(&place, link),
        html! {
            (with_code(&diagnostic.message)) (times(message.times)) (reached(message))
            @if message.shown.is_none() { (help(message)) }
        },
    ];
    HtmlRow::new(diagnostic.code.as_str(), cells)
}

/// Returns a message as an item of the list below its line.
pub(super) fn item(message: &Message) -> Markup {
    let diagnostic = &message.diagnostic;
    let severity = diagnostic.severity.as_str();
    html! {
        li.(severity) {
            span.sev { (severity) "[" (diagnostic.code.as_str()) "]" }
            " column " (diagnostic.place.start().column) ": "
            (with_code(&diagnostic.message)) (times(message.times)) (reached(message)) (help(message))
        }
        "\n"
    }
}

/// Returns the main programs that reach a message in a called program (R17.1).
fn reached(message: &Message) -> Markup {
    let reached_from = &message.diagnostic.reached_from;
    html! {
        @if !reached_from.is_empty() { " (" (reached_from) ")" }
    }
}

fn help(message: &Message) -> Markup {
    let diagnostic = &message.diagnostic;
    if diagnostic.advice.is_empty() && diagnostic.labels.is_empty() {
        return html! {};
    }
    html! {
        ul {
            @for label in &diagnostic.labels {
                li {
                    (label.place.file) ":" (label.place.start().to_string()) ": "
                    (with_code(&label.text))
                }
            }
            @for advice in &diagnostic.advice {
                li { "help: " (with_code(&advice.to_string())) }
            }
        }
    }
}
