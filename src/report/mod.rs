//! From data to text: one file a format.

pub mod lists;
