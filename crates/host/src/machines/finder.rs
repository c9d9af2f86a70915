//! Finds the programs that programs call, and no other files (R2.13, R2.16).

use std::borrow::Cow;
use std::collections::HashMap;
use std::ffi::OsString;
use std::io;
use std::path::{Path, PathBuf};

use super::allowed_roots::{AllowedRoots, OutsidePolicy};
use crate::disk::{
    Disk, FileRegistry, FolderEntry, Input, Naming, OpenText, PROGRAM, normal, spelt_as,
};
use frictcomp::interpreter::{Finder, NoProgram};
use frictcomp::text::SourceFile;

/// Folders of called programs besides the folder of the caller.
#[derive(Debug, Clone, Default)]
#[non_exhaustive]
pub struct SearchPath {
    /// The folders of `program_dirs`, searched in this order.
    pub program_dirs: Vec<PathBuf>,
    /// The folder of the configuration; empty, meaning the current one, without a configuration.
    pub project: PathBuf,
    /// Treatment of programs outside them.
    pub outside_policy: OutsidePolicy,
}

impl SearchPath {
    /// Returns the project, the configured folders and everything below them.
    pub fn allowed_roots(&self, disk: &Disk) -> AllowedRoots {
        let allowed_roots = AllowedRoots::on(disk, self.outside_policy).with(&self.project);
        self.program_dirs
            .iter()
            .fold(allowed_roots, |allowed_roots, folder| {
                allowed_roots.with(folder)
            })
    }
}

/// Finds called programs in the caller's folder and in the configured folders.
pub struct ProgramFinder {
    folders: Vec<PathBuf>,
    allowed_roots: AllowedRoots,
    naming: Naming,
    /// Paths of the files named so far.
    known: HashMap<String, PathBuf>,
    /// The names of the files that were found, by their real paths.
    names: HashMap<PathBuf, String>,
    /// Registry of the files read.
    registry: FileRegistry,
    disk: Disk,
}

impl ProgramFinder {
    /// Creates a finder for the programs that `main` calls.
    pub fn new(main: &Input, search_path: &SearchPath, naming: Naming, disk: &Disk) -> Self {
        let mut known = HashMap::new();
        let mut names = HashMap::new();
        if let Input::File(path) | Input::Open(OpenText { path, .. }) = main {
            let name = naming.name(path);
            names.extend(disk.real(path).map(|real| (real, name.clone())));
            known.insert(name, path.clone());
        }
        Self {
            folders: search_path.program_dirs.clone(),
            allowed_roots: search_path.allowed_roots(disk).with(main.folder()),
            naming,
            known,
            names,
            registry: FileRegistry::default(),
            disk: disk.clone(),
        }
    }

    /// Sets the registry that notes the files read.
    pub fn noting(self, registry: &FileRegistry) -> Self {
        let registry = registry.clone();
        Self { registry, ..self }
    }

    fn locate(&mut self, name: &str, caller: &str) -> Result<PathBuf, NoProgram> {
        let beside = self.folder_of(caller);
        self.locate_from(name, beside)
    }

    fn folder_of(&self, caller: &str) -> PathBuf {
        let folder = self.known.get(caller).and_then(|path| path.parent());
        folder.unwrap_or(Path::new("")).to_owned()
    }

    /// Returns the folders in which a program is looked for, in their order.
    fn folders_from(&self, beside: PathBuf) -> Vec<PathBuf> {
        let further = self.folders.iter().cloned();
        std::iter::once(beside).chain(further).collect()
    }

    /// Returns the file that a program in a folder refers to by a name. It is not read.
    pub(crate) fn place(&mut self, name: &str, folder: &Path) -> Result<PathBuf, NoProgram> {
        let path = self.locate_from(name, folder.to_owned())?;
        // Judged by the name alone, `..` after a link leads to a different file.
        let real = self.disk.real(&path);
        let plain = normal(&path);
        let is_same = real.is_ok_and(|real| self.disk.real(&plain).is_ok_and(|it| it == real));
        Ok(if is_same { plain } else { path })
    }

    fn locate_from(&mut self, name: &str, beside: PathBuf) -> Result<PathBuf, NoProgram> {
        // A path on the control's own disk means nothing here, but its last part does.
        let slashed = name.replace('\\', "/");
        let last = slashed.rsplit('/').next().unwrap_or(&slashed);
        let folders = self.folders_from(beside);
        let mut refused = None;
        for folder in &folders {
            for name in [slashed.as_str(), last] {
                match self.usable(folder, name) {
                    Ok(path) => return Ok(path),
                    Err(NoProgram::Absent) => {}
                    Err(why) => refused = refused.or(Some(why)),
                }
            }
        }
        let near = || self.with_extension(&folders, last);
        Err(refused.or_else(near).unwrap_or(NoProgram::Absent))
    }

    /// Returns a file that differs only in its extension, which the control expects in the call.
    fn with_extension(&mut self, folders: &[PathBuf], name: &str) -> Option<NoProgram> {
        let stem = format!("{}.", name.to_lowercase());
        for folder in folders {
            let listing = self.disk.listing(folder);
            let listed = listing.range(stem.clone()..);
            let begins = |(name, _): &(&String, &Vec<OsString>)| name.starts_with(&stem);
            let alike: Vec<OsString> = listed
                .take_while(begins)
                .filter_map(|(_, names)| names.first().cloned())
                .collect();
            let mut names = alike.iter().filter_map(|name| name.to_str());
            if let Some(near) = names.find(|name| self.usable(folder, name).is_ok()) {
                return Some(NoProgram::Near(near.to_owned()));
            }
        }
        None
    }

    /// Returns a file of that name in a folder, if it may be called.
    fn usable(&mut self, folder: &Path, name: &str) -> Result<PathBuf, NoProgram> {
        if name.is_empty() {
            return Err(NoProgram::Absent);
        }
        let name = &*native(name);
        if !self.allowed_roots.may_hold(&folder.join(name)) {
            return Err(NoProgram::Outside);
        }
        let path = self.existing(folder, name).ok_or(NoProgram::Absent)?;
        let entry = self.disk.entry(&path).map_err(|error| unusable(&error))?;
        if !self.allowed_roots.holds(&path) {
            return Err(NoProgram::Outside);
        }
        match entry {
            FolderEntry::File => Ok(path),
            FolderEntry::Folder => Err(NoProgram::Unusable("is a folder".to_owned())),
            FolderEntry::Special => Err(NoProgram::Unusable("is not a regular file".to_owned())),
        }
    }

    /// Returns the path of that name below a folder; the control's disk does not distinguish upper from lower
    /// case.
    fn existing(&mut self, folder: &Path, name: &str) -> Option<PathBuf> {
        let exact = folder.join(name);
        match self.disk.entry(&exact) {
            Err(error) if error.kind() == io::ErrorKind::NotFound => {}
            // A folder of that name may exist next to the file that is meant.
            Ok(FolderEntry::Folder | FolderEntry::Special) => {
                return Some(self.spelled(folder, name).unwrap_or(exact));
            }
            Ok(FolderEntry::File) | Err(_) => return Some(exact),
        }
        if Path::new(name).has_root() {
            return None;
        }
        self.spelled(folder, name)
    }

    /// Returns the path of that name below a folder, whatever the case of each part.
    fn spelled(&mut self, folder: &Path, name: &str) -> Option<PathBuf> {
        let mut path = folder.to_owned();
        let mut parts = name.split('/').filter(|part| !part.is_empty()).peekable();
        while let Some(part) = parts.next() {
            if matches!(part, "." | "..") {
                path.push(part);
                continue;
            }
            let is_last = parts.peek().is_none();
            let disk = self.disk.clone();
            let wanted = |path: &PathBuf| {
                let entry = disk.entry(path);
                entry.is_ok_and(|entry| (entry == FolderEntry::File) == is_last)
            };
            let exact = path.join(part);
            if wanted(&exact) {
                path = exact;
                continue;
            }
            let listing = self.disk.listing(&path);
            let alike = listing.get(&part.to_lowercase())?;
            let mut alike = alike.iter().map(|name| path.join(name));
            path = alike.find(wanted)?;
        }
        Some(path)
    }

    /// Returns the name of a file in records, which no other file has.
    fn name(&mut self, path: &Path) -> String {
        let real = self.disk.real(path);
        let real = real.unwrap_or_else(|_| path.to_owned());
        if let Some(name) = self.names.get(&real) {
            return name.clone();
        }
        // Judged by the name alone, `..` after a link leads to a different file.
        let shown = Some(normal(path))
            .filter(|shown| self.disk.real(shown).is_ok_and(|shown| shown == real));
        let mut shown = shown.unwrap_or_else(|| path.to_owned());
        if cfg!(windows) {
            shown = spelt_as(&shown, &real);
        }
        let mut name = self.naming.name(&shown);
        let mut parts = shown.iter().rev().skip(1);
        while self.known.contains_key(&name) {
            let Some(part) = parts.next() else { break };
            name = format!("{}/{name}", part.to_string_lossy());
        }
        self.names.insert(real, name.clone());
        self.known.insert(name.clone(), path.to_owned());
        name
    }
}

impl Finder for ProgramFinder {
    fn find(&mut self, name: &str, caller: &str) -> Result<SourceFile, NoProgram> {
        let path = self.locate(name, caller);
        let path = path.inspect_err(|_| self.registry.misses(name))?;
        self.registry.reads(PROGRAM, &path);
        let text = self.disk.read(&path).map_err(|error| unusable(&error))?;
        Ok(SourceFile::new(self.name(&path), text))
    }

    fn others(&mut self, name: &str, caller: &str) -> Vec<String> {
        let folders = self.folders_from(self.folder_of(caller));
        // A name with a folder says which file is meant.
        if name.contains(['/', '\\']) || folders.len() < 2 {
            return Vec::new();
        }
        let found = folders
            .iter()
            .filter_map(|folder| self.usable(folder, name).ok());
        let found: Vec<PathBuf> = found.collect();
        let disk = self.disk.clone();
        let text = |path: &PathBuf| disk.read(path).ok();
        let Some((taken, others)) = found.split_first() else {
            return Vec::new();
        };
        let (real, taken) = (disk.real(taken).ok(), text(taken));
        let differs = |path: &&PathBuf| disk.real(path).ok() != real && text(path) != taken;
        others
            .iter()
            .filter(differs)
            .map(|path| self.name(path))
            .collect()
    }
}

/// Returns a name in the system's form; one with a drive, `C:/CNC/sub.nc`, begins at a root on every system.
fn native(name: &str) -> Cow<'_, str> {
    let drive = name.as_bytes().get(1) == Some(&b':');
    if drive && !cfg!(windows) {
        Cow::Owned(format!("/{name}"))
    } else {
        Cow::Borrowed(name)
    }
}

fn unusable(error: &io::Error) -> NoProgram {
    NoProgram::Unusable(match error.kind() {
        io::ErrorKind::NotFound | io::ErrorKind::NotADirectory => return NoProgram::Absent,
        io::ErrorKind::PermissionDenied => "cannot be read: permission denied".to_owned(),
        io::ErrorKind::IsADirectory => "is a folder".to_owned(),
        io::ErrorKind::InvalidInput => "has a name that no file can have".to_owned(),
        _ => format!("cannot be read: {error}"),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn called_programs_are_found_beside_the_caller_and_in_the_folders() {
        let root = tempfile::tempdir().unwrap();
        let path = |name: &str| root.path().join(name);
        std::fs::create_dir_all(path("cycles/deep")).unwrap();
        std::fs::write(path("main.nc"), "L SUB.nc").unwrap();
        std::fs::write(path("sub.nc"), "beside").unwrap();
        std::fs::write(path("cycles/drill.nc"), "folder").unwrap();
        std::fs::write(path("cycles/deep/x.nc"), "deep").unwrap();
        let main = Input::File(path("main.nc"));
        let search_path = SearchPath {
            program_dirs: vec![path("cycles")],
            ..SearchPath::default()
        };
        for naming in [Naming::AsGiven, Naming::FileName] {
            let mut finder = ProgramFinder::new(&main, &search_path, naming, &Disk::default());
            let caller = main.name(naming);
            let mut find = |name: &str| {
                let found = finder.find(name, &caller).ok();
                found.map(|file| file.text().to_owned())
            };
            assert_eq!(find("SUB.NC").as_deref(), Some("beside"));
            assert_eq!(find(r"C:\CNC\prg\sub.nc").as_deref(), Some("beside"));
            assert_eq!(find("drill.nc").as_deref(), Some("folder"));
            assert_eq!(find(r"deep\x.nc").as_deref(), Some("deep"));
            assert_eq!(find("missing.nc"), None);
            assert_eq!(find(""), None);
            let shown = finder.find("sub.nc", &caller).ok().unwrap();
            assert_eq!(naming == Naming::FileName, &**shown.name() == "sub.nc");
        }
    }

    #[test]
    fn what_lies_elsewhere_is_not_called() {
        // R2.16
        let root = tempfile::tempdir().unwrap();
        let path = |name: &str| root.path().join(name);
        std::fs::create_dir_all(path("project/programs")).unwrap();
        std::fs::create_dir_all(path("project/Cycles")).unwrap();
        std::fs::create_dir_all(path("shared/deep")).unwrap();
        std::fs::create_dir_all(path("project/programs/folder.nc")).unwrap();
        for name in [
            "secret.nc",
            "project/programs/main.nc",
            "project/Cycles/Drill.nc",
            "shared/deep/x.nc",
        ] {
            std::fs::write(path(name), "text").unwrap();
        }
        let main = Input::File(path("project/programs/main.nc"));
        let search_path = |outside_policy| SearchPath {
            program_dirs: vec![path("shared")],
            project: path("project"),
            outside_policy,
        };
        let caller = main.name(Naming::AsGiven);
        let secret = path("secret.nc").display().to_string();
        let why = |outside_policy, name: &str| {
            let mut finder = ProgramFinder::new(
                &main,
                &search_path(outside_policy),
                Naming::AsGiven,
                &Disk::default(),
            );
            finder
                .find(name, &caller)
                .map(|file| file.text().to_owned())
        };
        for name in [
            "../cycles/drill.nc",
            r"..\CYCLES\DRILL.NC",
            "../../shared/deep/x.nc",
            "deep/x.nc",
            r"C:\CNC\prg\main.nc",
        ] {
            assert_eq!(
                why(OutsidePolicy::Kept, name).as_deref(),
                Ok("text"),
                "{name}"
            );
        }
        for name in [
            "../../secret.nc",
            r"..\..\secret.nc",
            "../../not-there.nc",
            &secret,
            r"\\server\share\secret.nc",
            r"D:\secret.nc",
        ] {
            assert_eq!(
                why(OutsidePolicy::Kept, name),
                Err(NoProgram::Outside),
                "{name}"
            );
        }
        assert_eq!(
            why(OutsidePolicy::Allowed, "../../secret.nc").as_deref(),
            Ok("text")
        );
        assert_eq!(why(OutsidePolicy::Allowed, &secret).as_deref(), Ok("text"));
        assert_eq!(
            why(OutsidePolicy::Kept, "not-there.nc"),
            Err(NoProgram::Absent)
        );
        let folder = NoProgram::Unusable("is a folder".to_owned());
        assert_eq!(why(OutsidePolicy::Kept, "folder.nc"), Err(folder));
    }

    #[test]
    fn files_of_one_name_keep_apart() {
        let root = tempfile::tempdir().unwrap();
        let path = |name: &str| root.path().join(name);
        for name in ["one", "two"] {
            std::fs::create_dir(path(name)).unwrap();
            std::fs::write(path(name).join("sub.nc"), name).unwrap();
        }
        std::fs::write(path("main.nc"), "").unwrap();
        let main = Input::File(path("main.nc"));
        let search_path = SearchPath::default();
        let mut finder =
            ProgramFinder::new(&main, &search_path, Naming::FileName, &Disk::default());
        let mut find = |name: &str| finder.find(name, "main.nc").ok().unwrap();
        let (one, two, again) = (
            find("one/sub.nc"),
            find("two/sub.nc"),
            find("two/../one/SUB.nc"),
        );
        assert_eq!((&**one.name(), one.text()), ("sub.nc", "one"));
        assert_eq!((&**two.name(), two.text()), ("two/sub.nc", "two"));
        assert_eq!(again.name(), one.name());
    }
}
