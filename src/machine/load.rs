//! From a start-up list to the axes that it describes (R3.12 to R3.14).

use std::sync::Arc;

use super::assemble::AxisDraft;
use super::{AxisSet, Configuration, Machine};
use crate::codes::Code;
use crate::diagnostic::Diagnostic;
use crate::lists::{
    AxisValues, ChannelAxis, ChannelList, Conditions, Entries, FrictionDraft, Given, NamedList,
    StartupList,
};
use crate::source::SourceFile;

/// More axes than any control has; what lies beyond is not read.
pub(super) const MAX_AXES: usize = 1024;

/// Hands list files to the library, which opens none itself.
pub trait ListFiles {
    /// The list at a path, or `None` when there is none. A relative path has been resolved
    /// against the folder of the list that asks, as far as that list's own name has one. The name
    /// of the source is what diagnostics show, and what further paths are resolved against.
    fn read(&mut self, path: &str) -> Option<SourceFile>;
}

/// A host that has no list files.
pub struct NoLists;

impl ListFiles for NoLists {
    fn read(&mut self, _path: &str) -> Option<SourceFile> {
        None
    }
}

/// The head and the friction parameters of one value list.
#[derive(Debug, Clone, Default)]
pub(super) struct ValueList {
    pub(super) head: AxisValues,
    pub(super) friction: FrictionDraft,
}

impl ValueList {
    pub(super) fn from_entries(list: &Entries, diagnostics: &mut Vec<Diagnostic>) -> Self {
        Self {
            head: AxisValues::from_entries(list, diagnostics),
            friction: FrictionDraft::from_entries(list, diagnostics),
        }
    }
}

/// Reads lists through the host and collects what they give reason to say.
pub(super) struct Loader<'f> {
    files: &'f mut dyn ListFiles,
    /// The folder of the start-up list, for paths of the control's own disk.
    startup_folder: Option<String>,
    pub(super) diagnostics: Vec<Diagnostic>,
    pub(super) names: Vec<Arc<str>>,
}

impl<'f> Loader<'f> {
    pub(super) fn new(files: &'f mut dyn ListFiles) -> Self {
        Self {
            files,
            startup_folder: None,
            diagnostics: Vec::new(),
            names: Vec::new(),
        }
    }

    /// The entries of a list that another one names; FC123 when there is no such file (R3.14).
    pub(super) fn load(&mut self, asked: &Given<String>) -> Option<Entries> {
        let folder = folder(asked.file());
        let mut candidates = vec![join(folder, &asked.value)];
        if asked.value.contains('\\') || asked.value.get(1..2) == Some(":") {
            let name = asked.value.rsplit(['\\', '/']).next().unwrap_or_default();
            let startup = self.startup_folder.as_deref().unwrap_or(folder);
            candidates.push(join(startup, name));
        }
        let found = candidates.iter().find_map(|path| self.files.read(path));
        if found.is_none() {
            self.diagnostics.push(
                Diagnostic::new(
                    Code::Fc123,
                    asked.place(),
                    format!(
                        "`{}`, named in line {} of `{}`, is not found",
                        asked.value,
                        asked.line(),
                        asked.file()
                    ),
                )
                .with_help(format!("looked for `{}`", candidates.join("` and `"))),
            );
        }
        found.map(|file| self.entries(&Arc::new(file)))
    }

    /// The entries of a list that is here already.
    pub(super) fn entries(&mut self, file: &Arc<SourceFile>) -> Entries {
        if !self.names.contains(file.name()) {
            self.names.push(file.name().clone());
        }
        let mut entries = Entries::parse(file);
        self.diagnostics.append(&mut entries.diagnostics);
        entries
    }

    pub(super) fn axis_list(&mut self, asked: &Given<String>) -> Option<AxisValues> {
        let entries = self.load(asked)?;
        Some(AxisValues::from_entries(&entries, &mut self.diagnostics))
    }

    pub(super) fn value_list(&mut self, asked: &Given<String>) -> Option<ValueList> {
        let entries = self.load(asked)?;
        Some(ValueList::from_entries(&entries, &mut self.diagnostics))
    }

    /// The axes of a start-up list: in the order of the channel list, then those that no channel
    /// names.
    pub(super) fn startup(&mut self, list: &Entries) -> Vec<AxisDraft> {
        self.startup_folder = Some(folder(list.source().name()).to_owned());
        let startup = StartupList::from_entries(list, &mut self.diagnostics);
        let default = self.default_values(&startup);
        let mut listed: Vec<(Given<String>, AxisDraft)> = Vec::new();
        for asked in startup.axis_lists.iter().take(MAX_AXES) {
            if let Some(own) = self.axis_list(asked) {
                let mut values = default.clone();
                values.override_with(own);
                listed.push((asked.clone(), AxisDraft::new(String::new(), values)));
            }
        }
        let mut axes = Vec::new();
        for channel in startup.channel_lists.iter().take(MAX_AXES) {
            let Some(entries) = self.load(channel) else {
                continue;
            };
            let channel = ChannelList::from_entries(&entries, &mut self.diagnostics);
            let room = MAX_AXES.saturating_sub(axes.len());
            for axis in channel.axes.into_iter().take(room) {
                let found = find_listed(&axis, &listed).map(|at| listed.remove(at).1);
                axes.extend(channel_axis(axis, found, &default));
            }
        }
        for (asked, mut draft) in listed {
            if let Some(name) = &draft.values.name {
                draft.name.clone_from(&name.value);
                axes.push(draft);
            } else {
                self.diagnostics.push(
                    Diagnostic::new(
                        Code::Fc124,
                        asked.place(),
                        format!(
                            "no list names the axis of `{}`, it is left out",
                            asked.value
                        ),
                    )
                    .with_help("`kopf.log_achs_name` in the axis list names it"),
                );
            }
        }
        self.drop_repeated(&mut axes);
        for named in startup.value_lists.iter().take(MAX_AXES) {
            self.attach(named, &mut axes);
        }
        axes
    }

    /// The values of the default list, which describes no axis of its own.
    fn default_values(&mut self, startup: &StartupList) -> AxisValues {
        let list = startup.default_axis_list.as_ref();
        let mut default = list
            .and_then(|asked| self.axis_list(asked))
            .unwrap_or_default();
        default.number = None;
        default.name = None;
        default
    }

    /// Keeps the first of several axes with one name, and a number of axes that a control can
    /// have.
    fn drop_repeated(&mut self, axes: &mut Vec<AxisDraft>) {
        axes.truncate(MAX_AXES);
        let mut at = 0;
        while at < axes.len() {
            if axes[..at].iter().any(|axis| axis.name == axes[at].name) {
                let second = axes.remove(at);
                let place = second.values.name.as_ref().map(Given::place);
                let message = format!(
                    "axis `{}` exists already, this one is left out",
                    second.name
                );
                self.diagnostics
                    .extend(place.map(|place| Diagnostic::new(Code::Fc124, place, message)));
            } else {
                at += 1;
            }
        }
    }

    /// Reads a value list and gives it to its axis.
    fn attach(&mut self, named: &NamedList, axes: &mut [AxisDraft]) {
        let Some(list) = self.value_list(&named.path) else {
            return;
        };
        let numbers: Vec<Given<u32>> = [&named.axis_number, &list.head.number]
            .into_iter()
            .filter_map(Clone::clone)
            .collect();
        let position = if numbers.is_empty() {
            let name = list.head.name.as_ref().map(|name| &name.value);
            axes.iter().position(|axis| Some(&axis.name) == name)
        } else {
            numbers.iter().find_map(|number| {
                let number = Some(number.value);
                axes.iter().position(|axis| axis.list_number() == number)
            })
        };
        if let Some(position) = position {
            let owner = &mut axes[position];
            owner.startup_number.clone_from(&named.axis_number);
            owner.value_list = list;
            return;
        }
        let number = numbers.first();
        let place = number.map_or_else(|| named.path.place(), Given::place);
        let message = match number {
            Some(number) => format!(
                "`{}` is for axis number {}, which no axis list has",
                named.path.value, number.value
            ),
            None => format!("`{}` does not say for which axis it is", named.path.value),
        };
        self.diagnostics
            .push(Diagnostic::new(Code::Fc135, place, message).with_help("the list has no effect"));
    }
}

/// The axis list of a channel's axis: the one with its number, else the one with its name.
fn find_listed(axis: &ChannelAxis, listed: &[(Given<String>, AxisDraft)]) -> Option<usize> {
    let find = |test: &dyn Fn(&AxisDraft) -> bool| listed.iter().position(|(_, d)| test(d));
    let by_number = axis
        .number
        .as_ref()
        .and_then(|number| find(&|draft| draft.list_number() == Some(number.value)));
    let by_name = || {
        let name = axis.name.as_ref()?;
        find(&|draft| {
            draft
                .values
                .name
                .as_ref()
                .is_some_and(|n| n.value == name.value)
        })
    };
    by_number.or_else(by_name)
}

/// An axis as a channel names it, with its list if there is one. `None` when nothing names it.
fn channel_axis(
    axis: ChannelAxis,
    found: Option<AxisDraft>,
    default: &AxisValues,
) -> Option<AxisDraft> {
    let mut draft = found.unwrap_or_else(|| AxisDraft::new(String::new(), default.clone()));
    draft.set_channel_number(axis.number);
    let name = axis.name.or_else(|| draft.values.name.clone())?;
    draft.name.clone_from(&name.value);
    draft.values.name = Some(name);
    Some(draft)
}

impl Configuration {
    /// The machine that a start-up list describes, with every list that it names.
    pub fn from_startup(file: SourceFile, files: &mut dyn ListFiles) -> Self {
        let mut configuration = Self::default();
        configuration.read_startup(&Arc::new(file), files);
        configuration
    }

    pub(super) fn read_startup(&mut self, file: &Arc<SourceFile>, files: &mut dyn ListFiles) {
        let mut loader = Loader::new(files);
        let entries = loader.entries(file);
        let axes = loader.startup(&entries);
        self.assemble(axes, loader);
    }

    /// Puts the axes together under the machine's build and takes over what the lists gave reason
    /// to say, with the user's severities.
    pub(super) fn assemble(&mut self, axes: Vec<AxisDraft>, loader: Loader<'_>) {
        self.diagnostics.extend(loader.diagnostics);
        self.files.extend(loader.names);
        let conditions = Conditions {
            build: self.machine.build,
            ..Conditions::default()
        };
        if axes.is_empty() {
            let any = Machine::unconfigured();
            self.machine.axes = any.axes;
            self.machine.axis_set = any.axis_set;
        } else {
            self.machine.axis_set = AxisSet::Configured;
        }
        for draft in axes {
            let (finished, report) = draft.finish(&conditions, &mut self.diagnostics);
            self.machine.axes.push(finished);
            self.reports.push(report);
        }
        let levels = &self.levels;
        self.diagnostics
            .retain_mut(|diagnostic| match levels.severity(diagnostic.code) {
                Some(severity) => {
                    diagnostic.severity = severity;
                    true
                }
                None => false,
            });
    }
}

/// The folder of a path as it is written, without its separator; empty for a bare name.
fn folder(path: &str) -> &str {
    match path.rfind(['/', '\\']) {
        Some(0) => "/",
        Some(at) => &path[..at],
        None => "",
    }
}

/// A path seen from a folder, with `/` between its parts.
fn join(folder: &str, path: &str) -> String {
    let path = path.replace('\\', "/");
    let absolute = path.starts_with('/') || path.get(1..2) == Some(":");
    if folder.is_empty() || absolute {
        path
    } else if folder.ends_with('/') {
        format!("{folder}{path}")
    } else {
        format!("{folder}/{path}")
    }
}
