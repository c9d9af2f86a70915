//! The file that a path in a list means, and files in place of another kind of list: R3.12 to
//! R3.14.

use frictcomp::machine::{Configuration, ListFiles, check_list};
use frictcomp::text::SourceFile;

use super::host::{Memory, codes, judge, meant};

/// Returns the machine of a start-up list at some place among other lists.
fn at(path: &str, files: &[(&'static str, &'static str)]) -> Configuration {
    let mut memory = Memory(files.iter().copied().collect());
    let startup = memory.read(path).unwrap();
    Configuration::from_startup(startup, &mut memory)
}

const X: &str = "kopf.achs_nr 1\nkopf.log_achs_name X\nkenngr.achs_typ 1\nEnde";

#[test]
fn paths_are_tried_from_each_folder_above() {
    // R3.12
    let startups = [
        (
            "listen/hochlauf.lis",
            "achs_mds[0] ./listen/a.lis\nEnde",
            "listen/a.lis",
        ),
        (
            "cnc/listen/hochlauf.lis",
            "achs_mds[0] .\\listen\\a.lis\nEnde",
            "cnc/listen/a.lis",
        ),
        (
            "a/b/c/hochlauf.lis",
            "achs_mds[0] lists/a.lis\nEnde",
            "a/lists/a.lis",
        ),
        (
            "a/b/c/hochlauf.lis",
            "achs_mds[0] lists/a.lis\nEnde",
            "lists/a.lis",
        ),
        (
            "listen/hochlauf.lis",
            "achs_mds[0] ..\\x\\a.lis\nEnde",
            "listen/../x/a.lis",
        ),
    ];
    for (path, text, list) in startups {
        let found = at(path, &[(path, text), (list, X)]);
        assert_eq!(codes(&found.diagnostics), [""; 0], "{path} {list}");
        assert_eq!(&*found.files[1], list, "{path}");
        assert_eq!(found.machine.axes[0].name, "X");
    }
}

#[test]
fn the_nearest_list_counts() {
    // R3.12: the start-up list's own folder, then those above, then the bare name
    let files = [
        ("a/b/h.lis", "achs_mds[0] l/x.lis\nEnde"),
        ("a/b/x.lis", X),
        ("a/l/x.lis", X),
        ("a/b/l/x.lis", X),
    ];
    for (count, expected) in [(4, "a/b/l/x.lis"), (3, "a/l/x.lis"), (2, "a/b/x.lis")] {
        assert_eq!(&*at("a/b/h.lis", &files[..count]).files[1], expected);
    }
}

#[test]
fn a_path_of_another_disk_is_tried_by_its_last_part() {
    // R3.12
    for path in [
        "C:\\TwinCAT\\a.lis",
        "D:/cnc/listen/a.lis",
        "\\\\plc\\share\\a.lis",
    ] {
        let text: &'static str = Box::leak(format!("achs_mds[0] {path}\nEnde").into_boxed_str());
        let found = at("m/h.lis", &[("m/h.lis", text), ("m/a.lis", X)]);
        assert_eq!(codes(&found.diagnostics), [""; 0], "{path}");
        assert_eq!(&*found.files[1], "m/a.lis");
    }
}

#[test]
fn a_missing_list_says_where_it_was_looked_for() {
    // R3.12, R3.14
    let found = at(
        "m/h.lis",
        &[(
            "m/h.lis",
            "achs_mds[0] l/a.lis # the first\nachs_mds[1] b.lis\nEnde",
        )],
    );
    assert_eq!(codes(&found.diagnostics), ["FC123 1:13", "FC123 2:13"]);
    assert_eq!(found.missing, 2);
    assert_eq!(
        found.diagnostics[0].help()[1],
        "only `(` opens a comment after a path"
    );
    let help = &found.diagnostics[1].help();
    assert_eq!(
        help,
        &["looked for `m/b.lis`, in the same way from each folder above"]
    );
}

#[test]
fn as_many_lists_are_there_as_the_list_says() {
    // R3.12: the control does not start without them
    let found = at(
        "h.lis",
        &[
            (
                "h.lis",
                "zahl_mds 3\nachs_mds[0] a.lis\nachs_mds[2] a.lis\nEnde",
            ),
            ("a.lis", X),
        ],
    );
    let first = &found.diagnostics[0];
    assert_eq!(codes(&found.diagnostics)[0], "FC123 1:10");
    assert!(
        first.message.contains("`achs_mds[1]` names no list"),
        "{}",
        first.message
    );
}

#[test]
fn a_list_of_another_kind_is_said_where_it_is_named() {
    // R3.10 to R3.13
    let value = "kopf.achs_nr 1\nfrict_comp.mode 0\nEnde";
    let channel = "gruppe[0].achse[0].bezeichnung X\nEnde";
    for (text, list) in [
        ("achs_mds[0] l.lis\nEnde", value),
        ("achs_mds[0] l.lis\nEnde", channel),
        ("achs_kw[0] l.lis\nEnde", X),
        ("sda_mds[0] l.lis\nEnde", X),
        ("sda_mds[0] l.lis\nEnde", "zahl_mds 0\nEnde"),
    ] {
        let found = at("h.lis", &[("h.lis", text), ("l.lis", list)]);
        assert_eq!(codes(&found.diagnostics)[0][..5], *"FC125", "{text}");
        assert_eq!(meant(&found.diagnostics[0]), "l.lis");
    }
    // The head alone, or an empty list, belongs to both.
    for list in [
        "kopf.achs_nr 1\nkopf.log_achs_name X\nEnde",
        "# nothing\nEnde",
    ] {
        for text in ["achs_mds[0] l.lis\nEnde", "achs_kw[0] l.lis\nEnde"] {
            let found = at("h.lis", &[("h.lis", text), ("l.lis", list)]);
            let codes = codes(&found.diagnostics);
            assert!(
                codes.iter().all(|code| !code.starts_with("FC125")),
                "{codes:?}"
            );
        }
    }
}

#[test]
fn what_is_no_start_up_list_is_said() {
    // R3.12
    for (text, what) in [
        ("kopf.achs_nr 1\nfrict_comp.mode 0\nEnde", "a value list"),
        (X, "an axis list"),
        ("[machine]\nstartup = \"h.lis\"\n", "a `frictcomp.toml`"),
        ("%part\nN10 G0 X5\nM30\n", "a program"),
        ("N10 G0 X5\nN20 M30\n", "a program"),
        ("X[COMP ON FRICT]\nM30\n", "a program"),
        ("<?xml version=\"1.0\"?>", "an XML file"),
        ("wz[0].radius 5\nEnde", "a tool list"),
        ("# only words\n", "an empty file"),
    ] {
        let file = SourceFile::new("f", text);
        let found = Configuration::from_startup(file, &mut Memory(std::iter::empty().collect()));
        assert_eq!(codes(&found.diagnostics), ["FC125 1:1"], "{text}");
        let message = &found.diagnostics[0].message;
        assert_eq!(message, &format!("`f` is {what}, not a start-up list"));
    }
}

#[test]
fn lists_that_say_nothing_about_compensation_are_silent() {
    // R3.5
    for text in [
        "wz[0].typ 1\nwz[0].radius 5\nEnde",
        "np_grp[0].achse[0].x 1\nEnde",
        "makro_def[0].symbol CALC\nmakro_def[0].nc_code P5 = P2 + 3\nEnde",
        "hr_data[0].log_nr 1\nEnde",
    ] {
        assert_eq!(judge(text).diagnostics, [], "{text}");
    }
}

#[test]
fn the_manual_s_start_up_list_needs_only_what_is_read() {
    // R3.12, R3.13: two channels, a default list for each kind, lists that do not matter here
    let startup = "# ****\nkonfiguration ZWEI_KANAL\nkanal_anzahl 2\next_var_max 200\nplc_mode 0\n\
        listen ASCII\n# ****\ndefault_sda_mds ..\\listen\\default_sda.lis\n\
        sda_mds[0] ..\\listen\\sda1.lis\nwerkz_data[0] ..\\listen\\werkz_d1.lis\n\
        fb_storage_size[0] 0x200000\nsda_mds[1] ..\\listen\\sda2.lis\n\
        hmi[0].objects ..\\listen\\objects1.lis\nhmi[0].mode write+\n\
        zahl_mds 3\ndefault_achs_mds ..\\listen\\default.lis\nachs_mds[0] ..\\listen\\a1.lis\n\
        achs_mds[1] ..\\listen\\a2.lis\nachs_mds[2] ..\\listen\\a3.lis\nEnde\n";
    let files = [
        ("cnc/listen/hochlauf.lis", startup),
        (
            "cnc/listen/default_sda.lis",
            "grp_anzahl 1\ngruppe[0].achse[0].bezeichnung X\nspindel[0].bezeichnung S\nEnde",
        ),
        (
            "cnc/listen/sda1.lis",
            "#cax_face_id 1\ngruppe[0].achs_anzahl 1\ngruppe[0].achse[0].log_achs_nr 1\n\
             gruppe[0].achse[1].log_achs_nr 0\nspindel[0].log_achs_nr 3\nEnde",
        ),
        (
            "cnc/listen/sda2.lis",
            "gruppe[0].achs_anzahl 1\ngruppe[0].achse[0].log_achs_nr 2\n\
             gruppe[0].achse[0].bezeichnung Z\nEnde",
        ),
        ("cnc/listen/default.lis", "lr_param.frict_comp 0\nEnde"),
        (
            "cnc/listen/a1.lis",
            "kopf.achs_nr 1\nlr_param.frict_comp 0\nEnde",
        ),
        (
            "cnc/listen/a2.lis",
            "kopf.achs_nr 2\nlr_param.frict_comp 0\nEnde",
        ),
        (
            "cnc/listen/a3.lis",
            "kopf.achs_nr 3\nkenngr.achs_typ 4\nEnde",
        ),
    ];
    // Paths with `..` are not resolved by name.
    let mut memory = Above(files.iter().copied().collect());
    let file = SourceFile::new("cnc/listen/hochlauf.lis", startup);
    let found = Configuration::from_startup(file, &mut memory);
    assert_eq!(codes(&found.diagnostics), [""; 0]);
    let names: Vec<_> = found
        .machine
        .axes
        .iter()
        .map(|a| (a.name.as_str(), a.number))
        .collect();
    assert_eq!(names, [("X", Some(1)), ("Z", Some(2)), ("S", Some(3))]);
    assert!(found.machine.axes[2].is_spindle());
    let report = check_list(
        SourceFile::new("cnc/listen/hochlauf.lis", startup),
        None,
        &mut memory,
    );
    assert_eq!((report.files.len(), report.missing), (8, 0));
}

/// Lists by their paths, `..` resolved.
struct Above(std::collections::BTreeMap<&'static str, &'static str>);

impl ListFiles for Above {
    fn read(&mut self, path: &str) -> Result<SourceFile, frictcomp::machine::NoList> {
        let mut parts: Vec<&str> = Vec::new();
        for part in path.split('/') {
            if part == ".." {
                parts.pop();
            } else {
                parts.push(part);
            }
        }
        let text = self.0.get(parts.join("/").as_str());
        let text = text.ok_or(frictcomp::machine::NoList::Missing)?;
        Ok(SourceFile::new(path, *text))
    }
}

#[test]
fn a_second_channel_with_the_same_axes_is_said_once() {
    // R3.13
    let channel = "gruppe[0].achse[0].bezeichnung X\ngruppe[0].achse[1].bezeichnung Y\nEnde";
    let found = at(
        "h.lis",
        &[
            ("h.lis", "sda_mds[0] k.lis\nsda_mds[1] l.lis\nEnde"),
            ("k.lis", channel),
            ("l.lis", channel),
        ],
    );
    assert_eq!(codes(&found.diagnostics), ["FC124 2:12"]);
    assert_eq!(found.machine.axes.len(), 2);
}

#[test]
fn the_name_of_an_axis_is_one_word() {
    // R3.2, R3.13
    let found = at(
        "h.lis",
        &[
            ("h.lis", "sda_mds[0] k.lis\nEnde"),
            (
                "k.lis",
                "gruppe[0].achse[0].bezeichnung X  # main\ngruppe[0].achse[1].bezeichnung Y (x)\nEnde",
            ),
        ],
    );
    assert_eq!(codes(&found.diagnostics), ["FC124 1:32"]);
    let names: Vec<_> = found
        .machine
        .axes
        .iter()
        .map(|axis| axis.name.as_str())
        .collect();
    assert_eq!(names, ["X", "Y"]);
}
