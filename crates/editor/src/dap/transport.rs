//! Messages of the protocol: a header with their length, and JSON.

use std::io::{self, BufRead, Read, Write};

use serde::Deserialize;
use serde_json::{Value, json};

/// The longest message that is read.
const LONGEST: u64 = 64 << 20;

/// The longest line of a header.
const LONGEST_HEADER: u64 = 4096;

/// Request of a client.
#[derive(Debug, Deserialize)]
pub(super) struct Request {
    pub(super) seq: i64,
    pub(super) command: String,
    #[serde(default)]
    pub(super) arguments: Value,
}

/// Message from the client.
#[derive(Debug)]
pub(super) enum Incoming {
    Request(Request),
    /// Message that is not a request; the reason in words.
    Garbled(String),
}

/// Reads the next message; `None` at the end of the input.
///
/// # Errors
/// The input cannot be read, or its headers cannot be followed.
pub(super) fn read(input: &mut impl BufRead) -> io::Result<Option<Incoming>> {
    let Some(length) = read_header(input)? else {
        return Ok(None);
    };
    let mut body = Vec::new();
    input.by_ref().take(length).read_to_end(&mut body)?;
    if (body.len() as u64) < length {
        return Ok(None);
    }
    Ok(Some(match serde_json::from_slice(&body) {
        Ok(request) => Incoming::Request(request),
        Err(error) => Incoming::Garbled(error.to_string()),
    }))
}

/// Returns the length that the header of the next message announces.
fn read_header(input: &mut impl BufRead) -> io::Result<Option<u64>> {
    let mut length = None;
    loop {
        let mut line = Vec::new();
        input
            .by_ref()
            .take(LONGEST_HEADER)
            .read_until(b'\n', &mut line)?;
        if line.is_empty() {
            return Ok(None);
        }
        let line = String::from_utf8_lossy(&line);
        let line = line.trim();
        match (line.split_once(':'), length) {
            (Some((key, value)), _) if key.eq_ignore_ascii_case("content-length") => {
                length = value
                    .trim()
                    .parse()
                    .ok()
                    .filter(|length| *length <= LONGEST);
            }
            (None, Some(length)) if line.is_empty() => return Ok(Some(length)),
            (None, _) => {
                let found = format!("a header without a usable Content-Length: `{line}`");
                return Err(io::Error::new(io::ErrorKind::InvalidData, found));
            }
            (Some(_), _) => {}
        }
    }
}

/// Writes messages and numbers them.
pub(super) struct Outgoing<W> {
    output: W,
    seq: i64,
}

impl<W: Write> Outgoing<W> {
    pub(super) fn new(output: W) -> Self {
        Self { output, seq: 0 }
    }

    /// Answers a request.
    pub(super) fn respond(
        &mut self,
        request: &Request,
        answer: Result<Value, String>,
    ) -> io::Result<()> {
        let mut message = json!({
            "type": "response",
            "request_seq": request.seq,
            "command": request.command,
            "success": answer.is_ok(),
        });
        match answer {
            Ok(body) => message["body"] = body,
            Err(why) => {
                message["body"] = json!({ "error": { "id": 1, "format": why, "showUser": true } });
                message["message"] = why.into();
            }
        }
        self.send(message)
    }

    /// Tells the client of something.
    pub(super) fn event(&mut self, event: &str, body: &Value) -> io::Result<()> {
        self.send(json!({ "type": "event", "event": event, "body": body }))
    }

    fn send(&mut self, mut message: Value) -> io::Result<()> {
        self.seq += 1;
        message["seq"] = self.seq.into();
        let body = message.to_string();
        write!(self.output, "Content-Length: {}\r\n\r\n{body}", body.len())?;
        self.output.flush()
    }
}
