//! The bindings have everything that their documents promise; their own tests run them.

use std::collections::BTreeSet;
use std::fs;

use frictcomp::{machine::Machine, text::SourceFile};
use frictcomp_report::{Csv, Positions, View};

use crate::{read, root};

/// Returns the folders of all packages.
fn packages() -> Vec<String> {
    let mut folders = vec![".".to_owned()];
    for parent in ["crates", "bindings"] {
        let path = root().join(parent);
        let entries = fs::read_dir(path).expect("packages");
        let names = entries.map(|entry| entry.expect("an entry").file_name());
        folders.extend(names.map(|name| format!("{parent}/{}", name.to_string_lossy())));
    }
    folders
}

/// Returns the functions that a text names.
fn functions(text: &str) -> BTreeSet<&str> {
    let words = text.split(|letter: char| !(letter.is_alphanumeric() || letter == '_'));
    words
        .filter(|word| word.starts_with("frictcomp_"))
        .collect()
}

#[test]
fn the_c_manual_names_every_function_of_the_header() {
    // R13.5
    let (header, manual) = (read("bindings/c/include/frictcomp.h"), read("docs/c.md"));
    let mut named = functions(&manual);
    named.remove("frictcomp_c"); // The name of the library.
    assert_eq!(functions(&header), named);
}

#[test]
fn no_panic_crosses_the_border_to_c() {
    // R13.5
    let library = read("bindings/c/src/lib.rs");
    assert!(library.contains("#[cfg(panic = \"abort\")]\ncompile_error!"));
    // Only one file uses pointers.
    assert!(read("bindings/c/Cargo.toml").contains("unsafe_code = \"deny\""));
    for file in ["lib", "machine", "compensation", "failure"] {
        let source = read(&format!("bindings/c/src/{file}.rs"));
        assert!(!source.contains("unsafe"), "{file}");
    }
}

/// Returns the names in the first column of the first table after a heading.
fn first_column<'a>(manual: &'a str, heading: &str) -> Vec<&'a str> {
    let (_, part) = manual.split_once(heading).expect("the heading");
    let rows = part.lines().skip_while(|line| !line.starts_with("| `"));
    let rows = rows.take_while(|line| line.starts_with('|'));
    rows.map(|row| row.split('`').nth(1).expect("a name"))
        .collect()
}

#[test]
fn the_python_manual_has_the_columns_of_the_timeline() {
    // R13.4
    let mut machine = Machine::enabled(["X"]);
    machine.axes.truncate(1);
    let program = SourceFile::new("a.nc", "N10 X1\nN20 M30\n");
    let mut csv = Vec::new();
    let mut sink = Csv::new(&mut csv, View::default()).with_positions(Positions::Shown);
    let _ = frictcomp::run(program, machine, &mut sink);
    drop(sink);
    let csv = String::from_utf8(csv).expect("text");
    let header: Vec<&str> = csv.lines().next().expect("a header").split(',').collect();
    let manual = read("docs/python.md");
    let mut promised = first_column(&manual, "## The columns of a timeline");
    promised.retain(|name| *name != "level"); // As in NDJSON.
    assert_eq!(promised, header);
    // The columns are created with the same names.
    let rows = read("bindings/python/src/timeline/rows.rs");
    for name in promised.iter().filter(|name| !name.starts_with('X')) {
        assert!(rows.contains(&format!("\"{name}\"")), "{name}");
    }
}

#[test]
fn the_python_manual_names_everything_that_is_exported() {
    // R13.4
    let (module, manual) = (
        read("bindings/python/python/frictcomp/__init__.py"),
        read("docs/python.md"),
    );
    let (_, exported) = module.split_once("__all__ = [").expect("names");
    let exported = exported.split('"').skip(1).step_by(2);
    let (_, names) = manual.split_once("## Names").expect("the heading");
    for name in exported {
        assert!(names.contains(&format!("`{name}`")), "{name}");
    }
}

#[test]
fn the_wheel_has_the_version_of_the_command() {
    // R13.4
    let version = format!("version = \"{}\"", env!("CARGO_PKG_VERSION"));
    let manifest = read("bindings/python/pyproject.toml");
    assert!(manifest.contains(&version));
}

/// Returns the script of a step of the action, by the name of the step.
fn step(action: &str, name: &str) -> String {
    let (_, step) = action.split_once(&format!("- name: {name}\n")).expect(name);
    let (_, script) = step.split_once("run: |\n").expect("a script");
    let lines = script
        .lines()
        .take_while(|line| line.starts_with("        "));
    lines.fold(String::new(), |script, line| {
        script + line.trim_start_matches("        ") + "\n"
    })
}

/// Runs a script as GitHub does, with a command that prints its arguments in place of frictcomp.
#[cfg(unix)]
fn arguments_of(script: &str, inputs: &[(&str, &str)]) -> (Option<i32>, String) {
    use std::os::unix::fs::PermissionsExt as _;
    let folder = tempfile::tempdir().expect("a folder");
    let command = folder.path().join("frictcomp");
    fs::write(&command, "#!/bin/sh\nprintf '<%s>' \"$@\"\n").expect("written");
    fs::set_permissions(&command, fs::Permissions::from_mode(0o755)).expect("set");
    let path = std::env::var("PATH").unwrap_or_default();
    let output = std::process::Command::new("bash")
        .args(["--noprofile", "--norc", "-eo", "pipefail", "-c", script])
        .env("PATH", format!("{}:{path}", folder.path().display()))
        .envs([
            ("FAIL_ON", "warning"),
            ("CONFIG", ""),
            ("ENABLE", ""),
            ("ARGS", ""),
        ])
        .envs(inputs.iter().copied())
        .output()
        .expect("bash");
    (
        output.status.code(),
        String::from_utf8_lossy(&output.stdout).into_owned(),
    )
}

#[cfg(unix)]
#[test]
fn the_action_takes_every_line_of_its_inputs() {
    // R13.11
    let action = read("action.yml");
    let check = step(&action, "Check");
    let (status, said) = arguments_of(&check, &[("PATHS", "one two\n  three\r\n\nfour\n")]);
    assert_eq!(status, Some(0));
    assert_eq!(
        said,
        "<check><--format><github><--fail-on><warning><--><one><two><three><four>"
    );
    let inputs = [
        ("PATHS", "."),
        ("CONFIG", "my machine.toml"),
        ("ENABLE", "X,Y"),
        ("ARGS", "--quiet\n--skip none"),
    ];
    let (_, said) = arguments_of(&check, &inputs);
    assert!(
        said.ends_with("<--quiet><--skip><none><--config><my machine.toml><--enable><X,Y><--><.>"),
        "{said}"
    );
    // R18.29
    let folder = tempfile::tempdir().expect("a folder");
    let page = folder.path().join("summary.md");
    let shown = page.to_string_lossy();
    let inputs = [("PATHS", "a.nc"), ("GITHUB_STEP_SUMMARY", &*shown)];
    arguments_of(&check, &inputs);
    assert_eq!(
        fs::read_to_string(&page).expect("a summary"),
        "```text\n<check><-q><--fail-on><warning><--><a.nc>```\n"
    );
    // An empty list of files must not count as success.
    let (status, said) = arguments_of(&check, &[("PATHS", " \n ")]);
    assert!(status != Some(0) && !said.contains("<check>"), "{said}");
    let golden = step(&action, "Compare with what was agreed");
    let (_, said) = arguments_of(&golden, &[("GOLDEN", "a\nb c\n")]);
    assert_eq!(said, "<golden><--><a><b><c>");
    // A failed check does not prevent the comparison.
    assert!(action.contains("if: ${{ !cancelled() && steps.install.outcome == 'success' &&"));
}

#[test]
fn the_hook_takes_every_program_that_the_command_takes() {
    // R13.11
    let hooks = read(".pre-commit-hooks.yaml");
    let (_, endings) = hooks.split_once(r"(?i)\.(").expect("letters of any case");
    let (endings, _) = endings.split_once(")$").expect("an end");
    let endings: BTreeSet<&str> = endings.split('|').collect();
    let kinds = read("crates/host/src/disk/file_kind.rs");
    let (_, known) = kinds
        .split_once("EXTENSIONS: [&str; 10] =")
        .expect("the endings");
    let (known, _) = known.split_once(';').expect("an end");
    // R18.5: no other, such as the encrypted `.ecy`.
    let known: BTreeSet<&str> = known.split('"').skip(1).step_by(2).collect();
    assert_eq!(endings, known);
    for hook in hooks.split("files: ").skip(1) {
        assert!(hook.contains("|plc") && !hook.contains("ecy"), "{hook}");
    }
}

#[test]
fn every_package_says_where_its_sources_are_and_can_be_published() {
    // R13.10
    let manifest = read("Cargo.toml");
    for key in ["repository", "homepage"] {
        assert!(manifest.contains(&format!("\n{key} = \"https://")), "{key}");
    }
    for folder in packages() {
        let manifest = read(&format!("{folder}/Cargo.toml"));
        for key in ["version", "repository", "homepage"] {
            let inherited = manifest.contains(&format!("\n{key}.workspace = true"));
            assert!(inherited, "{folder}: {key}");
        }
        assert!(
            manifest.contains("\ndocumentation = \"https://")
                || manifest.contains("\npublish = false"),
            "{folder}"
        );
    }
    // A version here would be looked up in the registry, where it does not exist before it is
    // published.
    let (_, tests) = manifest
        .split_once("\n[dev-dependencies]\n")
        .expect("those of tests");
    let own = tests.lines().filter(|line| line.starts_with("frictcomp"));
    for line in own {
        assert!(
            line.contains("path = ") && !line.contains("version"),
            "{line}"
        );
    }
    let build = read("dist/build");
    for line in [
        "--remap-path-prefix=$home=",
        "names_no_folder \"$executable\"",
        "names_no_folder \"$file\"",
    ] {
        assert!(build.contains(line), "{line}");
    }
}

#[test]
fn what_c_hosts_link_with_has_a_version() {
    // R13.14: `bindings/c/test` links with it, by the lines of docs/c.md.
    let major = env!("CARGO_PKG_VERSION_MAJOR");
    assert!(read("bindings/c/build.rs").contains("-soname,libfrictcomp_c.so.{major}"));
    assert!(read("docs/c.md").contains(&format!("`libfrictcomp_c.so.{major}`")));
    let header = read("bindings/c/include/frictcomp.h");
    assert!(header.contains(&format!(
        "#define FRICTCOMP_VERSION \"{}\"",
        env!("CARGO_PKG_VERSION")
    )));
    let build = read("bindings/c/build");
    for file in ["frictcomp.pc", "frictcomp-config.cmake", "--message-format"] {
        assert!(build.contains(file), "{file}");
    }
}
