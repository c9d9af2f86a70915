//! Messages over standard input and output.
//!
//! The reader of lsp-server allocates as much memory as a header announces, and ends at the first message
//! that is not JSON. This one allocates memory as bytes arrive, up to a bound, and continues after a
//! message that it cannot read.

use std::io::{self, BufRead, Read, Write};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

use crossbeam_channel::{Sender, bounded, unbounded};
use lsp_server::{Connection, Message};

use super::log::log;

/// The longest message: programs of some million blocks, written as JSON.
const LONGEST: u64 = 1 << 30;

/// The longest line of a header.
const LONGEST_HEADER: u64 = 4096;

/// Number of messages that may wait for the server before the client is blocked.
const AHEAD: usize = 64;

/// Time limit for writing the last messages.
const PATIENCE: Duration = Duration::from_secs(2);

/// A client at the other end of standard input and output.
pub(super) struct Stdio {
    /// The connection to it.
    pub(super) connection: Connection,
    writer: JoinHandle<io::Result<()>>,
}

impl Stdio {
    /// Starts reading and writing.
    ///
    /// # Errors
    /// The system cannot start a thread.
    pub(super) fn open() -> io::Result<Self> {
        let (incoming, receiver) = bounded(AHEAD);
        let (sender, outgoing) = unbounded::<Message>();
        let complaints = sender.clone();
        thread::Builder::new()
            .name("reader".to_owned())
            .spawn(move || read_all(&mut io::stdin().lock(), &incoming, &complaints))?;
        let writer = thread::Builder::new()
            .name("writer".to_owned())
            .spawn(move || {
                let mut stdout = io::stdout().lock();
                outgoing.into_iter().try_for_each(|message| {
                    message.write(&mut stdout)?;
                    stdout.flush()
                })
            })?;
        Ok(Self {
            connection: Connection { sender, receiver },
            writer,
        })
    }

    /// Sends the last messages, as long as the client reads them.
    pub(super) fn close(self) {
        drop(self.connection);
        let end = Instant::now() + PATIENCE;
        while !self.writer.is_finished() && Instant::now() < end {
            thread::sleep(Duration::from_millis(1));
        }
    }
}

/// Passes messages on until the client closes its end or the receiver is gone.
fn read_all(input: &mut dyn BufRead, incoming: &Sender<Message>, complaints: &Sender<Message>) {
    while let Ok(Some(body)) = read_body(input) {
        match serde_json::from_slice(&body) {
            Ok(message) => {
                let is_exit = matches!(&message, Message::Notification(it) if it.method == "exit");
                if incoming.send(message).is_err() || is_exit {
                    return;
                }
            }
            Err(error) => {
                let _ = complaints.send(log(format!("a message is not JSON-RPC: {error}")));
            }
        }
    }
}

/// Returns the body of the next message; `None` at the end of the input.
fn read_body(input: &mut dyn BufRead) -> io::Result<Option<Vec<u8>>> {
    let mut length = None;
    loop {
        let mut line = Vec::new();
        (&mut *input)
            .take(LONGEST_HEADER)
            .read_until(b'\n', &mut line)?;
        if line.is_empty() {
            return Ok(None);
        }
        let line = line.trim_ascii();
        if line.is_empty() {
            break;
        }
        let (name, value) = std::str::from_utf8(line)
            .ok()
            .and_then(|line| line.split_once(':'))
            .ok_or(io::ErrorKind::InvalidData)?;
        if name.eq_ignore_ascii_case("Content-Length") {
            let value = value.trim().parse().ok();
            length = Some(
                value
                    .filter(|length| *length <= LONGEST)
                    .ok_or(io::ErrorKind::InvalidData)?,
            );
        }
    }
    let length: u64 = length.ok_or(io::ErrorKind::InvalidData)?;
    let mut body = Vec::new();
    let read = input.take(length).read_to_end(&mut body)?;
    let is_whole = u64::try_from(read) == Ok(length);
    Ok(is_whole.then_some(body))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(bytes: &[u8]) -> (Vec<Message>, Vec<Message>) {
        let (incoming, received) = unbounded();
        let (complaints, complained) = unbounded();
        read_all(&mut &bytes[..], &incoming, &complaints);
        drop((incoming, complaints));
        (
            received.into_iter().collect(),
            complained.into_iter().collect(),
        )
    }

    fn framed(body: &str) -> String {
        format!("Content-Length: {}\r\n\r\n{body}", body.len())
    }

    #[test]
    fn what_cannot_be_read_costs_only_itself() {
        // R12.1
        let good = framed(r#"{"jsonrpc":"2.0","method":"initialized","params":{}}"#);
        let bytes = [
            framed("{"),
            framed("[1]"),
            good.clone(),
            framed("\u{1}"),
            good,
        ]
        .concat();
        let (received, complained) = read(bytes.as_bytes());
        assert_eq!((received.len(), complained.len()), (2, 3));
    }

    #[test]
    fn a_header_that_lies_ends_the_input() {
        // R12.1
        let good = framed(r#"{"method":"initialized"}"#);
        for bad in [
            "Content-Length: 99999999999999\r\n\r\n".to_owned(),
            "Content-Length: -1\r\n\r\n".to_owned(),
            "nonsense\r\n\r\n".to_owned(),
            "Content-Length: 2147483648\r\n\r\n{}".to_owned(),
            "\r\n".to_owned(),
            "x".repeat(10_000),
            "Content-Length: 100\r\n\r\n{}".to_owned(),
        ] {
            let (received, _) = read((good.clone() + &bad).as_bytes());
            assert_eq!(received.len(), 1, "{bad}");
        }
        let typed = good.replace("Content-Length: ", "Content-Type: x\r\ncontent-length:");
        assert_eq!(read(typed.as_bytes()).0.len(), 1);
    }
}
