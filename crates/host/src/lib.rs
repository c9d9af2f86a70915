//! Everything that needs files or threads but not the command line: for the command line, an editor,
//! Python, and other hosts that run programs from a disk.
//!
//! [`Machines`] finds the machine of a program from `frictcomp.toml` or the control's lists;
//! [`find_programs`] walks folders, an [`Input`] is one program, [`run_alone`] and [`run_program`]
//! run it with everything that it calls. [`StateFile`] holds the state that one run leaves for the next,
//! [`OutputFiles`] are put in place all at once, [`read_commanded`] and [`read_circles`] read recordings
//! of a machine, and [`compare`] and [`tune`] simulate on all processors.
//!
//! Nothing here prints or depends on options: long work reports to a [`Watcher`], and failures
//! are [`HostError`]s.
//!
//! ```
//! use frictcomp_host::{EncodedText, decode};
//!
//! // An umlaut in the code page of an old system.
//! assert_eq!(decode(b"N10 M30 (f\xfcr X)\n".to_vec()), "N10 M30 (für X)\n");
//! let file = EncodedText::new(b"N10 M30 (f\xfcr X)\n".to_vec());
//! assert_eq!(file.replaced([(4..7, "M2")])?, b"N10 M2 (f\xfcr X)\n");
//! # Ok::<(), frictcomp_host::NotEncodable>(())
//! ```

mod allowed_roots;
pub mod ask;
mod assumed;
mod atomic_file;
mod audits;
mod axes_ahead;
mod both_versions;
mod call_graph;
mod changed_programs;
pub mod commission;
pub mod conformance;
mod contours;
mod cures;
mod decode;
mod digest;
mod discovery;
mod disk;
mod dry_run;
mod encoded_text;
mod error;
mod file_kind;
mod finder;
mod first_look;
mod fixed_length;
mod git;
mod golden;
mod in_use;
mod input;
mod interrupt;
mod left_out;
mod lines;
mod list_files;
mod main_programs;
mod memory;
mod memory_disk;
mod mend;
mod open_text;
mod outputs;
mod parameter_files;
mod paths;
mod pieces;
mod read;
mod recorded_files;
mod registry;
pub mod replay;
mod selection;
mod shared_map;
mod signatures;
mod simulations;
mod state_file;
mod switched_axes;
mod switches;
mod trace_error;
mod traces;
mod unread;
mod walk;
mod watch;
mod workers;

pub use allowed_roots::{AllowedRoots, OutsidePolicy};
pub use assumed::UnusedAxes;
pub use audits::{ArchiveAuditor, AuditOptions};
pub use both_versions::{MachineOfVersions, MachineOwner};
pub use call_graph::{CallGraph, FoundCall, GraphProgram, MissingCall};
pub use changed_programs::ChangedPrograms;
pub use contours::{ContourSetup, NoDrivenContour, drive_contour};
pub use cures::MendedProgram;
pub use decode::decode;
pub use digest::{sha256_of, sha256_of_data, sha256_of_text};
pub use discovery::{ConfigurationChoice, LoadedMachine, MachineOptions, Machines, nearest_config};
pub use disk::Disk;
pub use dry_run::{
    Axes, Programs, RunContext, RunSummary, SingleRun, expect_axes, open_session, run_alone,
    run_program, run_programs,
};
pub use encoded_text::{EncodedText, NotEncodable};
pub use error::HostError;
pub use file_kind::{CONFIG_NAME, is_program, is_source};
pub use finder::{ProgramFinder, SearchPath};
pub use first_look::{find_startup, outline_of, write_new};
pub use git::{ChangedFile, OldFile, Revision};
pub use golden::{GoldenDrift, GoldenFile, GoldenKind, GoldenResults, UpdatedFolder};
pub use input::{Input, Naming, reopen};
pub use interrupt::{clean_up_when_stopped, survive_file_size_limit};
pub use left_out::{LeftOutFile, LeftOutFiles, WhyLeftOut};
pub use list_files::{ListsOnDisk, read_list};
pub use main_programs::{ExecutedProgram, main_programs};
pub use memory::memory_for_simulation;
pub use mend::{MendedFile, mend, write_mended};
pub use open_text::OpenText;
pub use outputs::{OutputFile, OutputFiles};
pub use parameter_files::{check_list_file, find_plant, read_value_list};
pub use read::read_text;
pub use recorded_files::{copies_among, recordings_in, refuse_copies};
pub use registry::{FileRegistry, Replaces};
pub use selection::{FolderOptions, FolderSelection, IgnoreFiles};
pub use signatures::{SignedAt, signatures_of};
pub use simulations::{compare, learn, tune};
pub use state_file::StateFile;
pub use switched_axes::switched_axes;
pub use switches::switches_of;
pub use trace_error::TraceError;
pub use traces::{
    is_recording, read_axis, read_circles, read_commanded, read_motion, read_trace, read_turns,
};
pub use unread::{UnreadVariable, unread_variables};
pub use walk::{FoundPrograms, find_programs};
pub use watch::{Done, Progress, Watch, Watcher};
pub use workers::{in_order, processors};

pub use shared_map::SharedMap;

pub use parameter_files::is_configuration;
pub use watch::{LineTracker, Passes, Reached};
