//! Results of lists and `frictcomp.toml`.

use std::fmt::Write as _;
use std::path::Path;
use std::sync::Arc;

use frictcomp::comp::{CncBuild, Kind, KindSet};
use frictcomp::diagnostic::Diagnostic;
use frictcomp::drive_interface::{Evidence, Presence, TorqueScale, check_drive};
use frictcomp::lists::{AxisType, Origin};
use frictcomp::lists::{Entries, Entry, ListKind};
use frictcomp::machine::{
    Axis, AxisSet, Configuration, ListsReport, Parameterisation, check_configuration, check_list,
};
use frictcomp::text::SourceFile;
use frictcomp_report::results::lists::render_parameters;

use super::fixes::{Texts, mended};
use super::runs::{advice, message};
use crate::support::Lists;
use crate::{Case, PLACE};

/// The list that is read as the start-up list, whatever it is.
const START_UP: &str = "hochlauf.lis";

/// Number of columns of the parameters.
const WIDTH: usize = 100;

/// Shows the messages on a list, and what it gives.
pub(crate) fn shown(case: &Case, list: &str, parts: &str) -> String {
    let mut parts: Vec<&str> = parts.split(' ').collect();
    let named = parts.iter().position(|part| part.contains('.'));
    let named = named.map(|at| parts.remove(at));
    let mut files = case.files.clone();
    let holder = files.iter_mut().find(|(_, text)| text.contains(PLACE));
    let name = if let Some((holder, text)) = holder {
        *text = text.replace(PLACE, list);
        named.unwrap_or(holder)
    } else {
        named.unwrap_or("a.lis")
    };
    let name = name.to_owned();
    files.entry(name.clone()).or_insert_with(|| list.to_owned());
    let checked = Checked {
        build: case.bench().machine.build,
        name: &name,
        files: &files,
    };
    let mut shown = of_list(checked, &parts);
    let mut with_returns = files.clone();
    for text in with_returns.values_mut() {
        *text = text.replace('\n', "\r\n");
    }
    let files = &with_returns;
    let other = of_list(Checked { files, ..checked }, &parts);
    if other != shown {
        write!(shown, "with CRLF\n{other}").expect("text");
    }
    shown
}

fn of_list(checked: Checked<'_>, parts: &[&str]) -> String {
    let Checked { name, files, .. } = checked;
    let has = |part: &str| parts.contains(&part);
    if has("entries") {
        return entries(&files[name]);
    }
    let report = checked.report();
    if has("drive") {
        return drives(name, &report);
    }
    let mut text = String::new();
    for said in &report.diagnostics {
        writeln!(text, "{}", message(said, name)).expect("text");
        if has("help") {
            let axis = said.axis.iter().map(|axis| format!("axis {axis}"));
            for line in axis.chain(advice(said)) {
                writeln!(text, "    {line}").expect("text");
            }
        }
        if has("fixes") {
            let say = |texts: &Texts| {
                let again = Checked {
                    files: texts,
                    ..checked
                };
                again.report().diagnostics
            };
            for fix in &said.fixes {
                text.push_str(&mended(said, fix, files, &say));
            }
        }
    }
    match checked.machine(&report) {
        Some(found) => text.push_str(&of_machine(&found)),
        None => writeln!(text, "{}", kind(&report)).expect("text"),
    }
    if has("files") {
        writeln!(text, "read: {}", report.files.join(", ")).expect("text");
    }
    if has("parameters") {
        text += &render_parameters(&report.reports, &report.programs, WIDTH);
    }
    text
}

/// A list or a configuration among others.
#[derive(Clone, Copy)]
struct Checked<'a> {
    build: Option<CncBuild>,
    name: &'a str,
    files: &'a Texts,
}

impl Checked<'_> {
    fn source(&self) -> SourceFile {
        SourceFile::new(self.name, self.files[self.name].as_str())
    }

    fn report(&self) -> ListsReport {
        let files = &mut Lists(self.files);
        if is_configuration(self.name) {
            return check_configuration(self.source(), files);
        }
        let mut report = check_list(self.source(), self.build, files);
        if self.name.ends_with(START_UP) {
            report.diagnostics = Configuration::from_startup(self.source(), files).diagnostics;
        }
        report
    }

    /// Returns the machine of a start-up list or a configuration.
    fn machine(&self, report: &ListsReport) -> Option<Configuration> {
        let files = &mut Lists(self.files);
        if is_configuration(self.name) {
            return Configuration::from_toml(self.source(), files).ok();
        }
        let starts = report.kind == Some(ListKind::Startup) || self.name.ends_with(START_UP);
        starts.then(|| Configuration::from_startup(self.source(), files))
    }
}

fn is_configuration(name: &str) -> bool {
    Path::new(name).extension().is_some_and(|it| it == "toml")
}

fn of_machine(found: &Configuration) -> String {
    let mut text = String::new();
    if found.machine.axis_set == AxisSet::AsTheyOccur {
        text.push_str("the axes as they occur\n");
    } else {
        for axis in &found.machine.axes {
            writeln!(text, "{}", of_axis(axis)).expect("text");
        }
    }
    for slave in &found.machine.gantry_slaves {
        writeln!(text, "{}, slave of a gantry", slave.name).expect("text");
    }
    if found.missing > 0 {
        writeln!(text, "{} missing", found.missing).expect("text");
    }
    text
}

fn kind(report: &ListsReport) -> &'static str {
    match report.kind {
        Some(ListKind::Startup) => "start-up list",
        Some(ListKind::Channel) => "channel list",
        Some(ListKind::Axis) => "axis list",
        Some(ListKind::Value) if report.accepted.is_empty() => "value list without effect",
        Some(ListKind::Value) => "value list in effect",
        Some(ListKind::Head) => "axis list or value list",
        _ if is_configuration(&report.files[0]) => "refused",
        _ => "no list of an axis",
    }
}

fn of_axis(axis: &Axis) -> String {
    let mut parts = vec![axis.name.clone()];
    parts.extend(axis.number.map(|number| format!("number {number}")));
    match axis.axis_type {
        AxisType::Linear => {}
        AxisType::Rotary => parts.push("rotary".to_owned()),
        AxisType::Spindle => parts.push("spindle".to_owned()),
    }
    let kinds = [
        ("configured", axis.configured),
        ("manual", axis.manual),
        ("required", axis.required),
    ];
    for (word, kinds) in kinds {
        if kinds != KindSet::NONE {
            let kinds: Vec<&str> = kinds.iter().map(Kind::as_str).collect();
            parts.push(format!("{word} {}", kinds.join(" ")));
        }
    }
    if axis.frict_comp_origin != Origin::Default {
        parts.push(format!("P-AXIS-00522 from {}", axis.frict_comp_origin));
    }
    match &axis.friction {
        Parameterisation::Missing => {}
        Parameterisation::Off => parts.push("value list off".to_owned()),
        Parameterisation::Rejected { file, code } => parts.push(format!("{file} refused: {code}")),
        Parameterisation::Assumed => parts.push("value list assumed".to_owned()),
        Parameterisation::Accepted(list) => {
            let points = list.table.len();
            let plural = if points == 1 { "" } else { "s" };
            parts.push(format!("value list of {points} point{plural}"));
        }
    }
    if axis.torque_scale != TorqueScale::default() {
        parts.push(format!("torque times {}", axis.torque_scale.factor()));
    }
    if !axis.is_described() {
        parts.push("not described".to_owned());
    }
    parts.join(", ")
}

/// Shows each entry with the forms in which its value can be read.
fn entries(text: &str) -> String {
    let entries = Entries::parse(&Arc::new(SourceFile::new("a.lis", text)));
    let mut shown = String::new();
    for said in &entries.diagnostics {
        writeln!(shown, "{}", message(said, "a.lis")).expect("text");
    }
    for entry in &entries.entries {
        writeln!(shown, "{}", of_entry(entry)).expect("text");
    }
    shown
}

fn of_entry(entry: &Entry) -> String {
    let mut forms = vec![format!("text `{}`", entry.text().value)];
    forms.push(format!("word `{}`", entry.word().value));
    forms.dedup_by(|word, text| word[5..] == text[5..]);
    let number = entry.number().value.number;
    forms.extend(number.map(|number| format!("number {}", number.to_f64())));
    let truth = entry.truth().value;
    forms.extend(truth.map(|truth| truth.to_string()));
    let words: Vec<&str> = entry.words().iter().map(|word| word.value).collect();
    if words.len() > 1 {
        forms.push(format!("words {}", words.join(" ")));
    }
    format!("{}: {}", entry.key(), forms.join(", "))
}

/// Shows what each axis of a report sends to its drive and receives from it.
fn drives(name: &str, report: &ListsReport) -> String {
    let mut text = String::new();
    for axis in &report.reports {
        let accepted = report.accepted.iter();
        let mut accepted = accepted.filter(|it| it.axis == axis.axis);
        let friction = accepted.next().map(|it| &it.list);
        let drive = check_drive(&axis.listed_drive(friction), &Evidence::default());
        let say = |said: &Diagnostic| message(said, name);
        for said in &drive.diagnostics {
            writeln!(text, "{}", say(said)).expect("text");
        }
        for open in &drive.open {
            writeln!(text, "open: {}", say(open)).expect("text");
        }
        for (signal, presence) in [
            ("additive torque", &drive.additive_torque),
            ("actual torque", &drive.actual_torque),
        ] {
            let known = match presence {
                Presence::Present { evidence } => format!("present, {evidence}"),
                Presence::Missing { evidence } => format!("missing, {evidence}"),
                Presence::Unknown { .. } => "unknown".to_owned(),
                Presence::NotApplicable => "not applicable".to_owned(),
            };
            writeln!(text, "{signal} {known}").expect("text");
        }
        if let Some(largest) = drive.largest_torque {
            writeln!(text, "largest torque {largest} × 0.1 %").expect("text");
        }
    }
    text
}
