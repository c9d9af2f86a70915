//! Malicious names and texts: the tool outputs nothing that a terminal, a log, a runner or a spreadsheet
//! would obey (R9.76).
#![cfg(unix)]

use crate::folder::command;
use std::fs;
use std::path::Path;
use std::process::Output;

/// A file name that switches colours on, rings the bell, reverses the writing direction, ends its line and
/// gives a runner a command.
const NAME: &str = "a\u{1b}[31m\u{7}\u{9b}31m\u{202e}\u{2028}\r\n::error file=x::boom.nc";

/// Name of a file in the current folder that begins with a command to a runner.
const COMMAND: &str = "::error file=y::boom.nc";

fn tool(folder: &Path, arguments: &[&str]) -> Output {
    command(folder, arguments)
        .env("COLUMNS", "60")
        .output()
        .unwrap()
}

/// Programs, lists, a configuration and traces with such names and such texts in them.
fn prepare(folder: &Path) {
    let evil = "\u{1b}]0;pwned\u{7}\u{9b}2J\u{202e}\u{2066}\u{2029}\u{7f}";
    let program = format!(
        "%{evil}\n(=1+1{evil}) X[COMP OFF FRICT]\n=1+1{evil}\n@P1=3\n-5\n+7\nX[COMP OFF {evil}]\n\
         X[COMP OFF FRICT] ; ::error file=z::boom {evil} and more words than a line of sixty columns has\n\
         L \"{evil}.nc\"\n$IF V.E.{evil}\n$ENDIF\n#{evil}\n  ::error::boom\nQ9{evil}=4\n\
         ; frictcomp: allow FC401 {evil}\nX[COMP OFF \\\n{evil}]\n"
    );
    for name in [NAME, COMMAND] {
        fs::write(folder.join(name), &program).unwrap();
        fs::write(
            folder.join(format!("{name}.timeline")),
            format!("{evil}\n::error::x\n"),
        )
        .unwrap();
    }
    let list = NAME.replace(".nc", ".lis");
    fs::write(
        folder.join(&list),
        format!(
            "kopf.achs_nr 1\nkopf.log_achs_name {evil}\nfrict_comp.mode {evil}\nfrict_comp.mode 3\n\
             frict_comp.{evil} 3\n::error::x\n{evil}\nfrict_comp.table[0].in 1{evil}\nEnde\n"
        ),
    )
    .unwrap();
    fs::write(
        folder.join("h.lis"),
        format!(
            "achs_mds[0] {evil}.lis\nachs_kw[0] missing ::error::boom{evil}.lis\nsda_mds[0] k.lis\n\
             zahl_mds 1\nzahl_kw 1\n\
             Ende\n"
        ),
    )
    .unwrap();
    fs::write(
        folder.join("k.lis"),
        format!(
            "gruppe[0].achse[0].bezeichnung =X{evil}\ngruppe[0].achse[1].bezeichnung X\nEnde\n"
        ),
    )
    .unwrap();
    fs::write(
        folder.join("bad.toml"),
        format!("[machine]\nstartup = \"{}\"\n", "::error::b"),
    )
    .unwrap();
    fs::write(
        folder.join("evil.toml"),
        "[[axis]]\nname = \"=X\\u001b\\u009b\\u202e\"\n",
    )
    .unwrap();
    fs::write(folder.join("plant.toml"), format!("name = 3 # {evil}\n")).unwrap();
    fs::write(
        folder.join("trace.csv"),
        format!("t{evil},x,y\n1,2,{evil}\n"),
    )
    .unwrap();
}

/// Checks that a terminal or a runner obeys no part of an output.
fn is_harmless(output: &Output, arguments: &[&str]) {
    for bytes in [&output.stdout, &output.stderr] {
        let text = std::str::from_utf8(bytes).unwrap();
        let hidden = text.chars().find(|&letter| {
            (letter.is_control() && !matches!(letter, '\n' | '\t'))
                || matches!(letter, '\u{200b}'..='\u{200f}' | '\u{2028}'..='\u{202e}' | '\u{2060}'..='\u{206f}')
        });
        assert_eq!(hidden, None, "{arguments:?}\n{text}");
        let github = arguments.contains(&"github");
        for line in text.lines().map(str::trim_start) {
            // `::: ` leads to another file, as in rustc; a runner has no command of that name.
            let ours = line.starts_with("::: ") || github && line.contains(",title=");
            let command = line.starts_with("::") || line.starts_with("##");
            assert!(!command || ours, "{arguments:?}\n{line}");
        }
    }
    assert!(matches!(output.status.code(), Some(0..=2)), "{arguments:?}");
}

#[test]
fn what_turns_the_direction_of_writing_is_said_wherever_it_stands() {
    // R9.94
    let root = tempfile::tempdir().unwrap();
    let folder = root.path();
    let codes = |name: &str, text: &str| {
        fs::write(folder.join(name), text).unwrap();
        let command = if name == "v.lis" { "lists" } else { "check" };
        let output = tool(folder, &[command, "--format", "concise", name]);
        let said = String::from_utf8(output.stdout).unwrap();
        let lines = said.lines().filter(|line| line.contains("FC102"));
        let places = lines.map(|line| {
            assert!(line.contains("U+202E RIGHT-TO-LEFT OVERRIDE"), "{line}");
            line.split(':').nth(1).unwrap().parse::<u32>().unwrap()
        });
        places.collect::<Vec<_>>()
    };
    let program = "%A\n; x \u{202e}\nN10 G01 X1 F5 (\u{202e})\r\n#MSG [\"\u{202e}\"]\nX[COMP \\\n\
                   ON FRICT] ; \u{202e}\n#COMMENT BEGIN\n\u{202e}\n#COMMENT END\n$IF 1\n;\u{202e}\n$ENDIF\nM30\n";
    assert_eq!(codes("a.nc", program), [2, 3, 4, 6, 8, 11]);
    assert_eq!(
        codes("plain.nc", "N10 ; Läufer – „groß“ ★\nM30\n"),
        [0_u32; 0]
    );
    let list = "# \u{202e}\nfrict_comp.mode 3 (\u{202e})\nEnde\n";
    assert_eq!(codes("v.lis", list), [1, 2]);
}

#[test]
fn a_control_character_within_a_block_is_no_blank() {
    // R9.94 R2.1
    let root = tempfile::tempdir().unwrap();
    let folder = root.path();
    for (text, is_said) in [
        ("X[COMP\0ON FRICT]\nM30\n", true),
        ("G1\0X1 F5\nM30\n", true),
        ("G1 X1 F5\u{1a} Y1\nM30\n", true),
        ("G1 X1 F5 \0\0\nM30\n\u{3}", false),
        ("G1 X1 F5 ; \0 x\nM30\n", false),
    ] {
        fs::write(folder.join("a.nc"), text).unwrap();
        let output = tool(
            folder,
            &["check", "--enable", "X", "--format", "concise", "a.nc"],
        );
        let said = String::from_utf8(output.stdout).unwrap();
        assert_eq!(said.contains("FC101"), is_said, "{text:?}: {said}");
    }
}

#[test]
fn a_list_or_configuration_that_is_too_large_is_refused_unread() {
    // R9.94
    let root = tempfile::tempdir().unwrap();
    let folder = root.path();
    fs::write(folder.join("a.nc"), "M30\n").unwrap();
    let large = fs::File::create(folder.join("large.toml")).unwrap();
    large.set_len(65 << 20).unwrap();
    let output = tool(folder, &["check", "--config", "large.toml", "a.nc"]);
    assert_eq!(output.status.code(), Some(2));
    let said = String::from_utf8(output.stderr).unwrap();
    assert!(said.contains("which no list or configuration is"), "{said}");
}

#[test]
fn no_command_and_no_format_lets_harm_out() {
    // R9.76
    let root = tempfile::tempdir().unwrap();
    let folder = root.path();
    prepare(folder);
    let list = NAME.replace(".nc", ".lis");
    for name in [NAME, COMMAND] {
        for format in ["text", "ndjson", "json", "csv"] {
            for more in [
                &["--keep-going"][..],
                &["--changes"],
                &["--kinds", "all", "--enable", "X"],
            ] {
                let arguments = [&["run", "--format", format, name][..], more].concat();
                is_harmless(&tool(folder, &arguments), &arguments);
            }
        }
        for format in [
            "text", "concise", "json", "ndjson", "github", "gitlab", "sarif", "junit",
        ] {
            for arguments in [
                &["check", "--format", format, name][..],
                &["check", "--format", format, "."],
                &["check", "--startup", "h.lis", "--format", format, name],
                &["lists", "--format", format, &list, "h.lis", "k.lis"],
            ] {
                is_harmless(&tool(folder, arguments), arguments);
            }
        }
        for arguments in [
            &["golden", name][..],
            &["golden", "."],
            &["diff", name, COMMAND],
            &["diff", "h.lis", name],
            &["show", "values", name],
            &["show", "passed-over", name],
            &["check", "--config", "bad.toml", name],
            &["check", "--config", "evil.toml", name],
            &["run", "--config", name, name],
            &["run", "--startup", name, name],
            &["config", "show", "--startup", "h.lis"],
            &["config", "show", "--config", "evil.toml"],
            &["config", "show", name],
            &["lists", "--show", &list, "h.lis"],
            &["lists", name],
            &["current", name],
            &["current", "--enable", "X", name],
            &["circle", "--recording", "trace.csv"],
            &["circle", "--value-list", &list],
            &["circle", "--plant", "plant.toml"],
            &["circle", "--plant", NAME],
            &["tune", "--plant", NAME],
            &["explain", NAME],
            &["run", "--enable", NAME, name],
            &["run", "--set", NAME, name],
            &["run", "--kinds", NAME, name],
            &["run", "--state", "no/such\n::error::x", name],
            &["run", "missing\n::error::boom\u{1b}[2J.nc"],
            &["run", "--output", "no/such\n::error::x\u{9b}", name],
            &["--bogus\n::error::boom\u{1b}[2J"],
            &["init", NAME],
            &["run", "--html", "page.html", name],
        ] {
            is_harmless(&tool(folder, arguments), arguments);
        }
        let page = fs::read_to_string(folder.join("page.html")).unwrap();
        let hidden = page
            .chars()
            .find(|c| c.is_control() && !matches!(c, '\n' | '\t'));
        assert_eq!(hidden, None);
    }
    for update in [true, false] {
        let arguments: &[&str] = if update {
            &["golden", "--update", "."]
        } else {
            &["golden", "."]
        };
        is_harmless(&tool(folder, arguments), arguments);
    }
    for name in [NAME, COMMAND] {
        let agreed = fs::read(folder.join(format!("{name}.timeline"))).unwrap();
        let written = Output {
            stdout: agreed,
            ..tool(folder, &["explain"])
        };
        is_harmless(&written, &["timeline"]);
    }
}

#[test]
fn records_hold_the_true_names() {
    // R9.76: JSON escapes, nothing is lost
    let root = tempfile::tempdir().unwrap();
    prepare(root.path());
    let output = tool(
        root.path(),
        &["run", "--format", "ndjson", "--keep-going", NAME],
    );
    let mut files = 0;
    for line in std::str::from_utf8(&output.stdout).unwrap().lines() {
        let record: serde_json::Value = serde_json::from_str(line).unwrap();
        if let Some(file) = record.get("file") {
            assert_eq!(file, NAME);
            files += 1;
        }
    }
    assert!(files > 5, "{files}");
    let output = tool(root.path(), &["check", "--format", "json", NAME]);
    let document: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(document["records"][0]["file"], NAME);
}

#[test]
fn no_cell_of_a_spreadsheet_computes() {
    // R9.76
    let root = tempfile::tempdir().unwrap();
    prepare(root.path());
    let output = tool(
        root.path(),
        &["run", "--format", "csv", "--keep-going", NAME],
    );
    let mut reader = csv::ReaderBuilder::new()
        .has_headers(false)
        .from_reader(&output.stdout[..]);
    let mut texts = Vec::new();
    for row in reader.records() {
        let row = row.unwrap();
        for cell in &row {
            assert!(!cell.starts_with(['=', '+', '-', '@']), "{cell}");
        }
        texts.push(row[5].to_owned());
    }
    assert!(texts.iter().any(|text| text == "'@P1=3"), "{texts:?}");
    assert!(
        texts.iter().any(|text| text.starts_with("'=1+1\u{241b}")),
        "{texts:?}"
    );
}
