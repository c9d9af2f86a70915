//! The functions that the page calls.
//!
//! The page asks for room, writes the bytes of a question or a file into it and calls [`ask`] or [`put`].
//! The answer remains until the next question; the page asks for its place and length.

#![allow(unsafe_code, reason = "exported names are unsafe attributes")]

use std::cell::RefCell;

use crate::engine::Engine;

thread_local! {
    static BORDER: RefCell<Border> = RefCell::default();
}

/// The engine, and the bytes on their way in and out.
#[derive(Default)]
struct Border {
    engine: Engine,
    sent: Vec<u8>,
    answer: Vec<u8>,
}

/// Makes room for so many bytes and returns its address.
#[unsafe(no_mangle)]
extern "C" fn reserve(length: usize) -> *mut u8 {
    BORDER.with_borrow_mut(|border| {
        border.sent = vec![0; length];
        border.sent.as_mut_ptr()
    })
}

/// Accepts a file: its path, of the given number of bytes, followed by its content. `named` is 1 for a file that
/// the user picked individually.
#[unsafe(no_mangle)]
extern "C" fn put(path_length: usize, named: u32) {
    BORDER.with_borrow_mut(|border| {
        let mut path = std::mem::take(&mut border.sent);
        let content = path.split_off(path_length.min(path.len()));
        border
            .engine
            .put(&String::from_utf8_lossy(&path), content, named == 1);
    });
}

/// Answers a question; returns 0 if it is refused, in which case the answer says why.
#[unsafe(no_mangle)]
extern "C" fn ask() -> u32 {
    BORDER.with_borrow_mut(|border| {
        let question = std::mem::take(&mut border.sent);
        border.answer = Vec::new();
        match border.engine.ask(&question) {
            Ok(answer) => {
                border.answer = answer;
                1
            }
            Err(refusal) => {
                border.answer = serde_json::to_vec(&refusal).unwrap_or_default();
                0
            }
        }
    })
}

/// Returns the address of the answer.
#[unsafe(no_mangle)]
extern "C" fn answer() -> *const u8 {
    BORDER.with_borrow(|border| border.answer.as_ptr())
}

/// Returns the length of the answer in bytes.
#[unsafe(no_mangle)]
extern "C" fn answer_length() -> usize {
    BORDER.with_borrow(|border| border.answer.len())
}
