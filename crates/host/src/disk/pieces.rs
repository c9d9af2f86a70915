//! A file piece by piece, each of whole lines.

use std::io::{self, Read};

/// Number of bytes examined together.
const PIECE: usize = 256 * 1024;

/// Passes on all of a text, in pieces that end with a line. A line that fills a piece is cut.
///
/// # Errors
/// The text cannot be read.
pub(crate) fn whole_lines(mut text: impl Read, mut look: impl FnMut(&[u8])) -> io::Result<()> {
    let mut piece = vec![0; PIECE];
    let mut kept = 0;
    loop {
        let count = match text.read(&mut piece[kept..]) {
            Err(error) if error.kind() == io::ErrorKind::Interrupted => continue,
            count => count?,
        };
        let bytes = &piece[..kept + count];
        let whole = match memchr::memrchr2(b'\n', b'\r', bytes) {
            Some(at) if count > 0 => at + 1,
            // A line that is cut is examined with the next piece, unless it fills this one.
            _ if count > 0 && bytes.len() < PIECE => 0,
            _ => bytes.len(),
        };
        look(&bytes[..whole]);
        if count == 0 {
            return Ok(());
        }
        let rest = whole..kept + count;
        kept = rest.len();
        piece.copy_within(rest, 0);
    }
}
