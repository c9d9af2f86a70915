//! Chapter 17 of the rules with git, for many files.

use crate::console::git;
use crate::folder::{Bench, stderr};

#[test]
fn ten_thousand_changed_files_are_compared() {
    // R17.4
    let bench = Bench::new(&[]);
    for number in 0..10_000 {
        bench.write(
            &format!("p{number:05}.nc"),
            &format!("N10 X{number}\nN20 M30\n"),
        );
    }
    for arguments in [
        &["init", "-q"] as &[&str],
        &["add", "-A"],
        &["commit", "-q", "-m", "state"],
    ] {
        let done = git(bench.folder(), arguments).status();
        assert!(done.expect("git starts").success(), "git {arguments:?}");
    }
    for number in 0..10_000 {
        bench.write(
            &format!("p{number:05}.nc"),
            &format!("N10 X{number} F1\nN20 M30\n"),
        );
    }
    bench.write("p00007.nc", "N10 X[COMP OFF FRICT]\nN20 M30\n");
    let said = stderr(&bench.call(&["diff", "--git", "HEAD"]));
    assert!(
        said.contains("10000 programs compared with `HEAD`: 9999 switch the same"),
        "{said}"
    );
}
