//! `frictcomp.toml`, chapter 9.1.

use frictcomp::comp::Kind;
use frictcomp::diagnostic::{Code, Severity};
use frictcomp::lists::TablePoint;
use frictcomp::lists::{AxisType, Origin};
use frictcomp::machine::{
    AxisSet, Configuration, Machine, NoLists, Parameterisation, Setting, check_list,
};
use frictcomp::text::SourceFile;

use super::host::{Disk, codes};

#[test]
fn everything_has_its_key() {
    let text = r#"
[machine]
cycle_time_ms = 2
cnc_build = "3.1.3132.0"
program_dirs = ["cycles", "../shared"]
start_program = "start.nc"
end_program = "end.nc"
[machine.programs]
G80 = "drill.nc"
M6 = "toolchange.nc"
[[axis]]
name = "X"
frict_comp = true
compensations = ["CROSS", "LEAD"]
manual_activation = ["CROSS"]
required = ["FRICT"]
max_velocity = 20000
[axis.value]
mode = 3
table = [[0.0, 12.0], [1800.0, 10.5]]
[[axis]]
name = "C"
type = "R"
number = 4
[variables]
"V.E.PART" = 3
"V.E.NAME" = "left"
[lint]
FC402 = "off"
FC401 = "error"
"#;
    let file = SourceFile::new("frictcomp.toml", text);
    let found = Configuration::from_toml(file, &mut NoLists).expect("a machine");
    assert_eq!(found.diagnostics, []);
    let machine = &found.machine;
    assert_eq!(machine.cycle_time_ms, Some(2.0));
    assert_eq!(machine.build.unwrap().to_string(), "V3.1.3132.00");
    assert_eq!(machine.axis_set, AxisSet::Configured);
    assert_eq!(machine.programs.start.as_deref(), Some("start.nc"));
    assert_eq!(machine.programs.end.as_deref(), Some("end.nc"));
    let words: Vec<_> = machine
        .programs
        .words
        .iter()
        .map(|(w, f)| (&**w, &**f))
        .collect();
    assert_eq!(words, [("G80", "drill.nc"), ("M6", "toolchange.nc")]);
    let [x, c] = &machine.axes[..] else {
        panic!("two axes")
    };
    assert_eq!(
        x.configured,
        [Kind::Frict, Kind::Cross, Kind::Lead].into_iter().collect()
    );
    assert_eq!(x.manual, [Kind::Cross].into_iter().collect());
    assert_eq!(x.required, [Kind::Frict].into_iter().collect());
    assert_eq!(x.max_velocity_per_min, Some(20000.0));
    let origin = Origin::File {
        file: "frictcomp.toml".into(),
        line: 13,
    };
    assert_eq!(x.frict_comp_origin, origin);
    let Parameterisation::Accepted(list) = &x.friction else {
        panic!("{:?}", x.friction)
    };
    assert_eq!(
        list.table[1],
        TablePoint {
            input: 1800.0,
            output: 10.5
        }
    );
    assert_eq!((c.axis_type, c.number), (AxisType::Rotary, Some(4)));
    assert_eq!(c.frict_comp_origin, Origin::Default);
    assert_eq!(found.program_dirs, ["cycles", "../shared"]);
    assert_eq!(
        found.settings,
        [
            ("V.E.NAME".to_owned(), Setting::Text("left".into())),
            ("V.E.PART".to_owned(), Setting::Number(3.0)),
        ]
    );
    assert_eq!(found.levels.severity(Code::Fc402), None);
    assert_eq!(found.levels.severity(Code::Fc401), Some(Severity::Error));
}

#[test]
fn a_machine_comes_from_a_text() {
    let machine = Machine::from_toml("[[axis]]\nname = \"X\"\n").unwrap();
    assert_eq!(machine.axes[0].name, "X");
    assert!(Machine::from_toml("x").is_err());
}

/// R9.22: every file in `programs/machines/err` raises the code in its name.
#[test]
fn every_sample_of_a_mistake_makes_it() {
    let mut seen = 0;
    for entry in std::fs::read_dir(Disk::root().join("err")).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_name().unwrap().to_str().unwrap().to_owned();
        let file = || Disk::open(&format!("err/{name}"));
        let found = match path.extension().and_then(|e| e.to_str()) {
            Some("lis") => check_list(file(), None, &mut Disk).diagnostics,
            Some("toml") => match Configuration::from_toml(file(), &mut Disk) {
                Ok(found) => found.diagnostics,
                Err(error) => vec![*error.diagnostic],
            },
            _ => continue,
        };
        let raised =
            |d: &frictcomp::diagnostic::Diagnostic| name.starts_with(&format!("{}-", d.code));
        assert!(found.iter().any(raised), "{name}: {:?}", codes(&found));
        seen += 1;
    }
    assert!(seen >= 20, "{seen} samples");
}
