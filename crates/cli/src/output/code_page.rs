//! Text for programs that share a console on Windows.
//!
//! A console receives text in UTF-16 from the standard library and shows it in any code page. Text that goes
//! through a pipe, to `more`, `findstr` or PowerShell, is read in the code page of the console, 850 or 1252 in
//! western Europe, and is therefore written in it. Files and records are UTF-8 everywhere.

use std::io::{self, Write};
use std::str::from_utf8;

use encoding_rs::{Encoding, UTF_8};
use oem_cp::code_table::ENCODING_TABLE_CP_MAP;
use unicode_width::UnicodeWidthChar;

/// Code pages of Windows itself; those of consoles are older.
const ANSI: std::ops::RangeInclusive<u16> = 1250..=1258;

/// UTF-8 as a code page.
const UNICODE: u16 = 65001;

/// A code page of a console.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct CodePage(u16);

impl CodePage {
    /// Returns the code page of the console that reads from a pipe; `None` where UTF-8 is right: for files, on a
    /// terminal, without a console, outside Windows.
    pub(crate) fn behind(stream: &impl Stream) -> Option<Self> {
        Self::new(console::of_pipe(stream)?)
    }

    fn new(page: u16) -> Option<Self> {
        (page != UNICODE).then_some(Self(page))
    }

    /// Appends a text, with ASCII of the same width in place of characters that the code page lacks.
    fn encode(self, text: &str, out: &mut Vec<u8>) {
        for letter in text.chars() {
            if letter.is_ascii() {
                out.push(letter as u8);
            } else if let Some(byte) = self.byte(letter) {
                out.push(byte);
            } else {
                out.extend_from_slice(in_ascii(letter).as_bytes());
            }
        }
    }

    /// Returns the byte of a letter outside ASCII, where the code page has one.
    fn byte(self, letter: char) -> Option<u8> {
        if !ANSI.contains(&self.0) {
            return ENCODING_TABLE_CP_MAP.get(&self.0)?.get(&letter).copied();
        }
        let label = format!("windows-{}", self.0);
        let page = Encoding::for_label(label.as_bytes()).filter(|it| *it != UTF_8)?;
        let mut buffer = [0; 4];
        let (bytes, _, is_lossy) = page.encode(letter.encode_utf8(&mut buffer));
        match *bytes {
            [byte] if !is_lossy => Some(byte),
            _ => None,
        }
    }
}

/// Returns the replacement for a letter that a code page lacks.
fn in_ascii(letter: char) -> String {
    let sign = match letter {
        '◄' | '⟨' => "<",
        '→' | '⟩' => ">",
        // `~` is not part of any program word, unlike a full stop.
        '…' => "~",
        '─' => "-",
        'Δ' => "D",
        'µ' | 'μ' => "u",
        '²' => "2",
        '³' => "3",
        '·' => "*",
        '×' => "x",
        _ => return "?".repeat(letter.width().unwrap_or(1)),
    };
    sign.to_owned()
}

/// Writes text in a code page.
pub(crate) struct Encoded<W> {
    writer: W,
    page: CodePage,
    /// The beginning of a letter whose rest has not been written yet.
    begun: Vec<u8>,
}

impl<W: Write> Encoded<W> {
    pub(crate) fn new(writer: W, page: CodePage) -> Self {
        Self {
            writer,
            page,
            begun: Vec::new(),
        }
    }
}

impl<W: Write> Write for Encoded<W> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.begun.extend_from_slice(bytes);
        let whole = match from_utf8(&self.begun) {
            Err(error) if error.error_len().is_none() => error.valid_up_to(),
            _ => self.begun.len(),
        };
        let text = self.begun.drain(..whole).collect::<Vec<u8>>();
        let mut encoded = Vec::with_capacity(text.len());
        self.page
            .encode(&String::from_utf8_lossy(&text), &mut encoded);
        self.writer.write_all(&encoded)?;
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        self.writer.flush()
    }
}

#[cfg(windows)]
mod console {
    use std::fs::File;
    use std::io::IsTerminal;
    use std::os::windows::io::AsHandle;

    use win32console::console::WinConsole;

    /// A stream that may be a pipe.
    pub(crate) trait Stream: AsHandle + IsTerminal {}
    impl<S: AsHandle + IsTerminal> Stream for S {}

    /// Returns the code page of the console, if a stream is a pipe.
    pub(crate) fn of_pipe(stream: &impl Stream) -> Option<u16> {
        let handle = stream.as_handle().try_clone_to_owned().ok()?;
        let is_file = File::from(handle).metadata().is_ok_and(|it| it.is_file());
        if is_file || stream.is_terminal() {
            return None;
        }
        u16::try_from(WinConsole::get_output_code_page().ok()?).ok()
    }
}

#[cfg(not(windows))]
mod console {
    /// A stream that may be a pipe.
    pub(crate) trait Stream {}
    impl<S> Stream for S {}

    pub(crate) fn of_pipe(_: &impl Stream) -> Option<u16> {
        None
    }
}

pub(crate) use console::Stream;

#[cfg(test)]
mod tests {
    use super::*;

    fn written(page: u16, text: &str) -> Vec<u8> {
        let mut out = Vec::new();
        let mut writer = Encoded::new(&mut out, CodePage(page));
        // Letters in pieces.
        for byte in text.as_bytes() {
            writer.write_all(&[*byte]).expect("written");
        }
        out
    }

    #[test]
    fn umlauts_are_those_of_the_code_page_and_signs_are_ascii() {
        // R13.1
        let text = "(Übergröße) 12 µm ◄ X… Δ 漢\n";
        let expected: &[u8] = b"(\x9abergr\x94\xe1e) 12 \xe6m < X~ D ??\n";
        assert_eq!(written(850, text), expected);
        let expected: &[u8] = b"(\xdcbergr\xf6\xdfe) 12 \xb5m < X\x85 D ??\n";
        assert_eq!(written(1252, text), expected);
        let expected: &[u8] = b"(?bergr??e) 12 um < X~ D ??\n";
        assert_eq!(
            written(932, text),
            expected,
            "a code page that is not known"
        );
        assert_eq!(CodePage::new(65001), None);
    }
}
