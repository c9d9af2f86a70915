//! Tables in documents that tests generate.

use std::{env, fs};

/// Compares the table between `<!-- NAME -->` and `<!-- end of NAME -->` of a document with a fresh one, or
/// writes it with `UPDATE_DOCS=1`.
pub fn agrees(document: &str, name: &str, fresh: &str) {
    let path = format!("{}/../../docs/{document}", env!("CARGO_MANIFEST_DIR"));
    let text = fs::read_to_string(&path).expect("the document");
    let [begin, end] = ["", "end of "].map(|of| format!("<!-- {of}{name} -->\n"));
    let from = text.find(&begin).expect("its beginning") + begin.len();
    let to = text.find(&end).expect("its end");
    if env::var_os("UPDATE_DOCS").is_some() {
        fs::write(path, [&text[..from], fresh, &text[to..]].concat()).expect("written");
    } else {
        assert_eq!(&text[from..to], fresh, "{document}");
    }
}
