//! Sessions without a described machine.

use crate::folder::{Bench, json};

const OFF: &str = "X[COMP OFF FRICT]\nX1\nX[COMP OFF FRICT]\nY[COMP OFF_ALL]\nM30\n";

fn bench(program: &str) -> Bench {
    let bench = Bench::new(&[("a.nc", program)]);
    std::fs::remove_file(bench.folder().join("frictcomp.toml")).expect("removed");
    bench
}

#[test]
fn nothing_says_that_there_is_nothing_to_do() {
    // R1.37
    for program in [OFF, "X1\nM30\n"] {
        let bench = bench(program);
        let text = bench.stdout(&["run", "--width", "200", "--isolated", "a.nc"]);
        let first = text.lines().next().unwrap_or_default();
        assert!(first.starts_with("no machine is described"), "{text}");
        assert!(text.contains("`frictcomp init`"), "{text}");
        assert!(!text.to_lowercase().contains("nothing to do"), "{text}");
        let page = bench.folder().join("a.html");
        bench.stdout(&["run", "--isolated", "--html", "a.html", "a.nc"]);
        let page = std::fs::read_to_string(page).unwrap();
        assert!(page.contains("No machine is described"));
        assert!(!page.to_lowercase().contains("nothing to do"));
    }
}

#[test]
fn all_axes_are_proposed_once_and_first() {
    // R1.37: in every output that depends on it.
    let text = "X[COMP ON FRICT]\nY [COMP \\\nOFF FRICT]\nC[COMP OFF LEAD]\nM30\n";
    let bench = bench(text);
    for arguments in [
        &["run", "a.nc"][..],
        &["run", "--changes", "a.nc"],
        &["check", "a.nc"],
        &["diff", "a.nc", "a.nc"],
    ] {
        let mut all = arguments.to_vec();
        all.push("--isolated");
        all.extend(["--width", "200"]);
        let shown = bench.stdout(&all);
        let first = shown.lines().next().unwrap_or_default();
        assert!(first.starts_with("no machine is described"), "{shown}");
        assert!(first.ends_with("`--enable X,Y`"), "{shown}");
        assert_eq!(shown.matches("`--enable X").count(), 1, "{shown}");
    }
    let session = json(&bench.records(&["--isolated", "a.nc"])[0]);
    let remark = session["remark"].as_str().unwrap_or_default();
    assert!(remark.ends_with("`--enable X,Y`"), "{remark}");
    for arguments in [
        &["run", "--format", "csv", "a.nc"][..],
        &["check", "--format", "concise", "a.nc"],
        &["check", "--format", "sarif", "a.nc"],
    ] {
        let mut all = arguments.to_vec();
        all.push("--isolated");
        let output = bench.call(&all);
        let said = String::from_utf8(output.stderr).unwrap();
        assert!(said.contains("`--enable X,Y`"), "{arguments:?}: {said}");
        let data = String::from_utf8(output.stdout).unwrap();
        assert!(!data.contains("no machine is described"), "{data}");
    }
    bench.stdout(&["golden", "--isolated", "--update", "a.nc"]);
    let golden = bench.read("a.nc.timeline");
    assert!(golden.starts_with("no machine is described"), "{golden}");
    // A program that switches nothing does not depend on it.
    bench.write("b.nc", "G01 X1 F100\nM30\n");
    let shown = bench.stdout(&["check", "--isolated", "b.nc"]);
    assert!(!shown.contains("no machine is described"), "{shown}");
}
