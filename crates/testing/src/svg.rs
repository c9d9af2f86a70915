//! Pictures that tests read.

use roxmltree::Document;

/// The namespace of the elements.
pub const SVG: &str = "http://www.w3.org/2000/svg";

/// Returns the document of a picture.
///
/// # Panics
///
/// If it is not well-formed.
pub fn read(svg: &str) -> Document<'_> {
    Document::parse(svg).unwrap_or_else(|error| panic!("{error}:\n{svg}"))
}

/// Returns the texts that a picture shows.
pub fn texts<'a>(document: &'a Document<'_>) -> Vec<&'a str> {
    let nodes = document
        .descendants()
        .filter(|node| node.has_tag_name((SVG, "text")));
    nodes.filter_map(|node| node.text()).collect()
}

/// Asserts that a picture is well-formed, with only numbers where numbers belong, and runs nothing.
///
/// # Panics
///
/// If it is not.
pub fn sound(svg: &str) {
    let document = read(svg);
    for node in document.descendants() {
        assert!(!node.has_tag_name((SVG, "script")));
        for attribute in node.attributes() {
            let numeric = [
                "d", "x", "y", "x1", "x2", "y1", "y2", "r", "cx", "cy", "width", "height",
            ];
            if numeric.contains(&attribute.name()) {
                let value = attribute.value();
                assert!(!value.contains("NaN") && !value.contains("inf"), "{value}");
            }
        }
    }
}
