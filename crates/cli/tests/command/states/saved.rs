//! State files that are refused, and those of older versions.

use crate::folder::{Bench, json, of_schema_2};
use crate::workspace::root;

#[test]
fn a_damaged_file_stays_as_it_is() {
    // R9.30 R9.32: as files, through the tool.
    let bench = Bench::new(&[("a.nc", "X[COMP OFF FRICT]\nM30\n")]);
    let run = ["run", "--state", "s.json", "a.nc"];
    assert_eq!(bench.status(&run), Some(0));
    let good = of_schema_2(&bench.read("s.json"));
    let mut swapped = json(&good);
    swapped["axes"].as_array_mut().expect("a list").swap(0, 1);
    bench.write("s.json", &swapped.to_string());
    assert_eq!(
        bench.records(&["--state", "s.json", "a.nc"])[0],
        bench.records(&["--state", "s.json", "a.nc"])[0]
    );
    for damage in ["missing", "doubled", "surplus"] {
        let mut state = json(&good);
        let axes = state["axes"].as_array_mut().expect("a list");
        match damage {
            "missing" => drop(axes.remove(1)),
            "doubled" => axes.push(axes[0].clone()),
            _ => axes.push({
                let mut other = axes[0].clone();
                other["axis"] = "Q".into();
                other
            }),
        }
        let text = state.to_string();
        bench.write("s.json", &text);
        let output = bench.call(&run);
        let said = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(2), "{damage}: {said}");
        assert!(said.contains("damaged"), "{damage}: {said}");
        assert_eq!(bench.read("s.json"), text, "{damage}");
    }
}

#[test]
fn a_file_of_schema_1_is_read_with_nobody_known() {
    // R9.32
    let bench = Bench::new(&[("a.nc", "X[COMP OFF FRICT]\nM30\n"), ("b.nc", "X1\nM30\n")]);
    assert_eq!(bench.status(&["run", "--state", "s.json", "a.nc"]), Some(0));
    let mut old = json(&of_schema_2(&bench.read("s.json")));
    old["schema"] = 1.into();
    for axis in old["axes"].as_array_mut().expect("a list") {
        axis.as_object_mut().unwrap().retain(|key, _| {
            ["axis", "selected", "unknown", "max_points", "friction"].contains(&key.as_str())
        });
    }
    bench.write("s.json", &old.to_string());
    let text = bench.stdout(&["run", "--width", "200", "--state", "s.json", "b.nc"]);
    assert!(text.contains("info[FC403]"), "{text}");
    assert!(text.contains("a program that is not known"), "{text}");
    assert_eq!(json(&bench.read("s.json"))["schema"], 4);
}

#[test]
fn the_demo_says_fc403_twice_in_two_processes() {
    // R9.32
    let demo = |name: &str| {
        let path = root().join("programs/demo").join(name);
        std::fs::read_to_string(path).unwrap()
    };
    let (friction, next) = (demo("friction.nc"), demo("next.nc"));
    let bench = Bench::new(&[("friction.nc", &friction), ("next.nc", &next)]);
    bench.stdout(&["run", "--state", "s", "friction.nc"]);
    let apart = bench.stdout(&["run", "--width", "200", "--state", "s", "next.nc"]);
    assert_eq!(apart.matches("warning[FC403]").count(), 2, "{apart}");
    assert!(
        apart.contains("friction.nc:5") && apart.contains("friction.nc:3"),
        "{apart}"
    );
    assert!(
        apart.contains("`FRICTION`") && apart.contains("N45 X[COMP OFF FRICT]"),
        "{apart}"
    );
    assert!(!apart.contains("nothing to do"), "{apart}");
    // This output has not said how to bring them back to their start-up state.
    assert!(
        apart.contains("X and Y are left off: write X[COMP ON FRICT]"),
        "{apart}"
    );
}
