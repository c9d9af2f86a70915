//! Reads the axes that a start-up list describes (R3.12 to R3.14).

use std::collections::BTreeMap;

use super::axis::AxisDraft;
use super::channels::ChannelsOfAxis;
use super::loader::{FirstChannel, Loader, folder};
use crate::comp::KindSet;
use crate::diagnostic::{Code, Diagnostic};
use crate::lists::{
    AXIS_NAME_HELP, AxisPlacement, AxisType, AxisValues, ChannelAxis, ChannelList, ChannelSettings,
    Entries, Given, ListKind, NamedList, StartupList, is_axis_name,
};

/// Limit on the axes, beyond any control; further ones are not read.
pub(super) const MAX_AXES: usize = 1024;

impl Loader<'_> {
    /// Returns the axes of a start-up list: in the order of the channel list, then those that no
    /// channel names.
    pub(super) fn startup(&mut self, list: &Entries) -> Vec<AxisDraft> {
        self.startup_folder = Some(folder(list.source().name()).to_owned());
        let startup = StartupList::from_entries(list, &mut self.diagnostics);
        self.listed(&startup)
    }

    /// Returns the axes of the lists that a start-up list or a project names.
    pub(super) fn listed(&mut self, startup: &StartupList) -> Vec<AxisDraft> {
        let default = self.default_values(startup);
        let shared = default.frict_comp().map(|given| given.file().into());
        let mut listed: Vec<(Given<String>, AxisDraft)> = Vec::new();
        for asked in startup.axis_lists.iter().take(MAX_AXES) {
            if let Some(own) = self.axis_list(asked) {
                let mut values = default.clone();
                values.override_with(own);
                let mut draft = AxisDraft::new(String::new(), values);
                draft.is_listed = true;
                draft.list = Some(asked.value.clone());
                let placement = startup.placement(&asked.value);
                let name = placement.and_then(|it| it.name.clone());
                draft.values.name = name.or(draft.values.name.take());
                listed.push((asked.clone(), draft));
            }
        }
        let is_whole = listed.len() == startup.axis_lists.len();
        let mut named = NamedInChannels::default();
        let mut axes = self.channels(startup, &mut listed, (&default, &mut named));
        for (asked, mut draft) in listed {
            if let Some(name) = &draft.values.name {
                draft.name.clone_from(&name.value);
            }
            if draft.values.gantry_master.is_some() {
                self.slaves.push(draft);
            } else if draft.values.name.is_some() {
                axes.push(draft);
            } else {
                self.diagnostics.push(
                    Diagnostic::new(
                        Code::Fc124,
                        asked.place(),
                        format!(
                            "no list names the axis of `{}`; it is left out",
                            asked.value
                        ),
                    )
                    .with_help("`kopf.log_achs_name` in the axis list names it"),
                );
            }
        }
        self.drop_nameless(&mut axes);
        self.drop_repeated(&mut axes);
        named.give(&mut axes, self.project.count() > 0);
        for axis in &mut axes {
            axis.shared.clone_from(&shared);
            axis.is_covered = is_whole;
        }
        let mut attached = BTreeMap::new();
        for named in startup.value_lists.iter().take(MAX_AXES) {
            self.attach(named, &mut axes, &mut attached);
        }
        axes
    }

    /// Returns the axes that the channels name, each with its axis list, which is removed from
    /// `listed`, and notes the names of each channel.
    fn channels(
        &mut self,
        startup: &StartupList,
        listed: &mut Vec<(Given<String>, AxisDraft)>,
        (default, named): (&AxisValues, &mut NamedInChannels),
    ) -> Vec<AxisDraft> {
        let mut axes: Vec<AxisDraft> = Vec::new();
        let base = startup.default_channel_list.as_ref();
        let read = base.map(|asked| self.channel_list(asked));
        let is_base_read = !matches!(read, Some(None));
        let base = read.flatten().unwrap_or_default();
        let mut number = 0;
        named.is_partial |= !is_base_read || startup.channel_lists.len() > MAX_AXES;
        for asked in startup.channel_lists.iter().take(MAX_AXES) {
            let Some(own) = self.channel_list(asked) else {
                named.is_partial = true;
                continue;
            };
            let mut channel = base.clone();
            channel.override_with(own);
            number += 1;
            let mut placed: Vec<&AxisPlacement> = Vec::new();
            for placement in startup.placements.iter().filter(|it| it.is_in(number)) {
                let mut listed = listed.iter().map(|(_, draft)| draft);
                let is_it = |it: &&AxisDraft| it.list.as_ref() == Some(&placement.list);
                if listed.find(is_it).is_some_and(|it| !it.is_spindle()) {
                    let mut earlier = placed.iter().copied();
                    let first =
                        earlier.find(|it| it.index.is_some() && it.index == placement.index);
                    self.diagnostics
                        .extend(first.and_then(|first| one_place(first, placement)));
                    placed.push(placement);
                    channel.place(placement);
                }
            }
            // A program runs in one channel; the first one is used.
            self.channel.get_or_insert_with(|| {
                let settings = channel.settings();
                FirstChannel {
                    programs: channel.programs.clone(),
                    motion: channel.motion.clone(),
                    settings: ChannelSettings {
                        lacks_feed: settings.lacks_feed && is_base_read,
                        is_whole: is_base_read,
                        ..settings
                    },
                }
            });
            let (mut taken, mut repeated) = (Vec::new(), Vec::new());
            for (index, axis) in channel.indexed_axes() {
                let found = find_listed(axis, listed).map(|at| listed.remove(at).1);
                let Some(mut draft) = channel_axis(axis, found, default) else {
                    named.is_partial = true;
                    continue;
                };
                draft.is_main = index < MAIN_AXES;
                let is_new = named.note(&draft.name, number);
                if !is_new {
                    repeated.push(draft.name);
                } else if axes.iter().any(|other| other.name == draft.name) {
                    taken.push(draft.name);
                } else if axes.len() < MAX_AXES {
                    axes.push(draft);
                }
            }
            for spindle in channel.spindles() {
                if let Some(at) = find_listed(spindle, listed) {
                    let draft = &mut listed[at].1;
                    draft.values.axis_type.get_or_insert_with(|| {
                        let given = spindle.number.as_ref().map(|given| given.with(()));
                        let given = given.or_else(|| spindle.name.as_ref().map(|n| n.with(())));
                        given
                            .unwrap_or_else(|| asked.with(()))
                            .with(AxisType::Spindle)
                    });
                    draft.values.name = spindle.name.clone().or(draft.values.name.take());
                }
            }
            if !repeated.is_empty() {
                self.diagnostics.push(repeated_names(asked, &repeated));
            }
            if !taken.is_empty() {
                self.diagnostics.push(other_channel(asked, &taken));
            }
        }
        let channels = startup.channel_lists.len();
        let channels = u32::try_from(channels).unwrap_or(u32::MAX);
        for placement in &startup.placements {
            if let Some(given) = &placement.channel
                && channels > 0
                && !(1..=channels).contains(&given.value)
            {
                let list = &placement.list;
                let message = format!(
                    "there is no channel {} for the axis of `{list}`",
                    given.value
                );
                let said = Diagnostic::new(Code::Fc124, given.place(), message);
                self.diagnostics
                    .push(said.with_help("it is taken as an axis of no channel"));
            }
        }
        axes
    }

    fn channel_list(&mut self, asked: &Given<String>) -> Option<ChannelList> {
        let entries = self.load(asked, ListKind::Channel)?;
        Some(ChannelList::from_entries(&entries, &mut self.diagnostics))
    }

    /// Returns the values of the default list, which is not for a particular axis.
    fn default_values(&mut self, startup: &StartupList) -> AxisValues {
        let unread = AxisValues {
            unread: KindSet::ALL,
            ..AxisValues::default()
        };
        let mut default = match &startup.default_axis_list {
            Some(asked) => self.axis_list(asked).unwrap_or(unread),
            None => AxisValues::default(),
        };
        default.number = None;
        default.name = None;
        default.gantry_master = None;
        default.end = None;
        default
    }

    /// Drops axes whose name no program can use (R2.20).
    fn drop_nameless(&mut self, axes: &mut Vec<AxisDraft>) {
        axes.retain(|axis| {
            if is_axis_name(&axis.name) {
                return true;
            }
            let place = axis.values.name.as_ref().map(Given::place);
            let message = format!("`{}` is not an axis name; it is left out", axis.name);
            let diagnostic = place.map(|place| Diagnostic::new(Code::Fc124, place, message));
            let advised = diagnostic.map(|it| it.with_help(AXIS_NAME_HELP));
            self.diagnostics.extend(advised);
            false
        });
    }

    /// Keeps the first of several axes with the same name, and no more axes than a control can
    /// have.
    fn drop_repeated(&mut self, axes: &mut Vec<AxisDraft>) {
        axes.truncate(MAX_AXES);
        let mut at = 0;
        while at < axes.len() {
            if axes[..at].iter().any(|axis| axis.name == axes[at].name) {
                let second = axes.remove(at);
                let place = second.values.name.as_ref().map(Given::place);
                let message = format!(
                    "axis `{}` already exists; this one is left out",
                    second.name
                );
                self.diagnostics
                    .extend(place.map(|place| Diagnostic::new(Code::Fc124, place, message)));
            } else {
                at += 1;
            }
        }
    }

    /// Reads a value list and gives it to its axis, of which an earlier one may be attached already.
    fn attach<'s>(
        &mut self,
        named: &'s NamedList,
        axes: &mut [AxisDraft],
        attached: &mut BTreeMap<usize, &'s Given<String>>,
    ) {
        let Some(list) = self.value_list(&named.path) else {
            return;
        };
        let numbers: Vec<Given<u32>> = [&named.axis_number, &list.head.number]
            .into_iter()
            .filter_map(Clone::clone)
            .collect();
        // TwinCAT writes the number into the lists of a project by itself.
        let is_embedded = self.embedded.contains_key(&named.path.value);
        let is_unnumbered = list.head.number.is_none() && !is_embedded;
        let known = || axes.iter().chain(&self.slaves);
        let position = if named.owner.is_some() {
            known().position(|axis| axis.list == named.owner)
        } else if numbers.is_empty() {
            let name = list.head.name.as_ref().map(|name| &name.value);
            known().position(|axis| Some(&axis.name) == name)
        } else {
            numbers.iter().find_map(|number| {
                let number = Some(number.value);
                known().position(|axis| axis.list_number() == number)
            })
        };
        let mut owners = axes.iter_mut().chain(&mut self.slaves);
        if let Some((position, owner)) =
            position.and_then(|position| Some((position, owners.nth(position)?)))
        {
            let path = &named.path;
            let first = *attached.entry(position).or_insert(path);
            if !std::ptr::eq(first, path) {
                let message = format!(
                    "`{}` is a second value list of axis `{}`, after `{}`",
                    path.value, owner.name, first.value
                );
                let said = Diagnostic::new(Code::Fc124, path.place(), message);
                let said = said.with_label(first.place(), "the first one, which is used here");
                self.diagnostics.push(
                    said.with_help(
                        "keep one of them: which one the control takes is not documented",
                    ),
                );
                return;
            }
            owner.startup_number.clone_from(&named.axis_number);
            owner.unnumbered = is_unnumbered.then(|| path.clone());
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
            None => format!("`{}` does not say which axis it is for", named.path.value),
        };
        self.diagnostics
            .push(Diagnostic::new(Code::Fc135, place, message).with_help("the list has no effect"));
    }
}

/// Returns FC124 for two axes of a project that have one place in their channel: the last one takes it.
fn one_place(first: &AxisPlacement, other: &AxisPlacement) -> Option<Diagnostic> {
    let channel = other.channel.as_ref()?;
    let message = format!(
        "`{}` and `{}` have the index {} of channel {}",
        first.list, other.list, other.index?, channel.value
    );
    let said = Diagnostic::new(Code::Fc124, channel.place(), message);
    Some(said.with_help("give each axis of a channel its own `DefaultIndex`"))
}

/// The names of axes that channel lists give, each with the channels.
#[derive(Debug, Default)]
struct NamedInChannels {
    channels: BTreeMap<String, Vec<u32>>,
    /// Whether a list that may name further axes was not read.
    is_partial: bool,
}

impl NamedInChannels {
    /// Notes that a channel names an axis. Returns `false` if it has one of that name already.
    fn note(&mut self, name: &str, channel: u32) -> bool {
        let channels = self.channels.entry(name.to_owned()).or_default();
        let is_new = channels.last() != Some(&channel);
        if is_new {
            channels.push(channel);
        }
        is_new
    }

    /// Gives the axes their channels, unless a list is missing, no channel names axes, or all have the same ones.
    fn give(&self, axes: &mut [AxisDraft], is_project: bool) {
        let of = |axis: &AxisDraft| self.channels.get(&axis.name).cloned().unwrap_or_default();
        let path = || axes.iter().filter(|axis| !axis.is_spindle());
        let are_alike = path().all(|axis| path().next().map(of) == Some(of(axis)));
        if self.is_partial || self.channels.is_empty() || are_alike {
            return;
        }
        for axis in axes.iter_mut().filter(|axis| !axis.is_spindle()) {
            let channels = of(axis);
            axis.channels = if is_project {
                ChannelsOfAxis::Assumed(channels)
            } else {
                ChannelsOfAxis::Listed(channels)
            };
        }
    }
}

/// Returns FC124 for a channel that gives a name to several axes: names are unique in it (P-CHAN-00006).
fn repeated_names(asked: &Given<String>, names: &[String]) -> Diagnostic {
    let message = format!(
        "`{}` gives a name to several axes, of which the first has it and the others are left out: {}",
        asked.value,
        names.join(", ")
    );
    Diagnostic::new(Code::Fc124, asked.place(), message)
        .with_help("give each axis of a channel its own `bezeichnung`")
}

/// Returns FC124 for a channel whose axes have names of an earlier channel. Programs are assumed to
/// run in the first channel (R3.13).
fn other_channel(asked: &Given<String>, names: &[String]) -> Diagnostic {
    let message = format!(
        "the axes of `{}` have names of an earlier channel and are left out: {}",
        asked.value,
        names.join(", ")
    );
    Diagnostic::new(Code::Fc124, asked.place(), message)
        .with_help("programs are run in the first channel that has the axis")
}

/// Returns the axis list of a channel's axis: the one with its number, else the one with its name.
fn find_listed(axis: &ChannelAxis, listed: &[(Given<String>, AxisDraft)]) -> Option<usize> {
    let find = |test: &dyn Fn(&AxisDraft) -> bool| listed.iter().position(|(_, d)| test(d));
    if axis.list.is_some() {
        return find(&|draft| draft.list == axis.list);
    }
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

/// Number of main axes in a channel, which have the indices from 0 on (TF5200 Diagnosis, page 251681419).
const MAIN_AXES: u32 = 3;

/// Returns an axis of a channel, with its list if there is one. `None` if the axis has no name.
fn channel_axis(
    axis: &ChannelAxis,
    found: Option<AxisDraft>,
    default: &AxisValues,
) -> Option<AxisDraft> {
    let mut draft = found.unwrap_or_else(|| AxisDraft::new(String::new(), default.clone()));
    draft.set_channel_number(axis.number.clone());
    let name = axis.name.clone().or_else(|| draft.values.name.clone())?;
    draft.name.clone_from(&name.value);
    draft.values.name = Some(name);
    Some(draft)
}
