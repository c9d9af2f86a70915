//! The machine at the command line: lists from any folder, missing lists, files that are not lists.

use crate::folder::{command, stderr, stdout};
use std::fmt::Write as _;
use std::fs;
use std::path::Path;
use std::process::Output;

/// Runs the tool in a folder with wide lines.
fn tool(folder: &Path, arguments: &[&str]) -> Output {
    command(folder, arguments)
        .env("COLUMNS", "200")
        .output()
        .unwrap()
}

fn write(folder: &Path, files: &[(&str, &str)]) {
    for (name, text) in files {
        let path = folder.join(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, text).unwrap();
    }
}

/// Writes a start-up list as vendors ship it: it names lists from the control's working folder, one above.
fn vendor(folder: &Path) {
    write(
        folder,
        &[
            (
                "cnc/listen/hochlauf.lis",
                "# start\nzahl_mds 2\ndefault_achs_mds .\\Listen\\default.lis\n\
                 achs_mds[0] ./listen/achsmds1.lis\nachs_mds[1] ./listen/AchsMds2.lis\n\
                 sda_mds[0] ./listen/sda_mds1.lis\nachs_kw[0] ./listen/achskw1.lis\nzahl_kw 1\nEnde\n",
            ),
            (
                "cnc/listen/default.lis",
                "#kopf.achs_nr 0\nkenngr.antr_typ 8\nlr_param.frict_comp 1\nEnde\n",
            ),
            ("cnc/listen/achsmds1.lis", "kopf.achs_nr 1\nEnde\n"),
            (
                "cnc/listen/achsmds2.lis",
                "kopf.achs_nr 2\nlr_param.frict_comp 0\nEnde\n",
            ),
            (
                "cnc/listen/sda_mds1.lis",
                "#cax_face_id 1\ngruppe[0].achse[0].bezeichnung X\n\
                 gruppe[0].achse[0].log_achs_nr 1\ngruppe[0].achse[1].bezeichnung Y\n\
                 gruppe[0].achse[1].log_achs_nr 2\nEnde\n",
            ),
            (
                "cnc/listen/achskw1.lis",
                "kopf.achs_nr 1\nfrict_comp.mode 3\nfrict_comp.table_entries 1\n\
                 frict_comp.table[0].in 10\nfrict_comp.table[0].out 40\nEnde\n",
            ),
            ("cnc/a.nc", "X[COMP OFF FRICT]\nX[COMP ON FRICT]\nM30\n"),
        ],
    );
}

#[test]
fn a_vendor_s_start_up_list_is_read_from_any_folder() {
    // R3.12
    let root = tempfile::tempdir().unwrap();
    vendor(root.path());
    for (folder, list, shown) in [
        ("cnc", "listen/hochlauf.lis", "listen/achskw1.lis:3"),
        ("cnc", "./listen/hochlauf.lis", "listen/achskw1.lis:3"),
        ("cnc/listen", "hochlauf.lis", "../listen/achskw1.lis:3"),
        (
            "cnc/listen",
            "../listen/hochlauf.lis",
            "../listen/achskw1.lis:3",
        ),
        ("", "cnc/listen/hochlauf.lis", "cnc/listen/achskw1.lis:3"),
    ] {
        let folder = root.path().join(folder);
        let listed = tool(&folder, &["lists", "--show", list]);
        assert_eq!(listed.status.code(), Some(0), "{list}: {}", stderr(&listed));
        assert!(
            stdout(&listed).starts_with("no fault in 6 files\n"),
            "{}",
            stdout(&listed)
        );
        assert!(
            stdout(&listed).contains(shown),
            "{list}: {}",
            stdout(&listed)
        );
    }
    let absolute = root.path().join("cnc/listen/hochlauf.lis");
    let elsewhere = tempfile::tempdir().unwrap();
    let listed = tool(elsewhere.path(), &["lists", absolute.to_str().unwrap()]);
    assert_eq!(listed.status.code(), Some(0), "{}", stderr(&listed));
    let run = tool(
        &root.path().join("cnc"),
        &["run", "--startup", "listen/hochlauf.lis", "a.nc"],
    );
    assert_eq!(run.status.code(), Some(0), "{}", stdout(&run));
}

#[cfg(unix)]
#[test]
fn lists_are_regular_files_that_may_be_read() {
    // R3.14
    use std::os::unix::fs::symlink;
    let root = tempfile::tempdir().unwrap();
    vendor(root.path());
    let cnc = root.path().join("cnc");
    fs::remove_file(cnc.join("listen/achsmds2.lis")).unwrap();
    symlink("/dev/zero", cnc.join("listen/achsmds2.lis")).unwrap();
    let listed = tool(&cnc, &["lists", "listen/hochlauf.lis"]);
    assert_eq!(listed.status.code(), Some(1));
    let text = stdout(&listed);
    assert!(
        text.contains("cannot be read: it is not a regular file"),
        "{text}"
    );
    let named = tool(&cnc, &["lists", "listen/achsmds2.lis"]);
    assert_eq!(named.status.code(), Some(2));
    assert!(
        stderr(&named).contains("not a regular file"),
        "{}",
        stderr(&named)
    );
}

fn loads_and_runs(folder: &Path, program: &str) {
    let shown = tool(folder, &["config", "show"]);
    assert_eq!(
        (shown.status.code(), stderr(&shown)),
        (Some(0), String::new())
    );
    let listed = tool(folder, &["lists", "--fail-on", "info", "frictcomp.toml"]);
    assert_eq!(listed.status.code(), Some(0), "{}", stdout(&listed));
    let run = tool(folder, &["run", "--fail-on", "warning", program]);
    assert_eq!(
        run.status.code(),
        Some(0),
        "{}{}",
        stdout(&run),
        stderr(&run)
    );
}

#[test]
fn init_never_writes_over_a_file() {
    // R9.73
    let root = tempfile::tempdir().unwrap();
    write(
        root.path(),
        &[("frictcomp.toml", "# mine\n"), ("a.nc", "M30\n")],
    );
    let refused = tool(root.path(), &["init"]);
    assert_eq!(refused.status.code(), Some(2));
    assert!(
        stderr(&refused).contains("already exists"),
        "{}",
        stderr(&refused)
    );
    let text = fs::read_to_string(root.path().join("frictcomp.toml")).unwrap();
    assert_eq!(text, "# mine\n");
    #[cfg(unix)]
    {
        let linked = root.path().join("sub");
        fs::create_dir(&linked).unwrap();
        std::os::unix::fs::symlink("../gone.toml", linked.join("frictcomp.toml")).unwrap();
        assert_eq!(tool(&linked, &["init"]).status.code(), Some(2));
        assert!(!root.path().join("gone.toml").exists());
    }
    for folder in ["missing", "a.nc"] {
        let refused = tool(root.path(), &["init", folder]);
        assert_eq!(refused.status.code(), Some(2));
        assert!(
            stderr(&refused).contains("there is no folder"),
            "{}",
            stderr(&refused)
        );
    }
}

#[test]
fn init_takes_a_start_up_list_and_nothing_else() {
    // R9.73
    let root = tempfile::tempdir().unwrap();
    vendor(root.path());
    let cnc = root.path().join("cnc");
    let refused = tool(&cnc, &["init", "--startup", "listen/achskw1.lis"]);
    assert_eq!(refused.status.code(), Some(2));
    assert!(
        stderr(&refused).contains("is a value list"),
        "{}",
        stderr(&refused)
    );
    write(&cnc, &[("other/h.lis", "zahl_mds 0\nEnde\n")]);
    let refused = tool(&cnc, &["init"]);
    assert!(
        stderr(&refused).contains("several start-up lists"),
        "{}",
        stderr(&refused)
    );
    assert!(!cnc.join("frictcomp.toml").exists());
    write(root.path(), &[("prg/a.nc", "X[COMP ON FRICT]\nM30\n")]);
    let made = tool(
        root.path(),
        &["init", "prg", "--startup", "cnc/listen/hochlauf.lis"],
    );
    assert_eq!(made.status.code(), Some(0), "{}", stderr(&made));
    let text = fs::read_to_string(root.path().join("prg/frictcomp.toml")).unwrap();
    assert!(
        text.contains("startup = \"../cnc/listen/hochlauf.lis\""),
        "{text}"
    );
    loads_and_runs(&root.path().join("prg"), "a.nc");
}

#[test]
fn the_lead_of_an_axis_is_that_of_its_recordings() {
    // R6.26: a recording in turns of the motor, with the lead beside it, above it, or on the command line.
    let demo = include_str!("../../../../programs/demo/recordings/friction_x.csv");
    let mut text = "t,SetVelo,ActTorque\n".to_owned();
    for line in demo.lines() {
        let cells: Vec<f64> = line
            .split('\t')
            .filter_map(|cell| cell.parse().ok())
            .collect();
        if let [ms, velocity, torque] = cells[..] {
            let _ = writeln!(text, "{},{},{torque}", ms / 1000.0, velocity / 10_000.0);
        }
    }
    let described = tempfile::tempdir().expect("a folder");
    let axis = "[[axis]]\nname = \"X\"\nlead = 10\n";
    write(
        described.path(),
        &[("frictcomp.toml", axis), ("runs/x.csv", &text)],
    );
    let bare = tempfile::tempdir().expect("a folder");
    write(bare.path(), &[("runs/x.csv", &text)]);
    let identified = |folder: &Path, further: &[&str]| {
        let fixed =
            "identify runs/x.csv --velocity SetVelo --torque ActTorque --unit SetVelo=rev/s";
        let arguments: Vec<&str> = fixed.split(' ').chain(further.iter().copied()).collect();
        // The first line names the axis, where it is given.
        let text = stdout(&tool(folder, &arguments));
        text.split_once('\n')
            .map_or(String::new(), |(_, rest)| rest.to_owned())
    };
    let given = identified(bare.path(), &["--lead", "10"]);
    assert!(given.contains("value list"), "{given}");
    assert_eq!(identified(described.path(), &[]), given);
    assert_eq!(identified(described.path(), &["--axis", "X"]), given);
    assert_ne!(identified(described.path(), &["--lead", "5"]), given);
    assert_ne!(identified(bare.path(), &[]), given);
}
