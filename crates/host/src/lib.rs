//! Work that needs files or threads but not the command line: for the command line, an editor, Python, and other hosts
//! that run programs from a disk.
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

mod archive;
pub mod ask;
pub mod commission;
pub mod conformance;
mod disk;
mod drives;
mod error;
mod machines;
mod outputs;
mod recordings;
pub mod replay;
mod run;
mod simulations;
mod watch;
mod workers;

pub use archive::{
    ArchiveAuditor, AuditOptions, Baseline, CallGraph, CalledPrograms, ChangedFile,
    ChangedPrograms, CheckOptions, CheckedProgram, CheckedPrograms, FoundCall, FoundList,
    FoundPrograms, GraphProgram, KnownFindings, LeftOutFile, LeftOutFiles, MendedProgram,
    MissingCall, OldFile, ProgramsOnMachines, Revision, UnreadVariable, WhyLeftOut, find_programs,
    lists_below, outline_of, programs_in_order, unread_variables,
};
pub use disk::{
    CONFIG_NAME, Disk, EncodedText, FileRegistry, FolderOptions, FolderSelection, IgnoreFiles,
    Input, Naming, NotEncodable, OpenText, Replaces, SharedMap, decode, is_program, is_source,
    read_text, reopen, sha256_of,
};
pub use drives::{XmlError, read_devices, read_network};
pub use error::HostError;
pub use machines::{
    AllowedRoots, ConfigurationChoice, ListsOnDisk, LoadedMachine, MachineOfVersions,
    MachineOptions, MachineOwner, Machines, OutsidePolicy, ProgramFinder, SearchPath, UnusedAxes,
    check_list_file, find_plant, is_configuration, nearest_config, read_list, read_value_list,
    switched_axes,
};
pub use outputs::{
    MendedFile, OutputFile, OutputFiles, clean_up_when_stopped, mend, survive_file_size_limit,
    write_mended, write_new,
};
pub use recordings::{
    TraceError, channels_of, commanded_axes, is_recording, named_axes, read_axis, read_circles,
    read_commanded, read_trace, read_turns, recordings_in, refuse_copies, sole_axis,
};
pub use run::{
    Axes, ContourSetup, GoldenDrift, GoldenFile, GoldenKind, GoldenResults, NoDrivenContour,
    Programs, RunContext, RunSummary, SingleRun, StateFile, UpdatedFolder, drive_contour,
    expect_axes, open_session, run_alone, run_program, run_programs,
};
pub use simulations::{compare, learn, tune};
pub use watch::{Done, LineTracker, Passes, Progress, Reached, Watch, Watcher};
pub use workers::{in_order, memory_for_simulation, processors};
