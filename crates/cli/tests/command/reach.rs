//! The files that a program makes the tool read, and what the tool shows of forbidden ones.

#![cfg(unix)]

use std::fs;
use std::io::{BufRead, BufReader, Read, Write};
use std::os::unix::fs::symlink;
use std::path::Path;
use std::process::{Command, Output};

use crate::folder::Bench;

/// Text that no output may contain.
const SECRET: &str = "root:x:0:0:geheim";

/// Every way in which a command shows a program.
const WAYS: [&[&str]; 14] = [
    &["run", "main.nc"],
    &["run", "--keep-going", "main.nc"],
    &["run", "--format", "ndjson", "main.nc"],
    &["run", "--format", "json", "main.nc"],
    &["run", "--format", "csv", "main.nc"],
    &["run", "--html", "r.html", "main.nc"],
    &["check", "main.nc"],
    &["check", "--format", "concise", "main.nc"],
    &["check", "--format", "json", "main.nc"],
    &["check", "--format", "github", "main.nc"],
    &["check", "--format", "sarif", "main.nc"],
    &["golden", "--update", "main.nc"],
    &["diff", "main.nc", "main.nc"],
    &["current", "--axis", "X", "main.nc"],
];

/// Returns a project in a folder next to a secret.
fn project(main: &str) -> (tempfile::TempDir, Bench) {
    let around = tempfile::tempdir().expect("a folder");
    fs::write(around.path().join("secret"), SECRET).expect("written");
    (around, Bench::new(&[("main.nc", main)]))
}

fn all(output: &Output) -> String {
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    text + &String::from_utf8_lossy(&output.stderr)
}

/// Returns the output of every command about `main.nc`.
fn everything(bench: &Bench, further: &[&str]) -> String {
    let mut said = String::new();
    for way in WAYS {
        let mut arguments = way.to_vec();
        arguments.extend(further);
        said += &all(&bench.call(&arguments));
    }
    for entry in fs::read_dir(bench.folder()).expect("a folder") {
        let path = entry.expect("an entry").path();
        let is_ours = path
            .extension()
            .is_some_and(|end| end == "html" || end == "timeline");
        if is_ours {
            said += &fs::read_to_string(path).expect("text");
        }
    }
    said
}

#[test]
fn a_program_makes_no_command_show_what_lies_elsewhere() {
    // R2.16
    let (around, bench) = project("");
    let secret = around.path().join("secret").display().to_string();
    symlink(&secret, bench.folder().join("link.nc")).expect("a link");
    symlink(around.path(), bench.folder().join("links")).expect("a link");
    fs::create_dir(bench.folder().join("deep")).expect("a folder");
    symlink(bench.folder().join("deep"), bench.folder().join("inside")).expect("a link");
    let up = "../".repeat(30) + secret.trim_start_matches('/');
    let names = [
        secret.as_str(),
        &up,
        &up.replace('/', "\\"),
        "link.nc",
        "LINK.NC",
        "links/secret",
        "deep/../links/secret",
        "inside/../link.nc",
    ];
    for name in names {
        for call in [
            "L \"{}\"",
            "L CYCLE [NAME=\"{}\"]",
            "V.P.N : STRING[200] = \"{}\"\n#ENDVAR\nL V.P.N",
        ] {
            let call = call.replace("{}", name);
            let prefix = if call.starts_with('V') { "#VAR\n" } else { "" };
            bench.write("main.nc", &format!("{prefix}{call}\nM30\n"));
            if call.starts_with("L \"") && matches!(name, "link.nc" | "links/secret") {
                let said = everything(&bench, &[]);
                assert!(
                    !said.contains("geheim") && said.contains("FC321"),
                    "{call}: {said}"
                );
            }
            let said = all(&bench.call(&["check", "main.nc"]));
            assert!(
                !said.contains("geheim") && said.contains("FC321"),
                "{call}: {said}"
            );
            let allowed = all(&bench.call(&["check", "--allow-outside", "main.nc"]));
            assert!(allowed.contains("geheim"), "{call}: {allowed}");
        }
    }
    // Also on a way that only the machine knows to be taken.
    bench.write(
        "main.nc",
        &format!("$IF V.E.X\nL \"{secret}\"\n$ENDIF\nM30\n"),
    );
    let said = all(&bench.call(&["run", "main.nc"]));
    assert!(!said.contains("geheim") && said.contains("FC321"), "{said}");
}

#[test]
fn every_command_that_runs_programs_can_be_allowed_more() {
    // R2.16
    let (around, bench) = project("");
    let path = around.path().join("sub.nc").display().to_string();
    fs::write(&path, "X[COMP OFF FRICT]\nX[COMP ON FRICT]\nM17\n").expect("written");
    bench.write("main.nc", &format!("L \"{path}\"\nG0 X1\nM30\n"));
    let said = everything(&bench, &["--allow-outside"]);
    assert!(!said.contains("is outside the folders"), "{said}");
    assert!(everything(&bench, &[]).contains("is outside the folders"));
}

#[test]
fn a_sibling_folder_of_one_project_is_possible() {
    // R2.13 R2.16
    let bench = Bench::new(&[]);
    for folder in ["programs", "cycles", "other"] {
        fs::create_dir(bench.folder().join(folder)).expect("a folder");
    }
    bench.write(
        "programs/main.nc",
        "L \"../cycles/Drill.nc\"\nL \"..\\CYCLES\\drill.NC\"\nM30\n",
    );
    bench.write(
        "cycles/drill.nc",
        "X[COMP OFF FRICT]\nX[COMP ON FRICT]\nM17\n",
    );
    let check = |folder: &str, arguments: &[&str]| {
        let mut command = bench.command(arguments);
        all(&command
            .current_dir(bench.folder().join(folder))
            .output()
            .expect("it runs"))
    };
    // The folder of the configuration, wherever the tool is called.
    for (folder, program) in [
        ("", "programs/main.nc"),
        ("programs", "main.nc"),
        ("other", "../programs/main.nc"),
    ] {
        let said = check(folder, &["check", program]);
        assert!(!said.contains("FC32"), "{folder}: {said}");
    }
    // Without one the current folder.
    fs::remove_file(bench.folder().join("frictcomp.toml")).expect("removed");
    let said = check("", &["check", "--enable", "X", "programs/main.nc"]);
    assert!(!said.contains("FC32"), "{said}");
    let said = check("programs", &["check", "main.nc"]);
    assert!(
        said.contains("FC321") && said.contains("--allow-outside"),
        "{said}"
    );
    assert!(said.contains("program_dirs"), "{said}");
    // Or a folder that the configuration names.
    fs::write(
        bench.folder().join("programs/frictcomp.toml"),
        "[machine]\nprogram_dirs = [\"../cycles\"]\n",
    )
    .expect("written");
    let said = check("programs", &["check", "--enable", "X", "main.nc"]);
    assert!(!said.contains("FC32"), "{said}");
}

#[test]
fn a_program_that_is_there_with_an_extension_may_be_meant() {
    // R2.16
    let bench = Bench::new(&[("main.nc", "N10 L4712\nN20 M30\n"), ("4712.nc", "M17\n")]);
    fs::create_dir(bench.folder().join("4712.bak")).expect("a folder");
    let said = bench.stdout(&["check", "--format", "json", "main.nc"]);
    let document = crate::folder::json(&said);
    let said = &document["records"][0];
    assert_eq!(said["code"], "FC320", "{said}");
    assert_eq!(said["help"][0], "did you mean `4712.nc`?", "{said}");
    let fix = &said["fixes"][0];
    let place = [&fix["column"], &fix["end_column"]].map(serde_json::Value::as_u64);
    assert_eq!(
        (place, &fix["text"]),
        ([Some(6), Some(10)], &"4712.nc".into())
    );
    // A folder is not a program, and neither is a link that leads outside.
    let bench = Bench::new(&[("main.nc", "L4712\nM30\n")]);
    fs::create_dir(bench.folder().join("4712.d")).expect("a folder");
    symlink("/etc/hostname", bench.folder().join("4712.nc")).expect("a link");
    let said = all(&bench.call(&["check", "--format", "concise", "main.nc"]));
    assert!(
        said.contains("FC320") && !said.contains("did you mean"),
        "{said}"
    );
}

#[test]
fn what_is_no_file_to_call_is_said_as_what_it_is() {
    // R2.16
    let bench = Bench::new(&[]);
    let path = |name: &str| bench.folder().join(name);
    fs::create_dir(path("folder.nc")).expect("a folder");
    symlink("b.nc", path("a.nc")).expect("a link");
    symlink("a.nc", path("b.nc")).expect("a link");
    let made = Command::new("mkfifo").arg(path("pipe.nc")).status();
    assert!(made.expect("mkfifo").success());
    let big = fs::File::create(path("big.nc")).expect("a file");
    big.set_len((1 << 30) + 1).expect("a hole");
    for (name, what) in [
        ("folder.nc", "is a folder"),
        ("a.nc", "cannot be read"),
        ("pipe.nc", "is not a regular file"),
        ("big.nc", "larger than 1 GiB"),
        ("not-there.nc", "was not found"),
    ] {
        bench.write("main.nc", &format!("L {name}\nM30\n"));
        let said = all(&bench.call(&["check", "--format", "concise", "main.nc"]));
        assert!(
            said.contains("FC320") && said.contains(what),
            "{name}: {said}"
        );
        assert!(
            what == "was not found" || !said.contains("not found"),
            "{said}"
        );
    }
}

#[test]
fn a_list_elsewhere_is_named_and_not_shown() {
    // R2.16
    let (around, bench) = project("M30\n");
    let secret = around.path().join("secret");
    fs::write(&secret, format!("{SECRET} 1\nkopf.achs_nr geheim\n")).expect("written");
    let secret = secret.display().to_string();
    symlink(&secret, bench.folder().join("link.lis")).expect("a link");
    for list in [secret.as_str(), "link.lis"] {
        for toml in [
            format!("[machine]\nstartup = \"{list}\"\n"),
            format!("[[axis]]\nname = \"X\"\naxis_list = \"{list}\"\n"),
            format!("[[axis]]\nname = \"X\"\nvalue_list = \"{list}\"\n"),
        ] {
            bench.write("frictcomp.toml", &toml);
            let calls: [&[&str]; 5] = [
                &["lists", "frictcomp.toml"],
                &["lists", "--show", "--format", "json", "frictcomp.toml"],
                &["config", "show"],
                &["run", "main.nc"],
                &["check", "--format", "json", "main.nc"],
            ];
            for call in calls {
                let said = all(&bench.call(call));
                assert!(!said.contains("geheim"), "{call:?} {toml}: {said}");
            }
            let said = all(&bench.call(&["lists", "frictcomp.toml"]));
            assert!(
                said.contains("FC12") && said.contains(&format!("{list}:1:")),
                "{toml}: {said}"
            );
            let said = all(&bench.call(&["lists", "--allow-outside", "frictcomp.toml"]));
            assert!(said.contains("geheim"), "{toml}: {said}");
        }
    }
    // A list that the user names is shown wherever it is.
    let said = all(&bench.call(&["lists", &secret]));
    assert!(said.contains("geheim"), "{said}");
    // A configuration that was found may be a link.
    fs::remove_file(bench.folder().join("frictcomp.toml")).expect("removed");
    symlink(&secret, bench.folder().join("frictcomp.toml")).expect("a link");
    let output = bench.call(&["run", "main.nc"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(!all(&output).contains("geheim"), "{}", all(&output));
}

#[test]
fn a_program_to_which_its_end_is_added_while_it_is_read_leaves_no_state() {
    // R9.26
    let bench = Bench::new(&[("first.nc", "M30\n")]);
    assert_eq!(
        bench.status(&["run", "--state", "s.json", "first.nc"]),
        Some(0)
    );
    let good = bench.read("s.json");
    let blocks = "X[COMP OFF FRICT]\nG1 X1 F1000\n".repeat(30_000);
    for input in ["long.nc", "-"] {
        bench.write("long.nc", &blocks);
        let mut command = bench.command(&["run", "--format", "ndjson", "--state", "s.json", input]);
        let path = bench.folder().join("long.nc");
        if input == "-" {
            command.stdin(fs::File::open(&path).expect("it is there"));
        }
        let mut child = command.spawn().expect("it starts");
        let mut output = BufReader::new(child.stdout.take().expect("it is piped"));
        output.read_line(&mut String::new()).expect("a record");
        // The pipe is full now; the end of the program has not been read.
        append(&path, "X[COMP ON FRICT]\nM30\n");
        std::io::copy(&mut output, &mut std::io::sink()).expect("read");
        let mut said = String::new();
        let mut errors = child.stderr.take().expect("it is piped");
        errors.read_to_string(&mut said).expect("text");
        let status = child.wait().expect("it ends");
        assert_eq!(status.code(), Some(2), "{input}: {said}");
        assert!(
            said.contains("changed while it was read"),
            "{input}: {said}"
        );
        assert_eq!(bench.read("s.json"), good, "{input}");
    }
}

fn append(path: &Path, text: &str) {
    let mut file = fs::OpenOptions::new()
        .append(true)
        .open(path)
        .expect("it is there");
    file.write_all(text.as_bytes()).expect("written");
}
