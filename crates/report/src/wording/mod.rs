//! Text for people: messages, numbers, advice.

mod advice;
mod axes;
mod command_line;
mod diagnostics;
mod figures;
mod strings;
mod unified;
mod visible;

pub(crate) use advice::{FinalStates, listed};
pub(crate) use axes::glitch_in_words;
pub use axes::{assumed_limits, feed_moves_text};
pub use command_line::command_line;
pub use diagnostics::{Detail, FALLBACK_WIDTH, Look, Paint, fitted, render, wrap};
pub(crate) use figures::{push_field, push_row, to_json_line};
pub use figures::{rounded, to_json};
pub use strings::counted;
pub(crate) use strings::{KeptText, append_json, append_json_text, grouped, integer};
pub use unified::{TextChange, render_unified};
pub(crate) use visible::{is_command, last_part, push_escaped};
pub use visible::{leading, visible, visible_line};
