//! Faulty recordings in the command: what it refuses, and what it asks (R6.21).

use crate::folder::answer;
use crate::workspace::root;

/// Returns a file for the command, with other bytes in place of some.
fn play(name: &str, text: &[u8], arguments: &[&str]) -> (Option<i32>, String, String) {
    let folder = tempfile::tempdir().expect("a folder");
    std::fs::write(folder.path().join(name), text).expect("written");
    let list = folder.path().join("new.lis");
    let list_written = ["--write-list", "new.lis"];
    let (status, said) = answer(
        folder.path(),
        &[&["identify", name], arguments, &list_written].concat(),
    );
    (
        status,
        said,
        std::fs::read_to_string(list).unwrap_or_default(),
    )
}

/// Returns the lines of the demo with other torques.
fn with_torques(change: impl Fn(i64) -> i64) -> String {
    let text = std::fs::read_to_string(root().join("programs/demo/recordings/friction_x.csv"))
        .expect("the demo");
    let line = |line: &str| {
        let (before, torque) = line.rsplit_once('\t')?;
        let torque: i64 = torque.parse().ok()?;
        before
            .starts_with(|it: char| it.is_ascii_digit())
            .then(|| format!("{before}\t{}\n", change(torque)))
    };
    text.lines()
        .map(|it| line(it).unwrap_or_else(|| format!("{it}\n")))
        .collect()
}

#[test]
fn the_command_writes_no_wrong_list() {
    // R6.21: refused with status 2 and no list; reported first, and in the header of the list.
    let channels = ["--velocity", "SetVelo", "--torque", "ActTorque"];
    let (status, said, list) = play("absolute.csv", with_torques(i64::abs).as_bytes(), &channels);
    assert_eq!(status, Some(2), "{said}");
    assert!(
        said.contains("FC523") && !said.contains("value list:"),
        "{said}"
    );
    assert_eq!(list, "");
    let turned = with_torques(|it| -it);
    let (status, said, list) = play("turned.csv", turned.as_bytes(), &channels);
    assert_eq!(status, Some(0), "{said}");
    let named = said.find("FC522").expect("the fault");
    assert!(
        named < said.find("value list:").expect("the list"),
        "{said}"
    );
    assert!(list.contains("FC522"), "{list}");
    // The content of an unnamed torque is unknown unless it is declared.
    let plain = with_torques(|it| it)
        .replace("ActTorque", "Signal")
        .replace("actual torque", "signal");
    let channels = ["--velocity", "SetVelo", "--torque", "Signal"];
    let (_, said, _) = play("plain.csv", plain.as_bytes(), &channels);
    assert!(said.contains("FC521"), "{said}");
    for (more, refused) in [
        (["--torque-kind", "actual"], false),
        (["--compensation", "off"], false),
        (["--compensation", "on"], true),
        (["--torque-kind", "loop"], true),
    ] {
        let all = [&channels[..], &more].concat();
        let (status, said, list) = play("plain.csv", plain.as_bytes(), &all);
        assert_eq!(
            status,
            Some(if refused { 2 } else { 0 }),
            "{more:?}: {said}"
        );
        assert_eq!(said.contains("FC521"), refused, "{more:?}: {said}");
        assert_eq!(list.is_empty(), refused, "{more:?}");
    }
    // The channel name takes precedence over the declaration.
    let named = plain.replace("Signal", "SpeedControllerOut");
    let channels = ["--velocity", "SetVelo", "--torque", "SpeedControllerOut"];
    let actual = [&channels[..], &["--torque-kind", "actual"]].concat();
    let (status, said, list) = play("named.csv", named.as_bytes(), &actual);
    assert_eq!((status, list.as_str()), (Some(2), ""), "{said}");
    assert!(said.contains("was given as `actual`"), "{said}");
    // A unit that is wrong by 1000.
    let demo = with_torques(|it| it);
    let channels = [
        &["--velocity", "SetVelo", "--torque", "ActTorque"][..],
        &["--unit", "SetVelo=mm/s"],
    ]
    .concat();
    let (_, said, _) = play("unit.csv", demo.as_bytes(), &channels);
    assert!(
        said.contains("FC524") && said.contains("`µm/s` is more likely"),
        "{said}"
    );
}

#[test]
fn what_scope_scales_is_found_or_asked() {
    // R6.23
    let channels = ["--velocity", "SetVelo", "--torque", "ActTorque"];
    let header = |rows: &str| with_torques(|it| it).replacen("Unit\t", &format!("{rows}Unit\t"), 1);
    let said = |rows: &str| play("scope.csv", header(rows).as_bytes(), &channels);
    // Integer samples of an integer variable that is drawn in thousandths.
    let (_, raw, _) = said("Offset\t0\t0\nScaleFactor\t1\t0.001\n");
    assert!(raw.contains("which are not in its samples"), "{raw}");
    let (_, open, _) = said("Offset\t0\t0\nScaleFactor\t1\t-1\n");
    assert!(
        open.contains("FC519") && open.contains("not known whether its samples contain"),
        "{open}"
    );
    let (_, found, _) =
        said("Offset\t0\t0\nScaleFactor\t1\t-1\nMin\t-120000\t-454\nMax\t120000\t456\n");
    assert!(found.contains("which are in its samples"), "{found}");
    let (_, found, _) =
        said("Offset\t0\t0\nScaleFactor\t1\t-1\nMin\t-120000\t-456\nMax\t120000\t454\n");
    assert!(found.contains("which are not in its samples"), "{found}");
    // A scaled unit is refused unless the unit of the samples is given.
    let rows = "Unit ScaleFactor\t0.001\t1\nUnit Offset\t0\t0\n";
    let (status, refused, list) = said(rows);
    assert_eq!(status, Some(2), "{refused}");
    assert!(refused.contains("unit scale 0.001"), "{refused}");
    assert_eq!(list, "");
    let given = [&channels[..], &["--unit", "SetVelo=um/s"]].concat();
    let (status, given, _) = play("scope.csv", header(rows).as_bytes(), &given);
    assert_eq!(status, Some(0), "{given}");
    let (status, packed, _) = play(
        "scope.csv.gz",
        b"\x1f\x8b\x08\x00\x00\x00\x00\x00",
        &channels,
    );
    assert_eq!(status, Some(2));
    assert!(packed.contains("compressed with gzip"), "{packed}");
}
