//! The torque interface of drives, `drive`.

use serde_json::{Value, json};

use crate::document::{Headline, Standing, Table};
use crate::wording::{listed, visible_line};
use frictcomp::drive_interface::{DriveReport, Presence, Signal};

/// Returns the verdict on the drives of the axes with friction compensation.
pub fn drives_headline(reports: &[DriveReport]) -> Headline {
    let named = |of: fn(&DriveReport) -> bool| {
        let reports = reports.iter().filter(|it| it.configured && of(it));
        let names: Vec<&str> = reports.map(|it| it.axis.as_str()).collect();
        listed(&names)
    };
    let reached =
        named(|it| !it.is_idle() && matches!(it.additive_torque, Presence::Present { .. }));
    let idle = named(DriveReport::is_idle);
    let missed = named(|it| matches!(it.additive_torque, Presence::Missing { .. }));
    let open = named(|it| matches!(it.additive_torque, Presence::Unknown { .. }));
    let standing = match (&missed, &idle, &open) {
        (Some(_), _, _) | (_, Some(_), _) => Standing::Bad,
        (None, None, Some(_)) => Standing::Open,
        (None, None, None) => Standing::Good,
    };
    let parts = [
        (missed, "does not reach the drive of"),
        (
            idle,
            "is 0, without an accepted value list or by a factor of 0, for",
        ),
        (open, "may not reach the drive of"),
        (reached, "reaches the drive of"),
    ];
    let parts = parts
        .into_iter()
        .filter_map(|(axes, how)| Some(format!("{how} {}", axes?)));
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
