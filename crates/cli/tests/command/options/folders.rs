//! Selection of the files of folders, and the remarks on the files left out.

use std::fs;

use serde_json::Value;

use super::stderr;
use crate::folder::{Bench, json, one_line};

const OFF: &str = "X[COMP OFF FRICT]\nG1 X5 F100\nX[COMP ON FRICT]\nM30\n";
const PLAIN: &str = "N10 G0 X1\nN20 M30\n";

/// Returns a folder with programs that are taken, ignored, hidden, excluded and of unknown extensions.
fn shop() -> Bench {
    let bench = Bench::new(&[("a.nc", PLAIN), ("B.PLC", PLAIN)]);
    for folder in ["old/deep", ".git", ".attic", "cache", "node_modules/m"] {
        fs::create_dir_all(bench.folder().join(folder)).expect("a folder");
    }
    for (name, text) in [
        (".gitignore", "old\ndraft.nc\ncache\nnode_modules\n"),
        ("old/one.nc", OFF),
        ("old/deep/TWO.MPF", OFF),
        ("old/notes.txt", OFF),
        (".attic/three.nc", PLAIN),
        (".git/four.nc", PLAIN),
        ("node_modules/m/five.nc", PLAIN),
        ("cache/six.nc", PLAIN),
        (
            "cache/CACHEDIR.TAG",
            "Signature: 8a477f597d28d172789f06886806bc55\n",
        ),
        ("draft.nc", OFF),
        ("part.prg", OFF),
        ("PART2.PRG", PLAIN),
        ("noext", PLAIN),
        ("wide.dnc", ""),
        // What other repositories hold.
        (
            "README.md",
            "# Part\n\n```nc\nX[COMP OFF FRICT]\nM30\n```\n",
        ),
        ("notes.txt", "Use G54, then M30.\nAsk Peter first.\n"),
        ("main.st", "x := 5;\n"),
        ("LICENSE", "Permission is hereby granted, free of charge\n"),
        ("trace.csv", "t,X\n0,1\n"),
        ("Makefile", "all:\n\tcargo build\n"),
        ("axis.lis", "kopf.achs_nr 1\n"),
        ("secret.ecy", OFF),
        ("a.nc.timeline", OFF),
    ] {
        bench.write(name, text);
    }
    let wide: Vec<u8> = format!("\u{feff}{OFF}")
        .encode_utf16()
        .flat_map(u16::to_le_bytes)
        .collect();
    fs::write(bench.folder().join("wide.dnc"), wide).expect("written");
    bench
}

#[test]
fn programs_that_are_not_looked_at_are_said() {
    // R18.5
    let bench = shop();
    fs::create_dir_all(bench.folder().join(".git")).expect("a folder");
    let output = bench.call(&["check", "--format", "concise"]);
    let (said, text) = (
        stderr(&output),
        String::from_utf8_lossy(&output.stdout).into_owned(),
    );
    let kinds = "not checked: 2 programs in ignored folders, 1 program in hidden folders, \
                 1 ignored program, 1 program without an extension, 1 `.dnc`, 2 `.prg`";
    let joined = one_line(&said);
    let kinds = one_line(kinds);
    assert!(joined.contains(&kinds), "{said}");
    let warned: Vec<&str> = text.lines().filter(|line| line.contains("FC105")).collect();
    assert_eq!(warned.len(), 3, "{text}");
    for (name, line) in [("draft.nc", 1), ("part.prg", 1), ("wide.dnc", 1)] {
        let place = format!("{name}:{line}:");
        assert!(warned.iter().any(|line| line.starts_with(&place)), "{text}");
    }
    for command in ["check", "audit"] {
        assert_eq!(
            bench.status(&[command, "--fail-on", "warning"]),
            Some(1),
            "{command}"
        );
        let off = &[command, "--fail-on", "error"][..];
        assert_eq!(bench.status(off), Some(0), "{command}");
        let said = stderr(&bench.call(&[command]));
        assert!(
            said.contains("not checked: 2 programs in ignored folders"),
            "{command}: {said}"
        );
    }
    for arguments in [&["golden", "--update"][..], &["golden"], &["show", "calls"]] {
        let said = stderr(&bench.call(arguments));
        assert!(
            said.contains("not checked: 2 programs in ignored folders"),
            "{arguments:?}: {said}"
        );
    }
}

#[test]
fn files_are_left_out_and_taken_as_the_user_says() {
    // R18.5
    let bench = shop();
    let taken = |more: &[&str]| -> Vec<String> {
        let arguments = [&["show", "files", "--format", "json"][..], more].concat();
        let shown = json(&bench.stdout(&arguments));
        let files = shown["files"].as_array().expect("files").iter();
        let taken = files.filter(|file| file["taken"] == Value::Bool(true));
        taken
            .map(|file| file["file"].as_str().expect("a name").to_owned())
            .collect()
    };
    assert_eq!(taken(&[]), ["B.PLC", "a.nc"]);
    let all = [
        ".attic/three.nc",
        "B.PLC",
        "a.nc",
        "draft.nc",
        "old/deep/TWO.MPF",
        "old/one.nc",
    ];
    let mut found = taken(&["--no-ignore"]);
    found.retain(|name| !name.starts_with("cache"));
    assert_eq!(found, all);
    assert_eq!(taken(&["--exclude", "*.plc", "--exclude", "B.*"]), ["a.nc"]);
    let left = taken(&[
        "--no-ignore",
        "--exclude",
        "old/deep",
        "--exclude",
        "/.attic",
        "--exclude",
        "cache",
    ]);
    assert_eq!(left, ["B.PLC", "a.nc", "draft.nc", "old/one.nc"]);
    // A file that is named is taken, and once.
    assert_eq!(
        taken(&["draft.nc", "--exclude", "*.nc", "./draft.nc", "part.prg"]),
        ["draft.nc", "part.prg"]
    );
    let configuration = bench.read("frictcomp.toml");
    bench.write("frictcomp.toml", &format!("{configuration}[check]\nexclude = [\"B.PLC\"]\nextensions = [\"nc\", \"plc\", \"prg\"]\n"));
    assert_eq!(taken(&[]), ["PART2.PRG", "a.nc", "part.prg"]);
    let output = bench.call(&["check", "--exclude", "{a"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr(&output).contains("is not a pattern of files"));
}

#[test]
fn a_list_of_files_says_why() {
    // R18.5
    let bench = shop();
    let text = bench.stdout(&["show", "files", "--exclude", "B.PLC"]);
    for line in [
        "a.nc",
        "B.PLC: not taken, it is excluded",
        "draft.nc: not taken, an ignore file names it",
        "old/one.nc: not taken, an ignore file names its folder",
        ".attic/three.nc: not taken, its folder is hidden",
        "part.prg: not taken, `.prg` is no extension of programs",
        "noext: not taken, it has no extension",
    ] {
        assert!(text.lines().any(|it| it == line), "{line}: {text}");
    }
    for name in [
        "README.md",
        "notes.txt",
        "main.st",
        "axis.lis",
        "secret.ecy",
        "four.nc",
        "five.nc",
        "six.nc",
    ] {
        assert!(!text.contains(name), "{name}: {text}");
    }
    let all = bench.stdout(&["show", "files", "--all"]);
    assert!(
        all.contains("notes.txt: not taken, it is no program"),
        "{all}"
    );
    let shown = json(&bench.stdout(&["show", "files", "--format", "json"]));
    let files = shown["files"].as_array().expect("files");
    let part = files
        .iter()
        .find(|file| file["file"] == "part.prg")
        .expect("it");
    assert_eq!(
        (&part["why"], &part["switches"]),
        (&Value::from("extension"), &Value::from(1))
    );
}

#[cfg(unix)]
#[test]
fn what_links_hide_is_said() {
    // R18.5
    let bench = Bench::new(&[("a.nc", PLAIN)]);
    let elsewhere = Bench::new(&[("x.nc", OFF), ("y.nc", OFF)]);
    let link = |target: &str, name: &str| {
        let target = elsewhere.folder().join(target);
        std::os::unix::fs::symlink(target, bench.folder().join(name)).expect("a link");
    };
    link("x.nc", "linked.nc");
    link("", "shared");
    link("missing.nc", "gone.nc");
    std::os::unix::fs::symlink("a.nc", bench.folder().join("same.nc")).expect("a link");
    let said = stderr(&bench.call(&["check"]));
    assert!(
        said.contains("not checked: 2 programs in linked folders, 1 link"),
        "{said}"
    );
    let said = stderr(&bench.call(&["check", "-v", "linked.nc"]));
    assert!(
        said.contains("1 file checked") && !said.contains("not checked"),
        "{said}"
    );
}

#[test]
fn a_program_without_a_block_is_said() {
    // R18.6
    let bench = Bench::new(&[]);
    for text in [
        "",
        "\n \r\n\n",
        "; only\n(comments)\n",
        "%PART\n",
        "\0\0\0\0\0",
        "\u{feff}",
        "%A\n%B\nX1\nM30\n",
    ] {
        bench.write("a.nc", text);
        for command in [
            &["check", "--fail-on", "error", "--format", "concise"][..],
            &["run", "--format", "ndjson"],
        ] {
            let output = bench.call(&[command, &["a.nc"]].concat());
            let said = String::from_utf8_lossy(&output.stdout).into_owned();
            assert_eq!(said.matches("FC103").count(), 1, "{text:?}: {said}");
            assert_eq!(output.status.code(), Some(0), "{text:?}: {said}");
        }
        assert_eq!(
            bench.status(&["check", "--fail-on", "warning", "."]),
            Some(1),
            "{text:?}"
        );
    }
    for text in [
        "M30",
        "/N10 X1\nM30",
        "%A\nM30\n%\n",
        "$IF 0\nX1\n$ENDIF\nM30",
    ] {
        bench.write("a.nc", text);
        let said = bench.stdout(&["check", "--skip", "all", "--format", "concise", "a.nc"]);
        assert!(!said.contains("FC103"), "{text:?}: {said}");
    }
}

#[test]
fn a_file_that_is_no_program_is_one_error() {
    // R18.6
    let bench = Bench::new(&[("a.nc", PLAIN)]);
    for (content, what) in [
        (&b"[machine]\nstartup = \"a.lis\"\n"[..], "TOML"),
        (b"{\n  \"schema\": 1\n}\n", "JSON"),
        (b"<?xml version=\"1.0\"?>\n<a/>\n", "XML"),
        (
            b"PK\x03\x04\x14\0\0\0\x08\0\x21\x9a\xff\x01",
            "a ZIP archive",
        ),
        (b"%PDF-1.7\n%\xe2\xe3\xcf\xd3\n1 0 obj\n", "a PDF document"),
        (b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR", "a PNG picture"),
        (b"\x7fELF\x02\x01\x01\0", "an executable"),
        (
            b"\x80\x01\x9f\x05\x06\x0e\x1b\xf0\x10\n\x15\x16\x17A",
            "binary data",
        ),
    ] {
        fs::write(bench.folder().join("b.nc"), content).expect("written");
        fs::write(bench.folder().join("b.dat"), content).expect("written");
        for command in ["run", "check", "audit", "contour", "golden"] {
            for name in ["b.nc", "b.dat"] {
                let output = bench.call(&[command, name]);
                let said = stderr(&output);
                assert_eq!(output.status.code(), Some(2), "{command} {name}: {said}");
                assert!(
                    said.contains(&format!("is {what}, not an NC program")),
                    "{said}"
                );
            }
        }
        let output = bench.call(&["check", "--format", "concise", "."]);
        let text = String::from_utf8_lossy(&output.stdout).into_owned();
        assert_eq!(output.status.code(), Some(1), "{text}");
        assert_eq!(
            text.lines().filter(|line| line.contains("error")).count(),
            1,
            "{text}"
        );
        assert!(text.contains("FC104") && text.contains(what), "{text}");
        assert_eq!(bench.status(&["audit", "."]), Some(1), "{what}");
        bench.write("c.nc", "L b.nc\nM30\n");
        let called = bench.stdout(&["check", "--format", "concise", "c.nc"]);
        assert!(
            called.contains("FC320") && called.contains(what),
            "{called}"
        );
        fs::remove_file(bench.folder().join("c.nc")).expect("removed");
    }
}
