//! `frictcomp.toml`, chapter 9.1, and its effect on lists.

use frictcomp::comp::Kind;
use frictcomp::diagnostic::{Code, Severity};
use frictcomp::lists::TablePoint;
use frictcomp::machine::{
    AxisSet, AxisType, Configuration, Machine, NoLists, Origin, Parameterisation, Setting,
    check_list,
};
use frictcomp::text::SourceFile;

use super::host::{Disk, codes};

fn read(text: &str) -> Configuration {
    let file = SourceFile::new("frictcomp.toml", text);
    Configuration::from_toml(file, &mut NoLists).unwrap_or_else(|error| panic!("{error}"))
}

/// Returns the place and the message of the error, and its advice.
fn refused(text: &str) -> (String, String) {
    let file = SourceFile::new("frictcomp.toml", text);
    match Configuration::from_toml(file, &mut NoLists) {
        Ok(_) => panic!("accepted: {text}"),
        Err(error) => {
            assert_eq!(error.diagnostic.code, Code::Fc110);
            (error.to_string(), error.diagnostic.help().join(" "))
        }
    }
}

#[test]
fn everything_has_its_key() {
    let found = read(
        r#"
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
"#,
    );
    assert_eq!(codes(&found.diagnostics), [""; 0]);
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
fn inline_values_have_the_checks_of_a_list() {
    // R3.20, R3.21, R3.26
    let values = |text: &str| {
        let text = format!("[[axis]]\nname = \"X\"\nfrict_comp = true\n[axis.value]\n{text}\n");
        let mut found = read(&text);
        (
            codes(&found.diagnostics),
            found.machine.axes.remove(0).friction,
        )
    };
    let (found, friction) = values("mode = 3\ntable = [[5, 1], [5, 1]]");
    assert_eq!(found[0], "P-ERR-110591 6:19");
    assert!(matches!(friction, Parameterisation::Rejected { .. }));
    let (found, friction) = values("table = [[0, 1]]");
    assert_eq!(friction, Parameterisation::Off);
    assert_eq!(found, ["FC303 3:14"]);
    assert_eq!(
        values("mode = 2\ntable = [[0, 1]]").0[0],
        "P-ERR-110592 5:8"
    );
    assert_eq!(values("mode = 3\ntable = []").0[0], "P-ERR-110592 5:8");
    let (found, _) = values("mode = 3\ntable_entries = 2\ntable = [[0, 1]]");
    assert_eq!(found[0], "FC133 6:17");
    assert_eq!(values("mode = 3\ntable = [[nan, 1]]").0[0], "FC130 6:11");
}

#[test]
fn the_file_overrides_the_lists() {
    // R3.10, R3.12
    let text = "[machine]\nstartup = \"mill3/hochlauf.lis\"\n[[axis]]\nname = \"Y\"\nfrict_comp = 0\n\
                [[axis]]\nname = \"X\"\n[axis.value]\nposition_delay = 3\n[[axis]]\nname = \"C\"\n\
                type = \"R\"\n[lint]\nFC135 = \"off\"\n";
    let file = SourceFile::new("frictcomp.toml", text);
    let found = Configuration::from_toml(file, &mut Disk).unwrap();
    assert_eq!(codes(&found.diagnostics), [""; 0]);
    let axes = &found.machine.axes;
    let names: Vec<_> = axes.iter().map(|axis| axis.name.as_str()).collect();
    assert_eq!(names, ["X", "Y", "Z", "C"]);
    let Parameterisation::Accepted(list) = &axes[0].friction else {
        panic!("{:?}", axes[0].friction)
    };
    assert_eq!((list.position_delay, list.table.len()), (3, 3));
    assert!(!axes[1].configured.contains(Kind::Frict));
    let origin = Origin::File {
        file: "frictcomp.toml".into(),
        line: 5,
    };
    assert_eq!(axes[1].frict_comp_origin, origin);
}

#[test]
fn severities_are_the_users() {
    // R9.28
    let text = "[[axis]]\nname = \"X\"\n[axis.value]\nmode = 3\ntable = [[0, 1]]\n[lint]\nFC135 = \"error\"\n";
    assert_eq!(read(text).diagnostics[0].severity, Severity::Error);
}

#[test]
fn without_axes_the_machine_is_unconfigured() {
    // R2.20
    let found = read("[machine]\ncycle_time_ms = 1.0\n");
    assert_eq!(found.machine.axis_set, AxisSet::AsTheyOccur);
    assert_eq!(found.machine.axes.len(), 9);
}

#[test]
#[allow(clippy::too_many_lines, reason = "a table of mistakes")]
fn what_does_not_exist_is_refused_with_its_place() {
    for (text, place, help) in [
        ("[machin]\n", "1:2", "did you mean `machine`?"),
        (
            "[machine]\ncyle_time_ms = 1\n",
            "2:1",
            "did you mean `cycle_time_ms`?",
        ),
        (
            "[machine]\ncycle_time_ms = 0\n",
            "2:17",
            "a CNC cycle of 1 ms",
        ),
        ("[machine]\ncnc_build = \"new\"\n", "2:13", ""),
        (
            "[machine]\ncnc_build = 3\n",
            "2:13",
            "`cnc_build = \"3.1.3132.0\"`",
        ),
        (
            "[machine]\nprogram_dirs = \"cycles\"\n",
            "2:16",
            "`program_dirs = [\"cycles\"]`",
        ),
        (
            "[machine]\nstartup = \"C:\\cnc\\h.lis\"\n",
            "2:15",
            "single quotes",
        ),
        (
            "[machine]\nstartup = lists/h.lis\n",
            "2:11",
            "put texts in quotes",
        ),
        (
            "[[machine]]\ncycle_time_ms = 1\n",
            "1:1",
            "`[machine]`, in single brackets",
        ),
        (
            "[axis]\nname = \"X\"\n",
            "1:1",
            "`[[axis]]`, in double brackets",
        ),
        (
            "[axis.value]\nmode = 3\n",
            "1:2",
            "`[[axis]]`, in double brackets",
        ),
        ("[[axis]]\nname = \"X Y\"\n", "2:8", "a name is a letter"),
        ("[[axis]]\nname = \"\"\n", "2:8", "a name is a letter"),
        (
            "[variables]\nV.E.PART = 3\n",
            "2:1",
            "write `\"V.E.PART\" = 3`",
        ),
        (
            "[variables]\nV.E.NAME = \"A\"\n",
            "2:1",
            "write `\"V.E.NAME\" = \"A\"`",
        ),
        (
            "[variables]\n@P4 = 1\n",
            "2:1",
            "put the name in quotes: `\"@P4\" = ...`",
        ),
        (
            "[[axis]]\nname = \"X\"\nfrict_cmp = true\n",
            "3:1",
            "did you mean `frict_comp`?",
        ),
        ("[[axis]]\nname = \"X\"\nfrict_comp = \"yes\"\n", "3:14", ""),
        ("[[axis]]\nname = \"X\"\ntype = \"Q\"\n", "3:8", "write `T`"),
        (
            "[[axis]]\nname = \"X\"\ncompensations = [\"KROSS\"]\n",
            "3:18",
            "did you mean `CROSS`?",
        ),
        (
            "[[axis]]\nname = \"X\"\nmanual_activation = [\"FRICT\"]\n",
            "3:22",
            "",
        ),
        (
            "[[axis]]\nname = \"X\"\n[[axis]]\nname = \"X\"\n",
            "4:8",
            "",
        ),
        ("[[axis]]\nfrict_comp = true\n", "1:1", ""),
        (
            "[[axis]]\nname = \"X\"\n[axis.value]\ntable = [[1, 2, 3]]\n",
            "4:10",
            "",
        ),
        (
            "[[axis]]\nname = \"X\"\n[axis.value]\nmode = \"3\"\n",
            "4:8",
            "",
        ),
        (
            "[[axis]]\nname = \"X\"\n[axis.value]\ndelay = 3\n",
            "4:1",
            "",
        ),
        ("axis = 3\n", "1:8", "`[[axis]]`"),
        ("[variables]\nA = true\n", "2:1", "write `\"A\" = 3`"),
        (
            "[variables]\nstable = [\"X1\"]\n",
            "2:11",
            "write `stable = [\"V.E.PART\"]`",
        ),
        ("[variables]\nstable = 3\n", "2:10", ""),
        ("[lint]\nFC4O2 = \"off\"\n", "2:1", "did you mean `FC402`?"),
        ("[lint]\nFC402 = \"of\"\n", "2:9", "did you mean `off`?"),
        (
            "[lint]\nP-ERR-70495 = \"off\"\n",
            "2:1",
            "only codes that begin with `FC`",
        ),
        ("[machine\n", "1:9", ""),
    ] {
        let (message, advice) = refused(text);
        let expected = format!("frictcomp.toml:{place}: ");
        assert!(message.starts_with(&expected), "{text}\n{message}");
        assert!(advice.contains(help), "{text}\n{advice}");
    }
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
