//! 2.4: expressions.

use insta::assert_snapshot;

use crate::support::Bench;

fn values(expressions: &[&str]) -> String {
    Bench::new().values("P1=1 P2=2 P10=2", expressions)
}

#[test]
fn operators_and_their_precedence() {
    // R2.30
    assert_snapshot!(values(&[
        "1+2*3", "[1+2]*3", "-2**2", "2**3**2", "2**-1", "10 MOD 4 + 1", "11MOD 3", "8/4/2", "2-3-4",
        "1+1==2", "1 < 2 == 1", "3 >= 3", "3 <= 2", "3 != 3", "2 > 1",
        "6 & 3", "6 | 3", "6 ^ 3", "1 | 6 & 3", "1 | 2 ^ 3",
        "INV['16#FFFFFFF0']", "1 && 0", "0 || 1", "1 || 0 && 0", "1 XOR 1", "1 XOR 0", "NOT[1]", "NOT[0.4]",
        "1 AND 0", "0 OR 1", "- -2", "+3", "-[1+1]", "2*-3", "1==1 && 2==3",
    ]), @"
    1+2*3 -> 7
    [1+2]*3 -> 9
    -2**2 -> -4
    2**3**2 -> 512
    2**-1 -> 0.5
    10 MOD 4 + 1 -> 3
    11MOD 3 -> 2
    8/4/2 -> 1
    2-3-4 -> -5
    1+1==2 -> 1
    1 < 2 == 1 -> 1
    3 >= 3 -> 1
    3 <= 2 -> 0
    3 != 3 -> 0
    2 > 1 -> 1
    6 & 3 -> 2
    6 | 3 -> 7
    6 ^ 3 -> 5
    1 | 6 & 3 -> 3
    1 | 2 ^ 3 -> 1
    INV['16#FFFFFFF0'] -> 15
    1 && 0 -> 0
    0 || 1 -> 1
    1 || 0 && 0 -> 1
    1 XOR 1 -> 0
    1 XOR 0 -> 1
    NOT[1] -> 0
    NOT[0.4] -> 1
    1 AND 0 -> 0
    0 OR 1 -> 1
    - -2 -> 2
    +3 -> 3
    -[1+1] -> -2
    2*-3 -> -6
    1==1 && 2==3 -> 0
    ");
}

#[test]
fn functions_and_constants() {
    // R2.30 R2.31
    assert_snapshot!(values(&[
        "ABS[-2]", "SQR[3]", "SQRT[16]", "EXP[0]", "LN[EXP[2]]", "DEXP[2]", "LOG[1000]", "SIN[30]", "cos[60]",
        "Tan[45]", "COT[45]", "ASIN[0.5]", "ACOS[0.5]", "ATAN[1]", "ATAN2[1, -1]", "ACOT[1]", "INT[-2.7]",
        "FRACT[2.75]", "CEIL[2.1]", "FLOOR[-2.1]", "ROUND[2.5]", "ROUND[-2.5]", "PI", "TRUE", "FALSE",
        "MIN[3, 2]", "MAX[3, 2]", "SIGN[-7]", "SIN[180]", "COS[90]", "[[sin[P1*30]+P2]/P1]",
    ]), @"
    ABS[-2] -> 2
    SQR[3] -> 9
    SQRT[16] -> 4
    EXP[0] -> 1
    LN[EXP[2]] -> 2
    DEXP[2] -> 100
    LOG[1000] -> 3
    SIN[30] -> 0.5
    cos[60] -> 0.5
    Tan[45] -> 1
    COT[45] -> 1
    ASIN[0.5] -> 30
    ACOS[0.5] -> 60
    ATAN[1] -> 45
    ATAN2[1, -1] -> 135
    ACOT[1] -> 45
    INT[-2.7] -> -2
    FRACT[2.75] -> 0.75
    CEIL[2.1] -> 3
    FLOOR[-2.1] -> -3
    ROUND[2.5] -> 3
    ROUND[-2.5] -> -3
    PI -> 3.141592654
    TRUE -> 1
    FALSE -> 0
    MIN[3, 2] -> 2
    MAX[3, 2] -> 3
    SIGN[-7] -> -1
    SIN[180] -> 0
    COS[90] -> 0
    [[sin[P1*30]+P2]/P1] -> 2.5
    ");
}

#[test]
fn truth() {
    // R2.31
    let taken = |condition: &str| {
        Bench::new()
            .run(&[&format!("$IF {condition}\nX[COMP OFF FRICT]\n$ENDIF\nM30")])
            .contains("X:active>inactive")
    };
    assert!(taken("0.5") && taken("-0.5") && taken("3") && taken("-7"));
    assert!(!taken("0.4") && !taken("0") && !taken("-0.49"));
}

#[test]
fn numbers() {
    // R2.32
    assert_snapshot!(values(&["5", "5.", ".5", "-.5", "007", "'16#FA1B'", "'0x0ED2'", "'H1869f'", "'2#101'", "'ZZ'"]), @"
    5 -> 5
    5. -> 5
    .5 -> 0.5
    -.5 -> -0.5
    007 -> 7
    '16#FA1B' -> 64027
    '0x0ED2' -> 3794
    'H1869f' -> 99999
    '2#101' -> 5
    'ZZ' -> FC312 2:9-13
    ");
}

#[test]
fn parameters() {
    // R2.33
    assert_snapshot!(values(&["P1+P2", "PP10", "PPP10*2", "P99", "P[5]", "PP99"]), @"
    P1+P2 -> 3
    PP10 -> 2
    PPP10*2 -> 4
    P99 -> FC311 2:9-12
    P[5] -> FC311 2:9-13
    PP99 -> FC311 2:10-13
    ");
    let bench = Bench::new();
    let preparation = "#VAR\nP100[3] = [1, 2, 3]\nP200[2][2] = [[1, 2], [3, 4]]\n#ENDVAR\nP100[2] = 30 P300[1] = 7 P2000=1";
    assert_snapshot!(bench.values(preparation, &["P100[0]+P100[2]", "P200[1][0]", "P200[1,1]", "P300[1]", "P2000", "P100[3]", "SIZEOF[P100]", "SIZEOF[P200,2]"]), @"
    P100[0]+P100[2] -> 31
    P200[1][0] -> 3
    P200[1,1] -> 4
    P300[1] -> 7
    P2000 -> 1
    P100[3] -> FC311 6:9-16
    SIZEOF[P100] -> 3
    SIZEOF[P200,2] -> 2
    ");
    // Cleared at program start, shared with subprograms.
    assert_snapshot!(bench.run(&["%L S\nP2=P1\nM17\n%M\nP1=5\nLL S\nP3=P2\nM30", "P1=P3\nM30"]), @"
    start X:active Y:active Z:unconfigured B:ineffective
    a.nc M
      1 line 5 -
      2 line 6 -
      3 line 2 - level 1
      4 line 3 - level 1
      5 line 7 -
      6 line 8 -
      end 6 M30 X:active Y:active Z:unconfigured B:ineffective
    b.nc -
      1 line 1 -
        FC311 1:4-6
      end 1 error X:active Y:active Z:unconfigured B:ineffective
    ");
    // The configuration can keep them.
    let kept = Bench::on("[machine]\nkeep_parameters = true\n[[axis]]\nname = \"X\"");
    assert_snapshot!(kept.run(&["P1=5 V.P.A=1\nM30", "$IF P1 == 5\nX1\n$ENDIF\nM30"]), @"
    start X:unconfigured
    a.nc -
      1 line 1 -
      2 line 2 -
      end 2 M30 X:unconfigured
    b.nc -
      1 line 1 -
      2 line 2 -
      3 line 3 -
      4 line 4 -
      end 4 M30 X:unconfigured
    ");
}

#[test]
fn variables_of_the_control_are_not_declared() {
    // R2.34
    for name in ["V.E.A", "v.g.a", "V.A.A[3]", "V.I.A", "V.SPDL.A"] {
        let said = Bench::new().run(&[&format!("#VAR\n{name} = 1\n#ENDVAR\nM30")]);
        assert!(said.contains("FC207 2:1-"), "{name}: {said}");
    }
}

#[test]
fn variables() {
    // R2.34
    let preparation = "#VAR\nV.P.COUNT : UNS32 = 3\nV.P.LIST[2][3] = [1, 2, 3, \\\n4, 5, 6]\nV.P.ZERO\nV.L.NAME : STRING[20] = \"abc\"\nV.L.EMPTY : STRING[5]\nV.L.A[3]\nV.L.T : STRING[5]\nV.CYC.N = 4\n#ENDVAR\nV.P.NEW = 8\nV.L.A[1] = 5\nV.P.GONE = 1\n#DELETE V.P.GONE";
    assert_snapshot!(Bench::new().values(preparation, &[
        "V.P.COUNT", "V.P.LIST[1][2]", "V.P.LIST[0,1]", "V.P.ZERO", "V.L.NAME", "V.L.EMPTY", "V.L.A[0]+V.L.A[1]", "V.CYC.N",
        "V.P.NEW", "V.P.GONE", "EXIST[V.P.GONE]", "EXIST[V.P.NEW]", "EXIST[P7]", "EXIST[V.L.A[2]]", "EXIST[V.L.A[3]]", "SIZEOF[V.P.LIST]", "SIZEOF[V.P.LIST, 2]", "SIZEOF[V.L.A]",
        "V.P.NONE", "V.L.NONE", "V.S.NONE",
    ]), @r#"
    V.P.COUNT -> 3
    V.P.LIST[1][2] -> 6
    V.P.LIST[0,1] -> 2
    V.P.ZERO -> 0
    V.L.NAME -> "abc"
    V.L.EMPTY -> ""
    V.L.A[0]+V.L.A[1] -> 5
    V.CYC.N -> 4
    V.P.NEW -> 8
    V.P.GONE -> FC311 16:9-17
    EXIST[V.P.GONE] -> 0
    EXIST[V.P.NEW] -> 1
    EXIST[P7] -> 0
    EXIST[V.L.A[2]] -> 1
    EXIST[V.L.A[3]] -> 0
    SIZEOF[V.P.LIST] -> 2
    SIZEOF[V.P.LIST, 2] -> 3
    SIZEOF[V.L.A] -> 3
    V.P.NONE -> FC311 16:9-17
    V.L.NONE -> FC311 16:9-17
    V.S.NONE -> FC311 16:9-17
    "#);
    // V.S. outlives programs, V.P. does not.
    assert_snapshot!(Bench::new().run(&["V.S.A=1 V.P.A=1\nM30", "P1=V.S.A\nP2=V.P.A\nM30"]), @"
    start X:active Y:active Z:unconfigured B:ineffective
    a.nc -
      1 line 1 -
      2 line 2 -
      end 2 M30 X:active Y:active Z:unconfigured B:ineffective
    b.nc -
      1 line 1 -
      2 line 2 -
        FC311 2:4-9
      end 2 error X:active Y:active Z:unconfigured B:ineffective
    ");
}

#[test]
fn strings() {
    // R2.35
    assert_snapshot!(values(&[
        "\"Hello\" + \" world!\"", "LEFT[\"Hello world!\", 5]", "MID[\"How are you?\", 3, 5]",
        "RIGHT[\"Hello world! How are you?\", 12]", "LEN[\"Hello world! How are you?\"]",
        "FIND[\"Hello world! How are you?\", \"How\"]", "FIND[\"abc\", \"x\"]", "ORD[\"Hello world!\", 1]", "ORD[\"Hello world!\", 7]", "ORD[\"A\"]",
        "INSERT[\"Hello!\", \" world\", 5]", "DELETE[\"Hello world!\", 6, 6]", "REPLACE[\"Hello world!\", \"Y\", 5, 1]",
        "INT_TO_STR[12]", "REAL_TO_STR[1.5]", "STR_TO_INT[\"12\"]+1", "STR_TO_REAL[\"1.5\"]*2",
        "\"a\" == \"a\"", "\"a\" != \"a\"", "LEN[\"a;b(c\"]", "LEN[\"a\\\"b\"]", "ORD[\"ab\", 3]", "\"a\" + 1", "\"a\" * \"b\"",
    ]), @r#"
    "Hello" + " world!" -> "Hello world!"
    LEFT["Hello world!", 5] -> "Hello"
    MID["How are you?", 3, 5] -> "are"
    RIGHT["Hello world! How are you?", 12] -> "How are you?"
    LEN["Hello world! How are you?"] -> 25
    FIND["Hello world! How are you?", "How"] -> 14
    FIND["abc", "x"] -> 0
    ORD["Hello world!", 1] -> 72
    ORD["Hello world!", 7] -> 119
    ORD["A"] -> 65
    INSERT["Hello!", " world", 5] -> "Hello world!"
    DELETE["Hello world!", 6, 6] -> "Hello!"
    REPLACE["Hello world!", "Y", 5, 1] -> "Y world!"
    INT_TO_STR[12] -> "12"
    REAL_TO_STR[1.5] -> "1.5"
    STR_TO_INT["12"]+1 -> 13
    STR_TO_REAL["1.5"]*2 -> 3
    "a" == "a" -> 1
    "a" != "a" -> 0
    LEN["a;b(c"] -> 5
    LEN["a\"b"] -> 3
    ORD["ab", 3] -> FC312 2:9-21
    "a" + 1 -> FC312 2:9-16
    "a" * "b" -> FC312 2:9-18
    "#);
}

#[test]
fn a_string_is_no_number() {
    // R2.37
    for program in [
        "X[P1]",
        "F[P1]",
        "G[P1]",
        "P[\"a\"] = 5",
        "P2 = P[P1]",
        "#TIME P1",
        "N[P1] X1",
        "$FOR P2=0, P1, 1\n$ENDFOR",
        "L SEQUENCE [N1 N2 REPEAT=P1]",
    ] {
        let said = Bench::new().run(&[&format!("P1 = \"a\"\n{program}\nM30")]);
        assert!(said.contains("FC312"), "{program}: {said}");
    }
}

#[test]
fn macros() {
    // R2.35
    let preparation = "\"STRING1\" = \"COS[\\\"STRING2\\\"]\"\n\"STRING2\" = \"5 * 12\"\n\"STRING3\" = \"SIN[89.5 + \\\"STRING1\\\"]\"";
    assert_snapshot!(Bench::new().values(preparation, &["-2 * \"STRING1\" + \"STRING2\" + \"STRING3\"", "\"STRING2\"/6", "\"OTHER\""]), @r#"
    -2 * "STRING1" + "STRING2" + "STRING3" -> 60
    "STRING2"/6 -> 10
    "OTHER" -> "OTHER"
    "#);
    let program = "\"OFF\" = \"X[COMP OFF FRICT] Y[COMP OFF FRICT]\"\n\"BOTH\" = \"\\\"OFF\\\" X[COMP ON FRICT] G1 X5\"\nN10 \"OFF\"\nN20 \"BOTH\"\nN30 \"NONE\"\nN40 G\"GNUM\"\n\"GNUM\" = \"60 - 7\"\nN50 G\"GNUM\" X\"POS\"\nN60 #INIT MACRO TAB\nN70 \"OFF\"\nM30";
    assert_snapshot!(Bench::new().keep_going().run(&[program]), @"
    start X:active Y:active Z:unconfigured B:ineffective
    a.nc -
      1 line 1 -
      2 line 2 -
      3 line 3 N10 X:active>inactive Y:active>inactive
      4 line 4 N20 X:inactive>active
        FC301 4:5-11
        FC327 4:5-11
        FC402 4:5-11
        FC402 4:5-11
        FC405 4:5-11
      5 line 5 N30
        FC207 5:5-11
      6 line 6 N40
        FC312 6:5-12
      7 line 7 -
      8 line 8 N50
        FC312 8:13-19
      9 line 9 N60
      10 line 10 N70
        FC207 10:5-10
      11 line 11 -
        FC401 4:5-11
      end 11 M30 X:active Y:inactive Z:unconfigured B:ineffective
    ");
    assert_snapshot!(Bench::new().run(&["\"A\" = \"X[COMP OFF FRICT]\"\nM30", "\"A\"\nM30"]), @"
    start X:active Y:active Z:unconfigured B:ineffective
    a.nc -
      1 line 1 -
      2 line 2 -
      end 2 M30 X:active Y:active Z:unconfigured B:ineffective
    b.nc -
      1 line 1 - X:active>inactive
      2 line 2 -
        FC401 1:1-4
      end 2 M30 X:inactive Y:active Z:unconfigured B:ineffective
    ");
}

#[test]
fn system_variables() {
    // R2.36
    let bench = Bench::new()
        .set("V.E.PART", 3.0)
        .set_text("V.E.NAME", "abc")
        .set("V.G.WZ[2].R", 5.0);
    assert_snapshot!(bench.values("G1 X10 Y20 F100", &[
        "V.E.PART", "V.E.NAME", "V.G.WZ[2].R", "V.E.OTHER", "V.A.ABS.X", "V.A.PROG[1]", "V.A.ABS.Z", "V.A.MODE.X", "V.G.NONE", "V.SPDL.POS", "V.TOOL.N",
        "V.E.LIST[2].X", "V.A.FRICT_COMP_INIT.X", "V.A.FRICT_COMP_ACTIVE.Z", "V.A.BACKLASH_COMP_ACTIVE.X", "EXIST[V.E.OTHER]", "SIZEOF[V.E.OTHER]",
    ]), @r#"
    V.E.PART -> 3
    V.E.NAME -> "abc"
    V.G.WZ[2].R -> 5
    V.E.OTHER -> unknown: V.E.OTHER
    V.A.ABS.X -> 10
    V.A.PROG[1] -> 20
    V.A.ABS.Z -> unknown: V.A.ABS.Z
    V.A.MODE.X -> unknown: V.A.MODE.X
    V.G.NONE -> unknown: V.G.NONE
    V.SPDL.POS -> unknown: V.SPDL.POS
    V.TOOL.N -> unknown: V.TOOL.N
    V.E.LIST[2].X -> unknown: V.E.LIST[2].X
    V.A.FRICT_COMP_INIT.X -> 1
    V.A.FRICT_COMP_ACTIVE.Z -> 0
    V.A.BACKLASH_COMP_ACTIVE.X -> unknown: V.A.BACKLASH_COMP_ACTIVE.X
    EXIST[V.E.OTHER] -> unknown: V.E.OTHER
    SIZEOF[V.E.OTHER] -> unknown: V.E.OTHER
    "#);
}

#[test]
fn what_cannot_be_computed() {
    // R2.37: the span is that of the sub-expression.
    assert_snapshot!(values(&[
        "1 + 2/0 + 3", "7 MOD 0", "1 + SQRT[-1]", "LN[0]", "LOG[-1]", "ASIN[2]", "TAN[90]", "COT[0]", "1E",
        "\"a\" + 1", "NOT[\"a\"]", "-\"a\"", "ABS[\"a\"]", "SIN[1, 2]", "2 * [P99 + 1]", "EXP[100000]", "[-8]**0.5", "1.5 & 1", "INV[-1]",
    ]), @r#"
    1 + 2/0 + 3 -> FC312 2:13-16
    7 MOD 0 -> FC312 2:9-16
    1 + SQRT[-1] -> FC312 2:13-21
    LN[0] -> FC312 2:9-14
    LOG[-1] -> FC312 2:9-16
    ASIN[2] -> FC312 2:9-16
    TAN[90] -> FC312 2:9-16
    COT[0] -> FC312 2:9-15
    1E -> 1
    "a" + 1 -> FC312 2:9-16
    NOT["a"] -> FC312 2:9-17
    -"a" -> FC312 2:9-13
    ABS["a"] -> FC312 2:9-17
    SIN[1, 2] -> FC312 2:9-18
    2 * [P99 + 1] -> FC311 2:14-17
    EXP[100000] -> FC312 2:9-20
    [-8]**0.5 -> FC312 2:9-18
    1.5 & 1 -> 0
    INV[-1] -> FC312 2:9-16
    "#);
}
