//! The features that users on Windows rely on. Most are the same on every system and tested on each; those
//! specific to Windows are tested there, by `scripts/windows-test` under Wine.

use std::fs;
use std::path::MAIN_SEPARATOR_STR as SEPARATOR;

use crate::folder::{Bench, json};

mod folder;

const MISTAKE: &str = "N10 X1\r\nN20 X[COMP ON FRIKT]\r\nN30 M30\r\n";
const SWITCH_OFF: &str = "N10 X[COMP OFF FRICT]\r\nN20 M30\r\n";

fn utf16(text: &str, bytes: fn(u16) -> [u8; 2]) -> Vec<u8> {
    text.encode_utf16().flat_map(bytes).collect()
}

#[test]
fn paths_have_one_kind_of_slash() {
    // R13.1
    let bench = Bench::new(&[]);
    fs::create_dir(bench.folder().join("mill")).expect("a folder");
    bench.write("mill/wrong.nc", MISTAKE);
    let path = format!("mill{SEPARATOR}wrong.nc");
    for format in [
        "text", "concise", "json", "ndjson", "github", "gitlab", "sarif", "junit",
    ] {
        for named in [path.as_str(), "mill"] {
            let said = bench.stdout(&["check", "--format", format, named]);
            assert!(said.contains("mill/wrong.nc"), "{format}: {said}");
            assert!(!said.contains("mill\\"), "{format}: {said}");
        }
    }
    for format in ["text", "ndjson", "csv"] {
        let shown = bench.stdout(&["run", "--format", format, &path]);
        assert!(shown.contains("mill/wrong.nc"), "{format}: {shown}");
        assert!(!shown.contains("mill\\"), "{format}: {shown}");
    }
    let missing = bench.call(&["run", &format!("mill{SEPARATOR}missing.nc")]);
    let said = String::from_utf8(missing.stderr).expect("text");
    assert!(said.contains("`mill/missing.nc`"), "{said}");
}

/// Lists as a control on Windows names them: from the root of its disk, on a server, from its working
/// folder, in any case.
#[test]
fn lists_of_the_control_are_found() {
    // R13.1
    let bench = Bench::new(&[("a.nc", SWITCH_OFF)]);
    let axis = |number: u8, name: &str| {
        format!(
            "kopf.achs_nr {number}\r\nkopf.log_achs_name {name}\r\nlr_param.frict_comp 1\r\nEnde\r\n"
        )
    };
    let value = "kopf.achs_nr 1\r\nfrict_comp.mode 3\r\nfrict_comp.table_entries 1\r\n\
                 frict_comp.table[0].in 10\r\nfrict_comp.table[0].out 40\r\nEnde\r\n";
    fs::create_dir_all(bench.folder().join("mill/listen")).expect("a folder");
    fs::create_dir_all(bench.folder().join("mill/cycles/deep")).expect("a folder");
    let startup = "zahl_mds 3\r\n\
                   achs_mds[0] C:\\TwinCAT\\CNC\\Listen\\Achse_X.lis\r\n\
                   achs_mds[1] \\\\nas.invalid\\cnc\\achse_y.lis\r\n\
                   achs_mds[2] .\\LISTEN\\achse_z.lis\r\n\
                   achs_kw[0] .\\Listen\\werte_x.lis\r\nzahl_kw 1\r\nEnde\r\n";
    bench.write("mill/listen/hochlauf.lis", startup);
    for (number, name) in [(1, "X"), (2, "Y"), (3, "Z")] {
        let file = format!("mill/listen/achse_{}.lis", name.to_lowercase());
        bench.write(&file, &axis(number, name));
    }
    bench.write("mill/listen/werte_x.lis", value);
    bench.write(
        "mill/cycles/deep/sub.nc",
        "N10 X[COMP OFF FRICT]\r\nN20 M17\r\n",
    );
    let toml =
        "[machine]\r\nstartup = 'listen\\hochlauf.lis'\r\nprogram_dirs = ['cycles\\deep']\r\n";
    bench.write("mill/frictcomp.toml", toml);
    bench.write(
        "mill/a.nc",
        "N10 L SUB.nc\r\nN20 X[COMP ON FRICT]\r\nN30 M30\r\n",
    );
    let shown = bench.stdout(&["config", "show", "--config", "mill/frictcomp.toml"]);
    for axis in ["X     T     active", "Y ", "Z "] {
        assert!(shown.contains(axis), "{axis}: {shown}");
    }
    assert!(!shown.contains("FC123"), "{shown}");
    let blocks = bench.blocks(&["mill/a.nc"]);
    assert_eq!(blocks[1]["file"], "mill/cycles/deep/sub.nc");
    assert_eq!(blocks[1]["friction"]["X"], "inactive");
}

#[test]
fn texts_of_notepad_and_powershell_are_read() {
    // R2.1, R13.1: UTF-16 in both orders, with its mark and without.
    let bench = Bench::new(&[]);
    let program = "N10 X1 (\u{dc}bung)\r\nN20 X[COMP ON FRIKT]\r\nN30 M30\r\n";
    bench.write("a.nc", program);
    let expected = bench.stdout(&["check", "a.nc"]);
    assert!(expected.contains("FRIKT"), "{expected}");
    let toml = bench.read("frictcomp.toml");
    for bytes in [u16::to_le_bytes as fn(u16) -> [u8; 2], u16::to_be_bytes] {
        for mark in ["\u{feff}", ""] {
            let write = |name: &str, text: &str| {
                let text = utf16(&format!("{mark}{text}"), bytes);
                fs::write(bench.folder().join(name), text).expect("written");
            };
            write("a.nc", program);
            write("frictcomp.toml", &toml);
            assert_eq!(bench.stdout(&["check", "a.nc"]), expected, "{mark:?}");
            let text = fs::read(bench.folder().join("a.nc")).expect("read");
            let piped = piped(&bench, &text);
            assert!(piped.contains("UTF-16"), "{mark:?}: {piped}");
        }
    }
}

/// Returns the message about a refused program on standard input.
fn piped(bench: &Bench, text: &[u8]) -> String {
    use std::io::Write;
    let mut command = bench.command(&["check", "-"]);
    let mut child = command
        .stdin(std::process::Stdio::piped())
        .spawn()
        .expect("it starts");
    let mut stdin = child.stdin.take().expect("a pipe");
    stdin.write_all(text).expect("written");
    drop(stdin);
    let output = child.wait_with_output().expect("it ends");
    assert_eq!(output.status.code(), Some(2));
    String::from_utf8(output.stderr).expect("text")
}

#[test]
fn long_paths_are_read_and_written() {
    // R13.1: Windows has a limit of 260 characters, which need not be respected.
    let bench = Bench::new(&[]);
    let long = ["a".repeat(90), "b".repeat(90), "c".repeat(90)].join("/");
    let folder = bench.folder().canonicalize().expect("a folder").join(&long);
    fs::create_dir_all(&folder).expect("a folder");
    fs::write(folder.join("a.nc"), SWITCH_OFF).expect("written");
    let path = |name: &str| format!("{long}/{name}");
    for _ in 0..2 {
        let output = bench.call(&[
            "run",
            "--state",
            &path("s.json"),
            "-o",
            &path("out.txt"),
            &path("a.nc"),
        ]);
        let said = String::from_utf8(output.stderr).expect("text");
        assert_eq!(output.status.code(), Some(0), "{said}");
    }
    let state = fs::read_to_string(folder.join("s.json")).expect("text");
    assert_eq!(json(&state)["schema"], 4);
    assert_eq!(fs::read_dir(&folder).expect("a folder").count(), 4);
}

#[test]
fn what_is_read_only_stays() {
    // R13.1
    let bench = Bench::new(&[("a.nc", SWITCH_OFF)]);
    bench.write("out.txt", "kept");
    let path = bench.folder().join("out.txt");
    let mut rights = fs::metadata(&path).expect("it is there").permissions();
    rights.set_readonly(true);
    fs::set_permissions(&path, rights).expect("read-only");
    let output = bench.call(&["run", "-o", "out.txt", "a.nc"]);
    let said = String::from_utf8(output.stderr).expect("text");
    assert_eq!(output.status.code(), Some(2), "{said}");
    assert!(
        said.contains("`out.txt` cannot be written: it is read-only"),
        "{said}"
    );
    assert_eq!(bench.read("out.txt"), "kept");
}

#[cfg(windows)]
mod only {
    use std::os::windows::fs::OpenOptionsExt;

    use super::*;

    /// Returns the code page of the console in which the test runs; 0 without one.
    fn code_page() -> u32 {
        let said = std::process::Command::new("cmd")
            .args(["/c", "chcp"])
            .output();
        let said = String::from_utf8(said.expect("cmd starts").stdout).expect("ASCII");
        let digits: String = said.chars().filter(char::is_ascii_digit).collect();
        digits.parse().expect("a number")
    }

    #[test]
    fn text_in_a_pipe_has_the_code_page_of_the_console() {
        // R13.1
        let comment = "(\u{dc}bergr\u{f6}\u{df}e)";
        let bench = Bench::new(&[]);
        let program = format!("N10 {comment}\r\nN20 X[COMP OFF FRICT]\r\nN30 M30\r\n");
        bench.write("a.nc", &program);
        let text = bench.call(&["run", "a.nc"]).stdout;
        let page = code_page();
        let (umlauts, mark): (&[u8], &[u8]) = match page {
            437 | 850 => (b"(\x9abergr\x94\xe1e)", b"inactive <"),
            1252 => (b"(\xdcbergr\xf6\xdfe)", b"inactive <"),
            0 | 65001 => (comment.as_bytes(), "inactive \u{25c4}".as_bytes()),
            other => panic!("code page {other}"),
        };
        let holds = |part: &[u8]| text.windows(part.len()).any(|it| it == part);
        let shown = String::from_utf8_lossy(&text);
        assert!(holds(umlauts) && holds(mark), "{page}: {shown}");
        let records = bench.records(&["a.nc"]);
        assert!(records[2].contains(comment), "{page}: {}", records[2]);
        let said = bench.call(&["run", "\u{dc}.nc"]).stderr;
        let is_unicode = matches!(page, 0 | 65001);
        assert_eq!(String::from_utf8(said).is_ok(), is_unicode, "{page}");
    }

    #[test]
    fn wildcards_are_expanded() {
        // R13.1
        let bench = Bench::new(&[("a.nc", SWITCH_OFF), ("B.NC", SWITCH_OFF), ("c.txt", "")]);
        let output = bench.call(&["check", "-v", "*.nc"]);
        let said = String::from_utf8(output.stderr).expect("text");
        assert!(said.contains("2 files checked"), "{said}");
        assert_eq!(bench.status(&["check", "*.mpf"]), Some(2));
    }

    /// A program that has a file open on Windows prevents it from being read or replaced.
    #[test]
    fn a_file_that_another_program_has_open_is_named_and_kept() {
        // R13.1
        let bench = Bench::new(&[("a.nc", SWITCH_OFF)]);
        let call = ["run", "--state", "s.json", "-o", "out.txt", "a.nc"];
        assert_eq!(bench.status(&call), Some(0));
        for name in ["out.txt", "s.json", "a.nc"] {
            let before = bench.read(name);
            let mut options = fs::File::options();
            let open = options
                .read(true)
                .share_mode(0)
                .open(bench.folder().join(name));
            let open = open.expect("open");
            let output = bench.call(&call);
            let said = String::from_utf8(output.stderr).expect("text");
            assert_eq!(output.status.code(), Some(2), "{name}: {said}");
            let named = said.contains(&format!("`{name}` cannot be"));
            assert!(
                named && said.contains("another program has it open"),
                "{said}"
            );
            drop(open);
            assert_eq!(bench.read(name), before);
        }
        let files = fs::read_dir(bench.folder()).expect("a folder").count();
        assert_eq!(
            files, 5,
            "a machine, a program, the state and its lock, the output"
        );
    }

    #[test]
    fn no_output_takes_its_place_where_one_cannot() {
        // R9.70, R13.1
        let bench = Bench::new(&[("a.nc", SWITCH_OFF)]);
        bench.write("out.txt", "old");
        bench.write("page.html", "old");
        let mut options = fs::File::options();
        let open = options
            .read(true)
            .share_mode(3)
            .open(bench.folder().join("page.html"));
        let open = open.expect("open");
        let output = bench.call(&["run", "-o", "out.txt", "--html", "page.html", "a.nc"]);
        let said = String::from_utf8(output.stderr).expect("text");
        assert_eq!(output.status.code(), Some(2), "{said}");
        assert!(said.contains("`page.html` cannot be written"), "{said}");
        drop(open);
        assert_eq!(bench.read("out.txt"), "old");
        assert_eq!(bench.read("page.html"), "old");
    }

    #[test]
    fn names_of_devices_are_no_files() {
        // R13.1
        let bench = Bench::new(&[("a.nc", SWITCH_OFF)]);
        let output = bench.call(&["run", "-o", "aux.txt", "a.nc"]);
        let said = String::from_utf8(output.stderr).expect("text");
        assert_eq!(output.status.code(), Some(2), "{said}");
        assert!(said.contains("`AUX` is the name of a device"), "{said}");
        assert_eq!(bench.status(&["check", "con"]), Some(2));
        assert_eq!(bench.status(&["run", "-o", "nul", "a.nc"]), Some(0));
    }
}
