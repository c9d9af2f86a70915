//! Where a picture stands, and its style.

/// Where a picture stands.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Frame<'a> {
    /// A file of its own, which carries its style.
    Alone,
    /// In a page that has [`STYLE`] in its own; the name makes the identifiers of the picture
    /// unique there.
    Inside(&'a str),
}

/// The style of all pictures. Nothing but class rules: what does not know `@media` draws them on
/// light ground.
pub const STYLE: &str = include_str!("style.css");
