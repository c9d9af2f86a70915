//! The contents of a release that can be checked by texts; `dist/build` makes it.

use std::collections::BTreeSet;
use std::fs;
#[cfg(unix)]
use std::process::Command;

use crate::{read, root};

/// Returns the texts of a list in a TOML file.
fn list(text: &str, key: &str) -> BTreeSet<String> {
    let document: toml::Table = text.parse().expect("TOML");
    let found = document
        .get(key)
        .or_else(|| document.get("licenses").and_then(|table| table.get(key)));
    let items = found.and_then(toml::Value::as_array).expect("a list");
    let words = items.iter().map(|item| item.as_str().expect("a text"));
    words.map(str::to_owned).collect()
}

/// Returns the lines of the README between two headings.
fn section(heading: &str) -> String {
    let readme = read("README.md");
    let (_, from) = readme.split_once(heading).expect("the heading is there");
    let end = from.find("\n## ").unwrap_or(from.len());
    from[..end].to_owned()
}

#[test]
fn what_is_given_away_has_the_licences_that_are_allowed() {
    // R13.2
    assert_eq!(
        list(&read("dist/about.toml"), "accepted"),
        list(&read("deny.toml"), "allow")
    );
}

#[test]
fn the_readme_begins_with_what_a_release_has() {
    // R13.2
    let install = section("## Get started");
    let version = env!("CARGO_PKG_VERSION");
    let archives = [
        "frictcomp.html".to_owned(),
        format!("frictcomp-{version}-x86_64-pc-windows-gnu.zip"),
        format!("frictcomp-{version}-win32-x64.vsix"),
        format!("frictcomp-{version}-cp310-abi3-"),
        format!("frictcomp-{version}-x86_64-unknown-linux-musl.tar.gz"),
        format!("frictcomp-c-{version}-x86_64-pc-windows-gnu.zip"),
        "SHA256SUMS".to_owned(),
    ];
    let source = install
        .find("cargo run --release")
        .expect("from the source");
    for archive in &archives {
        let at = install.find(archive.as_str());
        assert!(at.is_some_and(|at| at < source), "{archive}: {at:?}");
    }
}

#[test]
fn a_release_is_made_by_the_script_alone() {
    // R13.2
    let workflow = read(".github/workflows/release.yml");
    assert!(workflow.contains("- run: dist/build\n"));
    let script = read("dist/build");
    for target in [
        "x86_64-unknown-linux-musl",
        "aarch64-unknown-linux-musl",
        "x86_64-pc-windows-gnu",
    ] {
        assert!(script.contains(target), "{target}");
    }
    for content in [
        "completions",
        "man --into",
        "THIRD-PARTY-LICENSES.txt",
        "SHA256SUMS",
    ] {
        assert!(script.contains(content), "{content}");
    }
}

#[test]
fn what_a_workflow_runs_is_named_by_its_content() {
    // R13.6: a tag of a third-party action can be moved, a commit cannot.
    for name in ["ci.yml", "release.yml"] {
        let workflow = read(&format!(".github/workflows/{name}"));
        let actions = workflow
            .lines()
            .filter_map(|line| line.split_once("uses: "));
        for (_, action) in actions.filter(|(_, action)| !action.starts_with("./")) {
            let (_, version) = action.split_once('@').expect("a version");
            let commit = version.split(' ').next().expect("a commit");
            let is_commit = commit.len() == 40 && commit.bytes().all(|it| it.is_ascii_hexdigit());
            assert!(is_commit, "{name}: {action}");
        }
    }
}

#[test]
fn a_wheel_runs_on_old_systems_and_has_its_notices() {
    // R13.10
    let build = read("bindings/python/build");
    assert!(build.contains("--zig --compatibility manylinux_2_28"));
    let project: toml::Table = read("bindings/python/pyproject.toml")
        .parse()
        .expect("TOML");
    let licences = project["project"]["license-files"].as_array();
    let licences = licences.expect("files").iter();
    let names: Vec<&str> = licences.filter_map(toml::Value::as_str).collect();
    assert!(names.contains(&"THIRD-PARTY-LICENSES*.txt"), "{names:?}");
    let release = read("dist/build");
    for made in [
        "aarch64-unknown-linux-gnu",
        "sdist",
        "licenses/THIRD-PARTY-LICENSES.txt",
    ] {
        assert!(release.contains(made), "{made}");
    }
}

#[test]
fn two_builds_can_be_the_same_bytes() {
    // R13.10: `dist/compare` builds them; nothing in an archive has the build time.
    let build = read("dist/build");
    for line in [
        "--mtime=\"@$SOURCE_DATE_EPOCH\"",
        "touch --no-dereference --date=\"@$SOURCE_DATE_EPOCH\"",
        "export SOURCE_DATE_EPOCH TZ=UTC",
    ] {
        assert!(build.contains(line), "{line}");
    }
    assert!(read("scripts/full").contains("dist/compare"));
}

#[test]
fn windows_shows_an_icon_and_a_version() {
    // R13.10: the head of an icon file has the number of its pictures.
    let icon = root().join("crates/cli/frictcomp.ico");
    let icon = fs::read(icon).expect("the icon");
    assert_eq!(icon[..4], [0, 0, 1, 0]);
    let sizes: Vec<u8> = (0..usize::from(icon[4]))
        .map(|at| icon[6 + 16 * at])
        .collect();
    // 0 means 256.
    assert_eq!(sizes, [16, 32, 48, 0]);
    assert!(read("crates/cli/build.rs").contains("set_icon(\"frictcomp.ico\")"));
    assert!(read("dist/build").contains("grep -qF .rsrc"));
}

#[test]
fn a_release_is_attested_and_says_what_is_inside() {
    // R13.10
    let workflow = read(".github/workflows/release.yml");
    for line in [
        "actions/attest-build-provenance@",
        "subject-checksums: dist/out/SHA256SUMS",
        "id-token: write",
        "attestations: write",
    ] {
        assert!(workflow.contains(line), "{line}");
    }
    let build = read("dist/build");
    let parts = [
        "crates/cli",
        "bindings/python",
        "bindings/web",
        "bindings/c",
    ];
    for part in parts {
        assert!(build.contains(&format!("materials {part} ")), "{part}");
    }
}

/// Returns the folders of the packages that are published, the library's among them.
fn published() -> Vec<String> {
    let root = root();
    let crates = fs::read_dir(root.join("crates")).expect("packages");
    let names = crates.map(|it| it.expect("an entry").file_name());
    let folders = names.map(|it| format!("crates/{}", it.to_string_lossy()));
    let is_published =
        |folder: &String| !read(&format!("{folder}/Cargo.toml")).contains("\npublish = false");
    let published = folders.filter(is_published);
    published.chain([".".to_owned()]).collect()
}

/// Returns the addresses to which a text in Markdown links.
fn links(text: &str) -> impl Iterator<Item = &str> {
    let targets = text.split("](").skip(1);
    targets.filter_map(|target| target.split([')', '#']).next())
}

#[test]
fn every_package_has_its_licences_and_a_readme_whose_links_work() {
    // R13.20
    let repository = repository();
    let mut readmes = vec!["bindings/python/README.md".to_owned()];
    for folder in published() {
        for licence in ["LICENSE-MIT", "LICENSE-APACHE"] {
            assert_eq!(read(&format!("{folder}/{licence}")), read(licence));
        }
        let manifest: toml::Table = read(&format!("{folder}/Cargo.toml")).parse().expect("TOML");
        let readme = manifest["package"]["readme"].as_str().expect("a README");
        assert!(!readme.contains(".."), "{folder}: {readme}");
        readmes.push(format!("{folder}/{readme}"));
    }
    assert_eq!(readmes.len(), 8);
    for readme in readmes {
        for link in links(&read(&readme)) {
            assert!(link.starts_with("https://"), "{readme}: {link}");
            let file = link
                .strip_prefix(&repository)
                .and_then(|it| it.strip_prefix("/blob/main/"));
            let exists = file.is_none_or(|it| root().join(it).exists());
            assert!(exists, "{readme}: {link}");
        }
    }
}

/// Returns the address of the repository.
fn repository() -> String {
    let manifest: toml::Table = read("Cargo.toml").parse().expect("TOML");
    let address = manifest["workspace"]["package"]["repository"].as_str();
    address.expect("an address").to_owned()
}

#[test]
fn the_owner_of_the_repository_is_set_in_one_place() {
    // R13.20: `dist/owner` sets it; what a release has is searched for one that is not set.
    let repository = repository();
    for file in ["README.md", "docs/ci.md", "editors/vscode/package.json"] {
        let text = read(file);
        for (at, _) in text.match_indices("https://github.com/") {
            let own = text[at..]
                .split(['"', ')', '>', '\n'])
                .next()
                .unwrap_or_default();
            assert!(
                !own.contains("/frictcomp") || own.starts_with(&repository),
                "{file}: {own}"
            );
        }
    }
    let workflow = read(".github/workflows/release.yml");
    assert!(workflow.contains("test \"$(dist/owner)\" = \"$GITHUB_REPOSITORY_OWNER\""));
    assert!(read("dist/try").contains("names no owner of the repository"));
}

#[cfg(unix)]
#[test]
fn bash_reads_every_script() {
    // R13.20
    let mut read = 0;
    for folder in [
        "dist",
        "scripts",
        "bindings/c",
        "bindings/python",
        "bindings/web",
    ] {
        for entry in fs::read_dir(root().join(folder)).expect("a folder") {
            let path = entry.expect("an entry").path();
            let text = fs::read_to_string(&path).unwrap_or_default();
            if text.starts_with("#!/usr/bin/env bash") {
                let output = Command::new("bash").arg("-n").arg(&path).output();
                let said = String::from_utf8_lossy(&output.expect("bash").stderr).into_owned();
                assert!(said.is_empty(), "{said}");
                read += 1;
            }
        }
    }
    assert!(read > 10, "{read}");
}

#[test]
fn what_is_published_was_tested_and_tried_and_needs_few_rights() {
    // R13.20
    let workflow = read(".github/workflows/release.yml");
    assert!(workflow.contains("\npermissions: {}\n"));
    let (_, jobs) = workflow.split_once("\njobs:\n").expect("jobs");
    let name = |job: &str| job.split(':').next().unwrap_or_default().trim().to_owned();
    let jobs: Vec<&str> = jobs.split("\n\n").collect();
    let of = |wanted: &str| {
        let found = jobs.iter().find(|job| name(job) == wanted);
        *found.unwrap_or_else(|| panic!("no job {wanted}"))
    };
    for job in &jobs {
        assert!(job.contains("permissions:"), "{job}");
        let writes = job.contains("contents: write");
        assert_eq!(writes, name(job) == "release", "{job}");
    }
    assert!(of("release").contains("needs: [test, try]"));
    assert!(of("try").contains("- run: dist/try\n"));
    for place in ["crates-io", "pypi", "marketplace", "open-vsx"] {
        let job = of(place);
        assert!(job.contains("needs: release"), "{place}");
        assert!(job.contains(&format!("environment: {place}")), "{place}");
    }
    for trusted in ["crates-io", "pypi"] {
        let job = of(trusted);
        assert!(job.contains("id-token: write") && !job.contains("secrets."));
    }
}

#[test]
fn the_book_has_every_document_in_four_parts() {
    // R13.21
    let contents = read("docs/SUMMARY.md");
    let parts: Vec<&str> = contents
        .lines()
        .filter_map(|it| it.strip_prefix("# "))
        .collect();
    assert_eq!(
        parts,
        ["frictcomp", "Use", "Commission", "Reference", "Embed"]
    );
    let documents = root().join("docs");
    for entry in fs::read_dir(documents).expect("documents") {
        let name = entry.expect("an entry").file_name();
        let name = name.to_string_lossy();
        let listed = contents.contains(&format!("({name})"));
        let is_document = name.ends_with(".md") && name != "SUMMARY.md";
        assert!(listed || !is_document, "{name} is not in the book");
        assert!(
            name.ends_with(".md") || !name.contains('.'),
            "{name} is no document"
        );
    }
    // Archives have it in HTML; the references come from the command and its pages.
    assert!(read("dist/build").contains("dist/book \"$folder/docs\""));
    assert!(read("dist/book").contains("man --format markdown"));
}

#[test]
fn the_example_of_the_page_begins_with_a_path() {
    // R13.18: `bindings/web/test` opens it, and drops what is no program.
    let example = read("bindings/web/page/demo.ts");
    let first = example.split("[\"example/").nth(1).expect("a file");
    assert!(first.starts_with("contour/plate.nc\""), "{first}");
    let tests = read("bindings/web/tests/browser.mjs");
    for shown in [
        "#contour img",
        "the folder is empty",
        "#channels img",
        ".field-error",
    ] {
        assert!(tests.contains(shown), "{shown}");
    }
}
