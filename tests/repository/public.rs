//! The promises to hosts: a type has one name, can grow, and can be sent to another thread.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use crate::{root, rust_files};

/// A package that others may use.
struct Package {
    /// Folder.
    folder: &'static str,
    /// The prefix of its rooms in the list.
    prefix: &'static str,
}

const PACKAGES: [Package; 6] = [
    package(".", ""),
    package("crates/physics", ""),
    package("crates/recordings", ""),
    package("crates/report", "report"),
    package("crates/host", "host"),
    package("crates/editor", ""),
];

const fn package(folder: &'static str, prefix: &'static str) -> Package {
    Package { folder, prefix }
}

impl Package {
    /// Returns the file that says what a room makes public; the package itself is the room without a name.
    fn face(&self, room: &str) -> PathBuf {
        let source = root().join(self.folder).join("src");
        match room {
            "" => source.join("lib.rs"),
            room => source.join(room).join("mod.rs"),
        }
    }

    /// Returns whether a room re-exports an item of another one, which is the same item.
    fn shows(&self, room: &str, name: &str) -> bool {
        let room = room.strip_prefix(self.prefix).unwrap_or(room);
        let room = room.trim_start_matches("::").replace("::", "/");
        let face = code(&self.face(&room));
        let is_word = |statement: &str| {
            let mut words = statement.split(|c: char| !c.is_alphanumeric() && c != '_');
            words.any(|word| word == name)
        };
        let mut shown = face
            .split(';')
            .filter(|it| it.contains("pub use crate::") || it.contains("pub use frictcomp::"));
        shown.any(is_word)
    }

    /// Returns every public name with its room and the feature that it needs, sorted.
    fn items(&self) -> Vec<String> {
        let mut items = Vec::new();
        self.gather("", "", &mut items);
        items.sort();
        items
    }

    /// Appends the public names of the interface of a room, and the rooms in it.
    fn gather(&self, room: &str, needed: &str, items: &mut Vec<String>) {
        for item in public(&code(&self.face(room))) {
            let feature = match item.feature.as_str() {
                "" => needed,
                feature => feature,
            };
            let path = format!("{room}/{}", item.name);
            let path = path.trim_start_matches('/');
            if item.is_room && self.face(path).is_file() {
                self.gather(path, feature, items);
                continue;
            }
            let path = format!("{}/{path}", self.prefix);
            let path = path.trim_start_matches('/').replace('/', "::");
            items.push(if feature.is_empty() {
                path
            } else {
                format!("{path} ({feature})")
            });
        }
    }
}

/// Returns the text of a source file without comments.
fn code(path: &Path) -> String {
    let text = fs::read_to_string(path).expect("a source file");
    let lines = text
        .lines()
        .map(|line| line.split("//").next().unwrap_or(line));
    lines.collect::<Vec<_>>().join("\n")
}

/// The names that the statements of a file make public.
struct Public {
    name: String,
    /// The feature that it requires, or nothing.
    feature: String,
    is_room: bool,
}

fn public(code: &str) -> Vec<Public> {
    let mut found = Vec::new();
    let mut feature = "";
    for statement in code.split_inclusive([';', ']']) {
        let statement = statement.trim();
        if let Some(rest) = statement.strip_prefix("#[cfg(feature = \"") {
            feature = rest.trim_end_matches("\")]");
            continue;
        }
        let names = statement
            .strip_prefix("pub use ")
            .or_else(|| statement.strip_prefix("pub mod "));
        if let Some(names) = names.map(|names| names.trim_end_matches(';')) {
            let names = names.split_once('{').map_or_else(
                || names.rsplit("::").next().unwrap_or(names),
                |(_, names)| names.trim_end_matches('}'),
            );
            for name in names
                .split(',')
                .map(str::trim)
                .filter(|name| !name.is_empty())
            {
                let name = name.rsplit(" as ").next().unwrap_or(name);
                found.push(Public {
                    name: name.to_owned(),
                    feature: feature.to_owned(),
                    is_room: statement.starts_with("pub mod "),
                });
            }
        }
        feature = "";
    }
    found
}

#[test]
fn a_type_has_a_name_of_its_own() {
    let mut rooms: BTreeMap<String, Vec<String>> = BTreeMap::new();
    for package in &PACKAGES {
        for item in package.items() {
            // Names that only packages of the same version see are named within their room.
            if item.ends_with("(unstable)") {
                continue;
            }
            let Some((room, name)) = item.rsplit_once("::") else {
                continue;
            };
            if name.starts_with(|c: char| c.is_uppercase()) && !package.shows(room, name) {
                let places = rooms.entry(name.to_owned()).or_default();
                places.push(room.to_owned());
            }
        }
    }
    rooms.retain(|_, rooms| rooms.len() > 1);
    assert_eq!(rooms, BTreeMap::new());
}

/// The types that a caller fills in: all fields have to be named, so that a new field is a new question.
const FILLED_IN: &[&str] = &[
    "lists::Conditions",
    "lists::FrictionList",
    "lists::ListHead",
    "lists::TablePoint",
    "text::Place",
    "circle::Circle",
    "circle::CircularTest",
    "circle::CommandedCircle",
    "circle::LapRun",
    "circle::LearnedCircle",
    "circle::Learner",
    "circle::RecordedTrace",
    "circle::Task",
    "contour::ContourLimits",
    "current::Reading",
    "current::TraceColumns",
    "simulation::Plant",
    "simulation::Setpoint",
    "commission::Dynamics",
    "commission::FreeTravel",
    "commission::MeasuredAxis",
    "commission::PlanRequest",
    "commission::ValueListUsed",
    "evidence::EvidenceRecording",
    "evidence::Samples",
    "identify::Predictor",
    "trace::Choice",
    "report::Look",
    "report::TextChange",
    "report::html::GivenForRun",
    "report::html::RunInputs",
    "report::pictures::AxisSample",
    "report::results::audit::AuditReport",
    "report::results::commission::Acceptance",
    "report::results::compare::ContoursReport",
    "report::results::compare::VersionsReport",
    "report::results::contour::ContourSubject",
    "report::svg::Band",
    "report::svg::BandChart",
    "report::svg::BandRow",
    "report::svg::ChartAxis",
    "report::svg::CurveNote",
    "report::svg::LineChart",
    "report::svg::Panel",
    "report::svg::PlaneChart",
    "report::svg::PlaneMark",
    "report::svg::PlanePoint",
    "report::svg::PolarChart",
    "report::svg::PolarPanel",
    "report::svg::PolarSeries",
    "report::svg::SecondUnit",
    "report::svg::Series",
    "report::svg::XMark",
    "host::ContourSetup",
    "host::GoldenKind",
    "host::Input",
    "host::Programs",
    "host::ask::AskedAxis",
    "host::replay::ReplayChannels",
];

/// Returns whether the definition of a type in a text allows it to grow without breaking its readers; `None` if the
/// text does not define it, or if nothing of it is public.
fn can_grow(text: &str, name: &str) -> Option<bool> {
    let lines: Vec<&str> = text.lines().collect();
    let start = ["struct", "enum"].map(|kind| format!("pub {kind} {name}"));
    let defines = |line: &str| {
        let mut rest = start
            .iter()
            .filter_map(|start| line.strip_prefix(start.as_str()));
        rest.any(|rest| rest.starts_with([' ', '<']) && rest.ends_with('{'))
    };
    let at = lines.iter().position(|line| defines(line))?;
    let body = lines[at + 1..].iter().take_while(|line| **line != "}");
    let mut fields = body.filter(|line| line.starts_with("    ") && line.ends_with(','));
    let is_closed =
        lines[at].starts_with("pub struct") && fields.any(|field| !field.starts_with("    pub "));
    let above = lines[..at].iter().rev();
    let mut above = above.take_while(|line| line.starts_with("#[") || line.starts_with("///"));
    Some(is_closed || above.any(|line| line.contains("non_exhaustive")))
}

#[test]
fn what_is_read_can_grow() {
    let mut fixed = Vec::new();
    for package in &PACKAGES {
        let sources = rust_files(&format!("{}/src", package.folder));
        let read = |path: &PathBuf| fs::read_to_string(path).expect("a source file");
        let texts: Vec<String> = sources.iter().map(read).collect();
        let mut items = package.items();
        items.retain(|item| !item.ends_with("(unstable)"));
        fixed.extend(items.into_iter().filter(|item| {
            let name = item.rsplit("::").next().unwrap_or(item);
            let mut found = texts
                .iter()
                .filter_map(|text| can_grow(text, name))
                .peekable();
            found.peek().is_some() && found.all(|can_grow| !can_grow)
        }));
    }
    assert_eq!(fixed, FILLED_IN);
}

#[test]
fn what_hosts_keep_can_be_sent_to_another_thread() {
    fn is_send<T: Send>() {}
    is_send::<frictcomp::audit::Archive>();
    is_send::<frictcomp::diagnostic::Diagnostic>();
    is_send::<frictcomp::interpreter::Interpreter>();
    is_send::<frictcomp::interpreter::Snapshot>();
    is_send::<frictcomp::machine::Machine>();
    is_send::<frictcomp::session::SavedState>();
    is_send::<frictcomp::session::Session>();
    is_send::<frictcomp_host::HostError>();
    is_send::<frictcomp_host::LoadedMachine>();
    is_send::<frictcomp_physics::circle::Learner>();
    is_send::<frictcomp_physics::contour::ProgramContour<()>>();
    is_send::<frictcomp_physics::simulation::Drive>();
    is_send::<frictcomp_recordings::trace::TraceRecording>();
}
