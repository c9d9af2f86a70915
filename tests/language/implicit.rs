//! Programs called by words, programs that exist only on the machine, and the states after passing
//! over them: R2.14, R2.75, R2.83.

use insta::assert_snapshot;

use crate::support::{Bench, MACHINE, SourceMode};

fn machine(programs: &str) -> Bench {
    Bench::on(&format!("[machine]\n{programs}\n{MACHINE}"))
        .file("change.nc", "N1 X[COMP OFF FRICT]\nM17")
        .file("select.nc", "N2 Y[COMP OFF FRICT]\nM17")
        .file("data.nc", "N3 Y[COMP ON FRICT]\nM17")
        .file("drill.nc", "N4 X[COMP ON FRICT]\nP9=@P2\nM17")
}

/// Returns the end of each program's transcript.
fn ends(transcript: &str) -> Vec<&str> {
    let lines = transcript.lines().map(str::trim);
    lines.filter(|line| line.starts_with("end ")).collect()
}

#[test]
fn every_word_of_a_block_calls_its_program() {
    // R2.14: a tool is selected and changed in one block
    let bench = machine(
        "[machine.programs]\nT = \"select.nc\"\nM06 = \"change.nc\"\ng081 = \"drill.nc\"\nD = \"data.nc\"",
    );
    let program = "N10 T5 M6 D3 G81\nN20 X1\nM30";
    let lines = bench.run(&[program]);
    assert_snapshot!(lines, @"
    start X:active Y:active Z:unconfigured B:ineffective
    a.nc -
      1 line 1 N10
      2 line 1 N2 level 1 Y:active>inactive
      3 line 2 - level 1
      4 line 1 N1 level 1 X:active>inactive
      5 line 2 - level 1
      6 line 1 N3 level 1 Y:inactive>active
      7 line 2 - level 1
      8 line 1 N4 level 1 X:inactive>active
      9 line 2 - level 1
        FC311 2:4-7 in drill.nc
      end 9 error X:active Y:active Z:unconfigured B:ineffective
    ");
    assert_eq!(bench.handed(SourceMode::LineByLine).run(&[program]), lines);
    let bench = machine("[machine.programs]\nT = \"select.nc\"");
    // An unknown number still counts as a number.
    assert_snapshot!(bench.run(&["N10 T V.E.TOOL\nM30"]), @"
    start X:active Y:active Z:unconfigured B:ineffective
    a.nc -
      1 line 1 N10
      2 line 1 N2 level 1 Y:active>inactive
      3 line 2 - level 1
      4 line 2 -
        FC401 1:4-21 in select.nc
      end 4 M30 X:active Y:inactive Z:unconfigured B:ineffective
    ");
}

#[test]
fn which_function_is_called_must_be_known() {
    // R2.52
    for block in ["M V.E.M", "G V.E.G", "M=V.E.M"] {
        let program = format!("{block}\nM30");
        let transcript = Bench::new().run(&[&program]);
        assert!(transcript.contains("FC902"), "{block}: {transcript}");
        assert!(
            ends(&transcript)[0].contains("X:unknown Y:unknown"),
            "{block}: {transcript}"
        );
    }
}

#[test]
fn a_program_names_what_its_words_call() {
    // R2.75: until M30, without an equals sign, with the name in a variable
    let bench = machine("[machine.programs]\nM6 = \"data.nc\"").passing_branches();
    let program = "N10 #FILE NAME [ M6=\"change.nc\" G80 \"drill.nc\" ]\nN20 M6\nN30 G80 [1, 2]\nN40 #FILENAME[M6=\"\"]\nN50 M6\nM30";
    assert_snapshot!(bench.run(&[program, "M6\nM30"]), @"
    start X:active Y:active Z:unconfigured B:ineffective
    a.nc -
      1 line 1 N10
      2 line 2 N20
      3 line 1 N1 level 1 X:active>inactive
      4 line 2 - level 1
      5 line 3 N30
      6 line 1 N4 level 1 X:inactive>active
      7 line 2 - level 1
      8 line 3 - level 1
      9 line 4 N40
      10 line 5 N50
      11 line 6 -
      end 11 M30 X:active Y:active Z:unconfigured B:ineffective
    b.nc -
      1 line 1 -
      2 line 1 N3 level 1
      3 line 2 - level 1
      4 line 2 -
      end 4 M30 X:active Y:active Z:unconfigured B:ineffective
    ");
    let program =
        "#VAR\nV.P.N : STRING[20] = \"change.nc\"\n#ENDVAR\n#FILE NAME [M6=V.P.N]\nM6\nM30";
    assert!(bench.run(&[program]).contains("X:active>inactive"));
    let program = "#FILE NAME [M6=V.E.N]\nM6\nM30";
    let transcript = bench.run(&[program]);
    assert!(
        transcript.contains("FC902") && transcript.contains("X:unknown"),
        "{transcript}"
    );
    // In a region that may or may not be executed.
    let program = "$IF V.E.X\n#FILE NAME [M6=\"change.nc\"]\n$ENDIF\nM6\nM30";
    let transcript = bench.run(&[program]);
    assert!(
        transcript.contains("FC902") && transcript.contains("X:unknown"),
        "{transcript}"
    );
    let program = "$IF V.E.X\nM6\n$ENDIF\nM30";
    assert!(
        bench
            .run(&[program])
            .contains("end 2 M30 X:active Y:unknown")
    );
}

#[test]
fn a_modal_cycle_that_may_be_in_force_leaves_its_traces() {
    // R2.51
    let bench = Bench::new().file("c.nc", "X[COMP OFF FRICT]\nM17");
    for start in [
        "$IF V.E.X\nL CYCLE [NAME=c.nc MODAL_MOVE]\n$ENDIF",
        "X[COMP ON FRICT]\nL CYCLE [NAME=c.nc MODAL_MOVE]\n$IF V.E.X\n#DISABLE MODAL CYCLE\n$ENDIF",
    ] {
        let program = format!("{start}\nX[COMP ON FRICT]\nY1\nN99 P1=1\nM30");
        let transcript = bench.run(&[&program]);
        assert!(
            ends(&transcript)[0].contains("X:unknown"),
            "{start}: {transcript}"
        );
        let program = format!("{start}\n#DISABLE MODAL CYCLE\nX[COMP ON FRICT]\nY1\nM30");
        let transcript = bench.run(&[&program]);
        assert!(
            ends(&transcript)[0].contains("X:active"),
            "{start}: {transcript}"
        );
    }
}

#[test]
fn a_call_that_finds_nothing_on_one_way_ends_it() {
    // R14.5
    for call in ["L nothing.nc", "LL NOTHING", "L CYCLE [NAME=nothing.nc]"] {
        let program = format!("X1 Y1\n$IF V.E.X\n{call}\n$ENDIF\nM30");
        let transcript = Bench::new().run(&[&program]);
        assert!(
            ends(&transcript)[0].contains("X:active Y:active"),
            "{call}: {transcript}"
        );
    }
}

#[test]
fn programs_that_only_the_machine_has() {
    // R2.83
    let calls = "L secret.ecy\nL \"SYSCYCLE_1.CYC\"\nM30";
    let said = Bench::new().said("L secret.ecy\nM30");
    assert!(
        said.contains("FC320") && said.contains("external = [\"secret.ecy\"]"),
        "{said}"
    );
    let external = "external = [\"*.ecy\", \"SysCycle*.cyc\"]";
    assert_snapshot!(machine(external).run(&[calls]), @r#"
    start X:active Y:active Z:unconfigured B:ineffective
    a.nc -
      1 line 1 - X:active>unknown Y:active>unknown B:ineffective>unknown
        FC902 1:1-13
      2 line 2 -
        FC902 2:1-19
      3 line 3 -
      end 3 M30 X:unknown Y:unknown Z:unconfigured B:unknown
    opaque {"SYSCYCLE_1.CYC": 1, "secret.ecy": 1}
    "#);
    let keeps = |keeps: &str| machine(&format!("{external}\n[machine.external_keeps]\n{keeps}"));
    let all = keeps("compensation = true\npositions = true");
    assert_snapshot!(all.run(&[calls]), @r#"
    start X:active Y:active Z:unconfigured B:ineffective
    a.nc -
      1 line 1 -
      2 line 2 -
      3 line 3 -
      end 3 M30 X:active Y:active Z:unconfigured B:ineffective
    opaque {"SYSCYCLE_1.CYC": 1, "secret.ecy": 1}
    "#);
    assert_snapshot!(all.positions("G90 X1 Y2\nL a.ecy\nX3\nM30"), @"
    G90 X1 Y2 X:1 Y:2 Z:? B:?
    L a.ecy X:1 Y:2 Z:? B:?
    X3 X:3 Y:2 Z:? B:?
    M30 X:3 Y:2 Z:? B:?
    ");
    let states = keeps("compensation = true");
    assert_snapshot!(states.said("X1\nL a.ecy\nM30"), @"
    FC902 2:1 the program `a.ecy` is only on the machine; the call is passed over, and all positions become unknown
      help: if it leaves them as they are, say so in `[machine.external_keeps]`
    ");
    assert_snapshot!(states.positions("G90 X1 Y2\nL a.ecy\nX3\nM30"), @"
    G90 X1 Y2 X:1 Y:2 Z:? B:?
    L a.ecy X:?* Y:?* Z:?* B:?*
    X3 X:3* Y:?* Z:?* B:?*
    M30 X:3* Y:?* Z:?* B:?*
    ");
    let some = keeps("compensation = [\"*.ecy\"]\npositions = [\"*.ecy\"]");
    let transcript = some.run(&["L a.ecy\nX1\nL SysCycle.cyc\nM30"]);
    assert!(
        transcript.contains("FC902 3:1-15") && !transcript.contains("FC902 1:"),
        "{transcript}"
    );
    // As a modal cycle, before a program, in an unknown region, called by a word.
    let modal =
        machine(external).run(&["L CYCLE [NAME=a.ecy MODAL_MOVE]\nX[COMP ON FRICT]\nY1\nM30"]);
    assert!(ends(&modal)[0].contains("X:unknown"), "{modal}");
    let start = machine(&format!("{external}\nstart_program = \"a.ecy\"")).run(&["X1\nM30"]);
    assert!(ends(&start)[0].contains("X:unknown"), "{start}");
    let region = machine(external).run(&["$IF V.E.X\nL a.ecy\n$ENDIF\nM30"]);
    assert!(ends(&region)[0].contains("X:unknown"), "{region}");
    let word =
        machine(&format!("{external}\n[machine.programs]\nM6 = \"a.ecy\"")).run(&["M6\nM30"]);
    assert!(ends(&word)[0].contains("X:unknown"), "{word}");
    // It shares the parameters and variables of its caller (R2.33, R2.52).
    let program = "P1=0\nV.P.A=0\nL a.ecy\n$IF P1+V.P.A==1\nX[COMP OFF FRICT]\n$ENDIF\nM30";
    let parameters = all.run(&[program]);
    assert!(ends(&parameters)[0].contains("X:unknown"), "{parameters}");
    let kept = keeps("compensation = true\npositions = true\nparameters = true").run(&[program]);
    assert!(ends(&kept)[0].contains("X:active"), "{kept}");
    let not_a_key =
        frictcomp::machine::Machine::from_toml("[machine.external_keeps]\nmodal = true\n");
    assert!(not_a_key.is_err());
}

#[test]
fn what_an_unknown_cycle_does_is_not_known() {
    // R18.8: as after a program that only the machine has, wherever the word is executed
    let unknown = |programs: &[&str]| {
        let transcript = Bench::new().run(programs);
        let all = ends(&transcript);
        let last = all.last().copied().unwrap_or_default();
        assert!(
            last.contains("X:unknown Y:unknown Z:unconfigured B:unknown"),
            "{programs:?}: {transcript}"
        );
        transcript
    };
    for block in [
        "G81",
        "N10 G80",
        "G81 X1 Z-5",
        "G800",
        "G839[1, 2, , 4]",
        "G85 [P1]",
        "G899",
    ] {
        let transcript = unknown(&[&format!("P1=1\n{block}\nM30")]);
        assert_eq!(transcript.matches("FC325").count(), 1, "{transcript}");
    }
    // In a macro, a loop, a subprogram, on one way only, before the state of another program.
    unknown(&["\"DRILL\" = \"G81\"\n\"DRILL\"\nM30"]);
    let repeated = unknown(&["$FOR P1=1,3,1\nG81\nG82\nG81\n$ENDFOR\nM30"]);
    assert_eq!(repeated.matches("FC325").count(), 2, "{repeated}");
    unknown(&["%L SUB\nG83[1]\nM17\n%M\nLL SUB\nM30"]);
    unknown(&["$IF V.E.A == 1\nG81\n$ENDIF\nM30"]);
    unknown(&["/ G81\nM30"]);
    let session = unknown(&["G81\nM30", "G81\nM30"]);
    assert_eq!(session.matches("FC325").count(), 2, "{session}");
    // The program is called after the words of its block, and a later command sets the state.
    unknown(&["G81 X[COMP ON FRICT]\nM30"]);
    let set = Bench::new().run(&["G81\nX[COMP ON FRICT]\nM30"]);
    assert!(ends(&set)[0].contains("X:active Y:unknown"), "{set}");
    // Values that it may write.
    let values = Bench::new().values("P1=1\nV.P.A=2\nG0 X5\nG81", &["P1", "V.P.A", "V.A.ABS.X"]);
    assert_eq!(values.matches("-> unknown").count(), 3, "{values}");
    let found = Bench::new().said("G81\nM30");
    for wanted in [
        "FC325 1:1 no program is known for `G81`",
        "every axis becomes unknown",
        "[machine.programs]",
        "[machine.external_keeps]",
        "harmless = [\"G81\"]",
    ] {
        assert!(found.contains(wanted), "{wanted}: {found}");
    }
    // M, T and D words change nothing unless a program is named.
    let words = Bench::new().run(&["T3 D2 M6\nM100\nM30"]);
    assert!(ends(&words)[0].contains("X:active Y:active"), "{words}");
}

#[test]
fn a_configuration_says_what_an_unknown_cycle_keeps() {
    // R18.8
    let harmless = machine("harmless = [\"G81\", \"G800\"]");
    for program in ["P1=1\nG81\nG800[1]\nM30", "$IF V.E.A\nG81\n$ENDIF\nM30"] {
        let transcript = harmless.run(&[program]);
        assert!(
            ends(&transcript)[0].contains("X:active Y:active"),
            "{transcript}"
        );
        assert!(!transcript.contains("FC325"), "{transcript}");
    }
    let values = harmless.values("P1=1\nG0 X5\nG81", &["P1", "V.A.ABS.X"]);
    assert!(
        values.contains("P1 -> 1") && values.contains("V.A.ABS.X -> unknown"),
        "{values}"
    );
    assert!(ends(&harmless.run(&["G82\nM30"]))[0].contains("X:unknown"));
    let external = "external = [\"*.ecy\"]\n[machine.programs]\nG81 = \"drill.ecy\"";
    assert!(ends(&machine(external).run(&["G81\nM30"]))[0].contains("X:unknown"));
    let keeps = "[machine.external_keeps]\ncompensation = true";
    let kept = machine(&format!("{external}\n{keeps}")).run(&["G81\nM30"]);
    assert!(ends(&kept)[0].contains("X:active"), "{kept}");
    let named = machine("[machine.external_keeps]\ncompensation = [\"G8?\"]");
    let transcript = named.run(&["G81\nM30"]);
    assert!(ends(&transcript)[0].contains("X:active"), "{transcript}");
    let found = named.said("G81\nM30");
    assert!(
        found.contains("FC325") && found.contains("all positions become unknown"),
        "{found}"
    );
    let missing = machine("[machine.programs]\nM6 = \"gone.nc\"").said("M6\nM30");
    assert!(missing.contains("FC320"), "{missing}");
}
