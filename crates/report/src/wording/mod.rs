//! Text for people: messages, numbers, advice.

mod advice;
mod command_line;
mod diagnostics;
mod escape;
mod feed_moves;
mod glitch;
mod limits;
mod strings;
mod unified;
mod visible;

pub(crate) use advice::{FinalStates, listed};
pub use command_line::command_line;
pub use diagnostics::{Detail, FALLBACK_WIDTH, Look, Paint, fitted, render, wrap};
pub(crate) use escape::push_escaped;
pub use feed_moves::feed_moves_text;
pub(crate) use glitch::glitch_in_words;
pub use limits::assumed_limits;
pub(crate) use strings::{KeptText, append_json, append_json_text, grouped, integer, to_pretty};
pub use strings::{counted, rounded};
pub use unified::{TextChange, render_unified};
pub(crate) use visible::{any_byte, is_command, last_part};
pub use visible::{leading, visible, visible_line};
