//! Reads the machine of a TwinCAT project: follows its references, and gives each list to its axis or channel (R3.42).

use std::sync::Arc;

use super::axis::AxisDraft;
use super::loader::{EmbeddedList, Loader, NoList, folder, join};
use crate::diagnostic::{Code, Diagnostic, Severity};
use crate::lists::{
    AxisPlacement, Given, ListKind, NamedList, NoProject, Project, ProjectList, ProjectReference,
    StartupList,
};
use crate::text::{SourceFile, Span};

/// Limit on the files between a project and an item, beyond any project.
const MAX_DEPTH: usize = 16;

/// Limit on the files of a project, beyond any project; further ones are not read.
const MAX_FILES: usize = 4096;

/// Elements whose files hold no lists of the control; without them nothing is missing.
const WITHOUT_LISTS: [&str; 6] = ["Plc", "Io", "Safety", "Splc", "Cpp", "System"];

/// A project while its files are read.
#[derive(Default)]
struct Files {
    project: Project,
    /// The files from the project to the one that is read.
    path: Vec<Arc<str>>,
    /// Names of the files that were read.
    read: Vec<Arc<str>>,
    missing: usize,
}

impl Loader<'_> {
    /// Returns the axes of a project, as those of a start-up list that names its lists.
    ///
    /// # Errors
    /// The file is no TwinCAT project, or holds no list of the control.
    pub(super) fn project(&mut self, file: &Arc<SourceFile>) -> Result<Vec<AxisDraft>, NoProject> {
        let mut files = Files::default();
        self.part(file, &[], &mut files)?;
        if files.project.lists.is_empty() && files.project.empty.is_empty() {
            let missing = match files.missing {
                0 => String::new(),
                1 => "; 1 file that it refers to is missing".to_owned(),
                several => format!("; {several} files that it refers to are missing"),
            };
            return Err(NoProject {
                reason: format!(
                    "a TwinCAT project without a CNC: no text in it is a list of the control{missing}"
                ),
                span: Span::new(0, 0),
            });
        }
        self.missing += files.missing;
        self.startup_folder = Some(folder(file.name()).to_owned());
        let startup = self.startup_of(&files.project);
        Ok(self.listed(&startup))
    }

    /// Reads a file of a project, and those that it refers to.
    fn part(
        &mut self,
        file: &Arc<SourceFile>,
        around: &[usize],
        files: &mut Files,
    ) -> Result<(), NoProject> {
        files.read.push(file.name().clone());
        files.path.push(file.name().clone());
        self.names.push(file.name().clone());
        let references = files.project.add(file, around)?;
        for reference in references {
            self.follow(&reference, files);
        }
        files.path.pop();
        Ok(())
    }

    fn follow(&mut self, reference: &ProjectReference, files: &mut Files) {
        let written = &reference.path;
        let found = self.find_part(reference);
        let file = match found {
            Ok(file) => Arc::new(file),
            Err(reason) => {
                let mut elements = reference.elements.iter();
                let is_other =
                    elements.any(|it| WITHOUT_LISTS.iter().any(|no| no.eq_ignore_ascii_case(it)));
                let named = format!(
                    "`{}`, named in line {} of `{}`, {reason}",
                    written.value,
                    written.line(),
                    written.file()
                );
                let mut said = Diagnostic::new(Code::Fc123, written.place(), named);
                if is_other {
                    said.severity = Severity::Info;
                } else {
                    files.missing += 1;
                }
                let help = "what it says about the machine is not known; copy the project with its folder `_Config`";
                self.diagnostics.push(said.with_help(help));
                return;
            }
        };
        let refuse = |message: String| {
            Diagnostic::new(Code::Fc124, written.place(), message)
                .with_help("the lists in it are not read")
        };
        if files.path.contains(file.name()) {
            let message = format!(
                "`{}` leads back to itself; it is not read again",
                written.value
            );
            self.diagnostics.push(refuse(message));
        } else if files.read.contains(file.name()) {
            // Its lists are there already.
        } else if files.path.len() >= MAX_DEPTH || files.read.len() >= MAX_FILES {
            let message = format!(
                "`{}` is not read: {MAX_DEPTH} files lead to it one from another, or {MAX_FILES} were read",
                written.value
            );
            self.diagnostics.push(refuse(message));
        } else if let Err(error) = self.part(&file, &reference.items, files) {
            files.path.pop();
            let line = file.lines().line(error.span.start);
            let message = format!("`{}`, line {line}: {error}", file.name());
            self.diagnostics.push(refuse(message));
        }
    }

    /// Finds a file beside the one that names it, in a folder named like it, or below `_Config`.
    fn find_part(&mut self, reference: &ProjectReference) -> Result<SourceFile, String> {
        let written = &reference.path;
        let beside = folder(written.file());
        let name = written
            .file()
            .rsplit(['/', '\\'])
            .next()
            .unwrap_or_default();
        let stem = name.rsplit_once('.').map_or(name, |(stem, _)| stem);
        // Parts lie in `_Config`, in a folder of their kind: `_Config/NC/Axes/Axis 1.xti`.
        let of_elements = reference.elements.iter().rev();
        let of_elements = of_elements.flat_map(|it| [it.clone(), format!("_Config/{it}")]);
        let folders = ["", stem, "_Config", "Axes"].map(str::to_owned);
        let mut unreadable = None;
        for below in folders.into_iter().chain(of_elements) {
            let path = without_dots(&join(&join(beside, &below), &written.value));
            match self.files.read(&path) {
                Ok(file) => return Ok(file),
                Err(NoList::Missing) => {}
                Err(NoList::Unreadable(why)) => {
                    unreadable.get_or_insert(why);
                }
            }
        }
        Err(unreadable.map_or_else(
            || "is not found".to_owned(),
            |why| format!("cannot be read: {why}"),
        ))
    }

    /// Gives the lists of a project to their axes and channels.
    fn startup_of(&mut self, project: &Project) -> StartupList {
        let mut startup = StartupList::default();
        // The items that have an axis list, with its name.
        let mut owners: Vec<(usize, String)> = Vec::new();
        for list in &project.lists {
            let path = self.embed(project, list);
            let item = list.items.first().copied();
            match list.kind {
                Some(ListKind::Axis | ListKind::Head) => {
                    if let Some(first) = item.and_then(|it| owners.iter().find(|(at, _)| *at == it))
                    {
                        let message = format!(
                            "`{}` is the second axis list of its item, after `{}`",
                            path.value, first.1
                        );
                        self.leave_out(&path, message);
                        continue;
                    }
                    if let Some(at) = item {
                        owners.push((at, path.value.clone()));
                        let item = &project.items[at];
                        startup.placements.push(AxisPlacement {
                            list: path.value.clone(),
                            channel: item.channel.clone(),
                            index: item.index.as_ref().map(|given| given.value),
                            name: item.program_name.clone(),
                        });
                    }
                    startup.axis_lists.push(path);
                }
                Some(ListKind::Channel) => startup.channel_lists.push(path),
                Some(ListKind::Startup) => {
                    let message = format!(
                        "`{}` is a start-up list; the items of the project take its place",
                        path.value
                    );
                    self.leave_out(&path, message);
                }
                Some(ListKind::Value) | None => {}
            }
        }
        for list in &project.lists {
            if list.kind == Some(ListKind::Value) {
                let mut around = list.items.iter();
                let owner = around.find_map(|at| owners.iter().find(|(item, _)| item == at));
                let owner = owner.map(|(_, axis)| axis.clone());
                let path = self.embed(project, list);
                let mut known = startup.value_lists.iter();
                if let Some(first) = known.find(|it| owner.is_some() && it.owner == owner) {
                    let message = format!(
                        "`{}` is the second value list of its axis, after `{}`",
                        path.value, first.path.value
                    );
                    self.leave_out(&path, message);
                    continue;
                }
                startup.value_lists.push(NamedList {
                    path,
                    axis_number: None,
                    owner,
                });
            }
        }
        for (name, given) in &project.odd {
            let message = format!("`{}` of `{name}` is no number of a place", given.value);
            self.leave_out(given, message);
        }
        for (element, kind) in &project.empty {
            let message = format!("`{}` holds no entry of {}", element.value, kind.noun());
            self.leave_out(element, message);
        }
        startup.order_axes();
        startup
    }

    fn leave_out(&mut self, at: &Given<String>, message: String) {
        let said = Diagnostic::new(Code::Fc124, at.place(), message);
        self.diagnostics.push(said.with_help("it has no effect"));
    }

    /// Returns the name under which a list of a project is found from then on: item and element.
    fn embed(&mut self, project: &Project, list: &ProjectList) -> Given<String> {
        let known = self.embedded.iter();
        let mut known = known.filter(|(_, source)| Arc::ptr_eq(source, &list.source));
        if let Some((name, _)) = known.next() {
            return list.element.with(name.clone());
        }
        let item = project.name_of(list);
        let plain = format!("{item}.{}", list.element.value);
        let mut name = plain.clone();
        let mut number = 1;
        while self.embedded.contains_key(&name) {
            number += 1;
            name = format!("{plain} ({number})");
        }
        let lines = list.source.lines();
        let end = Span::new(0, list.source.text().trim_end().len()).end;
        let last_line = lines.line(end.saturating_sub(1));
        self.project.add(EmbeddedList {
            file: list.source.name().clone(),
            item,
            element: list.element.value.clone(),
            lines: lines.first()..=last_line,
        });
        self.embedded.insert(name.clone(), list.source.clone());
        list.element.with(name)
    }
}

/// Returns a path without `..` after a folder that it names, so that a file has one name.
fn without_dots(path: &str) -> String {
    let mut parts: Vec<&str> = Vec::new();
    for part in path.split('/') {
        let is_named = parts.last().is_some_and(|it| !matches!(*it, "" | ".."));
        if part == ".." && is_named {
            parts.pop();
        } else {
            parts.push(part);
        }
    }
    parts.join("/")
}
