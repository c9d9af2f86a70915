//! Files and their texts, read from the system or from memory.

mod decode;
mod encoded_text;
mod file_kind;
mod files;
mod fixed_length;
mod input;
mod lines;
mod memory_disk;
mod paths;
mod read;
mod registry;
mod selection;
mod shared_map;

pub use decode::decode;
pub use encoded_text::{EncodedText, NotEncodable};
pub use file_kind::{CONFIG_NAME, is_program, is_source};
pub(crate) use file_kind::{has_extension, is_known_otherwise, is_list, is_parameters, is_project};
pub use files::Disk;
pub(crate) use input::Opened;
pub use input::{Input, Naming, OpenText, reopen};
pub(crate) use lines::{LineReader, whole_lines};
pub(crate) use paths::{FolderEntry, normal, relative, spelt_as};
pub(crate) use read::{
    MOST_KEPT, open_regular, read_bytes, sha256_of_data, sha256_of_text, too_big,
};
pub use read::{read_text, sha256_of};
pub(crate) use registry::{Claim, PROGRAM, folder};
pub use registry::{FileRegistry, Replaces};
pub(crate) use selection::{EntryFilter, is_filled_by_a_tool};
pub use selection::{FolderOptions, FolderSelection, IgnoreFiles};
pub use shared_map::SharedMap;
