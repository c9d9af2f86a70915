//! The place of a picture, and its style.

/// The place of a picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Frame<'a> {
    /// A separate file, which carries its style.
    Alone,
    /// In a page that has [`STYLE`] in its own; the name makes the identifiers of the picture
    /// unique there.
    Inside(&'a str),
}

/// The style of all pictures. It has only class rules: viewers without `@media` draw them on a light
/// ground.
pub const STYLE: &str = include_str!("style.css");
