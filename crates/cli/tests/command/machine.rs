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

/// A start-up list as vendors ship it: it names lists from the control's working folder, one above.
fn vendor(folder: &Path) {
    write(
        folder,
        &[
            (
                "cnc/listen/hochlauf.lis",
                "# start\nzahl_mds 2\ndefault_achs_mds .\\Listen\\default.lis\n\
                 achs_mds[0] ./listen/achsmds1.lis\nachs_mds[1] ./listen/AchsMds2.lis\n\
                 sda_mds[0] ./listen/sda_mds1.lis\nachs_kw[0] ./listen/achskw1.lis\nEnde\n",
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

#[test]
fn missing_lists_are_counted_and_shown_where_they_are_named() {
    // R3.14
    let root = tempfile::tempdir().unwrap();
    vendor(root.path());
    let lists = root.path().join("cnc/listen");
    for name in ["default.lis", "achsmds2.lis", "achskw1.lis"] {
        fs::remove_file(lists.join(name)).unwrap();
    }
    let cnc = root.path().join("cnc");
    write(
        &cnc,
        &[(
            "frictcomp.toml",
            "[machine]\nstartup = \"listen/hochlauf.lis\"\n",
        )],
    );
    let listed = tool(&cnc, &["lists", "listen/hochlauf.lis"]);
    assert_eq!(listed.status.code(), Some(1));
    let said_of_lists = stdout(&listed);
    assert!(
        said_of_lists.starts_with("3 errors in 3 files, 3 lists are missing\n"),
        "{said_of_lists}"
    );
    let shown = tool(&cnc, &["config", "show"]);
    assert_eq!(shown.status.code(), Some(1));
    assert!(
        stdout(&shown).contains("lists          3 read, 3 missing"),
        "{}",
        stdout(&shown)
    );
    for line in [3, 5, 7] {
        let place = format!("listen/hochlauf.lis:{line}:");
        assert!(stderr(&shown).contains(&place), "{}", stderr(&shown));
    }
}

#[test]
fn a_folder_is_checked_by_its_configuration_or_by_the_list_or_project_below_it() {
    // R3.42
    let root = tempfile::tempdir().unwrap();
    vendor(root.path());
    let project = "<TcSmProject><Axis><ItemName>A</ItemName><AchsMds>kopf.achs_nr 1\nEnde\n</AchsMds></Axis></TcSmProject>";
    write(&root.path().join("twincat"), &[("M.tsproj", project)]);
    for (folder, file) in [
        ("cnc", "cnc/listen/hochlauf.lis"),
        ("cnc/listen", "cnc/listen/hochlauf.lis"),
        ("twincat", "twincat/M.tsproj"),
    ] {
        for command in ["lists", "drive"] {
            let [of_folder, of_file] =
                [folder, file].map(|path| tool(root.path(), &[command, path]));
            assert_eq!(of_folder.status, of_file.status, "{command} {folder}");
            assert_eq!(stderr(&of_folder), stderr(&of_file), "{command} {folder}");
            assert_eq!(of_folder.stdout, of_file.stdout, "{command} {folder}");
        }
    }
    let several = tool(root.path(), &["lists", "."]);
    assert_eq!(several.status.code(), Some(2), "{}", stderr(&several));
}

#[test]
fn what_is_no_start_up_list_starts_nothing() {
    // R3.12
    let root = tempfile::tempdir().unwrap();
    vendor(root.path());
    let cnc = root.path().join("cnc");
    write(&cnc, &[("mill.toml", "[[axis]]\nname = \"X\"\n")]);
    for (file, what) in [
        ("listen/achskw1.lis", "is a value list, not a start-up list"),
        (
            "listen/sda_mds1.lis",
            "is a channel list, not a start-up list",
        ),
        ("mill.toml", "is a `frictcomp.toml`, not a start-up list"),
        ("a.nc", "is a program, not a start-up list"),
        ("listen", "is a folder, not a list"),
    ] {
        for arguments in [
            vec!["run", "--startup", file, "a.nc"],
            vec!["check", "--startup", file, "a.nc"],
            vec!["config", "show", "--startup", file],
        ] {
            let refused = tool(&cnc, &arguments);
            assert_eq!(refused.status.code(), Some(2), "{arguments:?}");
            assert!(
                stderr(&refused).contains(what),
                "{arguments:?} {}",
                stderr(&refused)
            );
        }
    }
    write(
        &cnc,
        &[(
            "frictcomp.toml",
            "[machine]\nstartup = \"listen/achskw1.lis\"\n",
        )],
    );
    let refused = tool(&cnc, &["check", "a.nc"]);
    assert_eq!(refused.status.code(), Some(1));
    assert!(
        stdout(&refused).contains("frictcomp.toml:2:11"),
        "{}",
        stdout(&refused)
    );
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

#[test]
fn init_writes_what_loads_without_a_message() {
    // R9.73
    let root = tempfile::tempdir().unwrap();
    vendor(root.path());
    let cnc = root.path().join("cnc");
    let made = tool(&cnc, &["init"]);
    assert_eq!(made.status.code(), Some(0), "{}", stderr(&made));
    assert!(
        stderr(&made).starts_with("wrote `./frictcomp.toml`"),
        "{}",
        stderr(&made)
    );
    let text = fs::read_to_string(cnc.join("frictcomp.toml")).unwrap();
    assert!(
        text.contains("\nstartup = \"listen/hochlauf.lis\""),
        "{text}"
    );
    loads_and_runs(&cnc, "a.nc");

    let programs = tempfile::tempdir().unwrap();
    write(
        programs.path(),
        &[
            (
                "p/b.nc",
                "G0 X1 Y2 Z1=3\nZ1[COMP OFF FRICT]\nX[COMP ON FRICT]\nZ1[COMP ON FRICT]\nM30\n",
            ),
            ("p/sub/c.nc", "B[COMP OFF FRICT]\nB[COMP ON FRICT]\nM30\n"),
        ],
    );
    let made = tool(programs.path(), &["init", "p"]);
    assert_eq!(made.status.code(), Some(0), "{}", stderr(&made));
    assert!(
        stderr(&made).contains("the programs use X, Y, B, Z1"),
        "{}",
        stderr(&made)
    );
    let folder = programs.path().join("p");
    loads_and_runs(&folder, "b.nc");
    let shown = stdout(&tool(&folder, &["config", "show"]));
    let states: Vec<Vec<&str>> = shown
        .lines()
        .skip_while(|line| !line.starts_with("axis"))
        .skip(1)
        .map(|line| line.split_whitespace().take(3).collect())
        .collect();
    let expected = [
        ["X", "active"],
        ["Y", "active"],
        ["B", "active"],
        ["Z1", "active"],
    ];
    for (state, [name, word]) in states.iter().zip(expected) {
        assert_eq!([state[0], state[2]], [name, word]);
    }
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
fn axes_that_nobody_described_are_not_taken_for_others() {
    // R2.20
    let root = tempfile::tempdir().unwrap();
    write(
        root.path(),
        &[
            ("a.nc", "X2[COMP OFF FRICT]\nM30\n"),
            ("y.nc", "Y[COMP OFF FRICT]\nM30\n"),
        ],
    );
    let free = tool(root.path(), &["check", "a.nc"]);
    assert!(!stdout(&free).contains("did you mean"), "{}", stdout(&free));
    write(
        root.path(),
        &[("frictcomp.toml", "[[axis]]\nname = \"X\"\n")],
    );
    let text = stdout(&tool(root.path(), &["check", "y.nc"]));
    assert!(
        text.contains("the configuration lists all axes: X"),
        "{text}"
    );
    assert!(text.contains("`[[axis]]` with `name = \"Y\"`"), "{text}");
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

#[test]
fn numbers_without_a_header_and_a_time_are_no_recording() {
    // R6.27
    let folder = tempfile::tempdir().expect("a folder");
    let list = "frict_comp.mode 3\nfrict_comp.table_entries 1\nfrict_comp.table[0].in 0\n\
                frict_comp.table[0].out 100\n";
    write(
        folder.path(),
        &[("x.csv", "5,6\n3,2\n4,1\n4,1\n"), ("x.lis", list)],
    );
    for command in ["identify", "verify --value-list x.lis"] {
        let mut arguments: Vec<&str> = command.split(' ').collect();
        arguments.extend(["x.csv", "--velocity", "column 1", "--torque", "column 2"]);
        let output = tool(folder.path(), &arguments);
        assert_eq!(
            output.status.code(),
            Some(2),
            "{command}: {}",
            stderr(&output)
        );
        assert!(
            stderr(&output).contains("has no times"),
            "{}",
            stderr(&output)
        );
    }
}
