//! Bytes on their way to a writer.

use std::io::{self, Write};
use std::ops::ControlFlow;

use frictcomp::timeline::Sink;

/// Number of bytes gathered before they are written.
const CHUNK: usize = 64 * 1024;

/// A timeline format whose output can be ended.
pub trait Report: Sink {
    /// Writes what is complete before the next record. Formats that fold or hold back records keep
    /// those.
    fn flush(&mut self) -> ControlFlow<()>;

    /// Writes what is still held back.
    ///
    /// # Errors
    /// The first error of the writer, except a closed pipe.
    fn finish(&mut self) -> io::Result<()>;

    /// Returns whether the reader closed the pipe.
    fn is_closed(&self) -> bool;
}

/// A format that gathers its bytes before it writes them.
pub(crate) trait Gathered: Sink {
    /// Destination of the bytes.
    type Writer: Write;

    /// Returns the bytes on their way.
    fn output(&self) -> &Output<Self::Writer>;

    /// Returns the bytes on their way.
    fn output_mut(&mut self) -> &mut Output<Self::Writer>;

    /// Gathers what was held back, and the end of the document.
    fn close(&mut self) {}
}

impl<F: Gathered> Report for F {
    fn flush(&mut self) -> ControlFlow<()> {
        self.output_mut().flush()
    }

    fn finish(&mut self) -> io::Result<()> {
        self.close();
        self.output_mut().finish()
    }

    fn is_closed(&self) -> bool {
        self.output().is_closed()
    }
}

/// Bytes on their way to a writer, in chunks.
#[derive(Debug)]
pub(crate) struct Output<W> {
    writer: W,
    pub(crate) bytes: Vec<u8>,
    /// Offset of what a further record may change or take back.
    pub(crate) open: Option<usize>,
    failure: Option<io::Error>,
}

impl<W: Write> Output<W> {
    pub(crate) fn new(writer: W) -> Self {
        Self {
            writer,
            bytes: Vec::with_capacity(CHUNK + CHUNK / 4),
            open: None,
            failure: None,
        }
    }

    /// Returns the bytes for what a further record may change or take back.
    pub(crate) fn open_bytes(&mut self) -> &mut Vec<u8> {
        self.open = Some(self.bytes.len());
        &mut self.bytes
    }

    /// Writes if a chunk is full.
    pub(crate) fn settle(&mut self) -> ControlFlow<()> {
        if self.bytes.len() >= CHUNK {
            return self.flush();
        }
        self.verdict()
    }

    /// Writes everything that is not open.
    pub(crate) fn flush(&mut self) -> ControlFlow<()> {
        let end = self.open.unwrap_or(self.bytes.len());
        if self.failure.is_none() && end > 0 {
            let written = self
                .writer
                .write_all(&self.bytes[..end])
                .and_then(|()| self.writer.flush());
            self.failure = written.err();
        }
        self.bytes.drain(..end);
        self.open = self.open.map(|_| 0);
        self.verdict()
    }

    fn verdict(&self) -> ControlFlow<()> {
        if self.failure.is_some() {
            ControlFlow::Break(())
        } else {
            ControlFlow::Continue(())
        }
    }

    pub(crate) fn finish(&mut self) -> io::Result<()> {
        self.open = None;
        let _ = self.flush();
        match self.failure.take() {
            Some(error) if error.kind() == io::ErrorKind::BrokenPipe => {
                self.failure = Some(error);
                Ok(())
            }
            Some(error) => Err(error),
            None => Ok(()),
        }
    }

    pub(crate) fn is_closed(&self) -> bool {
        self.failure
            .as_ref()
            .is_some_and(|error| error.kind() == io::ErrorKind::BrokenPipe)
    }
}
