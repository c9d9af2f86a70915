//! Files that are written: put in place in one step, or not at all.

mod atomic_file;
mod files;
mod in_use;
mod interrupt;
mod mend;

pub(crate) use atomic_file::target;
pub(crate) use files::json_text;
pub use files::{OutputFile, OutputFiles};
pub(crate) use in_use::{device, told};
pub use interrupt::{clean_up_when_stopped, survive_file_size_limit};
pub(crate) use mend::read_encoded;
pub use mend::{MendedFile, mend, write_mended, write_new};
