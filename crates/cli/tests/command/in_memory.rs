//! A disk in memory gives the records that the same files give on the disk of the system.

use std::cell::RefCell;
use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::rc::Rc;
use std::sync::Arc;

use crate::folder::call;
use crate::workspace::root;
use frictcomp::interpreter::{Limits, Options};
use frictcomp::session::SessionOptions;
use frictcomp_host::decode;
use frictcomp_host::{
    Axes, Disk, FileRegistry, FolderSelection, HostError, Input, MachineOptions, Machines, Naming,
    OpenText, SingleRun, find_programs, run_alone,
};
use frictcomp_report::{TimelineFormat, TimelineOptions, command_line};

/// The bound on executed blocks for all programs, so that an endless loop is noticed.
const MAX_BLOCKS: u64 = 5000;

/// Returns every file below a folder of the repository, by its path from the root.
fn texts(folder: &str) -> Vec<OpenText> {
    let mut folders = vec![PathBuf::from(folder)];
    let mut texts = Vec::new();
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(root().join(&folder)).expect("a folder") {
            let path = folder.join(entry.expect("an entry").file_name());
            if root().join(&path).is_dir() {
                folders.push(path);
                continue;
            }
            let bytes = fs::read(root().join(&path)).expect("a file");
            texts.push(OpenText {
                path,
                text: Arc::new(decode(bytes)),
            });
        }
    }
    texts
}

/// The output of a timeline.
#[derive(Clone, Default)]
struct Written(Rc<RefCell<Vec<u8>>>);

impl Write for Written {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.0.borrow_mut().write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

/// Returns the records of a program on a disk in memory.
fn records(program: &OpenText, disk: &Disk) -> Result<Vec<u8>, HostError> {
    let input = Input::Open(program.clone());
    let mut machines =
        Machines::new(MachineOptions::default(), &FileRegistry::default()).on_disk(disk);
    let loaded = machines.for_folder(input.folder())?;
    let limits = Limits::default().with_blocks(MAX_BLOCKS);
    let options = SessionOptions::from(Options::default().with_limits(limits))
        .with_levels(loaded.levels.clone())
        .with_settings(loaded.settings.clone())
        .with_wording(Some(command_line));
    let alone = SingleRun {
        options,
        naming: Naming::AsGiven,
        axes: Axes::Ahead,
    };
    let written = Written::default();
    let mut report = TimelineFormat::Ndjson.report(written.clone(), TimelineOptions::default());
    run_alone(&input, &loaded, alone, &mut *report)?;
    report.finish().expect("memory takes everything");
    Ok(written.0.take())
}

#[test]
fn programs_in_memory_run_as_on_the_disk() {
    // R13.3
    let texts = texts("programs");
    let disk = Disk::in_memory(texts.iter().cloned());
    let folder = [root().join("programs")];
    let found = find_programs(&folder, |_| FolderSelection::default()).inputs;
    assert!(found.len() > 150, "{}", found.len());
    for input in found {
        let name = input.name(Naming::AsGiven);
        let below = Path::new(&name).strip_prefix(root()).expect("below");
        let program = texts.iter().find(|it| it.path == below).expect("read");
        let blocks = MAX_BLOCKS.to_string();
        let path = below.to_str().expect("a name in UTF-8");
        let on_disk = call(
            root(),
            &["run", "--format", "ndjson", "--max-blocks", &blocks, path],
        );
        match records(program, &disk) {
            Ok(records) => assert_eq!(
                String::from_utf8_lossy(&records),
                String::from_utf8_lossy(&on_disk.stdout),
                "{name}"
            ),
            Err(error) => {
                let said = String::from_utf8_lossy(&on_disk.stderr);
                assert!(said.contains(&error.to_string()), "{name}: {error}: {said}");
            }
        }
    }
}
