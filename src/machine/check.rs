//! Checks one list by itself, or a start-up list with all lists that it names.

use std::collections::BTreeMap;
use std::sync::Arc;

use super::axis::{AxisReport, Parameterisation, ValueList, on_spindle};
use super::configuration::Configuration;
use super::description::Machine;
use super::loader::{EmbeddedLists, ListFiles, describe, has_nothing};
use crate::comp::CncBuild;
use crate::diagnostic::{Advice, Code, Diagnostic, Severity};
use crate::drive_interface::{DriveSettings, Evidence, check_drive};
use crate::lists::{
    AxisType, AxisValues, ChannelList, Conditions, Entries, FrictionList, ListKind, Parameter,
    Verdict, is_xml,
};
use crate::text::{Place, SourceFile, Span};

/// Messages on a list.
#[derive(Debug, Clone)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct ListsReport {
    /// The kind of the list, by its keys; `None` if they belong to no kind that is read.
    pub kind: Option<ListKind>,
    /// Messages of the checks, with their own severities.
    pub diagnostics: Vec<Diagnostic>,
    /// The effective parameters of each axis that the list describes.
    pub reports: Vec<AxisReport>,
    /// The programs and macros of the channel and its settings of motion, each with its place.
    pub programs: Vec<Parameter>,
    /// The value lists that the control would accept.
    pub accepted: Vec<AcceptedList>,
    /// The lists that were read, in the order of reading.
    pub files: Vec<Arc<str>>,
    /// Number of named lists that do not exist.
    pub missing: usize,
    /// The lists within a TwinCAT project.
    pub embedded: EmbeddedLists,
}

/// A value list that the control would accept, and its axis.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct AcceptedList {
    /// The name of the axis; empty if a list is checked by itself and names none.
    pub axis: String,
    /// The type of the axis, for the unit of the velocities.
    pub axis_type: AxisType,
    /// The list.
    pub list: FrictionList,
}

impl AcceptedList {
    /// Returns the value lists of a machine, in the order of its axes.
    pub fn of(machine: &Machine) -> Vec<Self> {
        let lists = machine.axes.iter().filter_map(|axis| match &axis.friction {
            Parameterisation::Accepted(list) => Some(Self {
                axis: axis.name.clone(),
                axis_type: axis.axis_type,
                list: list.clone(),
            }),
            _ => None,
        });
        lists.collect()
    }
}

/// Checks a start-up list or a project with every list that it names.
fn check_machine(
    source: &Arc<SourceFile>,
    build: Option<CncBuild>,
    files: &mut dyn ListFiles,
) -> ListsReport {
    let mut configuration = Configuration::default();
    configuration.machine.build = build;
    configuration.read_startup(source, files);
    configuration.check_drives();
    let first = configuration.diagnostics.first();
    let is_refused =
        first.is_some_and(|said| said.code == Code::Fc125 && said.place.file == *source.name());
    let is_machine = !is_xml(source.text()) || !is_refused;
    ListsReport {
        kind: is_machine.then_some(ListKind::Startup),
        diagnostics: configuration.diagnostics,
        reports: configuration.reports,
        programs: configuration.programs,
        accepted: AcceptedList::of(&configuration.machine),
        files: configuration.files,
        missing: configuration.missing,
        embedded: configuration.embedded,
    }
}

/// Checks one list of any kind, for a kernel version if that is known. A start-up list is checked with every list that
/// it names; any other list by itself, so nothing is reported about related lists.
pub fn check_list(
    file: SourceFile,
    build: Option<CncBuild>,
    files: &mut dyn ListFiles,
) -> ListsReport {
    let source = Arc::new(file);
    let entries = Entries::parse(&source);
    let kind = ListKind::detect(&entries);
    let is_project = is_xml(source.text());
    if is_project || kind == Some(ListKind::Startup) {
        return check_machine(&source, build, files);
    }
    let mut diagnostics = entries.diagnostics.clone();
    diagnostics.extend(kind.into_iter().flat_map(|kind| kind.check_keys(&entries)));
    let mut reports = Vec::new();
    let mut programs = Vec::new();
    let mut accepted = Vec::new();
    match kind {
        Some(ListKind::Startup) => {}
        Some(ListKind::Channel) => {
            let channel = ChannelList::from_entries(&entries, &mut diagnostics);
            programs = channel.programs.parameters(&|_| false);
            programs.extend(channel.motion.parameters());
        }
        Some(ListKind::Axis | ListKind::Head) => {
            let values = AxisValues::from_entries(&entries, &mut diagnostics);
            let mut report = head(&values);
            report.parameters = values.parameters();
            report.selector = values.frict_comp().cloned();
            report.drive = values.drive;
            report.is_listed = true;
            let drive = check_drive(&report.listed_drive(None), &Evidence::default());
            diagnostics.extend(drive.diagnostics);
            diagnostics.extend(without_torque(&report));
            if report.axis_type == AxisType::Spindle {
                let selector = report.selector.as_ref();
                diagnostics.extend(on_spindle(&report.axis, None, selector));
            }
            reports.push(report);
        }
        Some(ListKind::Value) => {
            let list = ValueList::from_entries(&entries, &mut diagnostics);
            let mut report = head(&list.head);
            let reading = list.friction.check(&Conditions {
                build,
                axis_type: report.axis_type,
                ..Conditions::default()
            });
            diagnostics.extend(reading.diagnostics);
            if let Verdict::Accepted(list) = reading.verdict {
                accepted.push(AcceptedList {
                    axis: report.axis.clone(),
                    axis_type: report.axis_type,
                    list,
                });
            }
            // A value list has no selectors; their defaults would be meaningless.
            report.parameters = list.head.parameters();
            report
                .parameters
                .retain(|row| row.origin != crate::lists::Origin::Default);
            report.parameters.extend(reading.parameters);
            reports.push(report);
        }
        None if entries.unread_kind().is_some() || entries.lost_underscores() => {}
        None if has_nothing(&entries) => {
            let place = source.place(Span::new(0, 0));
            let mut empty = Diagnostic::new(Code::Fc124, place, "this list has no entries");
            empty.severity = Severity::Info;
            diagnostics.push(empty);
        }
        None => {
            let message = format!(
                "this is {}: no key belongs to an axis, value, channel or start-up list",
                describe(&entries)
            );
            diagnostics.push(
                Diagnostic::new(Code::Fc124, source.place(Span::new(0, 0)), message)
                    .with_help(Advice::ReadPage(Code::Fc124)),
            );
        }
    }
    ListsReport {
        kind,
        diagnostics,
        reports,
        programs,
        accepted,
        files: vec![source.name().clone()],
        missing: 0,
        embedded: EmbeddedLists::default(),
    }
}

/// Checks a `frictcomp.toml` with every list that it names.
pub fn check_configuration(file: SourceFile, files: &mut dyn ListFiles) -> ListsReport {
    let name = file.name().clone();
    match Configuration::from_toml(file, files) {
        Ok(mut configuration) => {
            configuration.check_drives();
            ListsReport {
                kind: None,
                accepted: AcceptedList::of(&configuration.machine),
                diagnostics: configuration.diagnostics,
                reports: configuration.reports,
                programs: configuration.programs,
                files: std::iter::once(name).chain(configuration.files).collect(),
                missing: configuration.missing,
                embedded: configuration.embedded,
            }
        }
        Err(error) => ListsReport {
            kind: None,
            diagnostics: vec![*error.diagnostic],
            reports: Vec::new(),
            programs: Vec::new(),
            accepted: Vec::new(),
            files: vec![name],
            missing: 0,
            embedded: EmbeddedLists::default(),
        },
    }
}

/// Returns the report of a list by itself, without parameters.
fn head(values: &AxisValues) -> AxisReport {
    AxisReport {
        axis: values
            .name
            .as_ref()
            .map_or_else(String::new, |name| name.value.clone()),
        axis_type: values
            .axis_type
            .as_ref()
            .map_or(AxisType::Linear, |given| given.value),
        parameters: Vec::new(),
        drive: BTreeMap::new(),
        selector: None,
        is_listed: false,
    }
}

impl Configuration {
    /// Reports axes with friction compensation but without a drive that takes it (R3.41), with the user's severities.
    fn check_drives(&mut self) {
        for report in &self.reports {
            let said = without_torque(report).map(|mut said| (self.levels.weigh(&mut said), said));
            let said = said.and_then(|(is_said, said)| is_said.then_some(said));
            self.diagnostics.extend(said);
        }
        self.embedded.explain(&mut self.diagnostics);
    }
}

/// Returns FC503 for an axis with P-AXIS-00522 and a simulated or virtual drive, which takes no additive torque.
/// Without `kenngr.antr_typ` the drive is a simulation, and with `kenngr.drive_simulation` whatever its type (R3.41).
fn without_torque(report: &AxisReport) -> Option<Diagnostic> {
    let selector = report.selector.as_ref().filter(|given| given.value)?;
    if report.axis_type == AxisType::Spindle {
        return None;
    }
    let settings = DriveSettings::from_entries(&report.drive, &mut Vec::new());
    // Telegram entries imply a drive, whose type TwinCAT fills in (R7.5).
    let mut keys = report.drive.keys();
    let is_given = keys.any(|key| key == "kenngr.antr_typ" || key.starts_with("antr."));
    let (place, message) = match (&settings.simulated, &settings.drive_type) {
        (Some(place), _) => {
            let message = "friction compensation is configured, but `kenngr.drive_simulation` \
                           switches the drive to simulation: no additive torque is sent";
            return Some(
                unsent(report, place.clone(), message.to_owned())
                    .with_help("set `kenngr.drive_simulation` to 0 on the machine itself"),
            );
        }
        (None, Some(given)) if given.value.is_without_drive() => {
            let name = given.value.as_str();
            let message = format!(
                "friction compensation is configured, but the drive type is {name}: no additive \
                 torque is sent"
            );
            (given.place(), message)
        }
        (None, None) if !is_given && report.is_listed => {
            let message = "friction compensation is configured, but no list gives the drive type: \
                           the default is 4, simulation, which takes no additive torque";
            (selector.place(), message.to_owned())
        }
        _ => return None,
    };
    let mut said = unsent(report, place, message)
        .with_help("set `kenngr.antr_typ` to `2` for SERCOS or `8` for CANopen");
    // The default may not apply: TwinCAT fills in the entries of a drive (R7.5).
    if !is_given {
        said.severity = Severity::Warning;
    }
    Some(said)
}

/// Returns FC503 about an axis.
fn unsent(report: &AxisReport, place: Place, message: String) -> Diagnostic {
    let mut said = Diagnostic::new(Code::Fc503, place, message);
    said.axis = (!report.axis.is_empty()).then(|| report.axis.clone());
    said
}
