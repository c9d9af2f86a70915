//! The torque interface of drives, `drive`.

use serde_json::{Value, json};

use crate::document::{Headline, Standing, Table};
use crate::wording::{listed, visible_line};
use frictcomp::drive_interface::{DriveReport, IdleBy, Presence, Signal};

/// Returns the verdict on the drives of the axes with friction compensation.
pub fn drives_headline(reports: &[DriveReport]) -> Headline {
    let named = |of: &dyn Fn(&DriveReport) -> bool| {
        let reports = reports.iter().filter(|it| it.configured && of(it));
        let names: Vec<&str> = reports.map(|it| it.axis.as_str()).collect();
        listed(&names)
    };
    let is_present =
        |it: &DriveReport| !it.is_idle() && matches!(it.additive_torque, Presence::Present { .. });
    let reached = named(&|it| is_present(it) && !it.lacks_type());
    let untyped = named(&|it| is_present(it) && it.lacks_type());
    let idle = [
        (
            IdleBy::NoValues,
            "is 0, without an accepted value list, for",
        ),
        (
            IdleBy::Outputs,
            "is 0, with outputs that are all 0 after scaling, for",
        ),
        (IdleBy::TorqueScaling, "is 0, by a torque scaling of 0, for"),
    ];
    let idle = idle.map(|(by, how)| (named(&|it| it.idle_by() == Some(by)), how));
    let missed = named(&|it| {
        let presence = &it.additive_torque;
        matches!(presence, Presence::Missing { .. } | Presence::NotApplicable)
    });
    let open = named(&|it| matches!(it.additive_torque, Presence::Unknown { .. }));
    let standing = if missed.is_some() || idle.iter().any(|(axes, _)| axes.is_some()) {
        Standing::Bad
    } else if open.is_some() || untyped.is_some() {
        Standing::Open
    } else {
        Standing::Good
    };
    let others = [
        (open, "may not reach the drive of"),
        (
            untyped,
            "goes to a simulated drive, unless TwinCAT fills in the type that no list gives, for",
        ),
        (reached, "reaches the drive of"),
    ];
    let missed = [(missed, "does not reach the drive of")];
    let parts = missed.into_iter().chain(idle).chain(others);
    let parts = parts.filter_map(|(axes, how)| Some(format!("{how} {}", axes?)));
    let parts: Vec<String> = parts.collect();
    if parts.is_empty() {
        return Headline::new(
            Standing::Open,
            "no drive of an axis with friction compensation is described",
        );
    }
    Headline::new(
        standing,
        format!("the compensation torque {}", parts.join("; it ")),
    )
}

/// Returns what is known about the drive of each axis.
pub fn render_drives(reports: &[DriveReport]) -> String {
    let drives = reports.iter().map(render_drive);
    drives.collect::<Vec<_>>().join("\n")
}

/// Returns the evidence on the drive of an axis as a record.
pub fn drive_record(report: &DriveReport) -> Value {
    let mut record = json!(report);
    if let Value::Object(keys) = &mut record {
        keys.insert("record".to_owned(), "drive".into());
    }
    record
}

fn render_drive(report: &DriveReport) -> String {
    let name = match report.axis.as_str() {
        "" => "without a name".into(),
        name => visible_line(name),
    };
    let kind = match report.drive_type {
        Some(kind) => format!("drive type {}", kind.as_str()),
        None => "drive type not given, the control takes simulation".to_owned(),
    };
    let simulated = if report.simulated {
        ", switched to simulation"
    } else {
        ""
    };
    let configured = if report.configured {
        ""
    } else {
        "; friction compensation is not configured"
    };
    let mut rows = Table::plain(["signal", "presence"]);
    let presences = [&report.additive_torque, &report.actual_torque];
    for (signal, presence) in Signal::ALL.iter().zip(presences) {
        let (word, why) = match presence {
            Presence::Present { evidence } => ("present", evidence.to_string()),
            Presence::Missing { evidence } => ("missing", evidence.to_string()),
            Presence::Unknown { reason } => ("unknown", reason.clone()),
            Presence::NotApplicable => ("none", "no drive takes or gives a torque here".to_owned()),
        };
        let signal = format!("  {}", signal.as_str());
        let told = format!("{word:<8} {}", visible_line(&why));
        rows.row(&[&signal, &told]);
    }
    let (numerator, denominator) = (report.scale.numerator, report.scale.denominator);
    rows.row(&[&"  torque scaling", &format!("{numerator}/{denominator}")]);
    if let Some(largest) = report.largest_torque {
        let percent = format!("{:.1} % of the rated torque", largest / 10.0);
        rows.row(&[&"  largest compensation", &percent]);
    }
    format!("axis {name} ({kind}{simulated}{configured})\n{rows}")
}
