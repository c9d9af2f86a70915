//! A gantry: the torque of both motors gives one list, or none (R16.8, R16.9).

use super::{friction, planned, put, run};
use crate::folder::one_line;

/// Returns a folder whose X has a second motor.
fn gantry() -> tempfile::TempDir {
    let folder = planned();
    let path = folder.path().join("m/plan-1.json");
    let plan = std::fs::read_to_string(&path).expect("a plan");
    let mut plan: serde_json::Value = serde_json::from_str(&plan).expect("a record");
    plan["plan"]["axes"][0]["followers"] = serde_json::json!(["X2"]);
    std::fs::write(&path, plan.to_string()).expect("written");
    folder
}

/// Returns the recorded speeds of X; the torque of its second motor is a share of that of the first plus a constant.
fn both_motors(part: f64, more: f64) -> String {
    let recorded = friction(0, 1.0).replacen("torque", "torque_X,torque_X2", 1);
    let rows = recorded.lines().map(|line| {
        let torque = line
            .rsplit(',')
            .next()
            .and_then(|it| it.parse::<f64>().ok());
        torque.map_or_else(
            || format!("{line}\n"),
            |torque| format!("{line},{:.0}\n", torque.mul_add(part, more)),
        )
    });
    rows.collect()
}

const BOTH: [&str; 2] = ["--torque", "torque_%"];

/// R16.8, R16.9: one motor allows no conclusion for both.
#[test]
fn a_gantry_gets_no_list_of_one_motor() {
    let folder = gantry();
    put(folder.path(), "a.csv", &friction(0, 1.0));
    for (arguments, reason) in [
        (&[][..], "their torque is not read: name the channels"),
        (&BOTH, "there is no channel `torque_X`"),
    ] {
        let (status, text) = run(folder.path(), arguments);
        assert!(status == Some(1) && text.contains(reason), "{text}");
        assert!(!folder.path().join("m/lists").exists());
    }
    let one = friction(0, 1.0).replacen("torque", "torque_X", 1);
    put(folder.path(), "a.csv", &one);
    let (status, text) = run(folder.path(), &BOTH);
    let words = [
        "the motors of X2 share the friction",
        "there is no channel `torque_X2`",
    ];
    assert!(
        status == Some(1) && words.iter().all(|it| text.contains(it)),
        "{text}"
    );
    assert!(!folder.path().join("m/lists").exists());
}

/// R16.8: motors that share the friction get the list of their mean; the force between them is not part of it.
#[test]
fn motors_that_share_the_friction_get_one_list() {
    let folder = gantry();
    put(folder.path(), "a.csv", &both_motors(0.9, 40.0));
    let (_, text) = run(folder.path(), &BOTH);
    let said = "the motors of X and X2 differ by at most 10 % of the friction; both motors get the list of the mean friction";
    let words = one_line(&text);
    assert!(words.contains(said), "{text}");
    let outputs = |folder: &tempfile::TempDir| {
        let lists = std::fs::read_dir(folder.path().join("m/lists")).expect("lists");
        let list = lists
            .map(|it| it.expect("a file").path())
            .next()
            .expect("a list");
        let text = std::fs::read_to_string(list).expect("text");
        let values = text.lines().filter(|it| it.contains("].out "));
        let values = values.filter_map(|it| it.split_whitespace().nth(1)?.parse().ok());
        values.collect::<Vec<f64>>()
    };
    let both = outputs(&folder);
    let alone = planned();
    put(alone.path(), "a.csv", &friction(0, 1.0));
    run(alone.path(), &[]);
    let one = outputs(&alone);
    assert!(
        !both.is_empty() && both.len() == one.len(),
        "{both:?} {one:?}"
    );
    for (both, one) in both.iter().zip(&one) {
        assert!((both / one - 0.95).abs() < 0.02, "{both} {one}");
    }
}

/// R16.8: motors whose friction differs do not get one list.
#[test]
fn motors_with_different_friction_get_no_list() {
    let folder = gantry();
    put(folder.path(), "a.csv", &both_motors(0.7, 0.0));
    let (status, text) = run(folder.path(), &BOTH);
    let words = one_line(&text);
    let reason = "the motors of X and X2 differ by 30 % of the friction: one list fits neither";
    assert!(status == Some(1) && words.contains(reason), "{text}");
    assert!(!folder.path().join("m/lists").exists());
}
