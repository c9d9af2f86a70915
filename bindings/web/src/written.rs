//! Bytes that a format writes and that are read afterwards.

use std::cell::RefCell;
use std::io::{self, Write};
use std::rc::Rc;

/// Bytes that a format writes; its copies are the same bytes.
#[derive(Debug, Clone, Default)]
pub(crate) struct WrittenBytes(Rc<RefCell<Vec<u8>>>);

impl WrittenBytes {
    pub(crate) fn take(&self) -> Vec<u8> {
        self.0.take()
    }
}

impl Write for WrittenBytes {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.0.borrow_mut().write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}
