//! What only code can show of lists: their networks of drives, files on the disk, any text, lists that are written.

#![allow(clippy::unwrap_used, reason = "a test that cannot continue fails")]

mod lists {
    mod config;
    mod drive;
    mod host;
    mod robust;
    mod values;
    mod written;
}
