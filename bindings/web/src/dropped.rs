//! The dropped files: programs, lists and configurations on a disk in memory.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use frictcomp::lists::ListKind;
use frictcomp::machine::{NoLists, check_list};
use frictcomp::text::SourceFile;
use frictcomp_host::decode;
use frictcomp_host::{
    Disk, FileRegistry, Input, LeftOutFile, LoadedMachine, MachineOptions, Machines, OpenText,
    check_list_file, is_program, nearest_config,
};
use frictcomp_recordings::trace::{Choice, TraceReader};
use serde::Serialize;

use crate::refusal::Refusal;

/// The role of a file for the page.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub(crate) enum Kind {
    Program,
    List,
    /// A list with the compensation values of an axis.
    Values,
    Startup,
    Configuration,
    /// A table of samples.
    Recording,
    /// A picture or a document to be printed.
    Picture,
    /// A program for another control.
    Foreign,
    /// File of a folder whose extension is not that of a program.
    Other,
}

/// A dropped file.
#[derive(Debug)]
struct DroppedFile {
    text: Arc<String>,
    kind: Kind,
}

/// The dropped files.
#[derive(Debug, Default)]
pub(crate) struct Dropped {
    files: BTreeMap<PathBuf, DroppedFile>,
    /// The disk with them, once it was requested.
    disk: Option<Disk>,
}

impl Dropped {
    /// Accepts a file, replacing one with the same path. `named` means that the user picked it individually: a
    /// file that is not a list is then a program, whatever its extension.
    pub(crate) fn put(&mut self, path: &str, content: Vec<u8>, named: bool) {
        let path = PathBuf::from(path.trim_start_matches('/'));
        let is_picture = is_picture(&path, &content);
        let text = Arc::new(decode(content));
        let kind = match self.files.get(&path) {
            _ if is_picture => Kind::Picture,
            // An edited text keeps its role.
            Some(before) if before.kind == Kind::Program => Kind::Program,
            _ => kind_of(&path, &text, named),
        };
        self.files.insert(path, DroppedFile { text, kind });
        self.disk = None;
    }

    /// Forgets all files.
    pub(crate) fn clear(&mut self) {
        *self = Self::default();
    }

    /// Returns the files with their roles; the extensions of a configuration count.
    pub(crate) fn files(&mut self) -> Vec<(String, Kind)> {
        let disk = self.disk();
        let mut machines =
            Machines::new(MachineOptions::default(), &FileRegistry::default()).on_disk(&disk);
        let files = self.files.iter().map(|(path, file)| {
            let kind = match file.kind {
                Kind::Other => {
                    let folder = path.parent().unwrap_or(path);
                    match machines.selection(folder).extensions {
                        Some(extensions) if is_program(path, Some(&extensions)) => Kind::Program,
                        _ => Kind::Other,
                    }
                }
                kind => kind,
            };
            (path.display().to_string(), kind)
        });
        files.collect()
    }

    pub(crate) fn disk(&mut self) -> Disk {
        let files = &self.files;
        let disk = self.disk.get_or_insert_with(|| {
            Disk::in_memory(files.iter().map(|(path, file)| OpenText {
                path: path.clone(),
                text: Arc::clone(&file.text),
            }))
        });
        disk.clone()
    }

    /// Returns a file that is not taken as a program.
    pub(crate) fn left_out(&self, path: &str) -> Option<LeftOutFile> {
        let path = Path::new(path);
        let file = self.files.get(path)?;
        Some(LeftOutFile::in_memory(path.to_owned(), &file.text))
    }

    /// Returns a program by its path.
    pub(crate) fn program(&self, path: &str) -> Result<Input, Refusal> {
        let path = Path::new(path);
        let file = self.files.get(path).ok_or_else(|| {
            Refusal::new(format!("there is no program `{}`", path.display()))
                .with_help("drop it again")
        })?;
        Ok(Input::Open(OpenText {
            path: path.to_owned(),
            text: Arc::clone(&file.text),
        }))
    }

    /// Returns the options for finding the machine of programs: from the nearest `frictcomp.toml` as on the command
    /// line, or, where none was dropped, from the only start-up list.
    pub(crate) fn options(&mut self, folder: &Path, enable: &[String]) -> MachineOptions {
        let disk = self.disk();
        let mut options = MachineOptions {
            enable: enable.to_vec(),
            ..MachineOptions::default()
        };
        if nearest_config(folder, &disk).is_none() {
            options.startup = self.only_startup();
        }
        options
    }

    /// Returns the start-up list, if there is exactly one.
    fn only_startup(&self) -> Option<PathBuf> {
        let files = self.files.iter();
        let has_cnc = |path: &Path| match &self.disk {
            Some(disk) if !is_list(path) => check_list_file(path, None, disk).is_ok(),
            _ => true,
        };
        let mut startups = files.filter(|(path, file)| file.kind == Kind::Startup && has_cnc(path));
        let (path, _) = startups.next()?;
        startups.next().is_none().then(|| path.clone())
    }

    /// Returns the machine of a program.
    pub(crate) fn machine(
        &mut self,
        input: &Input,
        enable: &[String],
    ) -> Result<Arc<LoadedMachine>, Refusal> {
        let options = self.options(input.folder(), enable);
        let mut machines = Machines::new(options, &FileRegistry::default()).on_disk(&self.disk());
        machines.look_ahead(std::slice::from_ref(input));
        Ok(machines.for_folder(input.folder())?)
    }
}

fn is_list(path: &Path) -> bool {
    let extension = path.extension();
    extension.is_some_and(|it| it.eq_ignore_ascii_case("lis"))
}

fn kind_of(path: &Path, text: &str, named: bool) -> Kind {
    let extension = path.extension().unwrap_or_default();
    if extension.eq_ignore_ascii_case("toml") {
        return Kind::Configuration;
    }
    if extension.eq_ignore_ascii_case("tsproj") {
        return Kind::Startup;
    }
    if extension.eq_ignore_ascii_case("xti") {
        return Kind::List;
    }
    if is_list(path) {
        let list = SourceFile::new(path.display().to_string(), text);
        return match check_list(list, None, &mut NoLists).kind {
            Some(ListKind::Startup) => Kind::Startup,
            Some(ListKind::Value) => Kind::Values,
            _ => Kind::List,
        };
    }
    let is_one_of = |known: &[&str]| known.iter().any(|it| extension.eq_ignore_ascii_case(it));
    if is_one_of(&RECORDINGS) || is_one_of(&["txt", "xml"]) && is_table(text) {
        return Kind::Recording;
    }
    if is_for_another_control(text) {
        return Kind::Foreign;
    }
    if named || is_program(path, None) {
        Kind::Program
    } else {
        Kind::Other
    }
}

/// Extensions of files that hold samples, or are known to hide them.
const RECORDINGS: [&str; 7] = ["csv", "tsv", "svdx", "svd", "svb", "tdms", "tcscopex"];

/// Returns whether a text has columns of samples.
fn is_table(text: &str) -> bool {
    let mut is_table = false;
    let mut reader = TraceReader::new(1, |_| {
        is_table = true;
        Ok(Choice::default())
    });
    // It ends at the second row of samples.
    let _ = reader.feed(text.as_bytes()).and_then(|()| reader.finish());
    is_table
}

/// Beginnings of pictures and of documents to be printed.
const PICTURES: [&[u8]; 6] = [
    b"\x89PNG",
    b"\xff\xd8\xff",
    b"GIF8",
    b"BM",
    b"%PDF",
    b"<svg",
];

fn is_picture(path: &Path, content: &[u8]) -> bool {
    let is_svg = path
        .extension()
        .is_some_and(|it| it.eq_ignore_ascii_case("svg"));
    // A program may begin with these letters.
    let is_bitmap = |beginning: &[u8]| beginning != b"BM" || content.contains(&0);
    is_svg
        || PICTURES
            .iter()
            .any(|it| content.starts_with(it) && is_bitmap(it))
}

/// Returns whether a text begins as a program for Heidenhain in its own language, with `BEGIN PGM` in its first line.
fn is_for_another_control(text: &str) -> bool {
    let first = text.lines().find(|line| !line.trim().is_empty());
    let words = first.unwrap_or_default().split_whitespace();
    let words = words.skip_while(|word| word.bytes().all(|it| it.is_ascii_digit()));
    words.take(2).eq(["BEGIN", "PGM"])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_no_program_is_told_apart_before_anything_runs() {
        // R13.18
        let mut dropped = Dropped::default();
        dropped.put("a.csv", b"t;x\n0;1\n".to_vec(), true);
        dropped.put("b.png", b"\x89PNG\r\n".to_vec(), true);
        dropped.put("c.h", b"0 BEGIN PGM C MM\n".to_vec(), true);
        dropped.put("d.nc", b"BMX=1\nM30\n".to_vec(), true);
        dropped.put("e.txt", b"t;x\n0;1\n0,1;2\n".to_vec(), true);
        dropped.put("f.txt", b"N10 X1\nN20 M30\n".to_vec(), true);
        dropped.put("g.svdx", b"PK\0".to_vec(), true);
        let kinds: Vec<Kind> = dropped.files().into_iter().map(|(_, kind)| kind).collect();
        let wanted = [
            Kind::Recording,
            Kind::Picture,
            Kind::Foreign,
            Kind::Program,
            Kind::Recording,
            Kind::Program,
            Kind::Recording,
        ];
        assert_eq!(kinds, wanted);
    }

    #[test]
    fn files_are_told_apart() {
        let mut dropped = Dropped::default();
        dropped.put("a/part.nc", b"M30".to_vec(), false);
        dropped.put("a/notes.txt", b"hello".to_vec(), false);
        dropped.put("picked.txt", b"M30".to_vec(), true);
        dropped.put(
            "a/hochlauf.lis",
            b"kanal_anzahl 1\nlisten.achse_anzahl 1\n".to_vec(),
            false,
        );
        let kinds: Vec<Kind> = dropped.files().into_iter().map(|(_, kind)| kind).collect();
        assert_eq!(
            kinds,
            [Kind::Startup, Kind::Other, Kind::Program, Kind::Program]
        );
        assert!(dropped.program("a/part.nc").is_ok() && dropped.program("b.nc").is_err());
        assert!(dropped.options(Path::new("a"), &[]).startup.is_some());
        dropped.put(
            "a/frictcomp.toml",
            b"extensions = [\"txt\"]".to_vec(),
            false,
        );
        assert_eq!(dropped.options(Path::new("a"), &[]).startup, None);
        dropped.clear();
        assert_eq!(dropped.files(), []);
        let project = "<TcSmProject><Cnc><Axis File=\"X.xti\"/></Cnc></TcSmProject>";
        let part = "<TcSmItem><ItemName>A</ItemName><AchsMds>kopf.achs_nr 1\nkopf.log_achs_name X\nlr_param.frict_comp 1\nEnde\n</AchsMds></TcSmItem>";
        dropped.put("p/Machine.tsproj", project.into(), false);
        dropped.put("p/Plc.tsproj", b"<TcSmProject/>".to_vec(), false);
        dropped.put("p/_Config/CNC/X.xti", part.into(), false);
        dropped.put("p/part.nc", b"X[COMP ON FRICT]\nM30\n".to_vec(), false);
        // R3.42
        let input = dropped.program("p/part.nc").expect("a program");
        let loaded = dropped.machine(&input, &[]).expect("a machine");
        assert_eq!(loaded.machine.axes.len(), 1);
        assert_eq!(
            loaded.origin.as_deref(),
            Some(Path::new("p/Machine.tsproj"))
        );
    }
}
